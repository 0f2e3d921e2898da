"""A PLC as CODESYS and OpenPLC run one: located variables (%IX0.0, %QX0.1, %MW2), and a loop of inputs, program, outputs.

    opennck run SCENARIO --plc-process "python3 examples/python_plc/cyclic_runtime.py {image}"

A runtime that is called from outside, through a shared library or a socket, has the same place: `Runtime.scan` copies its inputs in, lets it
run for one cycle, and copies its outputs out. `MAPPING` says which address of the machine each located variable is.
"""

import sys

from opennck_image import Image

# Located variable: address of the machine. What the NC or the machine writes is an input.
MAPPING = {
    "%IX0.0": "I0.0",  # key
    "%IX1.0": "DB32.DBX61.5",  # position controller of Y is active
    "%QX0.0": "Q0.0",  # lamp
    "%QX0.1": "Q0.1",  # the key was pressed for 100 ms
    "%QX1.0": "DB32.DBX1.5",  # position measuring system 1 of Y
    "%QX1.1": "DB32.DBX2.1",  # controller enable of Y
    "%QX1.2": "DB32.DBX21.7",  # pulse enable of Y
    "%QW2": "MW20",  # scans
}


class Ton:
    """The on delay of IEC 61131-3."""

    def __init__(self):
        self.since = None

    def __call__(self, start, seconds, now):
        if not start:
            self.since = None
        elif self.since is None:
            self.since = now
        # Whole microseconds: times are sums of cycles.
        return self.since is not None and round((now - self.since) * 1e6) >= round(seconds * 1e6)


class Program:
    """The program: it sees located variables only."""

    def __init__(self):
        self.pressed = Ton()
        self.scans = 0

    def __call__(self, io, now):
        self.scans += 1
        io["%QX1.0"] = io["%QX1.2"] = True
        io["%QX1.1"] = io["%IX0.0"]
        io["%QX0.0"] = io["%IX1.0"]
        io["%QX0.1"] = self.pressed(io["%IX0.0"], 0.1, now)
        io["%QW2"] = self.scans & 0xFFFF


class Runtime:
    """The loop of a runtime: inputs, program, outputs."""

    def __init__(self, program):
        self.program = program
        self.io = dict.fromkeys(MAPPING, 0)

    def scan(self, step):
        for located, address in MAPPING.items():
            if located.startswith("%I"):
                self.io[located] = step[address]
        self.program(self.io, step.time)
        for located, address in MAPPING.items():
            if located.startswith("%Q"):
                step[address] = int(self.io[located])


def main():
    with Image(sys.argv[1]) as image:
        runtime = None
        for step in image.steps():
            if step.first_scan:  # power on, or a restart of the PLC
                runtime = Runtime(Program())
            runtime.scan(step)
            image.answer(step)


if __name__ == "__main__":
    main()
