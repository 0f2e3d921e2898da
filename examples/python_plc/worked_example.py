"""The worked example of the gantry manual with a PLC in Python: a gantry is referenced, waits for the start, and synchronises.

    opennck serve g1_example --image nck.image --lock-step
    python3 examples/python_plc/worked_example.py nck.image

X is axis 1 (DB31), the leading axis; XF is axis 3 (DB33). The exit code is 0 when the grouping is synchronised, else 1.
"""

import sys

from opennck_image import Image

LONGEST = 120.0  # seconds of the NC


def enable(step):
    """The enables that every PLC program sets in every scan."""
    for db in (31, 32, 33):
        step[f"DB{db}.DBX1.5"] = 1  # position measuring system 1
        step[f"DB{db}.DBX2.1"] = 1  # controller enable
        step[f"DB{db}.DBX21.7"] = 1  # pulse enable


def sequence():
    """The actions of the operator and the PLC of the example, each up to a condition."""
    step = yield
    step["DB31.DBX29.5"] = 1  # no automatic synchronization
    while not (step["DB31.DBX61.5"] and step["DB33.DBX61.5"]):  # position controller active
        step = yield "waits for position control"
    assert step["DB31.DBB101"] == 0b1100_0000, "gantry axis and leading axis"
    assert step["DB33.DBB101"] == 0b1000_0000, "gantry axis and synchronous axis"
    step["DB11.DBX0.2"] = 1  # JOG
    step["DB11.DBX1.2"] = 1  # machine function REF
    begin = step.time
    while step.time - begin < 0.1:
        step["DB31.DBX4.7"] = 1  # traversing key plus of X
        step = yield "presses the key"
    step["DB31.DBX4.7"] = 0
    while not step["DB31.DBX101.4"]:  # gantry synchronization ready to start, alarm 10654
        step = yield "references"
    assert step["DB31.DBX60.4"] and step["DB33.DBX60.4"], "both axes are referenced"
    print(f"{step.time:8.3f} s  ready to start: DB31.DBB101 = {step['DB31.DBB101']:08b}")
    step["DB31.DBX29.4"] = 1  # start gantry synchronization
    while not step["DB31.DBX101.5"]:  # gantry grouping is synchronized
        step = yield "synchronises"
    print(f"{step.time:8.3f} s  synchronised:   DB31.DBB101 = {step['DB31.DBB101']:08b}")
    step["DB31.DBX29.4"] = 0
    yield "synchronised"


def main():
    with Image(sys.argv[1]) as image:
        program, state, begin = None, "starts", None
        for step in image.steps():
            if step.first_scan:  # OB100
                program = sequence()
                next(program)
                begin = step.time
            enable(step)
            state = program.send(step)
            image.answer(step)
            if state == "synchronised":
                return 0
            if step.time - begin > LONGEST:
                break
        print(f"the gantry did not synchronise; the last state is: {state}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
