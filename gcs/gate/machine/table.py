"""The gate's state machine: every (state, event) pair, literally, with no cell missing.

The machine runs from this table and from nothing else, and `gcs fsa` prints it.  The rows are
written where their cells are, by subject; here they become one.

VERIFYING lasts no longer than the tick that entered it, so nothing but the verifier's answer
can happen there.  STREAMING has no way in yet: its samples come from a client, and no
client's stream reaches this gate before the bridge does; what would happen there is written
all the same.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from types import MappingProxyType
from typing import Final, TypeAlias

from gcs.gate.machine.cells import GONE
from gcs.gate.machine.events import ATTENDED, Event
from gcs.gate.machine.rows_answers import ANSWER_ROWS
from gcs.gate.machine.rows_modes import MODE_ROWS
from gcs.gate.machine.rows_requests import REQUEST_ROWS
from gcs.gate.machine.rows_time import TIME_ROWS
from gcs.gate.machine.rows_vehicle import VEHICLE_ROWS
from gcs.gate.machine.rules import COLUMNS, Cell, Row
from gcs.gate.states import State

Table: TypeAlias = Mapping[tuple[State, Event], Cell]

ROWS: Final[Mapping[Event, Row]] = MappingProxyType(
    {**REQUEST_ROWS, **ANSWER_ROWS, **VEHICLE_ROWS, **MODE_ROWS, **TIME_ROWS}
)

TABLE: Final[Table] = MappingProxyType(
    {
        (state, event): (GONE, *cell) if cell and event in ATTENDED else cell
        for event in Event
        for state, cell in zip(COLUMNS, ROWS[event], strict=True)
    }
)
"""The rows, and in front of every request that wants an operator the refusal once he is lost."""


class Streams(StrEnum):
    """Which goal a state puts on the wire at every tick, control given."""

    NOTHING = "nothing"
    HOLD_GOAL = "the hold goal"
    ACTIVE_GOAL = "the active goal"
    AS_BEFORE = "as before, for the grace"


STREAMS: Final[Mapping[State, Streams]] = MappingProxyType(
    {
        State.NO_VEHICLE: Streams.NOTHING,
        State.STALE: Streams.AS_BEFORE,
        State.GROUNDED: Streams.NOTHING,
        State.TAKING_OFF: Streams.NOTHING,
        State.HOVERING: Streams.HOLD_GOAL,
        State.VERIFYING: Streams.HOLD_GOAL,
        State.MOVING: Streams.ACTIVE_GOAL,
        State.STREAMING: Streams.ACTIVE_GOAL,
        State.TAKING_PICTURE: Streams.HOLD_GOAL,
        State.FLYING_MISSION: Streams.NOTHING,
        State.RETURNING: Streams.NOTHING,
        State.LANDING: Streams.NOTHING,
        State.HOLDING: Streams.HOLD_GOAL,
        State.EXTERNAL: Streams.NOTHING,
    }
)
"""Setpoints leave in these states and in no other (invariant 1)."""
