"""The session's one work queue: what one input leads to is finished before the next input.

Work is done in the order in which it was returned, and what an item leads to is done in its
place.  There is one exception: an input for the gate that is raised while effects of the gate
are still being carried out waits until all of them are.  So the gate is never asked anything in
the middle of its own answer, and the record tells transitions in the order they happened.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final, TypeAlias, cast, get_args

from gcs.bridge.bridge import FIRST_NUMBER
from gcs.session.effects import Effect, Emit
from gcs.session.work import GateAnswered, ToGate, Work

EFFECT_TYPES: Final = frozenset(get_args(Effect))
"""Looked up by type: `isinstance` costs more than the rest of a turn."""

Step: TypeAlias = Callable[[Work, int], Sequence[Work]]
"""Does one item at `now_ns` and returns what follows from it.  What follows from a `ToGate` holds
one `GateAnswered`, behind the gate's own effects."""


class WorkQueue:
    """Runs work until only effects for the shell are left."""

    def __init__(self, step: Step) -> None:
        self._step = step
        self._postponed: list[Work] = []
        self._effects: list[Work] = []

    def run(self, work: Sequence[Work], now_ns: int) -> None:
        """Do all of it, and all that it leads to.

        What a MAVLink client is told is work, too: the bridge puts it in MAVLink's words.
        """
        agenda = list(reversed(work))  # the next item last
        step, effects, postponed = self._step, self._effects, self._postponed
        gate_answers = False
        while agenda:
            item = agenda.pop()
            kind = type(item)
            if kind is Emit and cast("Emit", item).client >= FIRST_NUMBER:
                agenda += reversed(step(item, now_ns))
            elif kind in EFFECT_TYPES:
                effects.append(item)
            elif kind is GateAnswered:
                gate_answers = False
                agenda += reversed(postponed)
                postponed.clear()
            elif kind is ToGate and gate_answers:
                postponed.append(item)
            else:
                gate_answers |= kind is ToGate
                agenda += reversed(step(item, now_ns))

    @property
    def put(self) -> Callable[[Effect], None]:
        """Takes an effect that leads to nothing, between two calls of `run`; good until `take`."""
        return self._effects.append

    def take(self) -> list[Effect]:
        """The effects so far, in the order in which the shell is to perform them."""
        effects, self._effects = self._effects, []
        return cast("list[Effect]", effects)

    def drop(self) -> None:
        """Nothing of what is under way: a part has failed in the middle of it."""
        self._postponed.clear()
        self._effects.clear()
