"""A PLC in another project's simulator: awlsim runs an AWL source, and OpenNCK is the NC beside it.

    pip install awlsim
    opennck run SCENARIO --plc-process "python3 examples/python_plc/awlsim_plc.py PROGRAM.awl {image}"

awlsim is free software under the GPL; it is installed by its user and runs in this process, not in OpenNCK. Its inputs, outputs, flags and
data blocks with the numbers of the interface get the bytes of the image before each scan, and what it writes goes back after it. Its timers
run with the time of the machine, not with that of the computer, so that a run gives the same trace each time.

The source declares the data blocks that it uses, also those of the interface, with at least the bytes that it uses:

    DATA_BLOCK DB 31
    STRUCT
      b : ARRAY [0 .. 127] OF BYTE ;
    END_STRUCT ;
    BEGIN
    END_DATA_BLOCK
"""

import sys

from opennck_image import Image

try:
    from awlsim.core.cpu import S7CPU
    from awlsim.core.main import AwlSim
    from awlsim.awlcompiler import AwlParser
    from awlsim.common.sources import AwlSource
except ImportError as error:
    sys.exit(f"awlsim is not installed ({error}): pip install awlsim")


class Clock:
    """The time of the machine, in seconds."""

    now = 0.0


def power_on(path):
    """A CPU with a freshly loaded program."""
    source = AwlSource.fromFile(path, path)
    parser = AwlParser()
    parser.parseSource(source)
    simulator = AwlSim()
    simulator.reset()
    simulator.load(parser.getParseTree())
    simulator.build()
    simulator.startup()
    return simulator


def areas(simulator):
    """The bytes of awlsim's areas by the names of the sections of the image."""
    cpu = simulator.getCPU()
    found = {("I", 0): cpu.inputs.getRawDataBytes(), ("Q", 0): cpu.outputs.getRawDataBytes(), ("M", 0): cpu.flags.getRawDataBytes()}
    for block in cpu.allDBs():
        # Block 0 of awlsim has no bytes.
        if block.structInstance is not None:
            found["DB", block.index] = block.structInstance.memory.getRawDataBytes()
    return found


def main():
    program, path = sys.argv[1:]
    # awlsim asks this function for the time at the end of each scan and within long ones.
    S7CPU.updateTimestamp.__defaults__ = (lambda: Clock.now,)
    with Image(path) as image:
        simulator = bytes_of = None
        for step in image.steps():
            Clock.now = step.time
            if step.first_scan:
                simulator = power_on(program)
                bytes_of = areas(simulator)
            shared = []
            for section in image.sections:
                own = bytes_of.get((section.kind, section.number if section.kind == "DB" else 0))
                length = min(section.length, len(own) - section.first) if own is not None else 0
                if length > 0:
                    shared.append((section, own, length))
                    own[section.first : section.first + length] = step.before[section.offset : section.offset + length]
            simulator.getCPU().updateTimestamp()
            simulator.runCycle()
            for section, own, length in shared:
                if section.writer == "PLC":
                    step.image[section.offset : section.offset + length] = own[section.first : section.first + length]
            image.answer(step)


if __name__ == "__main__":
    main()
