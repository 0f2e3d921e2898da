"""The program of the wheel: where it is, and a machine in real time."""

import json
import os
import signal
import subprocess
import time
import urllib.request

import opennck
import pytest


def test_the_program_is_the_one_of_this_version():
    printed = subprocess.run([opennck.program(), "--version"], capture_output=True, text=True, check=True).stdout
    assert printed == f"opennck {opennck.__version__}\n"


def test_a_machine_is_served_until_the_block_ends():
    with opennck.serve("g1_example", plc="enable_all", web="127.0.0.1:0") as server:
        assert server.s7[0] == "127.0.0.1" and server.s7[1] > 0
        command = urllib.request.Request(
            f"{server.web}api/command",
            data=json.dumps({"set": {"M10.0": 1}}).encode(),
            headers={"Content-Type": "application/json"},
        )
        with urllib.request.urlopen(command, timeout=10) as answer:
            assert json.load(answer)["cycle"] > 0
        process = server.process
        assert process.poll() is None
    if os.name == "posix":
        assert process.returncode == 0, server.lines


def test_a_server_that_cannot_start_says_why():
    begin = time.monotonic()
    with pytest.raises(opennck.Error, match="exit code 2(.|\n)*no_such_machine"):
        with opennck.serve("no_such_machine"):
            pass
    assert time.monotonic() - begin < 20


@pytest.mark.skipif(os.name != "posix", reason="a signal of POSIX")
def test_a_server_ends_with_the_block_also_after_an_exception():
    with pytest.raises(KeyError):
        with opennck.serve("g1_example") as server:
            raise KeyError
    assert server.process.returncode in (0, -signal.SIGTERM)
