"""pyS7: an independent client in Python; typed tags, up to 20 per request, PDU 960."""

import pyS7
from checks import PORT, becomes, close, equal, fails, holds
from pyS7 import DataType, MemoryArea, S7Client, S7Tag


def connected(pdu=960):
    client = S7Client("127.0.0.1", 0, 2, port=PORT, max_pdu=pdu)
    client.connect()
    return client


def array(block, start, count):
    return S7Tag(MemoryArea.DB, block, DataType.BYTE, start, 0, count)


c = connected()
holds("it is connected", c.is_connected)
equal("the PDU that it asks for", c.pdu_size, 960)

# One value of each type, as the PLC image has them.
tags = ["DB1000,X0.3", "DB1000,INT2", "DB1000,R4", "DB1000,DI8", "DB1000,DW12", "DB1000,W16", "DB1000,B18"]
equal("one value of each type", list(c.read(tags)), [True, -12345, 1.5, -70000, 0xDEADBEEF, 0xCAFE, 200])
equal("STRING", c.read(["DB1000,S20.10"])[0], "HELLO")
pattern = (0x8C, 0x00, 0xFF)
equal("an array", tuple(c.read([array(1001, 0, 9)])[0]), pattern * 3)
many = [f"DB1001,B{byte}" for byte in range(100)]
equal("a hundred tags", c.read(many), [pattern[byte % 3] for byte in range(100)])
scattered = [f"DB1001,B{byte}" for byte in range(0, 500, 20)]
equal("scattered tags", c.read(scattered, optimize=False), [pattern[byte % 3] for byte in range(0, 500, 20)])

# Interface: X is the leading axis of a gantry, XF is not.
becomes("DB31.DBX101.6 and DB33.DBX101.6", lambda: c.read(["DB31,X101.6", "DB33,X101.6"]), [True, False])
becomes("DB11.DBX6.2, JOG is active", lambda: c.read(["DB11,X6.2"]), [True])

# Written values are read back.
values = {
    "M10.3": True,
    "MB12": 77,
    "MI14": -5,
    "MW16": 65000,
    "MDI20": -2000000,
    "MDW24": 4000000000,
    "MR28": -0.25,
    "I8.1": True,
    "QB9": 9,
    "DB1002,R100": 3.5,
    "DB1002,X3.7": True,
    "DB1002,LR200": 2.718281828459045,
}
for tag, value in values.items():
    try:
        c.write([tag], [value])
        equal(f"{tag} written", c.read([tag])[0], value)
    except pyS7.S7AddressError as error:
        holds(f"{tag} is understood", False, f"{error}")
names = list(values)[:8]
c.write(names, [values[name] for name in names])
equal("all of them at once", c.read(names), [values[name] for name in names])
c.write(["DB1002,S300.20"], ["GANTRY"])
equal("STRING written", c.read(["DB1002,S300.20"])[0], "GANTRY")
big = tuple((index * 3) & 0xFF for index in range(800))
c.write([array(1002, 400, 800)], [big])
equal("800 bytes written", tuple(c.read([array(1002, 400, 800)])[0]), big)

# Addresses that do not exist; the other items are not affected.
fails("DB 99", c.read, ["DB99,B0"])
# The invalid item is last: after one, pyS7 takes two of its four bytes for the next item.
results = c.read_detailed(["DB1000,INT2", "DB1001,B0", "DB99,B0"], optimize=False)
equal("the good ones beside the bad", [result.success for result in results], [True, True, False])
equal("and their values", [results[0].value, results[1].value], [-12345, 0x8C])
results = c.write_detailed(["MB40", "DB99,B0"], [1, 1])
equal("a good write and a bad one", [result.success for result in results], [True, False])
fails("a write after the end", c.write, ["DB1000,B600"], [1])

# The CPU.
equal("state of the CPU", c.get_cpu_status(), "RUN")
info = c.get_cpu_info()
equal("order number", info["module_type_name"].strip(), "6ES7 317-2EK14-0AB0")
holds("its modules", len(info["modules"]) >= 3, f"{info}")
c.disconnect()

for pdu in (240, 480):
    c = connected(pdu)
    equal(f"a PDU of {pdu}", c.pdu_size, pdu)
    equal("a hundred tags with it", c.read(many), [pattern[byte % 3] for byte in range(100)])
    c.disconnect()
close()
