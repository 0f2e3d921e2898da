"""python-snap7: version 2 is snap7's own client in C++, version 3 is a new implementation in Python."""

import ctypes
import datetime
import struct

import snap7
from checks import PORT, becomes, close, equal, fails, holds
from snap7.type import Block, Parameter, S7DataItem, WordLen

IS_NATIVE = int(snap7.__version__.split(".")[0]) < 3
try:
    from snap7.type import Areas as Area
except ImportError:
    from snap7.type import Area


def connected(pdu=None):
    client = snap7.client.Client()
    if pdu:
        client.set_param(Parameter.PDURequest, pdu)
    client.connect("127.0.0.1", 0, 2, PORT)
    return client


c = connected()
holds("it is connected", c.get_connected())
equal("the PDU that it asks for", c.get_pdu_length(), 480)

# Data blocks: values of all types, as the PLC image has them.
types = bytes(c.db_read(1000, 0, 32))
equal("BOOL", types[0] >> 3 & 1, 1)
equal("INT, REAL, DINT", struct.unpack(">hfi", types[2:12]), (-12345, 1.5, -70000))
equal("DWORD, WORD, BYTE", struct.unpack(">IHB", types[12:19]), (0xDEADBEEF, 0xCAFE, 200))
equal("STRING", types[20:27], b"\x0a\x05HELLO")
equal("a read of several parts", bytes(c.db_read(1001, 0, 512)), (b"\x8c\x00\xff" * 171)[:512])

# Interface: X is the leading axis of a gantry, XF is not; the program enables both.
becomes("DB31.DBX101.6, X is the leading axis", lambda: c.db_read(31, 101, 1)[0] >> 6 & 1, 1)
equal("DB33.DBX101.6, XF is not", c.db_read(33, 101, 1)[0] >> 6 & 1, 0)
becomes("DB31.DBX61.5, position controller active", lambda: c.db_read(31, 61, 1)[0] >> 5 & 1, 1)
becomes("DB11.DBX6.2, JOG is active", lambda: c.db_read(11, 6, 1)[0] >> 2 & 1, 1)

# Written values are read back.
for start, length in ((0, 1), (10, 2), (100, 222), (500, 1000)):
    sent = bytearray((start + at * 7) & 0xFF for at in range(length))
    c.db_write(1002, start, sent)
    equal(f"{length} bytes written to DB 1002", bytes(c.db_read(1002, start, length)), bytes(sent))
for area, number, name in ((Area.MK, 0, "M"), (Area.PE, 0, "I"), (Area.PA, 0, "Q")):
    c.write_area(area, number, 8, bytearray(b"\x12\x34\x56"))
    equal(f"{name} 8 to 10", bytes(c.read_area(area, number, 8, 3)), b"\x12\x34\x56")
c.mb_write(20, 4, bytearray(b"\xde\xad\xbe\xef"))
equal("MD20", bytes(c.mb_read(20, 4)), b"\xde\xad\xbe\xef")
equal("timers", len(bytes(c.read_area(Area.TM, 0, 0, 3))), 6)
equal("counters", len(bytes(c.read_area(Area.CT, 0, 2, 4))), 8)

# Several items at once; the client itself refuses more than twenty.
def items(count):
    found, buffers = (S7DataItem * count)(), []
    for index in range(count):
        buffers.append(ctypes.create_string_buffer(4))
        found[index].Area = ctypes.c_int32(Area.DB.value)
        found[index].WordLen = ctypes.c_int32(WordLen.Byte.value)
        found[index].DBNumber = ctypes.c_int32(99 if index == 1 else 1001)
        found[index].Start = ctypes.c_int32(index)
        found[index].Amount = ctypes.c_int32(3)
        found[index].pData = ctypes.cast(ctypes.pointer(buffers[index]), ctypes.POINTER(ctypes.c_uint8))
    return found, buffers


def read_multi(count):
    asked, buffers = items(count)
    result = c.read_multi_vars(asked)
    return result[1] if isinstance(result, tuple) else asked, buffers


try:
    asked, buffers = read_multi(20)
    pattern = b"\x8c\x00\xff" * 9
    for index in (0, 2, 19):
        equal(f"item {index} of 20", buffers[index].raw[:3], pattern[index : index + 3])
    holds("item 1 of 20 has an error of its own", asked[1].Result != 0, f"{asked[1].Result}")
except Exception as error:  # version 3 answers one error for all
    holds("item 1 of 20 is refused", not IS_NATIVE, f"{error}")

# Addresses that do not exist.
fails("DB 99 does not exist", c.db_read, 99, 0, 1)
fails("DB 1000 ends at 512", c.db_read, 1000, 500, 20)
fails("a write after the end", c.db_write, 1000, 511, bytearray(2))
equal("and it goes on", bytes(c.db_read(1001, 0, 3)), b"\x8c\x00\xff")

