"""The session's one work queue: what one input leads to is finished before the next input.

Work is done in the order in which it was returned, and what an item leads to is done in its
place.  There is one exception: an input for the gate that is raised while effects of the gate
are still being carried out waits until all of them are.  So the gate is never asked anything in
the middle of its own answer, and the record tells transitions in the order they happened.

Each item has an owner: a vehicle, by its slot, or the station.  What an item leads to has the same
owner; `ForOwner` gives work to another one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final, TypeAlias, cast, get_args

import msgspec

from gcs.bridge.bridge import FIRST_NUMBER
from gcs.gate.inputs import ConditionChanged, MessageSeen, PositionSeen
from gcs.session.effects import Effect, Emit
from gcs.session.work import GATE_ANSWERED, STATION, ForOwner, GateAnswered, GateInput, Work

NOTICED: Final[list[Work]] = [GATE_ANSWERED]
NOTICE_ONLY: Final = frozenset({PositionSeen, MessageSeen, ConditionChanged})
"""What the gate hears over and over, and nearly always has no answer to."""

EFFECT_TYPES: Final = frozenset(get_args(Effect))
"""Looked up by type: `isinstance` costs more than the rest of a turn."""

Step: TypeAlias = Callable[[Work, int, int], Sequence[Work]]
"""Does one item of an owner at `now_ns` and returns what follows from it.  What follows from a
`GateInput` of a vehicle holds one `GateAnswered`, behind the gate's own effects."""


class _OwnedAgain(msgspec.Struct, frozen=True, gc=False):
    """On the agenda: from here on the items are this owner's again."""

    owner: int


class WorkQueue:
    """Runs work until only effects for the shell are left."""

    def __init__(self, step: Step) -> None:
        self._step = step
        self._postponed: list[ForOwner] = []
        self.effects: list[Work] = []
        """Those so far, in the order in which the shell is to perform them.  Between two calls of
        `run` one that leads to nothing may be appended; `len` of it is a mark for `back_to`."""

    def run(self, work: Sequence[Work], now_ns: int, owner: int = STATION) -> bool:
        """Do all of it, which is of `owner`, and all that it leads to.

        What a MAVLink client is told is work, too: the bridge puts it in MAVLink's words.
        False: it was nothing but effects and what the gate only takes notice of, such as one more
        position, so that nobody waits for anything else than before.
        """
        worked = False
        agenda: list[Work | _OwnedAgain] = list(reversed(work))  # the next item last
        step, effects, postponed = self._step, self.effects, self._postponed
        gate_answers = False
        while agenda:
            item = agenda.pop()
            if isinstance(item, _OwnedAgain):
                owner = item.owner
                continue
            kind = type(item)
            if kind is Emit and cast("Emit", item).operator >= FIRST_NUMBER:
                worked = True
                agenda += reversed(step(item, owner, now_ns))
            elif kind in EFFECT_TYPES:
                effects.append(item)
            elif isinstance(item, ForOwner):
                agenda.append(_OwnedAgain(owner))
                agenda += reversed(item.work)
                owner = item.owner
            elif kind is GateAnswered:
                gate_answers = False
                agenda += reversed(postponed)
                postponed.clear()
            elif kind is GateInput and owner != STATION:
                if gate_answers:
                    postponed.append(ForOwner(owner, (item,)))
                else:
                    answer = step(item, owner, now_ns)
                    if answer == NOTICED and type(cast("GateInput", item).given) in NOTICE_ONLY:
                        continue
                    worked = gate_answers = True
                    agenda += reversed(answer)
            else:
                worked = True
                agenda += reversed(step(item, owner, now_ns))
        return worked

    def back_to(self, mark: int) -> None:
        """Nothing of what came after that: a part has failed in the middle of it."""
        self._postponed.clear()
        del self.effects[mark:]

    def take(self) -> list[Effect]:
        """The effects so far; from here on there are none."""
        effects, self.effects = self.effects, []
        return cast("list[Effect]", effects)

    def drop(self) -> None:
        """Nothing of what is under way: a part has failed in the middle of it."""
        self._postponed.clear()
        self.effects.clear()
