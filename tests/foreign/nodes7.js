// nodes7, used by many tools: everything as bytes, more than fifty items per request, several requests in parallel.
'use strict';
const NodeS7 = require('nodes7');
const { becomes, equal, holds, pattern, port, run } = require('./checks.js');

/** A connection, and its functions as promises. */
function open() {
  const connection = new NodeS7({ silent: true });
  connection.setTranslationCB((name) => name);
  const connected = new Promise((resolve, reject) => {
    connection.initiateConnection({ port, host: '127.0.0.1', rack: 0, slot: 2, timeout: 5000 }, (error) =>
      error === undefined ? resolve() : reject(new Error(String(error))),
    );
  });
  const read = async (...names) => {
    connection.addItems(names);
    const found = await new Promise((resolve) => {
      connection.readAllItems((bad, values) => resolve({ bad, values }));
    });
    connection.removeItems(names);
    return { bad: found.bad, values: names.map((name) => found.values[name]) };
  };
  const write = (names, values) =>
    new Promise((resolve) => {
      connection.writeItems(names, values, (bad) => resolve(bad));
    });
  const close = () => new Promise((resolve) => connection.dropConnection(resolve));
  return { connection, connected, read, write, close };
}

run(async () => {
  const { connection, connected, read, write, close } = open();
  await connected;
  equal('the PDU that it asks for', connection.maxPDU, 960);

  const types = ['DB1000,X0.3', 'DB1000,INT2', 'DB1000,REAL4', 'DB1000,DINT8', 'DB1000,DWORD12', 'DB1000,WORD16', 'DB1000,BYTE18'];
  equal('one value of each type', (await read(...types)).values, [true, -12345, 1.5, -70000, 0xdeadbeef, 0xcafe, 200]);
  equal('STRING', (await read('DB1000,S20.10')).values, ['HELLO']);
  equal('an array', (await read('DB1001,BYTE0.9')).values, [[...pattern, ...pattern, ...pattern]]);
  equal('500 bytes', (await read('DB1001,BYTE0.500')).values[0].length, 500);

  // Far enough apart that each is a separate item, and all of them in one request.
  connection.doNotOptimize = true;
  const far = Array.from({ length: 60 }, (_, index) => `DB1001,BYTE${index * 8}`);
  equal('sixty items', (await read(...far)).values, far.map((_, index) => pattern[(index * 8) % 3]));
  connection.doNotOptimize = false;

  await becomes('X leads the gantry, XF does not', async () => (await read('DB31,X101.6', 'DB33,X101.6')).values, [true, false]);
  await becomes('JOG is active', async () => (await read('DB11,X6.2')).values, [true]);

  const written = {
    'M10.3': true,
    MB12: 77,
    MI14: -5,
    MW16: 65000,
    MDI20: -2000000,
    MR28: -0.25,
    QB9: 9,
    'DB1002,REAL100': 3.5,
    'DB1002,X3.7': true,
    'DB1002,S300.20': 'GANTRY',
    'DB1002,INT400.5': [1, -2, 3, -4, 5],
    'DB1002,BYTE500.3': [7, 8, 9],
    'DB1002,BYTE520': 1,
  };
  const names = Object.keys(written);
  equal('a write of many types', await write(names, Object.values(written)), false);
  equal('and what is found', (await read(...names)).values, Object.values(written));
  const big = Array.from({ length: 1500 }, (_, index) => (index * 3) & 0xff);
  equal('1500 bytes written', await write(['DB1002,BYTE520.1500'], [big]), false);
  equal('and found', (await read('DB1002,BYTE520.1500')).values, [big]);

  const bad = await read('DB99,INT0', 'DB1000,INT2');
  holds('DB 99 is bad', bad.bad === true && String(bad.values[0]).startsWith('BAD'), JSON.stringify(bad));
  equal('and the other is good', bad.values[1], -12345);
  holds('a write to DB 99 is bad', (await write(['DB99,INT0'], [1])) === true);
  equal('and it goes on', (await read('DB1000,INT2')).values, [-12345]);
  await close();
});
