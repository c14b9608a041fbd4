"""A vehicle's files on a real disk, all under one directory.

Every access walks the path anew and refuses whatever is no plain file or directory on the way:
symbolic links, junctions, devices, pipes.
"""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Final

from vehicle_sim.storage.store import (
    BYTES_MAX,
    ENTRIES_MAX,
    DirectoryEntry,
    StoreError,
    StoreFault,
    parts_of,
)

_FAULTS: Final = {
    errno.ENOENT: StoreFault.NOT_FOUND,
    errno.EEXIST: StoreFault.EXISTS,
    errno.EACCES: StoreFault.PROTECTED,
    errno.EPERM: StoreFault.PROTECTED,
    errno.EROFS: StoreFault.PROTECTED,
    errno.ELOOP: StoreFault.PROTECTED,
    errno.ENOSPC: StoreFault.NO_SPACE,
    errno.EFBIG: StoreFault.NO_SPACE,
    errno.EISDIR: StoreFault.WRONG_KIND,
    errno.ENOTDIR: StoreFault.WRONG_KIND,
    errno.ENOTEMPTY: StoreFault.NOT_EMPTY,
    errno.ENAMETOOLONG: StoreFault.BAD_PATH,
}
_NO_LINK: Final = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)


class DiskStore:
    """A `Store` in a directory that is there; what is written through it is bounded in bytes."""

    def __init__(self, root: Path, bytes_max: int = BYTES_MAX) -> None:
        """Raises OSError if `root` is no directory."""
        self._root: Final = root.resolve(strict=True)
        if not self._root.is_dir():
            raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), str(root))
        self._room = bytes_max

    def entries(self, path: str) -> list[DirectoryEntry]:
        with _faults(path):
            found = self._directory(path)
            entries: list[DirectoryEntry] = []
            with os.scandir(found) as scan:
                for each in scan:
                    status = each.stat(follow_symlinks=False)
                    if stat.S_ISDIR(status.st_mode):
                        entries.append(DirectoryEntry(each.name, 0, True))
                    elif stat.S_ISREG(status.st_mode):
                        entries.append(DirectoryEntry(each.name, status.st_size, False))
            return sorted(entries)[:ENTRIES_MAX]

    def size(self, path: str) -> int:
        with _faults(path):
            return self._file(path).stat().st_size

    def read(self, path: str, offset: int, count: int) -> bytes:
        with _faults(path), self._opened(path, os.O_RDONLY) as file:
            file.seek(offset)
            return file.read(count)

    def create(self, path: str) -> None:
        with _faults(path):
            found = self._resolved(path)
            if found.is_dir():
                raise StoreError(StoreFault.WRONG_KIND, path)
            if found.exists():
                self.truncate(path, 0)
                return
            os.close(os.open(found, os.O_WRONLY | os.O_CREAT | os.O_EXCL | _NO_LINK, 0o644))

    def write(self, path: str, offset: int, data: bytes) -> None:
        with _faults(path):
            growth = self._grow(path, offset + len(data), shrink=False)
            with self._opened(path, os.O_RDWR) as file:
                file.seek(offset)
                file.write(data)
            self._room -= growth

    def truncate(self, path: str, size: int) -> None:
        with _faults(path):
            growth = self._grow(path, size, shrink=True)
            with self._opened(path, os.O_RDWR) as file:
                file.truncate(size)
            self._room -= growth

    def remove(self, path: str) -> None:
        with _faults(path):
            found = self._file(path)
            size = found.stat().st_size
            found.unlink()
            self._room += size

    def make_directory(self, path: str) -> None:
        with _faults(path):
            self._resolved(path).mkdir()

    def remove_directory(self, path: str) -> None:
        with _faults(path):
            if not parts_of(path):
                raise StoreError(StoreFault.PROTECTED, path)
            self._directory(path).rmdir()

    def rename(self, old: str, new: str) -> None:
        with _faults(old):
            if not parts_of(old):
                raise StoreError(StoreFault.PROTECTED, old)
            source, target = self._resolved(old), self._resolved(new)
            source.lstat()
            if os.path.lexists(target):
                raise StoreError(StoreFault.EXISTS, new)
            if source in target.parents:
                raise StoreError(StoreFault.BAD_PATH, new)
            source.rename(target)

    def _grow(self, path: str, size: int, *, shrink: bool) -> int:
        """By how much the file will be longer then.  Raises NO_SPACE beyond the bound."""
        growth = size - self._file(path).stat().st_size
        growth = growth if shrink else max(0, growth)
        if growth > self._room:
            raise StoreError(StoreFault.NO_SPACE, path)
        return growth

    def _resolved(self, path: str) -> Path:
        """Where a path leads, without a link on the way.  The last name need not be there."""
        wanted = self._root.joinpath(*parts_of(path))
        if Path(os.path.realpath(wanted)) != wanted:
            raise StoreError(StoreFault.PROTECTED, path)
        return wanted

    def _file(self, path: str) -> Path:
        found = self._resolved(path)
        mode = found.lstat().st_mode
        if not stat.S_ISREG(mode):
            fault = StoreFault.WRONG_KIND if stat.S_ISDIR(mode) else StoreFault.PROTECTED
            raise StoreError(fault, path)
        return found

    def _directory(self, path: str) -> Path:
        found = self._resolved(path)
        if not stat.S_ISDIR(found.lstat().st_mode):
            raise StoreError(StoreFault.WRONG_KIND, path)
        return found

    def _opened(self, path: str, flags: int) -> IO[bytes]:
        handle = os.open(self._file(path), flags | _NO_LINK)
        return os.fdopen(handle, "rb" if flags == os.O_RDONLY else "r+b")


@contextmanager
def _faults(path: str) -> Iterator[None]:
    """What the system refuses, as the store's faults."""
    try:
        yield
    except OSError as error:
        raise StoreError(_FAULTS.get(error.errno or 0, StoreFault.BROKEN), path) from error
