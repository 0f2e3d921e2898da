"""The trace of a session or of a scenario: every change with its time, its writer and its cause."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    import pandas
    import pyarrow

#: A line of the trace, with the keys of `opennck run --trace`.
Row = dict[str, Any]


class _Source(Protocol):
    def json_lines(self) -> str: ...
    def text(self, causes: bool) -> str: ...
    def vcd(self) -> str: ...
    def svg(self) -> str: ...


class Trace:
    """A view of the trace: that of a session grows with it. `watch` selects the signals and values that it shows."""

    def __init__(self, source: _Source) -> None:
        self._source = source

    def rows(self) -> list[Row]:
        """The lines as dictionaries, in order of time `t` in seconds. Their keys are those of `opennck run --trace`."""
        return [json.loads(line) for line in self._source.json_lines().split("\n") if line]

    def __iter__(self) -> Iterator[Row]:
        return iter(self.rows())

    def text(self, *, causes: bool = True) -> str:
        """The trace for readers, one row for each change; without causes as in golden files."""
        return self._source.text(causes)

    def json_lines(self) -> str:
        """The trace as JSON lines, as `opennck why` and `opennck diff` read it."""
        return self._source.json_lines()

    def vcd(self) -> str:
        """The trace as a waveform for GTKWave and similar viewers."""
        return self._source.vcd()

    def svg(self) -> str:
        """The trace as a timing diagram."""
        return self._source.svg()

    def _repr_svg_(self) -> str:
        return self._source.svg()

    def columns(self) -> dict[str, list[Any]]:
        """The trace as columns of a table; what a row does not have is None.

        `kind` is `signal`, `value`, `alarm`, `note`, `event` or the word of another happening. `name` is the symbol, or else the address, the
        number of an alarm, or what happened.
        """
        columns: dict[str, list[Any]] = {name: [] for name in _COLUMNS}
        for row in self.rows():
            for name, value in _flat(row).items():
                columns[name].append(value)
        return columns

    def to_arrow(self) -> pyarrow.Table:
        """The trace as a table of Arrow; it needs `pip install opennck[arrow]`."""
        import pyarrow

        types = {"float": pyarrow.float64(), "int": pyarrow.int64(), "text": pyarrow.string()}
        schema = pyarrow.schema([(name, types[kind]) for name, kind in _COLUMNS.items()])
        return pyarrow.table(self.columns(), schema=schema)

    def to_pandas(self) -> pandas.DataFrame:
        """The trace as a data frame of pandas; it needs `pip install opennck[pandas]`."""
        import pandas

        return pandas.DataFrame(self.columns())


_COLUMNS = {
    "t": "float",
    "kind": "text",
    "name": "text",
    "address": "text",
    "value": "float",
    "by": "text",
    "because": "text",
    "where": "text",
    "text": "text",
    "event": "int",
}


def _flat(row: Row) -> Row:
    """A line with the columns of the table."""
    flat: Row = dict.fromkeys(_COLUMNS)
    for name in ("t", "by", "because", "where", "event"):
        flat[name] = row.get(name)
    value = row.get("value")
    if isinstance(value, str):
        flat["text"] = value
    elif value is not None:
        flat["value"] = float(value)
    if "signal" in row:
        flat.update(kind="signal", name=row.get("symbol", row["signal"]), address=row["signal"])
    elif "alarm" in row:
        raised = 1.0 if row["state"] == "raised" else 0.0
        flat.update(kind="alarm", name=str(row["alarm"]), value=raised, text=row["text"])
    elif "note" in row:
        flat.update(kind="note", name="note", text=row["note"])
    elif "happened" in row:
        happened = row["happened"]
        of = row.get("machine_data") or row.get("fault") or row.get("program")
        amount = row.get("amount", row.get("pulses", value))
        flat.update(kind=happened, name=of or happened, value=float(amount) if isinstance(amount, (int, float)) else None)
    elif "rule" in row:
        flat.update(kind="event", name=row["rule"])
    else:
        flat.update(kind="value", name=row["symbol"])
    return flat
