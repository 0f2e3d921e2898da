"""The types of the package: its sources are right, and the stub of the compiled module describes it."""

import subprocess
import sys

import pytest

pytest.importorskip("mypy")


# Packages that need not be there have no types.
OPTIONAL = ["--disable-error-code=import-not-found", "--disable-error-code=import-untyped"]


@pytest.mark.parametrize(
    "command", [["mypy", "--strict", *OPTIONAL, "-p", "opennck"], ["mypy.stubtest", "opennck._opennck"]]
)
def test_types(command, tmp_path):
    done = subprocess.run([sys.executable, "-m", *command], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
