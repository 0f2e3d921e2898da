# isg_gantry.py
"""A PLC in Python for a control of the ISG kernel: it starts the NC program, clears the difference of the gantry after an error, and goes on.

    opennck serve isg_hard_gantry --image cnc.image --lock-step
    python3 examples/python_plc/isg_gantry.py cnc.image

Channel 1 is DB801; axis 1, the master, is DB901; axis 5, its slave, is DB905.
"""

import sys

from opennck_image import Image

DRIVE_READY = [f"DB{db}.DBX3.0" for db in (901, 905, 906)]
IN_POSITION = [f"DB{db}.DBX3.3" for db in (901, 905)]


def supervisor():
    """The steps of the PLC, each up to a condition."""
    step = yield
    while True:
        while not all(step[bit] for bit in DRIVE_READY):
            step = yield
        step["DB801.DBX0.0"] = 1  # NC start
        while not step["DB801.DBX4.2"]:  # error of the channel
            step = yield
        step["DB801.DBX0.0"] = 0
        if step["DB905.DBX3.5"]:  # no reset clears it: somebody has to go to the machine
            print(f"{step.time:8.3f} s  locked", file=sys.stderr)
            while True:
                step = yield
        step["DB905.DBX0.4"] = 1  # gantry_on: the PLC takes over (enable_w)
        step["DB905.DBX0.5"] = 1  # gantry_on: clear the difference (command_w)
        since = step.time
        while step.time - since < 0.5:  # both axes have stood at their setpoints for half a second
            if not all(step[bit] for bit in IN_POSITION):
                since = step.time
            step = yield
        step["DB905.DBX0.5"] = 0
        step["DB801.DBX0.1"] = 1  # NC reset
        while step["DB801.DBX4.2"]:
            step = yield
        step["DB801.DBX0.1"] = 0


def main():
    with Image(sys.argv[1]) as image:
        program = None
        for step in image.steps():
            if step.first_scan:  # OB100
                program = supervisor()
                next(program)
            program.send(step)
            image.answer(step)


if __name__ == "__main__":
    main()
