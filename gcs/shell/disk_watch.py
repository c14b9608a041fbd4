"""A warning before the disk of the record is full."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from gcs.config import DISK_CRITICAL_BYTES, DISK_LOW_BYTES
from gcs.session.inputs import DiskLow

LOOK_NS = 10_000_000_000
"""Between two looks at the disk."""


@dataclass(frozen=True, slots=True)
class Threshold:
    """Less than either of them is too little."""

    free_bytes: int
    left_s: float
    """Until it is full, at the rate of this record so far."""


LOW = Threshold(DISK_LOW_BYTES, 20 * 60.0)
CRITICAL = Threshold(DISK_CRITICAL_BYTES, 2 * 60.0)

FreeBytes: TypeAlias = Callable[[], int | None]
"""How much room there is; None where that is unknown."""


class DiskWatch:
    """Tells once when there is little room, once when there is next to none, and again after
    there was enough."""

    def __init__(self, free_bytes: FreeBytes, now_ns: int) -> None:
        self._free_bytes = free_bytes
        self._start_ns = now_ns
        self._look_at_ns = now_ns
        self._told = 0
        self.free_bytes: int | None = None
        """As it was looked at last."""

    def look(self, written_bytes: int, now_ns: int) -> DiskLow | None:
        """`written_bytes` since the beginning, in all files.  Does nothing before it is due."""
        if now_ns < self._look_at_ns:
            return None
        self._look_at_ns = now_ns + LOOK_NS
        free = self.free_bytes = self._free_bytes()
        if free is None:
            return None
        left_s = self._left_s(free, written_bytes, now_ns)
        levels = [t for t in (LOW, CRITICAL) if free < t.free_bytes or (left_s or 1e9) < t.left_s]
        worse, self._told = len(levels) > self._told, len(levels)
        return DiskLow(free, left_s, CRITICAL in levels) if worse else None

    def _left_s(self, free: int, written_bytes: int, now_ns: int) -> float | None:
        """None until the rate is known."""
        recorded_s = (now_ns - self._start_ns) / 1e9
        if recorded_s < LOOK_NS / 1e9 or written_bytes <= 0:
            return None
        return free * recorded_s / written_bytes


def free_in(folder: Path) -> FreeBytes:
    """Of the disk that has `folder`."""

    def free_bytes() -> int | None:
        try:
            return shutil.disk_usage(folder).free
        except OSError:
            return None

    return free_bytes
