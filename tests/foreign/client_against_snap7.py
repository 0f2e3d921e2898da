"""Runs `opennck s7` against foreign servers: snap7's C++ server (python-snap7 2.1) and the Python server of
python-snap7 3.3. Standalone:

    python3 tests/foreign/client_against_snap7.py [--program target/debug/opennck]

It needs Python 3. If --python-2.1 and --python-3.3 do not name interpreters that have the packages already, it also needs a
package index for pip. A package that cannot be installed is reported and does not count as success. Exit codes: 0 all checks
passed, 1 a check failed, 3 not everything could be run.

Differences between these servers and a module, and how to work with them:

| server | behaviour | remedy |
|---|---|---|
| snap7 C++ | ends if a write request has more than 20 items, answers only 20 items of a read request | `--items 20` |
| snap7 C++ | cuts system state lists at the PDU | read shorter lists, here 001C |
| python-snap7 3.3 | writes only the first item of a request | `--items 1` |
| python-snap7 3.3 | answers a bit with its byte | read the byte |
"""

import argparse
import json
import pathlib
import socket
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SIZE = 60000

# A server whose memory can be queried on standard input: offset and length, in decimal.
SERVER = """
import ctypes, sys
import snap7
from snap7.server import Server
from snap7.type import SrvArea
port, size = int(sys.argv[1]), int(sys.argv[2])
old = hasattr(snap7, "__version__") and snap7.__version__.startswith("2") or not hasattr(Server, "set_rw_area_callback")
make = (lambda n: (ctypes.c_uint8 * n)()) if old else bytearray
block, flags = make(size), make(256)
for at in range(size):
    block[at] = at * 7 % 251
server = Server(log=False)
server.register_area(SrvArea.DB, 1, block)
server.register_area(SrvArea.MK, 0, flags)
server.start(tcp_port=port)
print("ready", flush=True)
for line in sys.stdin:
    area, offset, length = line.split()
    memory = block if area == "DB" else flags
    print(bytes(memory[int(offset):int(offset) + int(length)]).hex(), flush=True)
"""


class Served:
    """A server in a separate process."""

    def __init__(self, python):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        command = [python, "-c", SERVER, str(self.port), str(SIZE)]
        pipe, none = subprocess.PIPE, subprocess.DEVNULL
        self.process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=none, text=True)
        while (line := self.process.stdout.readline()) and line.strip() != "ready":
            pass
        if self.process.poll() is not None:
            raise RuntimeError("the server does not start")

    def memory(self, area, offset, length):
        self.process.stdin.write(f"{area} {offset} {length}\n")
        self.process.stdin.flush()
        while line := self.process.stdout.readline():
            if all(c in "0123456789abcdef" for c in line.strip()):
                return bytes.fromhex(line.strip())
        raise RuntimeError("the server has ended")

    def end(self):
        self.process.kill()
        self.process.wait()


class Checks:
    def __init__(self, program, name, served):
        self.program, self.name, self.served, self.failed = program, name, served, 0

    def s7(self, command, *arguments):
        host = f"127.0.0.1:{self.served.port}"
        line = [self.program, "s7", command, host, *arguments]
        return subprocess.run(line, capture_output=True, text=True, timeout=60)

    def rows(self, command, *arguments):
        done = self.s7(command, *arguments, "--format", "json")
        return json.loads(done.stdout) if done.stdout else [{"value": done.stderr}]

    def holds(self, what, found, expected):
        right = found == expected
        self.failed += not right
        print(f"{self.name}: {what}: {'ok' if right else f'NOT: found {found}, expected {expected}'}")


def pattern(offset, length):
    return bytes(at * 7 % 251 for at in range(offset, offset + length))


