"""A vehicle's flight logs by MAVLink's log protocol: which there are, and the bytes of one.

https://mavlink.io/en/services/log_download.html (LOG_REQUEST_LIST, LOG_ENTRY, LOG_REQUEST_DATA,
LOG_DATA, LOG_REQUEST_END).  A vehicle sends a range at a time, in pieces of 90 bytes; what was lost
is asked for range by range.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, TypeAlias

from gcs.protocol.effects import Address, Heard, Send, Wake
from gcs.protocol.transfers.byte_pieces import Pieces
from gcs.wire.messages import LogData, LogEntry, LogRequestData, LogRequestEnd, LogRequestList

PIECE_BYTES: Final = 90
QUIET_NS: Final = 400_000_000
"""Nothing of a range for so long: what is missing of it is asked for."""
WAITS: Final = 25
"""For so many quiet times nothing at all may come; a vehicle's card may be slow."""
FIRST_WAITS: Final = 8
"""The same before the first answer."""
NO_RANGE: Final = 0xFFFF


@dataclass(frozen=True, slots=True)
class LogsListed:
    """Every log, by its number."""

    logs: tuple[LogEntry, ...]


@dataclass(frozen=True, slots=True)
class LogBytes:
    """The next bytes of a log, in order."""

    offset: int
    data: bytes


@dataclass(frozen=True, slots=True)
class LogEnd:
    size: int


@dataclass(frozen=True, slots=True)
class LogFailed:
    text: str


LogEffect: TypeAlias = Send | LogsListed | LogBytes | LogEnd | LogFailed


class LogList:
    """Asks for the list until every entry came."""

    def __init__(self, target: Address, quiet_ns: int = QUIET_NS) -> None:
        self._target = target
        self._quiet_ns = quiet_ns
        self._found: dict[int, LogEntry] = {}
        self._count: int | None = None
        self._heard_ns: int | None = None
        self.deadline_ns: int | None = None
        self.done = False

    def start(self, now_ns: int) -> list[LogEffect]:
        self.deadline_ns = now_ns + self._quiet_ns
        if self._heard_ns is None:
            self._heard_ns = now_ns
        return [Send(LogRequestList(0, NO_RANGE, self._target.sysid, self._target.compid))]

    def stop(self) -> list[LogEffect]:
        """It is not wanted any more."""
        self.done, self.deadline_ns = True, None
        return []

    def handle(self, event: Heard | Wake, now_ns: int) -> list[LogEffect]:
        if self.done:
            return []
        if isinstance(event, Wake):
            if self.deadline_ns is None or now_ns < self.deadline_ns:
                return []
            if now_ns - (self._heard_ns or 0) >= FIRST_WAITS * self._quiet_ns:
                known = "the vehicle does not tell its logs"
                missing = f"{len(self._found)} of {self._count} logs were told"
                return [*self.stop(), LogFailed(known if self._count is None else missing)]
            return self.start(now_ns)
        entry = event.message
        if not isinstance(entry, LogEntry) or not self._target.includes(event.sysid, event.compid):
            return []
        self._heard_ns, self._count = now_ns, entry.num_logs
        self.deadline_ns = now_ns + self._quiet_ns
        if entry.num_logs:
            self._found[entry.id] = entry
        if len(self._found) < self._count:
            return []
        ordered = sorted(self._found.values(), key=lambda each: each.id)
        return [*self.stop(), LogsListed(tuple(ordered))]


class LogRead:
    """Reads log `number`, of `size` bytes, from `start` on."""

    def __init__(
        self, target: Address, number: int, size: int, start: int = 0, quiet_ns: int = QUIET_NS
    ) -> None:
        self._target = target
        self._number = number
        self._size = size
        self._pieces = Pieces(start, PIECE_BYTES)
        self._quiet_ns = quiet_ns
        self._until = 0
        """Where the range ends that was asked for last."""
        self._heard_ns = 0
        self.deadline_ns: int | None = None
        self.done = False

    def start(self, now_ns: int) -> list[LogEffect]:
        self._heard_ns = now_ns
        return self._ask(now_ns)

    def stop(self) -> list[LogEffect]:
        """It is not wanted any more: the vehicle may go on to log."""
        self.done, self.deadline_ns = True, None
        return [Send(LogRequestEnd(self._target.sysid, self._target.compid))]

    def handle(self, event: Heard | Wake, now_ns: int) -> list[LogEffect]:
        if self.done:
            return []
        if isinstance(event, Wake):
            if self.deadline_ns is None or now_ns < self.deadline_ns:
                return []
            if now_ns - self._heard_ns >= WAITS * self._quiet_ns:
                return [*self.stop(), LogFailed("the vehicle sends no more of it")]
            return self._ask(now_ns)
        told = event.message
        if not isinstance(told, LogData) or told.id != self._number:
            return []
        if not self._target.includes(event.sysid, event.compid):
            return []
        self._heard_ns = now_ns
        self.deadline_ns = now_ns + self._quiet_ns
        at = self._pieces.at
        data = self._pieces.add(told.ofs, bytes(told.data[: min(told.count, PIECE_BYTES)]))
        given: list[LogEffect] = [LogBytes(at, data)] if data else []
        if self._pieces.at >= self._size:
            return [*given, *self.stop(), LogEnd(self._pieces.at)]
        if told.count == 0 and self._pieces.gap is None:
            return [*given, *self.stop(), LogFailed(f"it ends after {self._pieces.at} bytes")]
        if told.ofs + told.count >= self._until:
            return [*given, *self._ask(now_ns)]
        return given

    def _ask(self, now_ns: int) -> list[LogEffect]:
        """For the first range that is missing; behind all that came, for all the rest."""
        self.deadline_ns = now_ns + self._quiet_ns
        if self._pieces.at >= self._size:
            return [*self.stop(), LogEnd(self._pieces.at)]
        begins, ends = self._pieces.gap or (self._pieces.end, self._size)
        self._until = ends
        sysid, compid = self._target.sysid, self._target.compid
        return [Send(LogRequestData(begins, ends - begins, self._number, sysid, compid))]
