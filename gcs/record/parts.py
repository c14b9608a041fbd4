"""The files of a session's record: when one ends, what stands in them to check them by, and what
a recorder tells of them: nothing is recorded any more, or it goes on in another file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias


@dataclass(frozen=True, slots=True)
class Rotation:
    """When a new file begins; 0 = never for this reason."""

    size_bytes: int = 0
    age_ns: int = 0

    def due(self, size_bytes: int, age_ns: int) -> bool:
        """Whether a file that is so large and so old is to be closed."""
        too_large = 0 < self.size_bytes <= size_bytes
        return too_large or 0 < self.age_ns <= age_ns


NEVER = Rotation()


@dataclass(frozen=True, slots=True)
class Seal:
    """On `/session/input`, as `RecordTick` and `RecordEnd`: what a reader can check the file by."""

    messages: int
    """Before this one, in all files of the session, without what later parts repeat."""
    crc32: int
    """Of all messages since the last seal, or since this file's beginning, end to end."""


@dataclass(frozen=True, slots=True)
class PartBegan:
    """On `/session/input`, as `RecordPart`, first of all in every file but a session's first."""

    part: int
    of: str
    """Name of the session's first file, without its suffix."""
    repeated: int
    """So many messages follow that are in an earlier file already."""
    messages: int
    """As in `Seal`: what earlier files should hold.  Fewer: the others are in no file."""


@dataclass(frozen=True, slots=True)
class RecordLost:
    """Nothing is recorded since `since_ns` (log_time of the last flush that reached the disk)."""

    path: Path
    since_ns: int
    reason: str


@dataclass(frozen=True, slots=True)
class RecordResumed:
    """Recording goes on in `path`; what happened from `since_ns` to `now_ns` is in no file."""

    path: Path
    since_ns: int
    now_ns: int


@dataclass(frozen=True, slots=True)
class RecordRotated:
    """The file before was closed in order; recording goes on in `path`, without a gap."""

    path: Path


RecordNews: TypeAlias = RecordLost | RecordResumed | RecordRotated