def check(checks, items_written):
    plain = ("--profile", "none")
    # One value of each type, at addresses with known bytes.
    read = checks.rows("read", "DB1.DBB10", "DB1.DBW10", "DB1.DBD10", "DB1.DBB20..23", *plain)
    ten = pattern(10, 4)
    whole = [int.from_bytes(ten[:length], "big") for length in (1, 2, 4)]
    checks.holds("values", [row["value"] for row in read], [*whole, list(pattern(20, 4))])
    # Longer than any PDU.
    [row] = checks.rows("read", f"DB1.DBB0..{SIZE - 1}", *plain)
    checks.holds(f"{SIZE} bytes", row["value"] == list(pattern(0, SIZE)), True)
    # More items than fit in one request.
    addresses = [f"DB1.DBB{at}" for at in range(100)]
    read = checks.rows("read", *addresses, "--items", "20", *plain)
    checks.holds("100 items, 20 each", [row["value"] for row in read], list(pattern(0, 100)))
    # Writes, and the resulting memory of the server.
    writes = [f"DB1.DBB{1000 + at}={at}" for at in range(60)]
    written = checks.s7("write", *writes, "--items", items_written, *plain)
    checks.holds("60 writes", written.returncode, 0)
    checks.holds("its memory", checks.served.memory("DB", 1000, 60), bytes(range(60)))
    many = ",".join(str(at % 256) for at in range(1000))
    written = checks.s7("write", f"DB1.DBB2000..2999={many}", "DB1.DBD4000:REAL=1.5", "--items", items_written, *plain)
    checks.holds("a long write", written.returncode, 0)
    checks.holds("its memory", checks.served.memory("DB", 2000, 1000), bytes(at % 256 for at in range(1000)))
    checks.holds("a REAL in its place", checks.served.memory("DB", 4000, 4).hex(), "3fc00000")
    # An item that does not exist is refused alone.
    done = checks.s7("read", "DB99.DBB0", *plain)
    checks.holds("a block that is not there", (done.returncode, "refused" in done.stdout), (1, True))


def check_snap7(checks):
    check(checks, "20")
    plain = ("--profile", "none")
    checks.holds("bits", checks.s7("write", "M10.3=1", "M10.4=1", *plain).returncode, 0)
    checks.holds("its flags", checks.served.memory("MK", 10, 1), b"\x18")
    read = checks.rows("read", "M10.3", "M10.2", "DB99.DBB0", "MB10", *plain)
    values = [row["value"] for row in read]
    values[2] = str(values[2])[:7]
    checks.holds("one refused item among others", values, [True, False, "refused", 24])
    # The server answers 20 of 30 items; the client requests the rest.
    addresses = [f"DB1.DBB{at}" for at in range(30)]
    read = checks.rows("read", *addresses, *plain)
    checks.holds("30 items at once", [row["value"] for row in read], list(pattern(0, 30)))
    info = {row["what"]: row["value"] for row in checks.rows("info")}
    checks.holds("state", info.get("state"), "RUN")
    checks.holds("block", info.get("DB1"), f"{SIZE} bytes")
    done = checks.s7("szl", "001C")
    checks.holds("list 001C", (done.returncode, "SNAP7-SERVER" in done.stdout), (0, True))


def check_python(checks):
    check(checks, "1")
    done = checks.s7("info")
    checks.holds("info", done.returncode, 0)


def interpreter(version, named, folder):
    """An interpreter that has the package, or the reason why there is none."""
    if named:
        return named, None
    python = pathlib.Path(folder) / version / "bin" / "python"
    for command in (
        [sys.executable, "-m", "venv", str(python.parents[1])],
        [str(python), "-m", "pip", "install", "--quiet", f"python-snap7=={version}"],
    ):
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            return None, (done.stderr.strip().splitlines() or ["no reason given"])[-1]
    return str(python), None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=str(ROOT / "target" / "debug" / "opennck"))
    parser.add_argument("--python-2.1", dest="old", help="an interpreter that has python-snap7 2.1.0")
    parser.add_argument("--python-3.3", dest="new", help="an interpreter that has python-snap7 3.3.0")
    options = parser.parse_args()
    if not pathlib.Path(options.program).exists():
        print(f"{options.program} not found: build it with `cargo build`, or give --program")
        return 3
    failed, missing = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for version, named, each in (("2.1.0", options.old, check_snap7), ("3.3.0", options.new, check_python)):
            python, why = interpreter(version, named, folder)
            if python is None:
                print(f"python-snap7 {version}: NOT RUN, cannot be installed: {why}")
                missing += 1
                continue
            served = Served(python)
            try:
                checks = Checks(options.program, f"python-snap7 {version}", served)
                each(checks)
                failed += checks.failed
            finally:
                served.end()
    print(f"{failed} checks failed" + (f", {missing} servers could not be run" if missing else ""))
    return 1 if failed else 3 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
