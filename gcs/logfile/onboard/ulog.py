"""Reads PX4's ULog files (.ulg), in windows.

A message is its size, its type and its content, and nothing marks where one begins.  Data messages
are found all at once, by the sizes that their subscriptions give them; the others are read one by
one.  Where none can begin, the bytes up to the next place where two messages follow one another, or
a sync message stands, are a gap.
"""

from __future__ import annotations

import struct
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from gcs.logfile.onboard.mapped import MappedFile, chain
from gcs.logfile.onboard.part import (
    FIRST_TIMES,
    WINDOW_BYTES,
    GapsBetween,
    Part,
    Rows,
    filled,
    groups_of,
    middle_of,
)
from gcs.logfile.onboard.ulog_format import HEAD_BYTES, Subscription, Topics
from gcs.logfile.onboard.ulog_messages import FIELDS, Messages, Row
from gcs.logfile.packed import TIME_FIELD
from gcs.mcap_file.chunk_reader import Index, rows_at
from gcs.mcap_file.errors import BadLogError

_FILE_HEAD_BYTES = 16
_START_AT = 8
_HEAD = struct.Struct("<HB")
_SUBSCRIBED = struct.Struct("<BH")
_OFFSETS = struct.Struct("<3Q")
_DATA, _FLAGS, _FORMAT, _SUBSCRIBE = b"DBFA"
_TYPES = frozenset(b"BFIMPQARDLCSO")
_LONGEST_OTHER = 10_000
"""Messages other than data are shorter: damage is more rarely taken for one."""
_SYNC = b"\x08\x00S\x2f\x73\x13\x20\x25\x0c\xbb\x12"
_NEVER = 1 << 17
_LEAST_SPAN = 4 << 10
"""Behind a new subscription so many bytes are looked at, and twice as many each time after that."""
_GPS = [f"{name}_{n}" for name in ("sensor_gps", "vehicle_gps_position") for n in range(4)]
_LAST_US = 2**62 // 1000
"""A time that damage may have made any number leaves room for a base within 63 bits."""


class Ulog:
    """Raises BadLogError and OSError."""

    def __init__(self, path: Path, window_bytes: int = WINDOW_BYTES) -> None:
        self.path = path
        self._window_bytes = window_bytes
        self.info: dict[str, str] = {}
        """What the log says of itself; whole when its parts were read."""
        self._base_ns = self.first_ns = 0
        self._look_at_its_head()

    def parts(self, only: Collection[str] | None = None) -> Iterator[Part]:
        messages = Messages(self.info)
        run = _Pass(self.path, messages, self._base_ns, only)
        return run.parts(self._window_bytes)

    def _look_at_its_head(self) -> None:
        """Whose log it is, near which time it begins, and what makes its times UTC, by the first
        GPS time.  A log without one is read whole; its times count from the autopilot's start."""
        run = _Pass(self.path, Messages(), 0, _GPS)
        base_ns = 0
        for part in run.parts(self._window_bytes):
            base_ns = base_ns or _base_ns(part)
            if base_ns and len(run.first_ns) >= FIRST_TIMES:
                break
        self._base_ns = base_ns
        self.first_ns = base_ns + middle_of(run.first_ns)
        self.system_id = run.messages.system_id


def _base_ns(part: Part) -> int:
    """By the first GPS time of any receiver."""
    found = []
    for _, offsets, rows in part.tables:
        if "time_utc_usec" in (rows.dtype.names or ()):
            known = np.flatnonzero(rows["time_utc_usec"])[:1].tolist()
            times = rows["time_utc_usec"], rows[TIME_FIELD]
            found += [(int(offsets[n]), int(times[0][n]), int(times[1][n])) for n in known]
    if not found:
        return 0
    _, utc_us, since_ns = min(found)
    return max(0, min(utc_us, _LAST_US) * 1000 - since_ns)


