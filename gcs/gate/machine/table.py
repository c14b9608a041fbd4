"""The gate's state machine: every (state, event) pair, literally, with no cell missing.

The machine runs from this table and from nothing else, and `gcs fsa` prints it.  The rows are
written in the files of `rows/`, by subject, and are put together here.

VERIFYING ends within the tick that enters it, so only the verifier's answer can happen there.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from types import MappingProxyType
from typing import Final, TypeAlias

from gcs.gate.machine.events import NEEDS_OPERATOR, Event
from gcs.gate.machine.rows.answers import ANSWER_ROWS
from gcs.gate.machine.rows.cells import refuse_if_operator_lost
from gcs.gate.machine.rows.failsafe import FAILSAFE_ROWS
from gcs.gate.machine.rows.flight import FLIGHT_ROWS
from gcs.gate.machine.rows.modes import MODE_ROWS
from gcs.gate.machine.rows.position import POSITION_ROWS
from gcs.gate.machine.rows.requests_to_fly import REQUEST_TO_FLY_ROWS
from gcs.gate.machine.rows.requests_to_stop import REQUEST_TO_STOP_ROWS
from gcs.gate.machine.rows.row import Cell, Row
from gcs.gate.machine.rows.streams import STREAM_ROWS
from gcs.gate.machine.rows.time import TIME_ROWS
from gcs.gate.states import State

Table: TypeAlias = Mapping[tuple[State, Event], Cell]

ROWS: Final[Mapping[Event, Row]] = MappingProxyType(
    {
        **REQUEST_TO_FLY_ROWS,
        **REQUEST_TO_STOP_ROWS,
        **STREAM_ROWS,
        **ANSWER_ROWS,
        **POSITION_ROWS,
        **FLIGHT_ROWS,
        **MODE_ROWS,
        **TIME_ROWS,
        **FAILSAFE_ROWS,
    }
)

TABLE: Final[Table] = MappingProxyType(
    {
        (state, event): (refuse_if_operator_lost, *cell)
        if cell and event in NEEDS_OPERATOR
        else cell
        for event in Event
        for state, cell in ROWS[event].items()
    }
)
"""The rows.  Every request that needs an operator is refused first where the operator is lost."""


class Streams(StrEnum):
    """What a state sends as a setpoint at every tick, as long as we have or take control."""

    NOTHING = "nothing"
    HOLD_GOAL = "the hold goal"
    ACTIVE_GOAL = "the active goal"
    SAMPLE = "the client's sample, or the hold goal in its place"
    HOLD_GOAL_UNTIL_MODE = "the hold goal, until another mode than guided is shown"
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
        State.STREAMING: Streams.SAMPLE,
        State.TAKING_PICTURE: Streams.HOLD_GOAL,
        State.FLYING_MISSION: Streams.HOLD_GOAL_UNTIL_MODE,
        State.RETURNING: Streams.HOLD_GOAL_UNTIL_MODE,
        State.LANDING: Streams.HOLD_GOAL_UNTIL_MODE,
        State.HOLDING: Streams.HOLD_GOAL,
        State.EXTERNAL: Streams.NOTHING,
    }
)
"""Setpoints leave in these states and in no other (invariant 1).

A PX4 in OFFBOARD that hears no setpoint for COM_OF_LOSS_T begins a failsafe of its own, which may
sink: so the place where it was stays its goal until the mode that was commanded is shown.
"""
