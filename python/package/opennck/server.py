"""A machine in real time in a process of its own: `opennck serve`."""

from __future__ import annotations

import os
import queue
import subprocess
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from ._opennck import Error
from .installed import program

#: The last line that the program prints at its start.
_READY = "press Ctrl-C to stop"


class Server:
    """A machine that is being served."""

    def __init__(self, process: subprocess.Popen[str], lines: Sequence[str]) -> None:
        #: The process of the program.
        self.process = process
        #: What the program has printed.
        self.lines = lines
        #: Where S7 clients connect: address and port. Rack 0, slot 2.
        self.s7 = _address(lines, "S7 on ")
        #: The address of the live page with the token of writers, if there is one; None without `web`.
        self.web = next((line.removeprefix("page on ") for line in lines if line.startswith("page on ")), None)


def _address(lines: Sequence[str], start: str) -> tuple[str, int]:
    line = next(line for line in lines if line.startswith(start))
    host, _, port = line.removeprefix(start).split(": ")[0].rpartition(":")
    return host.strip("[]"), int(port)


@contextmanager
def serve(
    machine: str | os.PathLike[str] | None = None,
    *,
    plc: str | None = None,
    s7: str = "127.0.0.1:0",
    web: str | None = None,
    options: Sequence[str] = (),
    wait: float = 30.0,
) -> Iterator[Server]:
    """Serves a machine in real time, from the line that says it is ready until the end of the `with` block.

    Port 0, the default, selects a free port: `server.s7` has it. `web="127.0.0.1:0"` also serves the live page. `options` are further
    arguments of `opennck serve`, such as `["--scenario", "my.toml"]`. `wait` is the longest time in seconds until the machine is ready.
    """
    command = [program(), "serve"]
    if machine is not None:
        command.append(os.fspath(machine))
    for option, value in (("--plc", plc), ("--s7", s7), ("--web", web)):
        if value is not None:
            command += [option, value]
    command += options
    process = subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, encoding="utf-8"
    )
    lines: list[str] = []
    try:
        _wait_until_ready(process, lines, wait)
        yield Server(process, lines)
    finally:
        process.terminate()
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def _wait_until_ready(process: subprocess.Popen[str], lines: list[str], wait: float) -> None:
    told: queue.Queue[bool] = queue.Queue()

    def read() -> None:
        assert process.stdout is not None
        with process.stdout:
            for line in process.stdout:
                lines.append(line.rstrip("\n"))
                if lines[-1] == _READY:
                    told.put(True)
        told.put(False)

    threading.Thread(target=read, daemon=True).start()
    end = time.monotonic() + wait
    try:
        is_ready = told.get(timeout=max(0.0, end - time.monotonic()))
    except queue.Empty:
        raise Error(f"`opennck serve` was not ready after {wait} s: {' / '.join(lines)}") from None
    if not is_ready:
        code = process.wait()
        raise Error(f"`opennck serve` ended with exit code {code}: {chr(10).join(lines)}")
