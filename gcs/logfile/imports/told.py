"""What the tables of an autopilot's own log tell of the vehicle, for the derived topics."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from heapq import merge
from operator import itemgetter
from typing import Any, TypeAlias

import numpy as np

from gcs.logfile.columns.layout import Records
from gcs.logfile.imports.vehicle import ReportedVehicle
from gcs.mcap_file.batch_writer import BatchWriter, Loose, Times
from gcs.record.derived import Derived
from gcs.report import RecordItem

OFTEN_NS = 40_000_000
"""Derived topics have at most 25 Hz: of what comes more often, one a period is looked at."""
TICK_NS = 500_000_000

Tell: TypeAlias = Callable[[Any, int], Iterator[RecordItem]]
"""Values of the columns and the time in ns -> what is to be recorded."""


@dataclass(frozen=True, slots=True)
class Told:
    """What the rows of a table tell of a vehicle; of several for one table the first that fits."""

    vehicle: ReportedVehicle
    table: str
    columns: tuple[str, ...]
    tell: Tell
    often: bool = False
    only: tuple[str, int] | None = None
    """A column and the value that it must have, where there is such a column."""
    unless: str = ""
    """A table that tells the same better: once it has come, this one is left."""


class Telling:
    """Goes over the rows of a log in order of time, stretch by stretch."""

    def __init__(self, told: list[Told], writer: BatchWriter) -> None:
        self._told = told
        self._writer = writer
        self._derived = Derived()
        self._chosen: dict[str, Told | None] = {}
        self._periods: dict[str, int] = {}
        """Of each table that comes often the last period that was looked at."""
        self._came: set[str] = set()
        self._tick_ns = 0

    def of(self, tables: dict[str, tuple[Times, Records]]) -> list[Loose]:
        """By table the time and the row of each message; all times are different."""
        streams = []
        for name, (log_ns, rows) in tables.items():
            told = self._for(name, rows)
            if told is not None:
                streams.append(self._values(told, log_ns, rows))
        loose: list[Loose] = []
        for now_ns, told, values in merge(*streams, key=itemgetter(0)):
            self._came.add(told.table)
            if told.unless in self._came:
                continue
            outs: list[Any] = []
            for item in told.tell(values, now_ns):
                outs += self._derived.handle(item, now_ns)
            if told.vehicle.status_is_due(now_ns):
                outs += self._derived.handle(told.vehicle.status(now_ns), now_ns)
            if now_ns >= self._tick_ns:
                self._tick_ns = now_ns + TICK_NS
                outs += self._derived.tick(now_ns)
            loose += self._loose(outs, now_ns)
        return loose

    def close(self, now_ns: int) -> list[Loose]:
        return self._loose(self._derived.close(now_ns), now_ns)

    def _loose(self, outs: list[Any], now_ns: int) -> list[Loose]:
        return [Loose(self._writer.channel(o.channel), now_ns, o.message) for o in outs]

    def _for(self, name: str, rows: Records) -> Told | None:
        if name not in self._chosen:
            has = set(rows.dtype.names or ())
            fits = (each for each in self._told if each.table == name and set(each.columns) <= has)
            self._chosen[name] = next(fits, None)
        return self._chosen[name]

    def _values(self, told: Told, log_ns: Times, rows: Records) -> Iterator[tuple[int, Told, Any]]:
        """Time, `told` and the values of the columns, in order of time."""
        if told.only is not None and told.only[0] in (rows.dtype.names or ()):
            mine = rows[told.only[0]] == told.only[1]
            rows, log_ns = rows[mine], log_ns[mine]
        if not len(rows):
            return
        if (np.diff(log_ns) < 0).any():
            order = np.argsort(log_ns)
            rows, log_ns = rows[order], log_ns[order]
        if told.often:
            periods = log_ns // OFTEN_NS
            kept = np.diff(periods, prepend=self._periods.get(told.table, -1)) != 0
            self._periods[told.table] = int(periods[-1])
            rows, log_ns = rows[kept], log_ns[kept]
        values = rows[list(told.columns)].tolist()
        for now_ns, each in zip(log_ns.tolist(), values, strict=True):
            yield now_ns, told, each
