// @st-one-io/nodes7, used by node-red-contrib-s7: typed items, no fill bytes in writes, blocks, clock and lists.
'use strict';
const { S7Endpoint, S7ItemGroup } = require('@st-one-io/nodes7');
const { becomes, equal, fails, holds, pattern, port, run } = require('./checks.js');

run(async () => {
  const plc = new S7Endpoint({ host: '127.0.0.1', port, rack: 0, slot: 2, autoReconnect: 0 });
  plc.on('error', (error) => holds('no error comes by itself', false, error.stack));
  await plc.connect();
  equal('the PDU that it asks for', plc.pduSize, 960);

  const read = async (...names) => {
    const group = new S7ItemGroup(plc);
    group.addItems(names);
    const found = await group.readAllItems();
    group.destroy();
    return names.map((name) => found[name]);
  };
  const write = async (names, values) => {
    const group = new S7ItemGroup(plc);
    group.addItems(names);
    await group.writeItems(names, values);
    group.destroy();
  };

  const types = ['DB1000,X0.3', 'DB1000,INT2', 'DB1000,REAL4', 'DB1000,DINT8', 'DB1000,DWORD12', 'DB1000,WORD16', 'DB1000,BYTE18'];
  equal('one value of each type', await read(...types), [true, -12345, 1.5, -70000, 0xdeadbeef, 0xcafe, 200]);
  equal('an array', await read('DB1001,BYTE0.9'), [[...pattern, ...pattern, ...pattern]]);
  const far = Array.from({ length: 60 }, (_, index) => `DB1001,BYTE${index * 8}`);
  equal('sixty items', await read(...far), far.map((_, index) => pattern[(index * 8) % 3]));
  equal('500 bytes', (await plc.readDB(1001, 0, 500)).length, 500);
  equal('flags', (await plc.readFlags(0, 16)).length, 16);
  equal('inputs and outputs', [(await plc.readInputs(0, 8)).length, (await plc.readOutputs(0, 8)).length], [8, 8]);

  await becomes('X leads the gantry, XF does not', () => read('DB31,X101.6', 'DB33,X101.6'), [true, false]);

  const written = {
    'M10.3': true,
    MB12: 77,
    MI14: -5,
    MW16: 65000,
    MDI20: -2000000,
    MR28: -0.25,
    'DB1002,REAL100': 3.5,
    'DB1002,X3.7': true,
    'DB1002,BYTE500': 1,
    'DB1002,BYTE502': 2,
    'DB1002,BYTE504': 3,
    'DB1002,INT400.5': [1, -2, 3, -4, 5],
  };
  const names = Object.keys(written);
  await write(names, Object.values(written));
  equal('what was written is found', await read(...names), Object.values(written));
  // As long as one request: it splits longer ones into a first piece and empty ones.
  const big = Buffer.from(Array.from({ length: 900 }, (_, index) => (index * 3) & 0xff));
  await plc.writeDB(1002, 520, big);
  equal('900 bytes written', Buffer.compare(await plc.readDB(1002, 520, 900), big), 0);

  await fails('DB 99', () => plc.readDB(99, 0, 1));
  await fails('a write after the end', () => plc.writeDB(1000, 600, Buffer.alloc(2)));
  equal('and it goes on', await read('DB1000,INT2'), [-12345]);

  const count = await plc.blockCount();
  holds('data blocks are counted', Object.values(count).some((number) => number >= 40), JSON.stringify(count));
  const blocks = await plc.listBlocks('DB');
  holds('and listed', [31, 1000, 1001, 1002].every((number) => blocks.some((block) => block.number === number)), JSON.stringify(blocks).slice(0, 200));
  const block = await plc.uploadBlock('DB', 1001);
  holds('an upload has the bytes', block.includes(Buffer.from([...pattern, ...pattern, ...pattern])), `${block.length}`);
  await fails('information of a block that does not exist', () => plc.getBlockInfo('DB', 99));
  holds('block information', (await plc.getBlockInfo('DB', 1001)) !== undefined);

  await plc.setTime(new Date(Date.UTC(2031, 4, 17, 12, 34, 56)));
  await becomes('the clock was set', async () => (await plc.getTime()).getFullYear(), 2031);

  holds('lists', (await plc.getAvailableSSL()).length > 20);
  const module = JSON.stringify(await plc.getModuleIdentification());
  holds('order number', module.includes('6ES7 317-2EK14-0AB0'), module);
  const component = JSON.stringify(await plc.getComponentIdentification());
  holds('type of the CPU', component.includes('CPU 317-2 PN/DP'), component);
  await fails('a list that does not exist', () => plc.getSSL(0x0fff, 0, true));
  await plc.disconnect();
});
