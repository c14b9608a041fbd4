"""The bytes of a file that come in pieces, in any order, some of them twice and some not at all."""

from __future__ import annotations


class Pieces:
    """From `start` on; what is there without a gap is given out once, in order.

    Pieces lie on a grid of `size` bytes from `start`, so that what is missing can be asked for in
    the same pieces: ArduPilot packs its parameters to the size of each read.
    """

    def __init__(self, start: int, size: int) -> None:
        self._start = start
        self._size = size
        self._ahead: dict[int, bytes] = {}
        self.at = start
        """Everything before this offset was given out."""
        self.end = start
        """Behind the last byte that came."""

    def add(self, offset: int, data: bytes) -> bytes:
        """What follows on `at` now; empty while something before it is missing."""
        self.end = max(self.end, offset + len(data))
        if offset + len(data) <= self.at:
            return b""
        if offset > self.at:
            if len(data) > len(self._ahead.get(offset, b"")):
                self._ahead[offset] = data
            return b""
        found = [data[self.at - offset :]]
        self.at = offset + len(data)
        while (data := self._ahead.pop(self.at, b"")) != b"":
            found.append(data)
            self.at += len(data)
        if self._ahead and min(self._ahead) < self.at:  # pieces that overlap
            first = min(self._ahead)
            found.append(self.add(first, self._ahead.pop(first)))
        return b"".join(found)

    @property
    def gap(self) -> tuple[int, int] | None:
        """The first range that is missing before `end`; None where nothing is."""
        return (self.at, min(self._ahead)) if self._ahead else None

    def missing(self, most: int) -> list[int]:
        """Offsets of the first `most` pieces before `end` that did not come."""
        found: list[int] = []
        if not self._ahead:
            return found
        at = self.at
        for offset in sorted(self._ahead):
            step = at - (at - self._start) % self._size
            while step < offset and len(found) < most:
                if step + self._size > at:
                    found.append(step)
                step += self._size
            at = max(at, offset + len(self._ahead[offset]))
            if len(found) >= most:
                break
        return found