# Blocks.
blocks = c.list_blocks()
holds("data blocks", blocks.DBCount >= 3 and blocks.OBCount >= 0, f"{blocks.DBCount}")
kind = Block.DB
numbers = list(c.list_blocks_of_type(kind, 1024))
holds("their numbers", {31, 1000, 1001, 1002} <= set(numbers), f"{numbers}")
information = c.get_block_info(kind, 1001)
equal("block information", (information.BlkNumber, information.MC7Size), (1001, 512))
fails("block information of none", c.get_block_info, kind, 99)
block = bytearray(c.upload(1001) if not IS_NATIVE else c.full_upload(Block.DB, 1001)[0])
holds("an upload has the block's bytes", b"\x8c\x00\xff" * 50 in bytes(block), f"{len(block)} bytes")
fails("a download is refused", c.download, bytearray(block), 1003)

# System state lists.
def runs():
    """The operating state in list 0424: 08 is RUN. Version 3 requests the state with a read of no item, which is answered, and takes any answer for RUN."""
    return b"\xff\x08" in bytes(c.read_szl(0x0424, 0).Data)[:8]


holds("the CPU runs", runs())
holds("and reports it", "Run" in str(c.get_cpu_state()))
if IS_NATIVE:
    info = c.get_cpu_info()
    equal("type of the CPU", info.ModuleTypeName, b"CPU 317-2 PN/DP")
    equal("order code", c.get_order_code().OrderCode[:20].strip(), b"6ES7 317-2EK14-0AB0")
    equal("protection", c.get_protection().sch_schal, 1)
    equal("the longest PDU of the module", c.get_cp_info().MaxPduLength, 960)
    holds("the list of lists", len(c.read_szl_list()) > 20)
    lists = c.read_szl(0x0011, 0)
    equal("records of list 0011", lists.Header.LengthDR, 28)
    for number, index in ((0x0000, 0), (0x001C, 0), (0x0131, 1), (0x0232, 4), (0x0424, 0), (0x00A0, 0)):
        holds(f"list {number:04X}", c.read_szl(number, index).Header.LengthDR > 0)
    fails("a list that does not exist", c.read_szl, 0x0FFF, 0)
else:
    info = c.get_cpu_info()
    equal("type of the CPU", bytes(info.ModuleTypeName).strip(b"\0"), b"CPU 317-2 PN/DP")
    holds("order code", b"6ES7 317" in bytes(c.get_order_code().OrderCode))

# The clock, the password, the services.
c.set_plc_datetime(datetime.datetime(2031, 5, 17, 12, 34, 56))
becomes("the clock was set", lambda: (c.get_plc_datetime().year, c.get_plc_datetime().month), (2031, 5))
if IS_NATIVE:
    fails("a password where there is none", c.set_session_password, "OPENNCK")
    holds("compress", c.compress(1000) in (0, None))
    holds("copy RAM to ROM", c.copy_ram_to_rom(1000) in (0, None))

# Stop and start; the NC reacts to the missing PLC as a control does.
c.plc_stop()
becomes("the CPU stops", runs, False)
c.plc_hot_start()
becomes("the CPU runs again", runs, True)
c.plc_stop()
c.plc_cold_start()
becomes("and after a cold start", runs, True)

# Cyclic data of MW20, every 100 ms. No client here has a function for it. The transport of version 3 sends arbitrary
# requests, and tshark checks the pushes of the server.
if not IS_NATIVE:
    request = "32 07 0000 0009 0008 {:04x} 000112 04 11 42 {:02x} 00 ff 09 {:04x} {}"

    def user_data(function, payload):
        """An answer; pushes before it are skipped."""
        text = request.format(len(payload) + 4, function, len(payload), payload.hex())
        answer = bytes(c.iso_exchange_buffer(bytearray.fromhex(text)))
        while answer[15] >> 4 != 8:
            answer = bytes(c.connection.receive_data())
        return answer

    other = connected()
    other.mb_write(20, 2, bytearray(b"\x12\x34"))
    item = bytes.fromhex("120a1002000200008300") + (20 * 8).to_bytes(2, "big")
    answer = user_data(1, b"\0\1\0\1" + item)
    job = answer[17]
    equal("cyclic data begin", (answer[20:22], answer[-6:]), (b"\0\0", b"\xff\x04\0\x10\x12\x34"))
    other.mb_write(20, 2, bytearray(b"\x56\x78"))

    def push():
        """The next push: group, function, job, value."""
        came = bytes(c.connection.receive_data())
        return came[15], came[16], came[17], came[-2:]

    becomes("and follow what is written", push, (0x02, 1, job, b"\x56\x78"))
    equal("until they are ended", user_data(4, bytes([1, job]))[20:22], b"\0\0")
    equal("and it goes on", bytes(c.mb_read(20, 2)), b"\x56\x78")
    other.disconnect()

# Other sizes of the PDU.
c.disconnect()
for pdu in (240, 960):
    c = connected(pdu)
    equal(f"a PDU of {pdu}", c.get_pdu_length(), pdu)
    equal("512 bytes with it", bytes(c.db_read(1001, 0, 512)), (b"\x8c\x00\xff" * 171)[:512])
    sent = bytearray(range(256)) * 5
    c.db_write(1002, 0, sent)
    equal(f"1280 bytes written with it", bytes(c.db_read(1002, 0, 1280)), bytes(sent))
    c.disconnect()
close()
