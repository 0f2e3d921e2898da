// node-snap7: snap7's client in C++ for JavaScript, used by FUXA and ioBroker.
'use strict';
const { S7Client } = require('node-snap7');
const { becomes, equal, holds, pattern, port, run } = require('./checks.js');

/** A client that is connected with this PDU. */
function connected(pdu) {
  const client = new S7Client();
  client.SetParam(client.RemotePort, port);
  client.SetParam(client.PDURequest, pdu);
  holds('it connects', client.ConnectTo('127.0.0.1', 0, 2), client.ErrorText(client.LastError()));
  equal('the PDU that it asks for', client.PDULength(), pdu);
  return client;
}

run(async () => {
  for (const pdu of [240, 480, 960]) {
    const client = connected(pdu);
    const long = client.DBRead(1001, 0, 512);
    equal('512 bytes', [...long], Array.from({ length: 512 }, (_, index) => pattern[index % 3]));
    const big = Buffer.from(Array.from({ length: 1500 }, (_, index) => (index * 3) & 0xff));
    holds('1500 bytes written', client.DBWrite(1002, 0, 1500, big));
    equal('and found', Buffer.compare(client.DBRead(1002, 0, 1500), big), 0);
    client.Disconnect();
  }

  const client = connected(480);
  const types = client.DBRead(1000, 0, 32);
  equal('BOOL', (types[0] >> 3) & 1, 1);
  equal('INT, REAL, DINT', [types.readInt16BE(2), types.readFloatBE(4), types.readInt32BE(8)], [-12345, 1.5, -70000]);
  equal('DWORD, WORD, BYTE', [types.readUInt32BE(12), types.readUInt16BE(16), types[18]], [0xdeadbeef, 0xcafe, 200]);
  const real = client.ReadArea(client.S7AreaDB, 1000, 4, 1, client.S7WLReal);
  equal('REAL as its type', real.readFloatBE(0), 1.5);
  const bit = client.ReadArea(client.S7AreaDB, 1000, 3, 1, client.S7WLBit);
  equal('BOOL as its type', [...bit], [1]);
  await becomes('X leads the gantry', async () => (client.DBRead(31, 101, 1)[0] >> 6) & 1, 1);

  for (const [name, read, write] of [
    ['M', 'MBRead', 'MBWrite'],
    ['I', 'EBRead', 'EBWrite'],
    ['Q', 'ABRead', 'ABWrite'],
  ]) {
    holds(`${name} written`, client[write](8, 3, Buffer.from([0x12, 0x34, 0x56])));
    equal(`${name} found`, [...client[read](8, 3)], [0x12, 0x34, 0x56]);
  }
  equal('timers and counters', [client.TMRead(0, 3).length, client.CTRead(2, 4).length], [6, 8]);

  const item = (number, start, amount) => ({
    Area: client.S7AreaDB, WordLen: client.S7WLByte, DBNumber: number, Start: start, Amount: amount,
  });
  const asked = Array.from({ length: 20 }, (_, index) => item(index === 1 ? 99 : 1001, index, 3));
  const found = client.ReadMultiVars(asked);
  holds('item 1 of 20 has an error of its own', found[1].Result !== 0);
  equal('item 19 of 20', [...found[19].Data], [pattern[1], pattern[2], pattern[0]]);
  const values = Array.from({ length: 20 }, (_, index) => ({ ...item(1002, 100 + 2 * index, 1), Data: Buffer.from([index]) }));
  holds('20 items written', client.WriteMultiVars(values).every((one) => one.Result === 0));
  equal('and found', client.DBRead(1002, 138, 1)[0], 19);
  const reals = [3, 7].map((index) => ({
    Area: client.S7AreaDB, WordLen: client.S7WLReal, DBNumber: 1002, Start: 200 + 4 * index, Amount: 1,
    Data: Buffer.from([0x41, 0x20, 0, index]),
  }));
  holds('two REAL written', client.WriteMultiVars(reals).every((one) => one.Result === 0));
  equal('each in its place', [client.DBRead(1002, 215, 1)[0], client.DBRead(1002, 231, 1)[0]], [3, 7]);

  equal('DB 99', client.DBRead(99, 0, 1), false);
  equal('after the end', client.DBRead(1000, 500, 20), false);
  holds('data blocks', client.ListBlocks().DBCount >= 3);
  const numbers = client.ListBlocksOfType(client.Block_DB);
  holds('their numbers', [31, 1000, 1001, 1002].every((number) => numbers.includes(number)), `${numbers}`);
  equal('block information', client.GetAgBlockInfo(client.Block_DB, 1001).MC7Size, 512);
  holds('an upload has the bytes', client.FullUpload(client.Block_DB, 1001, 1024).includes(Buffer.from(pattern)));

  equal('type of the CPU', client.GetCpuInfo().ModuleTypeName, 'CPU 317-2 PN/DP');
  equal('order code', client.GetOrderCode().Code.trim(), '6ES7 317-2EK14-0AB0');
  equal('protection', client.GetProtection().sch_schal, 1);
  holds('the communication processor', client.GetCpInfo().MaxPduLength >= 240);
  holds('the list of lists', client.ReadSZLList().length > 20);
  equal('a list that does not exist', client.ReadSZL(0x0fff, 0), false);
  holds('the clock is set', client.SetPlcDateTime(new Date(2031, 4, 17, 12, 34, 56)));
  await becomes('and read', async () => client.GetPlcDateTime().getFullYear(), 2031);

  const status = async () => client.PlcStatus();
  equal('the CPU runs', await status(), client.S7CpuStatusRun);
  holds('stop', client.PlcStop());
  await becomes('the CPU stops', status, client.S7CpuStatusStop);
  holds('hot start', client.PlcHotStart());
  await becomes('the CPU runs again', status, client.S7CpuStatusRun);
  holds('disconnected', client.Disconnect());
});
