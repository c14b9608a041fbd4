"""A file that never raises into whoever writes to it.

The recorder's libraries give up for good, and silently, at the first error of their output.  So
their output is this object: an OSError is kept in `failure`, what follows is swallowed, and the
recorder looks at `failure` after every write.
"""

from __future__ import annotations

from collections.abc import Callable
from os import SEEK_CUR
from pathlib import Path
from typing import Protocol, TypeAlias


class RawFile(Protocol):
    """What a guarded file needs of an unbuffered file."""

    def write(self, data: memoryview, /) -> int | None: ...
    def close(self) -> None: ...


Opener: TypeAlias = Callable[[Path], RawFile]
"""Opens a new file for writing; raises OSError (FileExistsError where it exists)."""


def open_exclusive(path: Path) -> RawFile:
    """The default opener: `xb`, unbuffered, so that nothing waits in this process for a crash."""
    return open(path, "xb", buffering=0)


class NoFile:
    """Takes everything and keeps nothing."""

    def write(self, data: memoryview, /) -> int:
        return len(data)

    def close(self) -> None:
        """Nothing is open."""


class GuardedFile:
    """Append-only bytes on disk.  After the first OSError nothing more is written, silently.

    `seek` goes nowhere but to the present position: an MCAP writer that was told not to seek
    asks only where it is.
    """

    __slots__ = ("_position", "_raw", "failure", "written")

    def __init__(self, raw: RawFile) -> None:
        self._raw = raw
        self._position = 0
        self.written = 0
        """Bytes that the system took for the file."""
        self.failure: OSError | None = None

    def write(self, data: bytes | bytearray) -> int:
        """Write all of `data`.  Returns len(data) even after a failure: look at `failure`."""
        self._position += len(data)
        if self.failure is None:
            rest = memoryview(data)
            try:
                while rest:
                    count = self._raw.write(rest) or 0
                    self.written += count
                    rest = rest[count:]
            except OSError as error:
                self.failure = error
        return len(data)

    def seek(self, offset: int, whence: int = 0) -> int:
        """Only `seek(0, SEEK_CUR)` and `seek(position)`.  Raises ValueError for anything else."""
        if (offset, whence) not in ((0, SEEK_CUR), (self._position, 0)):
            raise ValueError("a guarded file is written from its beginning to its end")
        return self._position

    def tell(self) -> int:
        return self._position

    def flush(self) -> None:
        """Nothing is buffered here."""

    def close(self) -> None:
        try:
            self._raw.close()
        except OSError as error:
            self.failure = self.failure or error