class _Pass:
    """Once over the file."""

    def __init__(
        self, path: Path, messages: Messages, base_ns: int, only: Collection[str] | None
    ) -> None:
        self._path = path
        self._file = file = MappedFile(path)
        self._data = file.data
        self._only = only
        self._base_ns = base_ns
        self.messages = messages
        self.first_ns: list[int] = []
        (start_us,) = struct.unpack("<Q", file.read(_START_AT, _FILE_HEAD_BYTES).ljust(8, b"\0"))
        self._last_ns = base_ns + min(start_us, _LAST_US) * 1000
        self._topics = Topics()
        self._subscriptions: list[Subscription] = []
        self._number_of = np.full(1 << 16, -1, np.int32)
        """Of each message id the number of its subscription."""
        self._least = np.full(1 << 16, _NEVER, np.int32)
        self._most = np.full(1 << 16, _NEVER, np.int32)
        """Bytes that its data may have."""
        self._others: list[tuple[int, int]] = []
        """Where messages other than data begin and end, since the last part."""
        self._section_end = len(file)
        self._resume: int | None = None
        """Where to go on behind a new subscription."""
        self._is_lost = False
        """No message begins before what is looked at next, as far as is known."""
        self._span = _LEAST_SPAN
        self._gaps = GapsBetween(file.read, _FILE_HEAD_BYTES)

    def parts(self, window_bytes: int) -> Iterator[Part]:
        at = _FILE_HEAD_BYTES
        for section_end in self._sections():
            self._section_end = section_end
            while at < self._section_end:
                at, starts, numbers = self._messages(at, min(self._section_end, at + window_bytes))
                yield self._part(at, starts, numbers)
                self._file.done(at)
            self._is_lost = False

    def _sections(self) -> list[int]:
        """Where each ends: what a crash of the autopilot has appended begins anew.  Raises
        BadLogError where the log has a feature that changes how it is read."""
        size = len(self._file)
        head = self._file.read(_FILE_HEAD_BYTES, _FILE_HEAD_BYTES + HEAD_BYTES + 40)
        if len(head) < HEAD_BYTES + 40 or head[2] != _FLAGS:
            return [size]
        flags, offsets = head[HEAD_BYTES + 8 : HEAD_BYTES + 16], _OFFSETS.unpack(head[-24:])
        if flags[0] & ~1 or any(flags[1:]):
            raise BadLogError(self._path, f"a ULog with features that are not known: {flags.hex()}")
        appended = sorted({each for each in offsets if _FILE_HEAD_BYTES < each < size})
        return [*(appended if flags[0] else ()), size]

    # ------------------------------------------------------------------------------- messages

    def _messages(self, at: int, stop: int) -> tuple[int, Index, Any]:
        """How far it was read, where data messages begin, the numbers of their subscriptions."""
        starts, numbers = [np.zeros(0, np.int64)], [np.zeros(0, np.int32)]
        while at < stop:
            end = min(stop, at + self._span)
            found, ends, known = self._candidates(at, end)

            def otherwise(
                at: int, _: int, found: Index = found, ends: Index = ends, end: int = end
            ) -> int | None:
                onward = self._other(at)
                if self._resume is not None:
                    return None
                return onward or self._next_message(found, ends, at + 1, end)

            if self._is_lost:
                at = self._next_message(found, ends, at, end)
            taken, at = chain(found, ends, at, end, otherwise)
            self._span *= 2
            if self._resume is not None:
                at, self._resume, self._span = self._resume, None, _LEAST_SPAN
            starts.append(found[taken])
            numbers.append(known[taken])
        return at, np.concatenate(starts), np.concatenate(numbers)

    def _candidates(self, begin: int, end: int) -> tuple[Index, Index, Any]:
        """What looks like a data message and begins before `end`: where it begins and ends, and the
        number of its subscription."""
        data = self._data
        begin, end = begin + 2, min(end, self._section_end - HEAD_BYTES - 2) + 2
        starts = self._file.places_of(_DATA, begin, end) - 2
        size = data[starts].astype(np.int32) | data[starts + 1].astype(np.int32) << 8
        ids = data[starts + 3].astype(np.int32) | data[starts + 4].astype(np.int32) << 8
        fits = (size >= self._least[ids]) & (size <= self._most[ids])
        starts, size, ids = starts[fits], size[fits], ids[fits]
        ends = starts + HEAD_BYTES + size
        whole = ends <= self._section_end
        return starts[whole], ends[whole], self._number_of[ids[whole]]

    def _other(self, at: int) -> int | None:
        """Read one message that is no data; where it ends.  None where none begins."""
        head = self._file.read(at, at + HEAD_BYTES)
        if len(head) < HEAD_BYTES:
            return None
        size, kind = _HEAD.unpack(head)
        end: int = at + HEAD_BYTES + size
        if end > self._section_end or size == 0:
            return None
        if kind in _TYPES and kind != _DATA and size <= _LONGEST_OTHER:
            content = self._file.read(at + HEAD_BYTES, end)
            if self._take(kind, content, at, end):
                self._others.append((at, end))
                return end
        # Data without a subscription, or a message that a newer version has.
        return end if self._may_begin(end) else None

    def _take(self, kind: int, content: bytes, at: int, end: int) -> bool:
        if kind == _FORMAT:
            return self._topics.learn(content.decode("utf-8", "replace"))
        if kind != _SUBSCRIBE:
            return self.messages.take(chr(kind), content, at)
        if len(content) <= _SUBSCRIBED.size:
            return False
        instance, number = _SUBSCRIBED.unpack_from(content)
        name = content[_SUBSCRIBED.size :].decode("utf-8", "replace")
        made = self._topics.subscribe(name, instance)
        if made is None:
            return False
        self.messages.data_begins(at)
        self._number_of[number] = len(self._subscriptions)
        self._least[number], self._most[number] = made.least + 2, made.most + 2
        self._subscriptions.append(made)
        self._resume = end
        return True

    def _next_message(self, found: Index, ends: Index, at: int, end: int) -> int:
        """Where a message begins that another one, or the end, follows; `end` where none does."""
        sync = self._file.find(_SYNC, at, min(end + len(_SYNC) - 1, self._section_end))
        first = int(np.searchsorted(found, at))
        self._is_lost = False
        for start, behind in zip(found[first:].tolist(), ends[first:].tolist(), strict=True):
            if 0 <= sync < start:
                break
            if self._may_begin(behind):
                return int(start)
        self._is_lost = sync < 0
        return end if sync < 0 else sync

    def _may_begin(self, at: int) -> bool:
        """Whether something stands there that is a message by its size and type."""
        head = self._file.read(at, at + HEAD_BYTES + 2)
        if len(head) < HEAD_BYTES + 2 or at == self._section_end:
            return at == self._section_end
        size, kind = _HEAD.unpack_from(head)
        if kind == _DATA:
            number = head[3] | head[4] << 8
            fits = bool(self._least[number] <= size <= self._most[number])
        else:
            fits = kind in _TYPES and 0 < size <= _LONGEST_OTHER
        return fits and at + HEAD_BYTES + size <= self._section_end

    # ----------------------------------------------------------------------------------- parts

    def _part(self, at: int, starts: Index, numbers: Any) -> Part:
        part = Part(read_bytes=at)
        sizes = self._data[starts].astype(np.int64) | self._data[starts + 1].astype(np.int64) << 8
        other_starts, other_ends = np.array(self._others, np.int64).reshape(-1, 2).T
        self._others = []
        every = np.concatenate((starts, other_starts))
        time_ns = np.full(len(every), -1, np.int64)
        groups = groups_of(numbers)
        for group in groups:
            subscription = self._subscriptions[numbers[group[0]]]
            offset = subscription.time_offset
            if offset is not None:
                raw = rows_at(self._data, starts[group] + offset, 8).view("<u8").ravel()
                told = np.minimum(raw, np.uint64(_LAST_US)).astype(np.int64)
                time_ns[group] = self._base_ns + told * 1000
        order = np.argsort(every, kind="stable")
        time_ns[order] = filled(time_ns[order], self._last_ns)
        if len(self.first_ns) < FIRST_TIMES:
            self.first_ns += time_ns[: len(starts)][:FIRST_TIMES].tolist()
        if len(order):
            self._last_ns = int(time_ns[order[-1]])
        if self._only is None:
            ends = np.concatenate((starts + HEAD_BYTES + sizes, other_ends))
            part.gaps += self._gaps.between(every[order], ends[order], time_ns[order])
            part.gaps += self._gaps.upto(at, more_follows=at < self._section_end)
        for group in groups:
            subscription = self._subscriptions[numbers[group[0]]]
            if self._only is None or subscription.name in self._only:
                rows = subscription.rows(self._data, starts[group], time_ns[group])
                part.tables.append(Rows(subscription.name, starts[group], rows))
        part.tables += self._rest(every[order], time_ns[order])
        return part

    def _rest(self, offsets: Index, time_ns: Index) -> Iterator[Rows]:
        """Texts, parameters and drop-outs as tables; `offsets` has them, among all messages."""
        rows, self.messages.rows = self.messages.rows, []
        for name, fields in FIELDS.items():
            mine = [row for row in rows if row.table == name]
            if not mine or not (self._only is None or name in self._only):
                continue
            made = np.zeros(len(mine), [(TIME_FIELD, "<i8"), *fields])
            places = np.array([row.offset for row in mine], np.int64)
            before = time_ns[np.searchsorted(offsets, places)]
            made[TIME_FIELD] = [
                self._time_ns(row, each) for row, each in zip(mine, before.tolist(), strict=True)
            ]
            for number, (column, _) in enumerate(fields):
                made[column] = [row.values[number] for row in mine]
            yield Rows(name, places, made)

    def _time_ns(self, row: Row, before_ns: int) -> int:
        if row.time_us is None:
            return before_ns
        return self._base_ns + min(row.time_us, _LAST_US) * 1000
