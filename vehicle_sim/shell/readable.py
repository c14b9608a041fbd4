"""Which sockets have something to read, however many there are.

`select` ends at a thousand descriptors; a fleet has more.
"""

from __future__ import annotations

import selectors
from typing import Final, Protocol


class Readable(Protocol):
    def fileno(self) -> int: ...


class ReadableSockets:
    """Descriptors with an owner's number each."""

    def __init__(self) -> None:
        self._selector: Final = selectors.DefaultSelector()

    def add(self, source: Readable, owner: int) -> None:
        self._selector.register(source, selectors.EVENT_READ, (source, owner))

    def drop(self, source: Readable) -> None:
        """Before the source is closed."""
        self._selector.unregister(source)

    def ready(self, timeout_s: float) -> list[tuple[Readable, int]]:
        """What can be read by then, with its owner."""
        return [key.data for key, _ in self._selector.select(timeout_s)]

    def close(self) -> None:
        self._selector.close()
