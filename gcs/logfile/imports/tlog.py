"""A .tlog into a record: every frame, every damaged byte, and the derived topics.

`gcs/logfile/exports/tlog.py` makes the same bytes of it again.  For that the record keeps, beside
log times that rise strictly, what stood in the file: a message's publish_time is its time stamp in
microseconds times 1000; one that is no multiple of 1000 says that there was none.  The time stamps
of a file that is damaged may be so too: log times are those that can be believed.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from gcs.logfile.frames import Mask, Small
from gcs.logfile.imports.frame_rows import FrameRows
from gcs.logfile.imports.result import METADATA, Imported
from gcs.logfile.imports.telemetry import Telemetry
from gcs.logfile.tlog import STAMP_BYTES, Gap, Window, read_windows
from gcs.mcap_file.batch_writer import BatchWriter, Loose, Rows, Times, strictly_increasing
from gcs.record import ros1
from gcs.record.derived import Derived
from gcs.wire.dialect import MESSAGES
from gcs.wire.frame import why_not

TICK_NS = 500_000_000
"""How often the derived topics are asked for what is due by the clock."""

JUMP_US = 3_600_000_000
"""A time stamp that is further from those around it is damaged."""
LAST_US = 2**63 // 1000
"""Nanoseconds since 1970 in 63 bits end here."""

_AROUND = 5


def import_tlog(
    source: Path, writer: BatchWriter, progress: Callable[[int], None] | None = None
) -> Imported:
    """Read all of `source`; `progress` gets the bytes that were read so far.

    Raises BadLogError where it is no .tlog, and OSError.
    """
    writer.metadata(METADATA, {"format": "tlog", "file": source.name})
    importing = _Import(writer)
    for window in read_windows(source):
        importing.add(window)
        if progress is not None:
            progress(window.read_bytes)
    return importing.finish()


class _Import:
    def __init__(self, writer: BatchWriter) -> None:
        self._writer = writer
        self._rows = FrameRows(writer)
        self._telemetry = Telemetry()
        self._derived = Derived()
        self._garbage = writer.channel(ros1.garbage_channel(0))
        self._last_ns = -1
        self._tick_ns = 0
        self._result = Imported("tlog")

    def add(self, window: Window) -> None:
        gaps, stamped = _what_can_be_kept(window)
        frames, data = window.frames, window.data
        starts = np.concatenate([frames.start, np.array([gap.start for gap in gaps], np.int64)])
        order = np.argsort(starts, kind="stable")
        of_all = np.zeros(len(starts), np.bool_)
        of_all[: len(frames)] = stamped
        stamps = np.zeros(len(starts), np.uint64)
        stamps[: len(frames)] = window.time_us
        log_ns = np.empty(len(starts), np.int64)
        log_ns[order] = log_times(stamps[order], of_all[order], self._last_ns)
        if len(log_ns):
            self._last_ns = int(log_ns[order[-1]])
        publish_ns = np.where(of_all, stamps.astype(np.int64) * 1000, _without_stamp(log_ns))
        mine = slice(len(frames))
        rows = list(self._rows.of(data, frames, log_ns[mine], publish_ns[mine]))
        garbage = [
            self._garbage_row(data[gap.start : gap.end].tobytes(), log_ns[number : number + 1])
            for number, gap in enumerate(gaps, len(frames))
        ]
        self._writer.write([*rows, *garbage], self._derive(window, log_ns[mine]))
        self._count(frames.msgid, gaps, log_ns[order])

    def finish(self) -> Imported:
        outs = self._derived.close(self._last_ns)
        self._writer.write(
            [], [Loose(self._writer.channel(o.channel), self._last_ns, o.message) for o in outs]
        )
        self._result.messages = self._writer.messages
        return self._result

    def _derive(self, window: Window, log_ns: Times) -> list[Loose]:
        loose: list[Loose] = []
        for item, now_ns in self._telemetry.of(window.data, window.frames, log_ns):
            outs = self._derived.handle(item, now_ns)
            if now_ns >= self._tick_ns:
                self._tick_ns = now_ns + TICK_NS
                outs += self._derived.tick(now_ns)
            loose += [Loose(self._writer.channel(o.channel), now_ns, o.message) for o in outs]
        return loose

    def _garbage_row(self, raw: bytes, log_ns: Times) -> Rows:
        message = np.frombuffer(ros1.encode_garbage(why_not(raw), raw), np.uint8)
        return Rows(self._garbage, log_ns, _without_stamp(log_ns), message[None, :])

    def _count(self, msgids: Small, gaps: list[Gap], log_ns: Times) -> None:
        result = self._result
        ids, counts = np.unique(msgids, return_counts=True)
        for msgid, count in zip(ids.tolist(), counts.tolist(), strict=True):
            name = MESSAGES[msgid].name if msgid in MESSAGES else f"UNKNOWN_{msgid}"
            result.kinds[name] = result.kinds.get(name, 0) + count
        result.garbage_stretches += len(gaps)
        result.garbage_bytes += sum(gap.end - gap.start for gap in gaps)
        if len(log_ns):
            result.span(int(log_ns[0]), int(log_ns[-1]))


def _without_stamp(log_ns: Times) -> Times:
    """The nearest publish_time that is no multiple of 1000."""
    return log_ns - log_ns % 1000 + 1


def _what_can_be_kept(window: Window) -> tuple[list[Gap], Mask]:
    """The gaps, and which time stamps fit into a publish_time; others become gaps."""
    fits = window.stamped & (window.time_us < LAST_US)
    if (fits == window.stamped).all():
        return window.gaps, fits
    starts = window.frames.start[window.stamped & ~fits].tolist()
    more = [Gap(start - STAMP_BYTES, start) for start in starts]
    return sorted([*window.gaps, *more]), fits


def log_times(time_us: NDArray[np.uint64], known: Mask, last_ns: int) -> Times:
    """Nanoseconds, strictly increasing and later than `last_ns`.

    What is not `known` gets the time of the one before it.  A time stamp that is `JUMP_US` away
    from the median of five around it is not believed; a clock that was set is.
    """
    at_us = np.minimum(time_us, np.uint64(LAST_US)).astype(np.int64)
    known = known & (time_us < LAST_US)
    if known.any():
        known[known] = _believed(at_us[known])
    source = np.maximum.accumulate(np.where(known, np.arange(len(at_us)), -1))
    filled_ns = np.where(source >= 0, at_us[source] * 1000, last_ns)
    return strictly_increasing(filled_ns, last_ns)


def _believed(at_us: NDArray[np.int64]) -> Mask:
    steps = np.diff(at_us)
    if not len(steps) or (abs(steps) < JUMP_US).all():
        return np.ones(len(at_us), np.bool_)
    around = sliding_window_view(np.pad(at_us, _AROUND // 2, mode="reflect"), _AROUND)
    believed: Mask = abs(at_us - np.median(around, axis=1)) < JUMP_US
    return believed
