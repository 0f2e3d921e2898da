"""What the Python clients share: checks that are counted, and the end."""

import os
import sys
import time

PORT = int(os.environ["S7_PORT"])
done, failed = 0, []


def equal(what, found, expected):
    """Both are the same."""
    holds(what, found == expected, f"expected {expected!r}, found {found!r}")


def holds(what, is_true, why=""):
    """It is true."""
    global done
    done += 1
    if not is_true:
        failed.append(what)
        print(f"FAILED {what}: {why}", flush=True)


def fails(what, action, *arguments):
    """It raises an error."""
    try:
        found = action(*arguments)
    except Exception:
        return holds(what, True)
    holds(what, False, f"an error was due, found {found!r}")


def becomes(what, read, expected):
    """It is so within three seconds."""
    end = time.monotonic() + 3
    found = read()
    while found != expected and time.monotonic() < end:
        time.sleep(0.02)
        found = read()
    equal(what, found, expected)


def close():
    """The last line of every client's script."""
    print(f"checks {done} failed {len(failed)}", flush=True)
    sys.exit(1 if failed else 0)
