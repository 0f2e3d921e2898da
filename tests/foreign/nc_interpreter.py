#!/usr/bin/env python3
"""Compares the NC programs of OpenNCK with the nc-gcode-interpreter of another project.

    python3 tests/foreign/nc_interpreter.py --opennck PROGRAM [--seed N] [--count N] [--keep DIRECTORY]

Random programs of the language that both know (R parameters, DEF, expressions, IF, FOR, WHILE, G0 and G1 with absolute and incremental
positions) run in both; R parameters and end positions must be the same. A seed gives the same programs everywhere. The exit code is 1 after
a difference, 3 if the interpreter is not available.

nc-gcode-interpreter 0.1.9 gives all operators the same priority, calculates with 24 bits of precision, lets TRANS alone move an axis, and
does not know GOTOF. The programs have parentheses around every operation, and none of the others. Some of its parse errors have other
reasons; those programs are counted as not understood.
"""

import argparse
import random
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
PROJECT = HERE.parent.parent
REQUIREMENTS = HERE / "requirements-nc-interpreter.txt"

# R parameters that a program uses; after it, two more have the values of its own variables.
PARAMETERS = [f"R[{number}]" for number in range(1, 5)]
OWN = ["QUA", "QUB"]
# Counters by depth of nesting. Names that begin with a word of the language are not understood by the other interpreter.
FOR, WHILE = ["KLA", "KLB", "KLC"], ["WHA", "WHB", "WHC"]

SCENARIO = """title   = "Random program {seed}"
machine = {machine!r}
plc     = "enable_all"
nc      = '''
{program}'''

[[step]]
wait   = "X.position_controller_active && Y.position_controller_active && Z.position_controller_active"
within = "1s"
[[step]]
set    = {{ "DB11.DBX0.0" = 1 }}
[[step]]
set    = {{ "CHAN1.nc_start" = 1 }}
[[step]]
wait   = "CHAN1.m2_m30_active"
within = "600s"
[[step]]
expect = [{expectations}]
"""


