"""A plugin for pytest: scenario files are tests, each compared with the golden file beside it.

A `*.toml` file is a scenario if it is below one of the folders in `opennck_scenarios` of the configuration, or if its golden file is beside it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import pytest

from . import _opennck

_FOLDERS: pytest.StashKey[set[Path]] = pytest.StashKey()


class NotPassed(Exception):
    """A scenario that did not pass; its text is the report of OpenNCK."""


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("opennck", "OpenNCK scenarios")
    group.addoption("--opennck-accept", action="store_true", help="write golden files that are missing or differ")
    group.addoption("--opennck-check-causes", action="store_true", help="also check the cause of every edge")
    parser.addini("opennck_scenarios", "folders with OpenNCK scenarios", type="paths", default=[])


def pytest_configure(config: pytest.Config) -> None:
    for folder in config.getini("opennck_scenarios"):
        if not folder.exists():
            raise pytest.UsageError(f"opennck_scenarios: the folder {folder} does not exist")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    if file_path.suffix == ".toml" and (_has_golden(file_path) or file_path.resolve() in _scenarios(parent.config)):
        return ScenarioFile.from_parent(parent, path=file_path)
    return None


def _has_golden(file: Path) -> bool:
    return any(file.parent.glob(f"{_escaped(file.stem)}.snap")) or any(file.parent.glob(f"{_escaped(file.stem)}@*.snap"))


def _escaped(stem: str) -> str:
    return "".join(f"[{letter}]" if letter in "*?[" else letter for letter in stem)


def _scenarios(config: pytest.Config) -> set[Path]:
    """The scenario files below the configured folders. Files that others include, machines and PLC programs are none."""
    if _FOLDERS not in config.stash:
        folders = config.getini("opennck_scenarios")
        files = _opennck.scenario_files(folders) if folders else []
        config.stash[_FOLDERS] = {file.resolve() for file in files}
    return config.stash[_FOLDERS]


class ScenarioFile(pytest.File):
    """A scenario file."""

    def collect(self) -> Iterator[pytest.Item]:
        try:
            cases = _opennck.cases(self.path)
        except _opennck.Error as error:
            raise self.CollectError(str(error)) from None
        for case in cases:
            yield ScenarioItem.from_parent(self, name=case.variant or "scenario", case=case)


class ScenarioItem(pytest.Item):
    """A case of a scenario: one combination of its matrix under one of its profiles."""

    def __init__(self, *, case: _opennck.Case, **options: Any) -> None:
        super().__init__(**options)
        self.case = case
        # Reports name the rules, as those of `opennck test --junit` do.
        self.user_properties += [("rule", rule) for rule in case.covers]

    def runtest(self) -> None:
        accept = self.config.getoption("opennck_accept")
        outcome = self.case.test(accept, self.config.getoption("opennck_check_causes"), None)
        if outcome.message:
            raise NotPassed(outcome.message)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        if isinstance(excinfo.value, (NotPassed, _opennck.Error)):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        return self.path, None, f"{self.path.stem}: {self.case.title}"


def pytest_report_header(config: pytest.Config) -> Iterable[str]:
    folders = config.getini("opennck_scenarios")
    return [f"opennck: scenarios below {', '.join(str(folder) for folder in folders)}"] if folders else []
