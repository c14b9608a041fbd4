"""What a letter comes to, for all memories that answer the gate's questions alike."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Final, TypeAlias, cast

from gcs.gate.machine.memory import Task
from tests.proof.columns import NEVER, Columns, Numbers
from tests.proof.decision_tree import DecisionTree
from tests.proof.edge import Edge, Objection
from tests.proof.invariants import objections, objections_to_step
from tests.proof.questions import VALUE, Instant, Questions, WatchedMemory
from tests.proof.taking import Taken
from tests.proof.vector import NOW, PLACE, TIMES, Vector, task_values

Move: TypeAlias = tuple[int, int | None, int]
"""`(place, from, plus_ns)`: the time at `place` becomes that at `from`, and `plus_ns` later."""

CHANGES: Final = 1 << 63
"""More than any time that passes."""


class Outcome:
    """How a vector changes, and what the invariants still have to ask.

    `sensible` is False where the letter makes no sense.  `idle_ns` is the time that passes where
    nothing else changes, else `CHANGES`.  `doubtful`: there may be objections.
    `cells` are those of the table that had a part in it.  `unmet`: no walk came upon it yet.
    """

    __slots__ = (
        "_bug",
        "_changes",
        "_checks",
        "_moves",
        "cells",
        "doubtful",
        "idle_ns",
        "sensible",
        "unmet",
    )

    def __init__(self, questions: Questions, taken: Taken | None) -> None:
        self._changes: list[tuple[int, int]] = []
        self._moves: list[Move] = []
        self._checks: list[DecisionTree[list[Objection]]] = []
        self._bug = None if taken is None else taken.bug
        self.unmet = True
        self.cells = frozenset(() if taken is None else taken.cells)
        self.sensible = self.doubtful = taken is not None
        if taken is not None:
            self._note_changes(questions, taken)
            known = dict(questions.asked)
            self._checks = [
                DecisionTree(questions, partial(_objections, _unread(step), last=last), known)
                for step, last in _with_last(taken.steps)
            ]
        self.idle_ns = CHANGES
        if not self._changes and [move[:2] for move in self._moves] == [(NOW, NOW)]:
            self.idle_ns = self._moves[0][2]

    def _note_changes(self, questions: Questions, taken: Taken) -> None:
        assert isinstance(taken.memory, WatchedMemory)
        self._move(NOW, taken.now_ns)
        written = taken.memory.written()
        if "task" in written:
            task = cast("Task | None", written["task"])
            written |= {"task": task is not None, **dict(task_values(task))}
        for name, value in written.items():
            place = PLACE[name]
            if name in TIMES:
                self._move(place, value)
                continue
            code = questions.codes.encode(name, value)
            if questions.asked.get((place, VALUE, 0)) != code:
                self._changes.append((place, code))

    def _move(self, place: int, time: object) -> None:
        if time is None:
            self._moves.append((place, None, 0))
            return
        assert isinstance(time, Instant), "a time comes from another time"
        if (time.place, time.plus_ns) != (place, 0):
            self._moves.append((place, time.place, time.plus_ns))

    def applied_to(self, vector: Vector) -> Vector:
        """What `vector`, which answered as this outcome wants it, becomes."""
        after = vector.copy()
        for place, code in self._changes:
            after[place] = code
        for place, origin, plus_ns in self._moves:
            if origin is None:
                after[place] = None
            else:
                after[place] = cast(int, vector[origin]) + plus_ns
        return after

    def write(self, before: Columns, numbers: Numbers, after: Columns) -> None:
        """As `applied_to`, for the vectors with these numbers: `after` is a copy of them, and is
        changed."""
        for place, code in self._changes:
            after[place] = code
        for place, origin, plus_ns in self._moves:
            after[place] = NEVER if origin is None else before[origin, numbers] + plus_ns

    def objections(self, vector: Vector) -> Iterator[Objection]:
        """Every invariant that is broken on the way from `vector`."""
        if self._bug is not None:
            yield Objection(0, f"a cell that cannot be entered: {self._bug!r}")
        for check in self._checks:
            yield from check(vector).result

    def first_objected(self, columns: Columns) -> int | None:
        """The first of these vectors from which an invariant is broken on the way."""
        if self._bug is not None:
            return 0
        objected = [
            int(numbers[0])
            for check in self._checks
            for found, numbers in check.split(columns)
            if found
        ]
        if objected:
            return min(objected)
        self._checks = [check for check in self._checks if not check.constant]
        self.doubtful = bool(self._checks)
        return None


def _with_last(steps: list[Edge]) -> Iterator[tuple[Edge, bool]]:
    for number, step in enumerate(steps, start=1):
        yield step, number == len(steps)


def _unread(edge: Edge) -> Edge:
    """The step with memories that hold what was written, and nothing that was read."""
    before, after = cast(WatchedMemory, edge.before), cast(WatchedMemory, edge.after)
    return replace(edge, before=before.unread(), after=after.unread())


def _objections(edge: Edge, *, last: bool) -> list[Objection]:
    """Of an `_unread` step, which stays so: it may be asked about another vector later.

    Where a letter ends, the explorer looks at what the gate remembers.
    """
    step = replace(edge, before=edge.before.copy(), after=edge.after.copy())
    return list(objections_to_step(step) if last else objections(step))
