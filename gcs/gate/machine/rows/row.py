"""How a row of the table is written: one event, and for every state the cell that it has there.

    Event.PHOTO_SEEN: row(
        during(NO_VEHICLE, STALE, GROUNDED, TAKING_OFF, HOVERING, then=unchanged),
        during(VERIFYING, then=cannot_happen),
        ...
    )

A row is literal and total: every state is named once, which `row` checks at import.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from types import MappingProxyType
from typing import Final, TypeAlias

from gcs.gate.machine.actions import Action
from gcs.gate.machine.checks import Check
from gcs.gate.machine.guards import Guard
from gcs.gate.machine.step_context import End, Reply
from gcs.gate.refusal import Code
from gcs.gate.states import State

NO_VEHICLE: Final = State.NO_VEHICLE
STALE: Final = State.STALE
GROUNDED: Final = State.GROUNDED
TAKING_OFF: Final = State.TAKING_OFF
HOVERING: Final = State.HOVERING
VERIFYING: Final = State.VERIFYING
MOVING: Final = State.MOVING
STREAMING: Final = State.STREAMING
TAKING_PICTURE: Final = State.TAKING_PICTURE
FLYING_MISSION: Final = State.FLYING_MISSION
RETURNING: Final = State.RETURNING
LANDING: Final = State.LANDING
HOLDING: Final = State.HOLDING
EXTERNAL: Final = State.EXTERNAL

COLUMNS: Final = (
    NO_VEHICLE,
    STALE,
    GROUNDED,
    TAKING_OFF,
    HOVERING,
    VERIFYING,
    MOVING,
    STREAMING,
    TAKING_PICTURE,
    FLYING_MISSION,
    RETURNING,
    LANDING,
    HOLDING,
    EXTERNAL,
)
"""Every state, in the order in which the table is written and printed."""


class Elsewhere(Enum):
    """Next states that are not given by their name.

    STAY is the present state; BACK, in STALE, the state that `Memory.back_to` remembers.
    """

    STAY = "stay"
    BACK = "back"


STAY: Final = Elsewhere.STAY
BACK: Final = Elsewhere.BACK

BACK_STATES: Final = (
    State.TAKING_OFF,
    State.HOVERING,
    State.MOVING,
    State.STREAMING,
    State.TAKING_PICTURE,
    State.FLYING_MISSION,
    State.HOLDING,
)
"""The states that BACK may stand for: those in which a position too old leads to STALE, and from
which the flight may go on when a fresh position arrives."""

Next: TypeAlias = State | Elsewhere


@dataclass(frozen=True, slots=True)
class Branch:
    """One alternative of a cell: the first whose guards (`when`) all hold is taken.

    What a branch that was taken does, in this order:

    1. `needs`: its checks are made.  The first that fails refuses the request, and nothing else
       of the branch happens.
    2. `refuse`: the request is refused with this code.  The rest of the branch still happens: a
       return whose path is blocked is refused, and the vehicle is held.
    3. `reply`: the request is accepted, or kept until the tick.
    4. `ends`: the outcome of the request that was under way before.  Where it is None and the
       reply is ACCEPTED, that request is superseded by the new one.
    5. `do`: the actions, in order.
    6. `to`: the next state.
    """

    when: tuple[Guard, ...] = ()
    needs: tuple[Check, ...] = ()
    refuse: Code | None = None
    reply: Reply = Reply.NONE
    ends: End | None = None
    do: tuple[Action, ...] = ()
    to: Next = STAY


Cell: TypeAlias = tuple[Branch, ...]
"""The branches of one state and one event, in order; the last one has no guard.  An empty cell
says that the event cannot happen in the state: if it does, the gate has a bug."""

Row: TypeAlias = Mapping[State, Cell]
"""The cells of one event, in the order of `COLUMNS`."""

Entry: TypeAlias = tuple[tuple[State, ...], Cell]


def during(*states: State, then: Branch | Cell) -> Entry:
    """In each of these states the event has the cell `then`, or the cell of that one branch."""
    return states, (then,) if isinstance(then, Branch) else then


def row(*entries: Entry) -> Row:
    """The row that the entries make.

    Raises ValueError, which ends the import, where a state is named twice or is missing.
    """
    cells: dict[State, Cell] = {}
    for states, cell in entries:
        for state in states:
            if state in cells:
                raise ValueError(f"{state.name} is named twice in a row of the table")
            cells[state] = cell
    missing = [state.name for state in COLUMNS if state not in cells]
    if missing:
        raise ValueError(f"{', '.join(missing)}: missing in a row of the table")
    return MappingProxyType({state: cells[state] for state in COLUMNS})
