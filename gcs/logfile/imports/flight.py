"""A log that is tables in memory, into a record: each table a topic, and the derived topics."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from heapq import merge
from operator import itemgetter
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from gcs.logfile import packed
from gcs.logfile.columns.layout import Records
from gcs.logfile.imports.result import METADATA, Imported
from gcs.logfile.imports.vehicle import ReportedVehicle
from gcs.logfile.packed import TIME_FIELD
from gcs.mcap_file.batch_writer import BatchWriter, Loose, Rows
from gcs.mcap_file.chunk_reader import Index
from gcs.record import ros1
from gcs.record.derived import Derived
from gcs.report import RecordItem

OFTEN_NS = 40_000_000
"""Derived topics have at most 25 Hz: of what comes more often, one a period is looked at."""
TICK_NS = 500_000_000
_SLICE = 200_000
"""So many messages are written at a time."""

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


def import_flight(
    name: str,
    prefix: str,
    source: Path,
    writer: BatchWriter,
    tables: dict[str, Records],
    told: list[Told],
    garbage: list[tuple[int, bytes]],
) -> Imported:
    """Write it all; topics are `prefix`/<table>."""
    result = Imported(name, {table: len(rows) for table, rows in tables.items()})
    writer.metadata(METADATA, {"format": name, "file": source.name})
    rows = [_rows(prefix, table, found, writer) for table, found in tables.items() if len(found)]
    rows += _garbage(garbage, writer, result)
    loose = _derived(tables, told, writer)
    times = np.sort(np.concatenate([each.log_ns for each in rows]))
    edges = [*times[::_SLICE].tolist()[1:], np.iinfo(np.int64).max]
    first = 0
    for edge in edges:
        last = next((n for n in range(first, len(loose)) if loose[n].log_ns >= edge), len(loose))
        parts = [_cut(each, edge) for each in rows]
        writer.write([part for part, _ in parts], loose[first:last])
        rows = [rest for _, rest in parts]
        first = last
    result.span(int(times[0]), int(times[-1]))
    result.messages = writer.messages
    return result


def _rows(prefix: str, name: str, table: Records, writer: BatchWriter) -> Rows:
    kind = prefix.strip("/")
    channel = writer.channel(packed.channel_of(f"{prefix}/{name}", f"{kind}/{name}", table))
    order = np.argsort(table[TIME_FIELD], kind="stable")
    times = table[TIME_FIELD][order]
    return Rows(channel, times, times, packed.messages_of(table)[order])


def _garbage(
    garbage: list[tuple[int, bytes]], writer: BatchWriter, result: Imported
) -> Iterator[Rows]:
    for time_ns, raw in garbage:
        result.garbage_stretches += 1
        result.garbage_bytes += len(raw)
        message = np.frombuffer(ros1.encode_garbage("garbage", raw), np.uint8)
        times = np.array([time_ns], np.int64)
        yield Rows(writer.channel(ros1.garbage_channel(0)), times, times, message[None, :])


def _cut(rows: Rows, edge_ns: int) -> tuple[Rows, Rows]:
    """What is before a time, and the rest."""
    at = int(np.searchsorted(rows.log_ns, edge_ns))
    channel, log_ns, publish_ns, data = rows
    return (
        Rows(channel, log_ns[:at], publish_ns[:at], data[:at]),
        Rows(channel, log_ns[at:], publish_ns[at:], data[at:]),
    )


def _derived(tables: dict[str, Records], told: list[Told], writer: BatchWriter) -> list[Loose]:
    derived = Derived()
    loose: list[Loose] = []
    tick_ns = now_ns = 0

    def put(outs: list[Any]) -> None:
        loose.extend(Loose(writer.channel(o.channel), now_ns, o.message) for o in outs)

    chosen = _that_fit(tables, told)
    streams = [_values(number, each, tables) for number, each in enumerate(chosen)]
    for now_ns, number, values in merge(*streams, key=itemgetter(0)):
        each = chosen[number]
        for item in each.tell(values, now_ns):
            put(derived.handle(item, now_ns))
        if each.vehicle.status_is_due(now_ns):
            put(derived.handle(each.vehicle.status(now_ns), now_ns))
        if now_ns >= tick_ns:
            tick_ns = now_ns + TICK_NS
            put(derived.tick(now_ns))
    put(derived.close(now_ns))
    return loose


def _that_fit(tables: dict[str, Records], told: list[Told]) -> list[Told]:
    fitting: dict[str, Told] = {}
    for each in told:
        rows = tables.get(each.table)
        if rows is not None and set(each.columns) <= set(rows.dtype.names or ()):
            fitting.setdefault(each.table, each)
    return list(fitting.values())


def _values(number: int, told: Told, tables: dict[str, Records]) -> Iterator[tuple[int, int, Any]]:
    """Time, `number` and the values of the columns, in order of time."""
    rows = tables[told.table]
    if told.only is not None and told.only[0] in (rows.dtype.names or ()):
        rows = rows[rows[told.only[0]] == told.only[1]]
    rows = rows[np.argsort(rows[TIME_FIELD], kind="stable")]
    times: Index = rows[TIME_FIELD]
    if told.often:
        kept = np.diff(times // OFTEN_NS, prepend=-1) != 0
        rows, times = rows[kept], times[kept]
    values = rows[list(told.columns)].tolist()
    for now_ns, each in zip(times.tolist(), values, strict=True):
        yield now_ns, number, each
