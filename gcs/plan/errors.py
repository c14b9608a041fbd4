"""What is wrong with a plan, told with file, place, item, expectation and hint."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum


class Level(IntEnum):
    """NOTE: what the reader decided.  WARNING: should be looked at.  ERROR: cannot be flown."""

    NOTE = 1
    WARNING = 2
    ERROR = 3


@dataclass(frozen=True, slots=True)
class Finding:
    """Something to tell about a plan that could be read.

    `where` is a line number or a JSON path, empty where the whole file is meant; `item` names
    what it is about; `index` counts into `Plan.items` where it is about one of them.
    """

    level: Level
    where: str
    item: str
    what: str
    hint: str = ""
    index: int | None = None


class PlanError(Exception):
    """A file that is not a plan, or a plan that cannot be converted as was asked."""

    def __init__(
        self, file: str, where: str, item: str, what: str, expected: str = "", hint: str = ""
    ) -> None:
        super().__init__(file, where, item, what, expected, hint)
        self.file = file
        self.where = where
        self.item = item
        self.what = what
        self.expected = expected
        self.hint = hint

    def __str__(self) -> str:
        """`file:where: item: what, expected ...`; the hint is for a line of its own."""
        place = f"{self.file}:{self.where}" if self.where else self.file
        named = self.where.rpartition(".")[2] == self.item  # the place says it already
        subject = f"{self.item}: " if self.item and not named else ""
        wanted = f", expected {self.expected}" if self.expected else ""
        return f"{place}: {subject}{self.what}{wanted}"
