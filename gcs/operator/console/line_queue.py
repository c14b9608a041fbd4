"""The lines of a console: most wait for their turn, some act at once and drop those before."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from gcs.operator.line_parser import Line, LineError, parse_line
from gcs.request_words import Quit, SendRequests
from gcs.shell.pipes import LineSource

MAX_WAITING_LINES = 10_000
"""Beyond it no more is read until some of them have had their turn."""


@dataclass(frozen=True, slots=True)
class BadLine:
    """A line that cannot be understood; `where` is its file and number."""

    where: str
    sentence: str
    hint: str


@dataclass(frozen=True, slots=True)
class AtOnce:
    """What is to be done now.  `dropped` stood before it in the queue and is not done any more."""

    line: Line | BadLine
    dropped: tuple[Line | BadLine, ...] = ()


class Lines(Protocol):
    """Where a console takes its lines from; see `LineQueue`."""

    @property
    def typed(self) -> bool: ...
    @property
    def ended(self) -> bool: ...
    @property
    def typed_end(self) -> bool: ...
    @property
    def full(self) -> bool: ...
    def fileno(self) -> int: ...
    def take(self) -> Line | BadLine | None: ...
    def read(self) -> list[AtOnce]: ...


class ScriptLines:
    """Lines that are all there from the start: each has its turn, an abort too."""

    typed = typed_end = full = False
    ended = True

    def __init__(self, lines: Sequence[str], name: str) -> None:
        """`name` is what errors call them."""
        parsed = (_parsed(text, f"{name}:{number}") for number, text in enumerate(lines, 1))
        self._waiting = deque(line for line in parsed if line is not None)

    def fileno(self) -> int:
        """Nothing more comes: there is nothing to wait for."""
        return -1

    def take(self) -> Line | BadLine | None:
        return self._waiting.popleft() if self._waiting else None

    def read(self) -> list[AtOnce]:
        return []


class LineQueue:
    """Numbered lines of a file descriptor.  `fileno()` is readable when there is news."""

    def __init__(self, fd: int, name: str, *, typed: bool = False) -> None:
        """`name` is what errors call it; `typed`: somebody types the lines on a terminal."""
        self._source = LineSource(fd, keep_blank=True)
        self._name = name
        self.typed = typed
        self._number = 0
        self._waiting: deque[Line | BadLine] = deque()

    def fileno(self) -> int:
        return self._source.fileno()

    @property
    def ended(self) -> bool:
        """Whether no more will be read; lines may still wait."""
        return self._source.ended

    @property
    def typed_end(self) -> bool:
        """Whether somebody has ended the input on a terminal: as good as `quit`."""
        return self.typed and self.ended

    @property
    def full(self) -> bool:
        return len(self._waiting) >= MAX_WAITING_LINES

    def take(self) -> Line | BadLine | None:
        """The next line in turn; None if none waits."""
        return self._waiting.popleft() if self._waiting else None

    def read(self) -> list[AtOnce]:
        """Read what there is, once, and say what of it acts at once; the rest waits."""
        found: list[AtOnce] = []
        for text in self._source.read():
            self._number += 1
            line = _parsed(text.decode(errors="replace"), f"{self._name}:{self._number}")
            if line is None:
                continue
            # Nobody who types waits for the news that a line was in vain.
            at_once = self.typed if isinstance(line, BadLine) else line.overtakes(typed=self.typed)
            if at_once:
                found.append(AtOnce(line, self._drop_for(line)))
            else:
                self._waiting.append(line)
        return found

    def _drop_for(self, line: Line | BadLine) -> tuple[Line | BadLine, ...]:
        """Whoever stops the vehicle, or leaves, does not want done what is still to come."""
        if isinstance(line, BadLine) or not isinstance(line.action, SendRequests | Quit):
            return ()
        dropped = tuple(self._waiting)
        self._waiting.clear()
        return dropped


def _parsed(text: str, where: str) -> Line | BadLine | None:
    try:
        return parse_line(text)
    except LineError as error:
        return BadLine(where, error.sentence, error.hint)