class Program:
    """A random program."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.depth = 0
        definitions = [f"DEF REAL {OWN[0]}=1.5", f"DEF REAL {OWN[1]}=0"] + [f"DEF INT {name}" for name in FOR + WHILE]
        start = [f"{name}=0" for name in PARAMETERS] + ["G0 G90 X=0 Y=0 Z=0"]
        blocks = [line for _ in range(self.random.randint(4, 10)) for line in self.block()]
        end = [f"R[5]={OWN[0]}", f"R[6]={OWN[1]}", "M30"]
        self.text = "".join(line + "\n" for line in definitions + start + blocks + end)

    def number(self):
        return self.random.choice([str(self.random.randint(0, 50)), str(self.random.randint(0, 20) / 4)])

    def variable(self):
        return self.random.choice(PARAMETERS + OWN)

    def expression(self, depth=0):
        if depth > 2 or self.random.random() < 0.3:
            return self.random.choice([self.variable, self.number])()
        kind = self.random.random()
        if kind < 0.8:
            return f"({self.expression(depth + 1)}{self.random.choice('+-*')}{self.expression(depth + 1)})"
        if kind < 0.9:
            return f"({self.expression(depth + 1)}/{self.random.choice('248')})"
        return f"({self.random.randint(0, 30)} {self.random.choice(['DIV', 'MOD'])} {self.random.randint(1, 7)})"

    def condition(self):
        comparison = self.random.choice(["<", ">", "<=", ">=", "==", "<>"])
        return f"(({self.expression(1)}){comparison}({self.expression(1)}))"

    def assignment(self):
        name = self.variable()
        yield f"{name}={self.expression()}"
        # Values stay small, so that 24 bits are enough.
        yield from [f"IF ({name}>500)", f"{name}=125", "ENDIF", f"IF ({name}<-500)", f"{name}=0-7", "ENDIF"]

    def motion(self):
        kind = self.random.random()
        axis = self.random.choice("XYZ")
        if kind < 0.5:
            yield f"{axis}={self.random.randint(1, 30)}"
        elif kind < 0.7:
            yield f"{axis}=IC({self.random.randint(-3, 3)}/2)"
        else:
            feed = self.random.choice(["", "G0 ", "G1 F9000 "])
            yield f"{feed}X={self.random.randint(1, 30)} Y={self.random.randint(1, 30)}.5"

    def block(self):
        kind = self.random.random()
        if kind < 0.4:
            yield from self.assignment()
        elif kind < 0.7 or self.depth == len(FOR):
            yield from self.motion()
        else:
            yield from self.structure()

    def blocks(self):
        for _ in range(self.random.randint(1, 3)):
            yield from self.block()

    def structure(self):
        kind, depth = self.random.random(), self.depth
        self.depth += 1
        if kind < 0.4:
            yield f"IF {self.condition()}"
            yield from self.blocks()
            if self.random.random() < 0.5:
                yield "ELSE"
                yield from self.blocks()
            yield "ENDIF"
        elif kind < 0.7:
            yield f"FOR {FOR[depth]}=1 TO {self.random.randint(0, 4)}"
            yield from self.blocks()
            yield "ENDFOR"
        else:
            counter = WHILE[depth]
            yield from [f"{counter}=0", f"WHILE ({counter}<{self.random.randint(0, 4)})", f"{counter}={counter}+1"]
            yield from self.blocks()
            yield "ENDWHILE"
        self.depth -= 1


def interpreter(folder):
    """The other interpreter, installed into a folder; None with the reason if it is not available."""
    target = folder / "nc-interpreter"
    if not (target / "done").exists():
        pip = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--target", str(target)]
        try:
            installed = subprocess.run([*pip, "-r", str(REQUIREMENTS)], capture_output=True, text=True, timeout=240)
        except (OSError, subprocess.TimeoutExpired) as error:
            return None, str(error)
        if installed.returncode != 0:
            return None, (installed.stderr.strip().splitlines() or ["pip failed"])[-1]
        (target / "done").touch()
    sys.path.insert(0, str(target))
    try:
        import nc_gcode_interpreter
    except ImportError as error:
        return None, str(error)
    return nc_gcode_interpreter, ""


def expectations(nc, program):
    """What must hold after a program by the other interpreter; None if it does not understand it."""
    try:
        _, state = nc.nc_to_dataframe(program, iteration_limit=100_000)
    except ValueError:
        return None
    values, axes = state["symbol_table"], state["axes"]
    found = [f"abs(R{number} - {float(values[f'R[{number}]'])!r}) < 0.001" for number in range(1, 7)]
    found += [f"abs({axis}.setpoint - {float(axes[axis])!r}) < 0.0001" for axis in "XYZ"]
    return ", ".join(f'"{text}"' for text in found)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--opennck", required=True, help="the program")
    parser.add_argument("--seed", type=int, default=1, help="the first program [default: 1]")
    parser.add_argument("--count", type=int, default=100, help="how many programs [default: 100]")
    parser.add_argument("--keep", type=Path, default=PROJECT / "target" / "foreign", help="folder for the interpreter")
    arguments = parser.parse_args()
    nc, reason = interpreter(arguments.keep.resolve())
    if nc is None:
        print(f"nc-gcode-interpreter  absent: {reason}")
        sys.exit(3)
    machine = str(PROJECT / "machine_data" / "portal")
    understood, different = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(arguments.seed, arguments.seed + arguments.count):
            program = Program(seed).text
            wanted = expectations(nc, program)
            if wanted is None:
                continue
            understood += 1
            scenario = Path(folder) / f"program_{seed}.toml"
            scenario.write_text(SCENARIO.format(seed=seed, machine=machine, program=program, expectations=wanted))
            run = subprocess.run([arguments.opennck, "run", str(scenario)], capture_output=True, text=True, timeout=120)
            if run.returncode != 0:
                different += 1
                print(f"-- program {seed}\n{program}{run.stderr.strip()}", flush=True)
    last = arguments.seed + arguments.count - 1
    print(f"nc-gcode-interpreter  programs {arguments.seed} to {last}: {understood} compared, {different} differ")
    sys.exit(1 if different or not understood else 0)


if __name__ == "__main__":
    main()
