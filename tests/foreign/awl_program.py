"""python-snap7 2 (snap7 in C++) against a machine that runs a STEP 7 program: timers, counters, the state of the CPU, its diagnostic buffer."""

import struct

import snap7
from checks import PORT, becomes, close, equal, holds
from snap7.type import Areas

c = snap7.client.Client()
c.connect("127.0.0.1", 0, 2, PORT)


def word(area, number):
    """A timer or a counter, in BCD; the base of a timer is in the bits 12 and 13."""
    return struct.unpack(">H", bytes(c.read_area(area, 0, number, 1)))[0]


def events(count):
    """The newest entries of the diagnostic buffer."""
    data = bytes(c.read_szl(0x00A0, 0).Data)
    return [struct.unpack_from(">H", data, entry * 20)[0] for entry in range(count)]


def state():
    return str(c.get_cpu_state())


holds("the CPU runs", "Run" in state(), state())
equal("T 5 and C 3 at rest", (word(Areas.TM, 5), word(Areas.CT, 3)), (0, 0))
c.mb_write(0, 1, bytearray([0b11]))
becomes("C 3 counts", lambda: word(Areas.CT, 3), 1)
# 100 s are 100 of the base 1 s; some of them have passed at most.
holds("T 5 runs", 0x2080 <= word(Areas.TM, 5) <= 0x2100, f"{word(Areas.TM, 5):04X}")
c.mb_write(0, 1, bytearray([0b1000_0000]))
becomes("the program stops the CPU", lambda: "Stop" in state(), True)
equal("a programming error, because DB 99 is not loaded", events(2), [0x4562, 0x253A])
c.mb_write(0, 1, bytearray(1))
c.plc_hot_start()
becomes("the CPU runs again", lambda: "Run" in state(), True)
equal("RUN after START-UP", events(2), [0x4302, 0x4301])
close()
