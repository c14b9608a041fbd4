"""A disk that is full, or is again after a while."""

from __future__ import annotations

import errno
from pathlib import Path

from gcs.mcap_file.writer import RawFile, open_exclusive


class Disk:
    """A disk with `free` bytes, shared by all files opened through it."""

    def __init__(self, free: int) -> None:
        self.free = free
        self.files: list[Path] = []

    def open(self, path: Path) -> RawFile:
        self.files.append(path)
        return _DiskFile(self, open_exclusive(path))


class _DiskFile:
    def __init__(self, disk: Disk, raw: RawFile) -> None:
        self._disk = disk
        self._raw = raw

    def write(self, data: memoryview, /) -> int:
        if self._disk.free == 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        fits = min(len(data), self._disk.free)
        self._disk.free -= fits
        self._raw.write(data[:fits])
        return fits

    def close(self) -> None:
        self._raw.close()
