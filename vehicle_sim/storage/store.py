"""Files of one vehicle: what a store can do, and the one in memory that every vehicle has.

Paths are POSIX-like, relative to the store's own root; a leading slash means that root.  Nothing
that a path says leads out of it: see `parts_of`.
"""

from __future__ import annotations

import zlib
from enum import Enum
from typing import Final, NamedTuple, Protocol

PATH_BYTES_MAX: Final = 239
"""What one MAVLink FTP payload carries."""
NAME_BYTES_MAX: Final = 128
DEPTH_MAX: Final = 16
BYTES_MAX: Final = 64 * 1024 * 1024
ENTRIES_MAX: Final = 4096
CRC_CHUNK: Final = 1 << 16
FORBIDDEN: Final = frozenset('\\:"*?<>|')
"""What some file system gives a meaning of its own, so that a plan works on every platform."""


class StoreFault(Enum):
    """Why a request to a store was refused."""

    NOT_FOUND = "there is no such file or directory"
    EXISTS = "it is there already"
    PROTECTED = "it is not to be changed"
    NO_SPACE = "the store is full"
    WRONG_KIND = "a file is no directory, and a directory no file"
    NOT_EMPTY = "the directory is not empty"
    BAD_PATH = "that is no path within the store"
    BROKEN = "the medium failed"


class StoreError(Exception):
    """A refused request; the store is as it was before."""

    def __init__(self, fault: StoreFault, path: str = "") -> None:
        super().__init__(f"{path!r}: {fault.value}" if path else fault.value)
        self.fault: Final = fault


class DirectoryEntry(NamedTuple):
    """One line of a directory listing."""

    name: str
    size: int  # bytes; 0 for a directory
    is_directory: bool


class Store(Protocol):
    """A tree of files.  Every method raises `StoreError`, and nothing else, if it cannot."""

    def entries(self, path: str) -> list[DirectoryEntry]:
        """What is directly in a directory, sorted by name."""
        ...

    def size(self, path: str) -> int:
        """Bytes of a file."""
        ...

    def read(self, path: str, offset: int, count: int) -> bytes:
        """Up to `count` bytes; empty at and after the end."""
        ...

    def create(self, path: str) -> None:
        """An empty file; one that is there loses what it held.  Its directory must be there."""
        ...

    def write(self, path: str, offset: int, data: bytes) -> None:
        """Into a file that is there; a gap before `offset` is filled with zeros."""
        ...

    def truncate(self, path: str, size: int) -> None:
        """Cut a file, or lengthen it with zeros."""
        ...

    def remove(self, path: str) -> None:
        """A file."""
        ...

    def make_directory(self, path: str) -> None:
        """Its parent must be there, it itself must not."""
        ...

    def remove_directory(self, path: str) -> None:
        """An empty one."""
        ...

    def rename(self, old: str, new: str) -> None:
        """A file or a whole directory; nothing may be there under the new name."""
        ...


def parts_of(path: str) -> tuple[str, ...]:
    """The names along a path, none for the root.  Raises `StoreError` (BAD_PATH).

    Empty names and `.` do not count; `..`, control characters, what other file systems reserve
    (`FORBIDDEN`), and what is too long or too deep are refused, not repaired.
    """
    try:
        encoded = path.encode("utf-8")
    except UnicodeEncodeError:
        raise StoreError(StoreFault.BAD_PATH, path) from None
    parts = tuple(part for part in path.split("/") if part not in ("", "."))
    if (
        len(encoded) > PATH_BYTES_MAX
        or len(parts) > DEPTH_MAX
        or any(ord(char) < 0x20 or ord(char) == 0x7F or char in FORBIDDEN for char in path)
        or any(
            # `..` among them; Windows drops these endings.
            part != part.rstrip(" .") or len(part.encode()) > NAME_BYTES_MAX
            for part in parts
        )
    ):
        raise StoreError(StoreFault.BAD_PATH, path)
    return parts


def crc32(store: Store, path: str) -> int:
    """MAVLink FTP's checksum of a file: CRC-32 that starts at 0 and is not inverted at the end."""
    crc, offset = 0, 0
    while chunk := store.read(path, offset, CRC_CHUNK):
        crc = crc32_of(chunk, crc)
        offset += len(chunk)
    return crc


def crc32_of(data: bytes, crc: int = 0) -> int:
    """The same of bytes; `crc` is that of what came before them."""
    return zlib.crc32(data, crc ^ 0xFFFFFFFF) ^ 0xFFFFFFFF


def put(store: Store, path: str, data: bytes) -> None:
    """A whole file at once, with the directories on the way to it."""
    parts = parts_of(path)
    for depth in range(1, len(parts)):
        try:
            store.make_directory("/".join(parts[:depth]))
        except StoreError as error:
            if error.fault is not StoreFault.EXISTS:
                raise
    store.create(path)
    store.write(path, 0, data)


