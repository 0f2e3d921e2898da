// The symbol file of `opennck signals --format node-red`: node-red-contrib-s7 splits the lines of its import at the semicolon and passes
// the addresses to nodes7, which must read all of them.
'use strict';
const { execFileSync } = require('node:child_process');
const { S7Endpoint, S7ItemGroup } = require('@st-one-io/nodes7');
const { equal, holds, port, run } = require('./checks.js');

run(async () => {
  const options = ['signals', '--machine', 'g1_example', '--format', 'node-red'];
  const text = execFileSync(process.env.OPENNCK, options, { encoding: 'utf8' });
  const variables = new Map(text.trim().split('\n').map((line) => line.split(';').reverse()));
  holds('more than a hundred variables', variables.size > 100, `${variables.size}`);
  equal('a key', variables.get('X.traversing_key_plus'), 'DB31,X4.7');

  const endpoint = new S7Endpoint({ host: '127.0.0.1', port, rack: 0, slot: 2, autoReconnect: 0 });
  await endpoint.connect();
  const group = new S7ItemGroup(endpoint);
  group.setTranslationCB((name) => variables.get(name));
  group.addItems([...variables.keys()]);
  const values = await group.readAllItems();
  equal('all are read', Object.keys(values).length, variables.size);
  for (const [name, address] of variables) {
    const expected = /,X/.test(address) ? 'boolean' : 'number';
    equal(`the type of ${name}`, typeof values[name], expected);
  }
  equal('X is the leading axis', values['X.gantry_leading_axis'], true);
  await endpoint.disconnect();
});
