"""Scenario files: `run` executes one, `test` compares traces with golden files."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from . import _opennck
from .trace import Trace

_Path = str | os.PathLike[str]
_Programs = Mapping[str, Callable[[_opennck.PlcIo], object]]


@dataclass(frozen=True)
class Step:
    """A step of a scenario: where it is written, its note, and `done`, `failed` or `not reached`."""

    file: str
    line: int
    note: str | None
    state: str


class Result:
    """The result of a case of a scenario, with its trace."""

    def __init__(self, name: str, title: str, outcome: _opennck.Outcome) -> None:
        self._outcome = outcome
        #: The file, the values of its matrix, and its profile if it has several.
        self.name = name
        #: What the scenario shows.
        self.title = title
        #: `passed` or `failed`; of `test` also `accepted`, `differs` (from the golden file), `missing` (golden file), `untrue` (a wrong
        #: cause), `unusable` (input).
        self.verdict = outcome.verdict
        #: Why it did not pass; empty if it passed.
        self.message = outcome.message
        #: The trace.
        self.trace = Trace(outcome)

    @property
    def ok(self) -> bool:
        """Whether the case passed."""
        return self.verdict in ("passed", "accepted")

    @property
    def steps(self) -> list[Step]:
        """The steps, with those that the scenario includes."""
        return [Step(*step) for step in self._outcome.steps()]

    @property
    def time(self) -> float:
        """The time at the end, in seconds."""
        return self._outcome.time()

    @property
    def remarks(self) -> list[str]:
        """Findings about the machine, and rules that never began."""
        return self._outcome.remarks()

    def get(self, expression: str) -> float:
        """The value of an expression at the end."""
        return self._outcome.value(expression)

    def check(self) -> Result:
        """Raises `Missed` if the case did not pass."""
        if not self.ok:
            raise _opennck.Missed(self.message)
        return self

    def _repr_svg_(self) -> str:
        return self._outcome.svg()

    def __repr__(self) -> str:
        return f"<opennck.Result {self.name}: {self.verdict}>"


def run(scenario: _Path, *, case: str | None = None, programs: _Programs | None = None) -> Result:
    """Runs a scenario file and returns its result.

    `case` selects one case of a file with a matrix or with several profiles, by a part of its name. `programs` are functions that a scenario
    names in `plc = "…"`, each called once in each PLC cycle. What cannot be used raises `Error`; a step that fails is a result.
    """
    cases = _opennck.cases(scenario)
    chosen = [one for one in cases if case is None or case in one.variant]
    if len(chosen) != 1:
        names = "".join(f"\n  {one.variant}" for one in cases)
        raise _opennck.Error(f"expected one case, found {len(chosen)} of {len(cases)} in {os.fspath(scenario)}; name one of{names}")
    return Result(chosen[0].name, chosen[0].title, chosen[0].run(_functions(programs)))


def test(
    *paths: _Path, accept: bool = False, check_causes: bool = False, programs: _Programs | None = None
) -> list[Result]:
    """Runs every scenario below the paths and compares each trace with the golden file beside it.

    `accept` writes golden files that are missing or differ; `check_causes` also checks the cause of every edge.
    """
    results = []
    for file in _opennck.scenario_files(list(paths)):
        for case in _opennck.cases(file):
            outcome = case.test(accept, check_causes, _functions(programs))
            results.append(Result(case.name, case.title, outcome))
    return results


# A test runner must not take it for a test.
test.__test__ = False  # type: ignore[attr-defined]


def _functions(programs: _Programs | None) -> dict[str, Any] | None:
    return None if programs is None else dict(programs)
