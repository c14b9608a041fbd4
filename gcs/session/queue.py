"""The session's one work queue: what one input leads to is finished before the next input.

Work is done in the order in which it was returned, and what an item leads to is done in its
place.  There is one exception: an input for the gate that is raised while effects of the gate
are still being carried out waits until all of them are.  So the gate is never asked anything in
the middle of its own answer, and the record tells transitions in the order they happened.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from typing import TypeAlias

from gcs.session.effects import EFFECTS, Effect
from gcs.session.work import GateAnswered, ToGate, Work

Step: TypeAlias = Callable[[Work, int], Iterable[Work]]
"""Does one item at `now_ns` and returns what follows from it.  What follows from a `ToGate` holds
one `GateAnswered`, behind the gate's own effects."""


class WorkQueue:
    """Runs work until only effects for the shell are left."""

    def __init__(self, step: Step) -> None:
        self._step = step
        self._agenda: deque[Work] = deque()
        self._postponed: list[ToGate] = []
        self._gate_answers = False
        self._effects: list[Effect] = []

    def add(self, work: Iterable[Work]) -> None:
        """Behind everything that is to be done already."""
        self._agenda.extend(work)

    def run(self, now_ns: int) -> list[Effect]:
        """Do everything; the effects in the order in which the shell is to perform them."""
        agenda, step = self._agenda, self._step
        while agenda:
            item = agenda.popleft()
            if isinstance(item, EFFECTS):
                self._effects.append(item)
            elif isinstance(item, ToGate):
                if self._gate_answers:
                    self._postponed.append(item)
                    continue
                self._gate_answers = True
                agenda.extendleft(reversed(tuple(step(item, now_ns))))
            elif isinstance(item, GateAnswered):
                self._gate_answers = False
                agenda.extendleft(reversed(self._postponed))
                self._postponed.clear()
            else:
                agenda.extendleft(reversed(tuple(step(item, now_ns))))
        effects, self._effects = self._effects, []
        return effects

    def clear(self) -> None:
        """Drop what is under way: a part has failed in the middle of it."""
        self._agenda.clear()
        self._postponed.clear()
        self._effects.clear()
        self._gate_answers = False
