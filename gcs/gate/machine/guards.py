"""When each `Guard` of the table holds.

A guard does not change the gate's memory.  Those that ask the verifier, and
`CLIMB_ENDED_ELSEWHERE`, leave the reason of a refusal in the turn, for its sentence.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from gcs.gate.condition import Severity
from gcs.gate.effects import CommandKind
from gcs.gate.machine import progress, streaming, verifying
from gcs.gate.machine.events import Event
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.machine.rules import Guard
from gcs.gate.machine.turn import Turn
from gcs.gate.requests import SetMode
from gcs.gate.states import Control, FlightMode, State

MODES_OF_STATE: Final[Mapping[State, frozenset[FlightMode]]] = MappingProxyType(
    {
        State.TAKING_OFF: frozenset({FlightMode.TAKEOFF, FlightMode.HOLD, FlightMode.GUIDED}),
        State.HOVERING: frozenset({FlightMode.GUIDED}),
        State.MOVING: frozenset({FlightMode.GUIDED}),
        State.STREAMING: frozenset({FlightMode.GUIDED}),
        State.TAKING_PICTURE: frozenset({FlightMode.GUIDED}),
        State.FLYING_MISSION: frozenset({FlightMode.MISSION}),
        State.RETURNING: frozenset({FlightMode.RETURN, FlightMode.LAND}),
        State.LANDING: frozenset({FlightMode.LAND}),
        State.HOLDING: frozenset({FlightMode.HOLD}),
    }
)
"""The modes that the vehicle flies in while we command a state; other states command none."""


def _task_in(*kinds: Event) -> Callable[[Turn], bool]:
    return lambda turn: turn.memory.task is not None and turn.memory.task.kind in kinds


def _mode(mode: FlightMode) -> Callable[[Turn], bool]:
    return lambda turn: turn.memory.mode is mode


def _disarmed_and_idle(turn: Turn) -> bool:
    memory = turn.memory
    return not memory.armed and memory.task is None and not memory.outstanding


def _take_off_may_come_late(turn: Turn) -> bool:
    return turn.now_ns < turn.memory.takeoff_until_ns


def _surely_on_ground(turn: Turn) -> bool:
    memory = turn.memory
    may_climb = memory.back_to is not None or (memory.armed and _take_off_may_come_late(turn))
    return memory.on_ground and not may_climb


def _task_ends_held(turn: Turn) -> bool:
    """Not where a disarm was commanded as well: then the request ends with the disarm."""
    disarms = any(kind is CommandKind.DISARM for _, kind in turn.memory.outstanding)
    return not disarms and _task_in(Event.HOLD, Event.ABORT)(turn)


def _retarget_allowed(turn: Turn) -> bool:
    task = turn.memory.task
    return (
        turn.policy.retarget == "replace"
        and task is not None
        and task.requested.source == turn.source
    )


def _force_disarm_unconfirmed(turn: Turn) -> bool:
    asked_ns = turn.memory.force_asked_ns
    within_ns = turn.policy.control.force_repeat_s * SECOND_NS
    return asked_ns is None or turn.now_ns - asked_ns > within_ns


def _stands_in_guided(turn: Turn) -> bool:
    """ArduPilot's GUIDED moves nothing on the ground; px4's OFFBOARD flies what is sent."""
    asked = turn.requested
    by_name = asked is not None and isinstance(asked.request, SetMode)
    return by_name and turn.memory.autopilot == "ardupilot" and turn.memory.on_ground


def _mode_fits_state(turn: Turn) -> bool:
    memory = turn.memory
    if memory.mode is None:
        return False
    if memory.flown_state is State.HOVERING and memory.control is Control.TAKING:
        return memory.mode in (FlightMode.GUIDED, FlightMode.HOLD)
    return memory.mode in MODES_OF_STATE.get(memory.flown_state, frozenset())


def _mission_goes_on(turn: Turn) -> bool:
    memory = turn.memory
    return memory.mode is FlightMode.MISSION and _task_in(Event.MISSION)(turn)


def _mode_awaited(turn: Turn) -> bool:
    memory = turn.memory
    return memory.asked_mode is not None and turn.now_ns < memory.asked_until_ns


def _grace_over(turn: Turn) -> bool:
    until_ns = turn.memory.grace_until_ns
    return until_ns is not None and turn.now_ns >= until_ns


def _guards_of_memory() -> dict[Guard, Callable[[Memory], bool]]:
    """The guards that need neither the time nor the policy."""
    return {
        Guard.HEARD_BEFORE: lambda m: m.heard_before,
        Guard.LOST_IN_FLIGHT: lambda m: m.lost_in_flight,
        Guard.NO_POSITION_YET: lambda m: m.pos_ned is None,
        Guard.AIRBORNE: lambda m: m.airborne,
        Guard.NOT_AIRBORNE: lambda m: not m.airborne,
        Guard.ON_GROUND: lambda m: m.on_ground,
        Guard.ARMED: lambda m: m.armed,
        Guard.DISARMED: lambda m: not m.armed,
        Guard.LIFTED_OFF: lambda m: m.lifted,
        Guard.IN_CONTROL: lambda m: m.control is Control.OURS,
        Guard.TAKING_CONTROL: lambda m: m.control is Control.TAKING,
        Guard.TASK_UNDER_WAY: lambda m: m.task is not None,
        Guard.GOAL_PENDING: lambda m: m.pending is not None,
        Guard.GOAL_ACTIVE: lambda m: m.goal is not None,
        Guard.HOLD_AWAITED: lambda m: m.hold_again_ns is not None,
        Guard.HELD_IN_PLACE: lambda m: m.hold is not None,
        Guard.HOLD_REQUESTED: lambda m: m.hold_requested,
        Guard.MISSION_AT_LAST_ITEM: lambda m: m.mission_over,
        Guard.IN_GRACE: lambda m: m.grace_until_ns is not None,
        Guard.RETURNS_TO_STATE: lambda m: m.back_to is not None,
        Guard.RETURNS_TO_FLIGHT: lambda m: m.back_to not in (None, State.HOLDING),
        Guard.OPERATOR_LOST: lambda m: m.operator_lost,
        Guard.PHOTO_TAKEN: lambda m: m.photo_ok,
    }


def _of_memory(holds: Callable[[Memory], bool]) -> Callable[[Turn], bool]:
    return lambda turn: holds(turn.memory)


GUARDS: Final[Mapping[Guard, Callable[[Turn], bool]]] = MappingProxyType(
    {
        **{guard: _of_memory(holds) for guard, holds in _guards_of_memory().items()},
        Guard.SURELY_ON_GROUND: _surely_on_ground,
        Guard.DISARMED_AND_IDLE: _disarmed_and_idle,
        Guard.TAKE_OFF_MAY_COME_LATE: _take_off_may_come_late,
        Guard.GUIDED_MAY_COME_LATE: lambda turn: turn.now_ns < turn.memory.guided_until_ns,
        Guard.TASK_IS_ARM: _task_in(Event.ARM),
        Guard.TASK_IS_TAKE_OFF: _task_in(Event.TAKE_OFF),
        Guard.TASK_IS_CONTROL: _task_in(Event.CONTROL),
        Guard.TASK_WAITS: lambda turn: (
            turn.memory.task is not None and turn.memory.task.waiting is not None
        ),
        Guard.TASK_ENDS_HELD: _task_ends_held,
        Guard.TASK_ENDS_LANDED: _task_in(Event.LAND, Event.RETURN, Event.MISSION),
        Guard.TASK_ENDS_DISARMED: _task_in(
            Event.LAND,
            Event.RETURN,
            Event.MISSION,
            Event.DISARM,
            Event.FORCE_DISARM,
            Event.ABORT,
        ),
        Guard.MISSION_GOES_ON: _mission_goes_on,
        Guard.ARRIVED: progress.arrived,
        Guard.AT_HEIGHT: progress.at_height,
        Guard.NEARLY_AT_HEIGHT: progress.nearly_at_height,
        Guard.CLIMB_ENDED_ELSEWHERE: progress.climb_ended_elsewhere,
        Guard.CLIMBS_TOO_HIGH: progress.climbs_too_high,
        Guard.POSITION_CLEARS: lambda turn: verifying.position(turn) is None,
        Guard.WAY_BACK_CLEARS: lambda turn: verifying.way_back(turn) is not None,
        Guard.POSITION_TOO_OLD: lambda turn: turn.stale,
        Guard.TOP_CLEARS: lambda turn: verifying.top(turn) is None,
        Guard.RETURN_PATH_CLEARS: lambda turn: verifying.return_path(turn) is None,
        Guard.BLOCKED_RETURN_FORWARDED: lambda turn: turn.policy.rtl_blocked == "forward",
        Guard.BLOCKED_RETURN_LANDS: lambda turn: turn.policy.rtl_blocked == "land",
        Guard.RETARGET_ALLOWED: _retarget_allowed,
        Guard.FENCE_SWITCHABLE: lambda turn: turn.policy.fence_switchable,
        Guard.FORCE_DISARM_FORBIDDEN: lambda turn: not turn.policy.allow_force_disarm,
        Guard.FORCE_DISARM_UNCONFIRMED: _force_disarm_unconfirmed,
        Guard.SEVERITY_PERMITS: lambda turn: turn.severity < Severity.HOLD,
        Guard.MODE_AWAITED: _mode_awaited,
        Guard.MODE_FITS_STATE: _mode_fits_state,
        Guard.GRACE_OVER: _grace_over,
        Guard.MODE_GUIDED: _mode(FlightMode.GUIDED),
        Guard.STANDS_IN_GUIDED: _stands_in_guided,
        Guard.MODE_TAKE_OFF: _mode(FlightMode.TAKEOFF),
        Guard.MODE_RETURN: _mode(FlightMode.RETURN),
        Guard.MODE_LAND: _mode(FlightMode.LAND),
        Guard.OWN_STREAM: streaming.own_stream,
        Guard.INTERRUPTED_STREAM: streaming.interrupted_stream,
        Guard.SAMPLE_CLEARS: lambda turn: verifying.given_sample(turn) is None,
        Guard.SAMPLES_GOOD_AGAIN: streaming.samples_good_again,
        Guard.FLOWN_SAMPLE_CLEARS_NO_MORE: streaming.clears_no_more,
        Guard.STREAM_SILENT: streaming.silent,
        Guard.STREAM_OVER: streaming.over,
    }
)
"""A test asserts that every `Guard` is here."""
