// Node-RED itself with node-red-contrib-s7, without a screen: the flow in flows.json reads cyclically, reports changes, writes, and
// requests blocks and lists. This script controls it over HTTP, as a user would with its editor and buttons.
'use strict';
const { spawn } = require('node:child_process');
const fs = require('node:fs');
const net = require('node:net');
const os = require('node:os');
const path = require('node:path');
const { isDeepStrictEqual, inspect } = require('node:util');
const { becomes, equal, holds, pattern, run, sleep } = require('../checks.js');

const freePort = () =>
  new Promise((resolve) => {
    const server = net.createServer().listen(0, '127.0.0.1', () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });

run(async () => {
  const home = fs.mkdtempSync(path.join(os.tmpdir(), 'node-red-'));
  const http = await freePort();
  fs.copyFileSync(path.join(__dirname, 'flows.json'), path.join(home, 'flows.json'));
  const main = require.resolve('node-red/red.js');
  const modules = path.dirname(path.dirname(main));
  const settings = { uiHost: '127.0.0.1', uiPort: http, flowFile: 'flows.json', httpAdminRoot: false, nodesDir: path.join(modules, 'node-red-contrib-s7'), telemetry: { enabled: false, updateNotification: false }, logging: { console: { level: 'info' } } };
  fs.writeFileSync(path.join(home, 'settings.js'), `module.exports = ${JSON.stringify(settings)};`);
  const log = fs.openSync(path.join(home, 'log'), 'w');
  const red = spawn(process.execPath, [main, '--userDir', home, '--settings', path.join(home, 'settings.js')], { stdio: ['ignore', log, log] });
  process.on('exit', () => {
    red.kill('SIGKILL');
    if (process.env.KEEP_LOG) fs.copyFileSync(path.join(home, 'log'), process.env.KEEP_LOG);
    fs.rmSync(home, { recursive: true, force: true });
  });

  const ask = async (where, body) => {
    const options = body === undefined ? {} : { method: 'POST', headers: { 'content-type': 'application/json' }, body: JSON.stringify(body) };
    const answer = await fetch(`http://127.0.0.1:${http}${where}`, { ...options, signal: AbortSignal.timeout(8000) });
    const bytes = Buffer.from(await answer.arrayBuffer());
    return answer.headers.get('content-type').includes('json') ? JSON.parse(bytes) : bytes;
  };
  const values = async () => (await ask('/values')).all;
  const value = async (name) => (await values())[name];
  const write = (variable, written) => ask('/write', { variable, value: written });
  const control = (name, payload = {}) => ask('/control', { function: name, payload });

  // It is connected and reads.
  const end = Date.now() + 60000;
  let first;
  while (!first && Date.now() < end) {
    await sleep(200);
    first = await ask('/values').then((found) => found.all && found, () => undefined);
  }
  holds('Node-RED runs and its endpoint reads', first !== undefined, fs.readFileSync(path.join(home, 'log'), 'utf8').slice(-2000));
  const { bool, int, real, dint, dword, word, byte, string, pattern: bytes } = first.all;
  equal('one value of each type', [bool, int, real, dint, dword, word, byte, string], [true, -12345, 1.5, -70000, 0xdeadbeef, 0xcafe, 200, 'HELLO']);
  equal('an array', bytes, [...pattern, ...pattern, ...pattern]);
  await becomes('X leads the gantry, XF does not', async () => [await value('X_leads'), await value('XF_leads')], [true, false]);
  const { cycles } = await ask('/values');
  await sleep(1000);
  const later = (await ask('/values')).cycles - cycles;
  holds('about twenty cycles in a second, fewer on a busy computer', later >= 3 && later <= 40, `${later}`);

  // It writes one and several values, and reads them back.
  for (const [name, written] of Object.entries({ bit: true, float: -2.25, text: 'panel', odd: 7, flag: true, flag_real: 0.5, input: true, output: 65000 })) {
    equal(`${name} is written`, await write(name, written), { done: true });
    await becomes(`${name} is found`, () => value(name), written);
  }
  const several = { bit: false, ints: [1, -2, 3, -4, 5], odd: 8, float: 4.5, text: 'seven', flag: false, output: 12 };
  equal('several in one message', await write(Object.keys(several), Object.values(several)), { done: true });
  await becomes('and found', async () => { const all = await values(); return Object.keys(several).map((name) => all[name]); }, Object.values(several));

  // A traversing key: the axis moves, and the flow gets the edges of its traverse command, one message each.
  const before = (await ask('/values')).edges;
  equal('key of Y', await write('key_plus_Y', true), { done: true });
  await becomes('Y traverses', () => value('traverse_command_Y'), true);
  equal('key released', await write('key_plus_Y', false), { done: true });
  await becomes('Y stands', () => value('traverse_command_Y'), false);
  equal('two edges', (await ask('/values')).edges.slice(before.length), [true, false]);
  const { changes } = await ask('/values');
  holds('only what changed is reported', changes.filter(([name]) => name === 'int').length === 1, inspect(changes.slice(0, 60)));

  // An address that does not exist does not affect the others.
  const logged = () => fs.readFileSync(path.join(home, 'log'), 'utf8');
  await becomes('a block that is not there is named', async () => /DB \[99\].*Object does not exist/.test(logged()), true);
  await becomes('its endpoint is offline, the one by TSAP has its value', async () => { const { gone, tsap, states } = await ask('/values'); return [gone, states.in_gone?.at(-1), tsap]; }, [undefined, 'red offline', { int: -12345 }]);

  // Blocks, lists, upload.
  const blocks = await control('list-blocks');
  holds('blocks are listed', isDeepStrictEqual([31, 1000, 1001, 1002].map((number) => (blocks.DB || []).some((block) => block.number === number)), [true, true, true, true]), inspect(blocks).slice(0, 300));
  const info = await control('all-block-info');
  // Each entry as sent by the CPU: the number follows type and language.
  const numbers = (Array.isArray(info) ? info : []).map(({ data }) => data[12] * 256 + data[13]);
  holds('information of all blocks', [31, 1000, 1001, 1002].every((number) => numbers.includes(number)), inspect(info).slice(0, 300));
  const upload = await control('upload-block', { type: 'DB', number: 1001 });
  holds('an upload has the bytes', Buffer.isBuffer(upload) && upload.includes(Buffer.from([...pattern, ...pattern, ...pattern])), inspect(upload).slice(0, 300));
  const all = await control('upload-all-blocks');
  holds('all blocks are uploaded', !all.error, inspect(all).slice(0, 300));
  const list = await control('ssl', { id: 0x1c, index: 1 });
  holds('a system state list', JSON.stringify(list).length > 20 && !list.error, inspect(list).slice(0, 300));
  holds('a list that does not exist is an error', (await control('ssl', { id: 0x0fff })).error !== undefined);
  holds('a block that does not exist is an error', (await control('upload-block', { type: 'DB', number: 99 })).error !== undefined);
  equal('and it goes on', await value('int'), -12345);
});
