"""An open simulator of the NC/PLC interface of SINUMERIK-style controls.

`Session` is a machine for tests step by step, `run` and `test` execute scenario files, `serve` runs a machine in real time for clients. The
words are those of scenario files, and errors are those of the program `opennck`.
"""

from importlib.metadata import version as _version

from ._opennck import Error, Missed, PlcIo
from .installed import program
from .scenarios import Result, Step, run, test
from .server import Server, serve
from .session import Session
from .trace import Trace

__version__ = _version("opennck")
__all__ = [
    "Error",
    "Missed",
    "PlcIo",
    "Result",
    "Server",
    "Session",
    "Step",
    "Trace",
    "program",
    "run",
    "serve",
    "test",
]
