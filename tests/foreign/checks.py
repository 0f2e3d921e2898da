"""Shared by the Python clients: counted checks, and the summary."""

import os
import sys
import time

PORT = int(os.environ["S7_PORT"])
done, failed = 0, []


def equal(what, found, expected):
    """Checks that both values are equal."""
    holds(what, found == expected, f"expected {expected!r}, found {found!r}")


def holds(what, is_true, why=""):
    """Checks that a condition is true."""
    global done
    done += 1
    if not is_true:
        failed.append(what)
        print(f"FAILED {what}: {why}", flush=True)


def fails(what, action, *arguments):
    """Checks that a call raises an error."""
    try:
        found = action(*arguments)
    except Exception:
        return holds(what, True)
    holds(what, False, f"expected an error, found {found!r}")


def becomes(what, read, expected):
    """Checks that a value is reached within three seconds."""
    end = time.monotonic() + 3
    found = read()
    while found != expected and time.monotonic() < end:
        time.sleep(0.02)
        found = read()
    equal(what, found, expected)


def close():
    """Prints the summary, which is the last line of every client's script."""
    print(f"checks {done} failed {len(failed)}", flush=True)
    sys.exit(1 if failed else 0)
