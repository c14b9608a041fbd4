"""What hostile runs have met, counted."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field
from typing import TypeAlias

from gcs.gate.machine.events import Event
from gcs.gate.machine.gate import Gate
from gcs.gate.machine.rows.row import Branch
from gcs.gate.states import State

Cell: TypeAlias = tuple[State, Event]


class CountingGate(Gate):
    """Counts the cells of the table that are entered."""

    met: Counter[Cell]

    @property
    def moving(self) -> bool:
        return self.state is State.MOVING

    def _branch(self, event: Event) -> Branch:
        self.met[self._step.memory.state, event] += 1
        return super()._branch(event)


@dataclass(slots=True)
class Seen:
    """What all runs have met, and the worst clearance of the truth."""

    runs: int = 0
    steps: int = 0
    cells: Counter[Cell] = field(default_factory=Counter)
    codes: Counter[str] = field(default_factory=Counter)
    under_promise: int = 0
    worst_m: float = math.inf

    def add(self, other: Seen) -> None:
        self.runs += other.runs
        self.steps += other.steps
        self.cells += other.cells
        self.codes += other.codes
        self.under_promise += other.under_promise
        self.worst_m = min(self.worst_m, other.worst_m)
