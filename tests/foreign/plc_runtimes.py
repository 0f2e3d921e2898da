#!/usr/bin/env python3
"""Runs a scenario with PLC programs in the runtimes of others, over the mapped image.

    python3 tests/foreign/plc_runtimes.py --opennck PROGRAM [--keep DIRECTORY]

awlsim (GPL, installed from its registry into DIRECTORY) runs an AWL source beside OpenNCK, in a process of its own; the loop of a runtime
as CODESYS and OpenPLC have it is in Python here. Each runs twice, and the traces must be the same. A runtime that is not available is listed
as absent, with the reason. The exit code is 1 if a check failed.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
EXAMPLES = HERE.parent.parent / "examples" / "python_plc"
FILES = HERE / "plc_runtimes"


def awlsim(keep):
    """Where awlsim is, and the reason if it is nowhere."""
    folder = keep / "awlsim"
    if not (folder / "awlsim").exists():
        command = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--target", str(folder)]
        # Without its compiled form: the clock is set from Python.
        variables = {**os.environ, "AWLSIM_CYTHON_BUILD": "0"}
        try:
            done = subprocess.run([*command, "-r", str(HERE / "requirements-awlsim.txt")], env=variables, capture_output=True, text=True, timeout=240)
        except subprocess.TimeoutExpired:
            return None, "pip did not finish within 240 s"
        if done.returncode != 0:
            return None, ((done.stdout + done.stderr).strip().splitlines() or ["pip failed"])[-1]
    return folder, ""


def run(opennck, process, path):
    """The trace of the scenario, and whether it passed."""
    variables = {**os.environ, "PYTHONPATH": os.pathsep.join(str(part) for part in path), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [opennck, "run", str(FILES / "key.toml"), "--plc-process", process]
    done = subprocess.run(command, env=variables, capture_output=True, text=True, timeout=120)
    return done.returncode == 0, done.stdout + done.stderr


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--opennck", required=True, help="the program")
    parser.add_argument("--keep", type=Path, default=Path(tempfile.gettempdir()) / "opennck-runtimes", help="folder for awlsim")
    arguments = parser.parse_args()
    arguments.keep.mkdir(parents=True, exist_ok=True)
    folder, reason = awlsim(arguments.keep.resolve())
    python = f'"{sys.executable}"'
    runtimes = [("located variables", f'{python} "{EXAMPLES / "cyclic_runtime.py"}" {{image}}', [EXAMPLES], "")]
    source = f'"{FILES / "enables.awl"}"'
    runtimes.append(("awlsim", f'{python} "{EXAMPLES / "awlsim_plc.py"}" {source} {{image}}', [EXAMPLES, folder], reason))
    failed = False
    for name, process, path, reason in runtimes:
        if reason:
            print(f"{name}: absent: {reason}")
            continue
        (passed, first), (_, second) = (run(arguments.opennck, process, path) for _ in range(2))
        is_good = passed and first == second
        failed |= not is_good
        print(f"{name}: {'passed, twice with the same trace' if is_good else 'FAILED'}")
        if not is_good:
            print(first if not passed else f"two traces:\n{first}\n{second}")
    sys.exit(1 if failed else 0)


main()