class MemoryStore:
    """A `Store` that is gone with its vehicle, bounded in bytes and in files."""

    def __init__(self, bytes_max: int = BYTES_MAX, entries_max: int = ENTRIES_MAX) -> None:
        self._bytes_max: Final = bytes_max
        self._entries_max: Final = entries_max
        self._files: dict[tuple[str, ...], bytearray] = {}
        self._directories: set[tuple[str, ...]] = {()}
        self._used = 0

    @property
    def used_bytes(self) -> int:
        """Of all files together."""
        return self._used

    def entries(self, path: str) -> list[DirectoryEntry]:
        parts = self._directory(path)
        depth = len(parts) + 1
        found = [
            DirectoryEntry(name[-1], 0, True)
            for name in self._directories
            if len(name) == depth and name[:-1] == parts
        ]
        found += [
            DirectoryEntry(name[-1], len(held), False)
            for name, held in self._files.items()
            if len(name) == depth and name[:-1] == parts
        ]
        return sorted(found)

    def size(self, path: str) -> int:
        return len(self._file(path))

    def read(self, path: str, offset: int, count: int) -> bytes:
        return bytes(self._file(path)[offset : offset + count])

    def create(self, path: str) -> None:
        parts = parts_of(path)
        if parts in self._directories:
            raise StoreError(StoreFault.WRONG_KIND, path)
        if parts in self._files:
            self.truncate(path, 0)
            return
        self._check_parent(parts, path)
        self._check_room(path)
        self._files[parts] = bytearray()

    def write(self, path: str, offset: int, data: bytes) -> None:
        held = self._file(path)
        if offset + len(data) > len(held):
            self.truncate(path, offset + len(data))
        held[offset : offset + len(data)] = data

    def truncate(self, path: str, size: int) -> None:
        held = self._file(path)
        growth = size - len(held)
        if self._used + growth > self._bytes_max:
            raise StoreError(StoreFault.NO_SPACE, path)
        if growth > 0:
            held.extend(bytes(growth))
        else:
            del held[size:]
        self._used += growth

    def remove(self, path: str) -> None:
        self._used -= len(self._file(path))
        del self._files[parts_of(path)]

    def make_directory(self, path: str) -> None:
        parts = parts_of(path)
        self._check_absent(parts, path)
        self._check_parent(parts, path)
        self._check_room(path)
        self._directories.add(parts)

    def remove_directory(self, path: str) -> None:
        parts = self._directory(path)
        if not parts:
            raise StoreError(StoreFault.PROTECTED, path)
        if self.entries(path):
            raise StoreError(StoreFault.NOT_EMPTY, path)
        self._directories.remove(parts)

    def rename(self, old: str, new: str) -> None:
        source, target = parts_of(old), parts_of(new)
        if not source:
            raise StoreError(StoreFault.PROTECTED, old)
        if source not in self._files and source not in self._directories:
            raise StoreError(StoreFault.NOT_FOUND, old)
        self._check_absent(target, new)
        self._check_parent(target, new)
        depth = len(source)
        if target[:depth] == source:
            raise StoreError(StoreFault.BAD_PATH, new)

        def moved(name: tuple[str, ...]) -> tuple[str, ...]:
            return target + name[depth:] if name[:depth] == source else name

        for name in (*self._files, *self._directories):
            parts_of("/".join(moved(name)))  # what lies below must not get too deep or too long
        self._files = {moved(name): held for name, held in self._files.items()}
        self._directories = {moved(name) for name in self._directories}

    def _file(self, path: str) -> bytearray:
        parts = parts_of(path)
        if parts in self._directories:
            raise StoreError(StoreFault.WRONG_KIND, path)
        held = self._files.get(parts)
        if held is None:
            raise StoreError(StoreFault.NOT_FOUND, path)
        return held

    def _directory(self, path: str) -> tuple[str, ...]:
        parts = parts_of(path)
        if parts in self._files:
            raise StoreError(StoreFault.WRONG_KIND, path)
        if parts not in self._directories:
            raise StoreError(StoreFault.NOT_FOUND, path)
        return parts

    def _check_absent(self, parts: tuple[str, ...], path: str) -> None:
        if parts in self._files or parts in self._directories:
            raise StoreError(StoreFault.EXISTS, path)

    def _check_parent(self, parts: tuple[str, ...], path: str) -> None:
        if parts[:-1] in self._files:
            raise StoreError(StoreFault.WRONG_KIND, path)
        if parts[:-1] not in self._directories:
            raise StoreError(StoreFault.NOT_FOUND, path)

    def _check_room(self, path: str) -> None:
        if len(self._files) + len(self._directories) > self._entries_max:
            raise StoreError(StoreFault.NO_SPACE, path)
