"""What a recorder tells of itself: nothing is recorded any more, or it goes on in another file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias


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
