"""snap7's native server, from the library inside python-snap7 2.x, with a single data block. `benches/s7` starts it.

    python snap7_server.py PORT BLOCK BYTES

Prints "ready" when clients can connect, and ends when its input ends. Python only waits: threads of the library serve the clients.
"""

import contextlib
import ctypes
import glob
import importlib.util
import os
import sys

SRV_AREA_DB = 5
LOCAL_PORT = 1


def library():
    """The shared library in the wheel."""
    found = importlib.util.find_spec("snap7")
    if found is None:
        sys.exit("python-snap7 is not installed")
    for folder in found.submodule_search_locations:
        for file in glob.glob(os.path.join(folder, "lib", "*snap7*")):
            return ctypes.CDLL(file)
    sys.exit("this python-snap7 has no native library: 2.1.0 has one, 3 has none")


def main():
    port, block, size = map(int, sys.argv[1:4])
    snap7 = library()
    snap7.Srv_Create.restype = ctypes.c_void_p
    server = ctypes.c_void_p(snap7.Srv_Create())
    data = (ctypes.c_uint8 * size)()
    number = ctypes.c_uint16(port)
    done = [
        # Its events are not used.
        snap7.Srv_SetMask(server, 0, 0),
        snap7.Srv_SetMask(server, 1, 0),
        snap7.Srv_SetParam(server, LOCAL_PORT, ctypes.byref(number)),
        snap7.Srv_RegisterArea(server, SRV_AREA_DB, ctypes.c_uint16(block), ctypes.byref(data), size),
        snap7.Srv_StartTo(server, b"127.0.0.1"),
    ]
    if any(done):
        sys.exit(f"snap7's server did not start: {done}")
    print("ready", flush=True)
    with contextlib.suppress(KeyboardInterrupt):
        sys.stdin.read()
    snap7.Srv_Stop(server)


main()
