"""What each letter of the alphabet comes to, for one vector or for many at once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TypeAlias

import numpy as np

from gcs.gate.machine.events import Event
from gcs.gate.states import State
from tests.proof.columns import Columns, Numbers
from tests.proof.decision_tree import DecisionTree
from tests.proof.outcome import Outcome
from tests.proof.vector import Vector

Cells: TypeAlias = set[tuple[State, Event]]
Trees: TypeAlias = Mapping[str, DecisionTree[Outcome]]


class Letters:
    """All letters, by a table of which the cells `altered` differ from the real one.

    `real` is what they come to by the real table; `anew`, by this one, is asked only where an
    altered cell had a part in that.
    """

    def __init__(self, real: Trees, anew: Trees, altered: Cells) -> None:
        self.names = tuple(real)
        self._real, self._anew, self._altered = real, anew, altered

    def __call__(self, vector: Vector) -> Iterator[tuple[str, Outcome]]:
        """Every letter that makes sense for a gate that remembers this, and its outcome."""
        for name in self.names:
            outcome = self.outcome(name, vector)
            if outcome.sensible:
                yield name, outcome

    def outcome(self, name: str, vector: Vector) -> Outcome:
        outcome = self._real[name](vector).result
        if not self._altered.isdisjoint(outcome.cells):
            outcome = self._anew[name](vector).result
        return outcome

    def split(
        self, name: str, columns: Columns, rows: list[list[int]]
    ) -> Iterator[tuple[Outcome, Numbers]]:
        """The outcomes of one letter, where it makes sense, and which of the vectors have it;
        `rows` are the vectors one by one."""
        for outcome, numbers in self._real[name].split(columns, rows):
            if self._altered.isdisjoint(outcome.cells):
                if outcome.sensible:
                    yield outcome, numbers
                continue
            for other, among in self._anew[name].split(np.take(columns, numbers, axis=1)):
                if other.sensible:
                    yield other, numbers[among]
