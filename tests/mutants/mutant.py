"""One alteration of the code under test, and what became of it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Final


class Kind(StrEnum):
    COMPARISON = "comparison"
    LOGIC = "logic"
    ARITHMETIC = "arithmetic"
    CHOICE = "min, max, any, all"
    CONSTANT = "constant"
    SETTING = "setting"
    MEMBER = "enum member"
    ELEMENT = "element of a set"
    ENTRY = "entry of a mapping"
    CELL = "table: a cell"
    BRANCH = "table: part of a branch"


@dataclass(frozen=True, slots=True)
class Mutant:
    """`number` counts the alterations of one file, or of one table, in the order of its text.

    `key` names it without a line number, so that it stays the same while lines move.  `lines` are
    the lines of which one is executed when the altered code runs; outside functions it is empty,
    and `names` are what the altered statement defines.  `cells` are the entries of a table.  Of
    a setting `module` is empty.
    """

    key: str
    file: str
    line: int
    kind: Kind
    before: str
    after: str
    number: int
    module: str
    lines: tuple[int, ...] = ()
    names: tuple[str, ...] = ()
    cells: tuple[str, ...] = ()
    table: int | None = None  # the index of the target's table, where it is a table's value

    @property
    def where(self) -> str:
        return f"{self.file}:{self.line}" if self.line else self.file


class Fate(StrEnum):
    KILLED = "killed"
    TIMED_OUT = "timed out"
    SURVIVED = "survived"
    UNTESTED = "no test runs it"


DEAD: Final = (Fate.KILLED, Fate.TIMED_OUT)


@dataclass(frozen=True, slots=True)
class Result:
    """`by` is the test that failed, or what else ended the run; `ran` how many tests ran."""

    mutant: Mutant
    fate: Fate
    by: str
    ran: int
    cpu_s: float

    @property
    def dead(self) -> bool:
        return self.fate in DEAD
