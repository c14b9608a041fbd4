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
from types import MappingProxyType
from typing import Final, TypeAlias

from gcs.gate.machine.rules import Branch, Cell
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
