"""An autopilot's own log into a record: each kind of message a topic, and the derived topics.

Messages of such a log are nearly in order of their times.  They are put in order here, without
having them all in memory: a message may be late by `HOLD_NS`, and is held back for so long.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from gcs.logfile import packed
from gcs.logfile.columns.layout import Records
from gcs.logfile.frames import Mask
from gcs.logfile.imports.log_clock import HOLD_NS, LogClock
from gcs.logfile.imports.result import METADATA, Imported
from gcs.logfile.imports.told import Telling, Told
from gcs.logfile.onboard.part import Gap, OnboardLog, Part
from gcs.logfile.packed import TIME_FIELD
from gcs.mcap_file.batch_writer import BatchWriter, Loose, Rows, Times, strictly_increasing
from gcs.mcap_file.chunk_reader import Index
from gcs.record import ros1


class _Table(NamedTuple):
    """Messages of one kind that are not written yet; `log_ns` is when each has its place."""

    offsets: Index
    log_ns: Times
    rows: Records

    def pick(self, which: Mask) -> _Table:
        return _Table(self.offsets[which], self.log_ns[which], self.rows[which])


def import_onboard(
    name: str,
    prefix: str,
    log: OnboardLog,
    told: list[Told],
    writer: BatchWriter,
    progress: Callable[[int], None] | None = None,
) -> Imported:
    """Write it all; topics are `prefix`/<table>.  Raises BadLogError and OSError."""
    writer.metadata(METADATA, {"format": name, "file": log.path.name})
    importing = _Import(Imported(name), prefix, log, told, writer)
    for part in log.parts():
        importing.add(part)
        if progress is not None:
            progress(part.read_bytes)
    return importing.finish()


class _Import:
    def __init__(
        self,
        result: Imported,
        prefix: str,
        log: OnboardLog,
        told: list[Told],
        writer: BatchWriter,
    ) -> None:
        self._result = result
        self._prefix = prefix
        self._writer = writer
        self._clock = LogClock(log.first_ns)
        self._telling = Telling(told, writer)
        self._held: dict[str, _Table] = {}
        self._gaps: list[tuple[int, Gap]] = []
        """Those held back, and when each has its place."""
        self._last_ns = -1

    def add(self, part: Part) -> None:
        """The next part of the log."""
        tables = {each.name: each for each in part.tables}
        offsets = [each.offsets for each in part.tables]
        gaps = np.array([gap.offset for gap in part.gaps], np.int64)
        every = np.concatenate((*offsets, gaps))
        order = np.argsort(every, kind="stable")
        told_ns = np.concatenate(
            (
                *(each.rows[TIME_FIELD] for each in part.tables),
                np.array([gap.time_ns for gap in part.gaps], np.int64),
            )
        )
        log_ns = np.empty(len(every), np.int64)
        log_ns[order] = self._clock.log_times(told_ns[order])
        at = 0
        for name, each in tables.items():
            mine = slice(at, at + len(each.rows))
            at += len(each.rows)
            self._hold(name, _Table(each.offsets, log_ns[mine], each.rows))
        self._gaps += zip(log_ns[at:].tolist(), part.gaps, strict=True)
        self._write(self._clock.latest_ns - HOLD_NS)

    def finish(self) -> Imported:
        self._write(np.iinfo(np.int64).max)
        self._writer.write([], self._telling.close(self._last_ns))
        result = self._result
        result.messages = self._writer.messages
        result.late = self._clock.late
        return result

    def _hold(self, name: str, more: _Table) -> None:
        held = self._held.get(name)
        if held is not None:
            # Of bytes: numpy compares the fields of records before it puts them together.
            both = np.concatenate((held.rows.view(np.uint8), more.rows.view(np.uint8)))
            more = _Table(
                np.concatenate((held.offsets, more.offsets)),
                np.concatenate((held.log_ns, more.log_ns)),
                both.view(more.rows.dtype),
            )
        self._held[name] = more

    def _write(self, edge_ns: int) -> None:
        """All that has its place before `edge_ns`: nothing that comes later can be before it."""
        ready = {name: table for name, table in self._held.items() if len(table.rows)}
        parts, self._held = {}, {}
        for name, table in ready.items():
            now = table.log_ns < edge_ns
            if now.all():
                parts[name] = table
                continue
            if now.any():
                parts[name] = table.pick(now)
            self._held[name] = table.pick(~now)
        gaps = [each for each in self._gaps if each[0] < edge_ns]
        self._gaps = [each for each in self._gaps if each[0] >= edge_ns]
        if parts or gaps:
            self._write_in_order(parts, gaps)

    def _write_in_order(self, parts: dict[str, _Table], gaps: list[tuple[int, Gap]]) -> None:
        """By their places in time, and where these are the same, by those in the file."""
        log_ns = np.concatenate(
            (*(each.log_ns for each in parts.values()), np.array([ns for ns, _ in gaps], np.int64))
        )
        offsets = np.concatenate(
            (
                *(each.offsets for each in parts.values()),
                np.array([gap.offset for _, gap in gaps], np.int64),
            )
        )
        order = np.lexsort((offsets, log_ns))
        log_ns[order] = strictly_increasing(log_ns[order], self._last_ns)
        self._last_ns = int(log_ns[order[-1]])
        self._result.span(int(log_ns[order[0]]), self._last_ns)
        rows: list[Rows] = []
        tables: dict[str, tuple[Times, Records]] = {}
        at = 0
        for name in sorted(parts, key=lambda each: int(parts[each].offsets[0])):
            self._channel(name, parts[name].rows)
        for name, table in parts.items():
            times = log_ns[at : at + len(table.rows)]
            at += len(table.rows)
            rows.append(self._rows(name, table.rows, times))
            tables[name] = times, table.rows
        loose = [*self._telling.of(tables), *self._garbage(gaps, log_ns[at:])]
        self._writer.write(rows, loose)

    def _channel(self, name: str, table: Records) -> int:
        topic, kind = f"{self._prefix}/{name}", f"{self._prefix.strip('/')}/{name}"
        return self._writer.channel(packed.channel_of(topic, kind, table))

    def _rows(self, name: str, table: Records, log_ns: Times) -> Rows:
        kinds = self._result.kinds
        kinds[name] = kinds.get(name, 0) + len(table)
        told_ns = np.maximum(table[TIME_FIELD], 0)
        return Rows(self._channel(name, table), log_ns, told_ns, packed.messages_of(table))

    def _garbage(self, gaps: list[tuple[int, Gap]], log_ns: Times) -> Iterator[Loose]:
        for (_, gap), time_ns in zip(gaps, log_ns.tolist(), strict=True):
            self._result.garbage_stretches += 1
            self._result.garbage_bytes += len(gap.raw)
            if self._result.garbage_at is None:
                self._result.garbage_at = gap.offset
            said = ros1.encode_garbage(f"no message, from byte {gap.offset} on", gap.raw)
            yield Loose(self._writer.channel(ros1.garbage_channel(0)), time_ns, said)
