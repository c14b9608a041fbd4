"""The guards: conditions of the table's branches, and when each holds.

A guard does not change the gate's memory.  Those that ask the verifier, and
`CLIMB_ENDED_ELSEWHERE`, leave the reason of a refusal in the step, for its sentence.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import StrEnum
from types import MappingProxyType
from typing import Final, Self

from gcs.gate.condition import Severity
from gcs.gate.effects import CommandKind
from gcs.gate.machine import progress, streaming, verifying
from gcs.gate.machine.events import Event
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.machine.step_context import StepContext
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


def _task_in(*kinds: Event) -> Callable[[StepContext], bool]:
    return lambda step: step.memory.task is not None and step.memory.task.kind in kinds


def _mode(mode: FlightMode) -> Callable[[StepContext], bool]:
    return lambda step: step.memory.mode is mode


def _disarmed_and_idle(step: StepContext) -> bool:
    memory = step.memory
    return not memory.armed and memory.task is None and not memory.outstanding


def _take_off_may_come_late(step: StepContext) -> bool:
    return step.now_ns < step.memory.takeoff_until_ns


def _surely_on_ground(step: StepContext) -> bool:
    memory = step.memory
    may_climb = memory.back_to is not None or (memory.armed and _take_off_may_come_late(step))
    return memory.on_ground and not may_climb


def _task_ends_held(step: StepContext) -> bool:
    """Not where a disarm was commanded as well: then the request ends with the disarm."""
    disarms = any(kind is CommandKind.DISARM for _, kind in step.memory.outstanding)
    return not disarms and _task_in(Event.HOLD, Event.ABORT)(step)


def _retarget_allowed(step: StepContext) -> bool:
    task = step.memory.task
    return (
        step.policy.retarget == "replace"
        and task is not None
        and task.requested.source == step.source
    )


def _force_disarm_unconfirmed(step: StepContext) -> bool:
    asked_ns = step.memory.force_asked_ns
    within_ns = step.policy.control.force_repeat_s * SECOND_NS
    return asked_ns is None or step.now_ns - asked_ns > within_ns


def _stands_in_guided(step: StepContext) -> bool:
    """ArduPilot's GUIDED moves nothing on the ground; px4's OFFBOARD flies what is sent."""
    asked = step.requested
    by_name = asked is not None and isinstance(asked.request, SetMode)
    return by_name and step.memory.autopilot == "ardupilot" and step.memory.on_ground


def _mode_fits_state(step: StepContext) -> bool:
    memory = step.memory
    if memory.mode is None:
        return False
    if memory.flown_state is State.HOVERING and memory.control is Control.TAKING:
        return memory.mode in (FlightMode.GUIDED, FlightMode.HOLD)
    return memory.mode in MODES_OF_STATE.get(memory.flown_state, frozenset())


def _mission_goes_on(step: StepContext) -> bool:
    memory = step.memory
    return memory.mode is FlightMode.MISSION and _task_in(Event.MISSION)(step)


def _mode_awaited(step: StepContext) -> bool:
    memory = step.memory
    return memory.asked_mode is not None and step.now_ns < memory.asked_until_ns


def _grace_over(step: StepContext) -> bool:
    until_ns = step.memory.grace_until_ns
    return until_ns is not None and step.now_ns >= until_ns


def _when(
    text: str, holds: Callable[[StepContext], bool]
) -> tuple[str, Callable[[StepContext], bool]]:
    """A member of `Guard`; in a bare pair the types would not be checked."""
    return text, holds


def _remembered(
    text: str, holds: Callable[[Memory], bool]
) -> tuple[str, Callable[[StepContext], bool]]:
    """A guard that needs neither the time nor the policy."""
    return text, lambda step: holds(step.memory)


class Guard(StrEnum):
    """A condition of a branch: its text in the printed table (`gcs fsa`), and when it holds."""

    holds: Callable[[StepContext], bool]

    def __new__(cls, text: str, holds: Callable[[StepContext], bool]) -> Self:
        member = str.__new__(cls, text)
        member._value_ = text
        member.holds = holds
        return member

    HEARD_BEFORE = _remembered("a vehicle was heard before", lambda m: m.heard_before)
    LOST_IN_FLIGHT = _remembered("we flew it when it was heard last", lambda m: m.lost_in_flight)
    NO_POSITION_YET = _remembered("it has told no position yet", lambda m: m.pos_ned is None)
    AIRBORNE = _remembered("it flies", lambda m: m.airborne)
    NOT_AIRBORNE = _remembered("it is not known to fly", lambda m: not m.airborne)
    ON_GROUND = _remembered("it stands on the ground", lambda m: m.on_ground)
    ARMED = _remembered("it is armed", lambda m: m.armed)
    DISARMED = _remembered("it is disarmed", lambda m: not m.armed)
    SURELY_ON_GROUND = _when("it stands, and no take-off can be under way", _surely_on_ground)
    DISARMED_AND_IDLE = _when("it is disarmed and nothing is under way", _disarmed_and_idle)
    LIFTED_OFF = _remembered("it had lifted off", lambda m: m.lifted)
    TAKE_OFF_MAY_COME_LATE = _when("our own take-off comes late", _take_off_may_come_late)
    IN_CONTROL = _remembered("we have control", lambda m: m.control is Control.OURS)
    TAKING_CONTROL = _remembered("control is being taken", lambda m: m.control is Control.TAKING)
    TASK_UNDER_WAY = _remembered("a request is under way", lambda m: m.task is not None)
    TASK_IS_ARM = _when("the request is to arm", _task_in(Event.ARM))
    TASK_IS_TAKE_OFF = _when("the request is to take off", _task_in(Event.TAKE_OFF))
    TASK_IS_CONTROL = _when("the request is for guided mode", _task_in(Event.CONTROL))
    TASK_WAITS = _when(
        "the request's command waits for a mode or a position",
        lambda step: step.memory.task is not None and step.memory.task.waiting is not None,
    )
    TASK_ENDS_HELD = _when("the request is to hold or abort", _task_ends_held)
    TASK_ENDS_LANDED = _when(
        "the request is to come down, and it stands",
        _task_in(Event.LAND, Event.RETURN, Event.MISSION),
    )
    TASK_ENDS_DISARMED = _when(
        "the request ends when disarmed",
        _task_in(
            Event.LAND, Event.RETURN, Event.MISSION, Event.DISARM, Event.FORCE_DISARM, Event.ABORT
        ),
    )
    MISSION_GOES_ON = _when("the mission lifts off again", _mission_goes_on)
    GOAL_PENDING = _remembered("a goal is pending", lambda m: m.pending is not None)
    GOAL_ACTIVE = _remembered("a goal is being flown", lambda m: m.goal is not None)
    ARRIVED = _when("it arrived", progress.arrived)
    AT_HEIGHT = _when("it reached the height", progress.at_height)
    NEARLY_AT_HEIGHT = _when("it has nearly reached the height", progress.nearly_at_height)
    CLIMB_ENDED_ELSEWHERE = _when("the climb ended elsewhere", progress.climb_ended_elsewhere)
    CLIMBS_TOO_HIGH = _when("it climbs above the height", progress.climbs_too_high)
    RETURNS_TO_FLIGHT = _remembered(
        "a position too old interrupted its flight",
        lambda m: m.back_to not in (None, State.HOLDING),
    )
    OPERATOR_LOST = _remembered("the operator is lost", lambda m: m.operator_lost)
    POSITION_CLEARS = _when(
        "the present position clears", lambda step: verifying.position(step) is None
    )
    WAY_BACK_CLEARS = _when(
        "it is outside, and the way back inside clears",
        lambda step: verifying.way_back(step) is not None,
    )
    POSITION_TOO_OLD = _when("the position is too old", lambda step: step.stale)
    TOP_CLEARS = _when("the way to the top clears", lambda step: verifying.top(step) is None)
    RETURN_PATH_CLEARS = _when(
        "the return path clears", lambda step: verifying.return_path(step) is None
    )
    BLOCKED_RETURN_FORWARDED = _when(
        "policy forwards blocked returns", lambda step: step.policy.rtl_blocked == "forward"
    )
    BLOCKED_RETURN_LANDS = _when(
        "policy lands on blocked returns", lambda step: step.policy.rtl_blocked == "land"
    )
    RETARGET_ALLOWED = _when("policy lets the goal's owner replace it", _retarget_allowed)
    FENCE_SWITCHABLE = _when(
        "policy lets the fence be switched", lambda step: step.policy.fence_switchable
    )
    FORCE_DISARM_FORBIDDEN = _when(
        "policy forbids disarming in the air", lambda step: not step.policy.allow_force_disarm
    )
    FORCE_DISARM_UNCONFIRMED = _when("it was asked for only once", _force_disarm_unconfirmed)
    SEVERITY_PERMITS = _when("severity permits motion", lambda step: step.severity < Severity.HOLD)
    HOLD_AWAITED = _remembered(
        "hold is commanded and not shown yet", lambda m: m.hold_again_ns is not None
    )
    HELD_IN_PLACE = _remembered("a held point is its goal", lambda m: m.hold is not None)
    HOLD_REQUESTED = _remembered("it was asked for", lambda m: m.hold_requested)
    MODE_AWAITED = _when("a commanded mode is not shown yet", _mode_awaited)
    MODE_FITS_STATE = _when("the mode belongs to the state", _mode_fits_state)
    MODE_GUIDED = _when("the mode is guided", _mode(FlightMode.GUIDED))
    STANDS_IN_GUIDED = _when(
        "guided is asked for by its name, and it stands still in it", _stands_in_guided
    )
    MODE_TAKE_OFF = _when("the mode is take-off", _mode(FlightMode.TAKEOFF))
    MODE_RETURN = _when("the mode is return", _mode(FlightMode.RETURN))
    MODE_LAND = _when("the mode is land", _mode(FlightMode.LAND))
    GUIDED_MAY_COME_LATE = _when(
        "our own guided command comes late", lambda step: step.now_ns < step.memory.guided_until_ns
    )
    MISSION_AT_LAST_ITEM = _remembered(
        "the mission reached its last item", lambda m: m.mission_over
    )
    IN_GRACE = _remembered(
        "a verified stream is in its grace", lambda m: m.grace_until_ns is not None
    )
    GRACE_OVER = _when("the grace is over", _grace_over)
    RETURNS_TO_STATE = _remembered("it was interrupted in flight", lambda m: m.back_to is not None)
    PHOTO_TAKEN = _remembered("the picture was taken", lambda m: m.photo_ok)
    OWN_STREAM = _when("it is the stream of this client", streaming.own_stream)
    INTERRUPTED_STREAM = _when(
        "it interrupted the stream of this client", streaming.interrupted_stream
    )
    SAMPLE_CLEARS = _when("the sample clears", lambda step: verifying.given_sample(step) is None)
    SAMPLES_GOOD_AGAIN = _when(
        "the samples are good, and have been long enough", streaming.samples_good_again
    )
    FLOWN_SAMPLE_CLEARS_NO_MORE = _when(
        "the sample that is flown clears no more", streaming.clears_no_more
    )
    STREAM_SILENT = _when("no sample came for the dead-man's time", streaming.silent)
    STREAM_OVER = _when("no sample came for too long", streaming.over)
