"""Files that are made when they are opened, beside those of the store."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias

from vehicle_sim.storage.store import DirectoryEntry, Store, StoreError, StoreFault, parts_of


@dataclass(frozen=True, slots=True)
class Virtual:
    """One such file.  Both raise `StoreError`."""

    read: Callable[[str], bytes]
    """What it holds now, by what follows `?` in its path."""
    write: Callable[[bytes], None] | None = None
    """Takes a whole upload when that is complete; None = read-only."""


VirtualFiles: TypeAlias = Mapping[str, Virtual]


class Tree:
    """A store with virtual files laid over it; what is virtual cannot be changed like a file."""

    def __init__(self, store: Store, virtual: VirtualFiles) -> None:
        self.store: Final = store
        self._virtual: Final = {parts_of(path): file for path, file in virtual.items()}

    def virtual(self, path: str) -> tuple[Virtual, str] | None:
        """The virtual file under a path, and the query that the path carries."""
        name, _, query = path.partition("?")
        file = self._virtual.get(parts_of(name))
        return (file, query) if file is not None else None

    def entries(self, path: str) -> list[DirectoryEntry]:
        """A directory's, sorted by name.  A virtual file's size is what it would hold now."""
        parts = parts_of(path)
        depth = len(parts)
        found = {
            name[depth]: (
                DirectoryEntry(name[depth], len(file.read("")), False)
                if len(name) == depth + 1
                else DirectoryEntry(name[depth], 0, True)
            )
            for name, file in self._virtual.items()
            if len(name) > depth and name[:depth] == parts
        }
        try:
            found = {entry.name: entry for entry in self.store.entries(path)} | found
        except StoreError:
            if not found:
                raise
        return sorted(found.values())

    def check_free(self, path: str) -> None:
        """Raises PROTECTED for a virtual file, and for a directory on the way to one."""
        name, _, _ = path.partition("?")
        parts = parts_of(name)
        if parts and any(virtual[: len(parts)] == parts for virtual in self._virtual):
            raise StoreError(StoreFault.PROTECTED, path)
