"""A session: a machine under test, step by step."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from . import _opennck
from .trace import Trace

#: A value of a signal: a number, a truth value for one bit, a percentage (`"50%"`) or a number with its base (`"2#1101"`).
Value = int | float | str
_Path = str | os.PathLike[str]


class Session:
    """A machine with its growing trace. Time passes only in `run`, `wait`, `hold` and `pulse`.

    `machine` is a folder, an archive, or the name of a built-in machine. `plc` is the name of a ready PLC program, the folder of a STEP 7
    program (with a `/`), or a function that is called once in each PLC cycle with a `PlcIo`. The verbs are those of scenario files, with
    the same values; durations are texts such as `"500ms"`.
    """

    def __init__(
        self,
        machine: _Path,
        plc: str | Callable[[_opennck.PlcIo], object] | None = None,
        *,
        profile: str | None = None,
        plc_image: _Path | None = None,
        watch: Sequence[str] = (),
    ) -> None:
        self._native = _opennck.Session(machine, plc, profile, plc_image)
        if watch:
            self.watch(*watch)

    # What the machine is now.

    def get(self, expression: str) -> float:
        """The value of an expression now: a signal, a value such as `X.position`, or anything that `wait` accepts."""
        return self._native.value(expression)

    def values(self, *expressions: str) -> dict[str, float]:
        """The values of several expressions now."""
        return {expression: self._native.value(expression) for expression in expressions}

    @property
    def time(self) -> float:
        """The time since the start of the session, in seconds."""
        return self._native.time()

    @property
    def cycle(self) -> int:
        """The number of cycles of the machine."""
        return self._native.cycle()

    @property
    def axes(self) -> Sequence[str]:
        """The names of the machine axes."""
        return self._native.axes()

    @property
    def channels(self) -> Sequence[str]:
        """The names of the channels."""
        return self._native.channels()

    @property
    def alarms(self) -> dict[str, str]:
        """The pending alarms: number or name, and text."""
        return dict(self._native.alarms())

    @property
    def warnings(self) -> Sequence[str]:
        """Findings about the files of the machine."""
        return self._native.warnings()

    # Signals.

    def set(self, signals: str | Mapping[str, Value], value: Value | None = None) -> None:
        """Writes signals once, in the next cycle: `set("X.traversing_key_plus", 1)` or `set({…})`. The PLC program may overwrite them."""
        self._signals("set", signals, value)

    def write(self, signals: str | Mapping[str, Value], value: Value | None = None) -> None:
        """Writes signals once as a client can: also those of the NCK, which the NCK then overwrites."""
        self._signals("write", signals, value)

    def force(self, signals: str | Mapping[str, Value], value: Value | None = None) -> None:
        """Overrides signals after every scan of the PLC program, until `release`."""
        self._signals("force", signals, value)

    def release(self, *signals: str) -> None:
        """Ends the override of signals."""
        self.step({"release": [*signals]})

    def pulse(self, *signals: str, length: str = "100ms") -> None:
        """Sets bits for a time, and resets them."""
        self.step({"pulse": [*signals], "for": length})

    # Time.

    def run(self, time: str) -> None:
        """Lets time pass."""
        self.step({"run": time})

    def wait(self, expression: str, within: str = "300s") -> None:
        """Lets time pass until an expression is true; raises `Missed` when the time is over."""
        self.step({"wait": expression, "within": within})

    def hold(self, expression: str, during: str) -> None:
        """Lets time pass; the expression must be true now and in every cycle."""
        self.step({"hold": expression, "during": during})

    # Expectations.

    def expect(self, *expressions: str) -> None:
        """All expressions must be true now."""
        self.step({"expect": [*expressions]})

    def image(self, expected: Mapping[str, Value]) -> None:
        """These bytes, words or bits must have these values now."""
        self.step({"image": dict(expected)})

    def capture(self, name: str, expression: str) -> float:
        """Stores a value for later expressions, and returns it."""
        self.step({"capture": {name: expression}})
        return self._native.value(name)

    def always(self, expression: str) -> None:
        """The expression must be true after every cycle from now on."""
        self._native.always(expression)

    def never(self, expression: str) -> None:
        """The expression must be false after every cycle from now on."""
        self._native.never(expression)

    def follows(self, name: str, when: str, then: str, within: str) -> None:
        """From now on, `then` must become true within a time after every rising edge of `when`."""
        self._native.follows(name, when, then, within)

    # Data and programs of the control.

    def machine_data(self, data: str | Mapping[str, Value], value: Value | None = None) -> None:
        """Stores machine data: `machine_data("34090[XF]", -0.941)`. They act when their class says."""
        self._signals("machine_data", data, value)

    def list(self, entries: str | Mapping[str, Value], value: Value | None = None) -> None:
        """Updates entries of parameter lists (ISG kernel, TwinCAT CNC)."""
        self._signals("list", entries, value)

    def r_parameters(self, parameters: str | Mapping[str, Value], value: Value | None = None) -> None:
        """Writes R parameters: `r_parameters("R5", 1.5)`, `"R5[CHAN2]"` in another channel."""
        self._signals("r_parameters", parameters, value)

    def program(self, file: _Path, channel: int = 1) -> None:
        """Selects an NC program, which NC start then runs; subprograms are found beside it."""
        self.step({"program": os.fspath(file), "channel": channel})

    def nc(self, text: str, channel: int = 1) -> None:
        """Selects an NC program by its text."""
        self.step({"nc": text, "channel": channel})

    def mdi(self, blocks: str, channel: int = 1) -> None:
        """Gives blocks to MDA."""
        self.step({"mdi": blocks, "channel": channel})

    def search(self, block: str, kind: str, channel: int = 1) -> None:
        """Searches a block: `contour`, `end_point`, `serupro`, `without_calculation`."""
        self.step({"search": {"block": block, "kind": kind}, "channel": channel})

    def preset(self, values: str | Mapping[str, float], value: float | None = None) -> None:
        """PRESET of the operator: the axes have these actual values from now on."""
        self._signals("preset", values, value)

    def function_generator(
        self,
        axis: str,
        *,
        amplitude: float | Sequence[float],
        frequency: float,
        duration: str,
        signal: str = "sine",
        offset: float = 0.0,
    ) -> None:
        """Gives the function generator a signal, which NC start in JOG begins."""
        values = {"axis": axis, "signal": signal, "offset": offset, "frequency": frequency, "duration": duration}
        self.step({"function_generator": {**values, "amplitude": amplitude}})

    # The operator, power, the PLC.

    def new_conf(self) -> None:
        """Sets machine data active."""
        self.step({"new_conf": True})

    def power_on(self) -> None:
        """Switches the control off and on."""
        self.step({"power_on": True})

    def plc(self, order: str) -> None:
        """Stops the PLC (`stop`), restarts it (`run`), or starts it cold (`cold`)."""
        self.step({"plc": order})

    def cancel(self) -> None:
        """Presses the key that cancels alarms."""
        self.step({"cancel": True})

    def handwheel(self, number: int, pulses: int, over: str) -> None:
        """Turns a handwheel while time passes in the next calls."""
        self.step({"handwheel": {"number": number, "pulses": pulses, "over": over}})

    # Faults.

    def fault(self, axis: str, kind: str, **keys: Value) -> None:
        """Causes a fault: `fault("XF", "block")`, `fault("X", "push", by=0.3)`."""
        self.step({"fault": {"axis": axis, "kind": kind, **keys}})

    def clear_fault(self, axis: str, kind: str, **keys: Value) -> None:
        """Removes a fault."""
        self.step({"clear_fault": {"axis": axis, "kind": kind, **keys}})

    # Any step.

    def include(self, file: _Path, times: int = 1) -> None:
        """Executes the steps of a scenario file; its head has no effect."""
        self.step({"include": os.fspath(file), "times": times})

    def step(self, step: Mapping[str, Any]) -> None:
        """Executes a step of a scenario file: `step({"set": {"X.traversing_key_plus": 1}})`."""
        self._native.step(json.dumps(dict(step)))

    def note(self, text: str) -> None:
        """Writes a note into the trace."""
        self._native.note(text)

    def _signals(self, verb: str, signals: str | Mapping[str, Any], value: Any) -> None:
        if isinstance(signals, str):
            if value is None:
                raise TypeError(f"{verb}: expected a value for {signals}, as in {verb}({signals!r}, 1)")
            self.step({verb: {signals: value}})
        elif value is None:
            self.step({verb: dict(signals)})
        else:
            raise TypeError(f"{verb}: expected a name and a value, or a dictionary")

    # The trace.

    def watch(self, *entries: str) -> None:
        """Selects what the trace shows: signals, values and patterns such as `X.traverse_command_*`. Values are recorded from now on."""
        self._native.watch([*entries])

    @property
    def trace(self) -> Trace:
        """Every change so far; it grows with the session."""
        return Trace(self._native)

    def _repr_svg_(self) -> str:
        return self._native.svg()

    # States.

    def save(self) -> bytes:
        """The complete state of the machine."""
        return self._native.save()

    def restore(self, saved: bytes) -> None:
        """Continues from a saved machine with the same files and the same PLC program. Trace, time and rules begin anew."""
        self._native.restore(saved)

    def fork(self) -> Session:
        """A second session that continues independently from this state, with the trace so far."""
        other = Session.__new__(Session)
        other._native = self._native.fork()
        return other

    def __repr__(self) -> str:
        return f"<opennck.Session of {', '.join(self.axes)} at {self.time} s>"
