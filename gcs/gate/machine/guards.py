"""When a guard of the table holds, and what a check objects."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from gcs.frames import Vec3
from gcs.gate.airspace.limits import STANDING
from gcs.gate.airspace.verifier import Cleared, Verifier
from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import CommandKind
from gcs.gate.machine.events import Event
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.machine.rules import Check, Guard
from gcs.gate.machine.turn import Turn
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import TakeOff
from gcs.gate.states import Control, FlightMode, State

CLIMB_ENDED_M_S = 0.3
"""A climb is over when it is slower than this near its top: nothing overshoots from there."""

OVERSHOOT_M = 1.0
"""How much higher than the arrival radius above its top a climb may swing."""

FORCE_REPEAT_S = 5.0
"""How soon a forced disarm in the air has to be asked for again, to be meant."""

NATURAL: Final[Mapping[State, frozenset[FlightMode]]] = MappingProxyType(
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
"""The modes that a state flies in; a state that is not named here has none of its own."""


def allow(turn: Turn, judged: Cleared | Refusal) -> Refusal | None:
    """Keep the verifier's numbers for the verdict, and its refusal if it is one."""
    if isinstance(judged, Refusal):
        turn.why = judged
        return judged
    turn.evidence = judged.evidence
    return None


def _unplaced() -> Refusal:
    return Refusal(Code.NO_ORIGIN, "home and fence are not known yet")


def here(turn: Turn) -> Refusal | None:
    """May the vehicle stay where it is?  A position too old is no position."""
    memory = turn.memory
    if memory.verifier is None:
        return allow(turn, _unplaced())
    if turn.stale or memory.pos_ned is None or memory.v_ned is None:
        return allow(turn, Refusal(Code.STALE, "the vehicle's position is too old"))
    return allow(turn, memory.verifier.hold_point(memory.pos_ned, memory.v_ned, floor_applies=True))


def _path_home(turn: Turn) -> Refusal | None:
    memory = turn.memory
    if memory.verifier is None or memory.home_ned is None:
        return allow(turn, Refusal(Code.RTL_BLOCKED, "home or fence is not known: land instead"))
    if memory.return_up_m is None:
        return allow(
            turn,
            Refusal(Code.RTL_BLOCKED, "the vehicle's return height is not known: land instead"),
        )
    if turn.stale or memory.pos_ned is None:
        return allow(turn, Refusal(Code.RTL_BLOCKED, "the position is too old: land instead"))
    judged = memory.verifier.return_path(memory.pos_ned, memory.home_ned, memory.return_up_m)
    if isinstance(judged, Refusal):
        sentence = f"{judged.sentence}: land instead"
        judged = Refusal(Code.RTL_BLOCKED, sentence, judged.numbers, judged.zone)
    return allow(turn, judged)


def _climb(turn: Turn) -> Refusal | None:
    memory = turn.memory
    assert turn.requested is not None
    assert isinstance(turn.requested.request, TakeOff)
    if memory.verifier is None:
        return allow(turn, _unplaced())
    if turn.stale or memory.pos_ned is None:
        return allow(turn, Refusal(Code.STALE, "the vehicle's position is too old"))
    return allow(turn, memory.verifier.takeoff(turn.requested.request.up_m, memory.pos_ned))


def _severity(turn: Turn) -> Refusal | None:
    if turn.severity < Severity.HOLD:
        return None
    return Refusal(Code.SEVERITY, turn.severity_sentence(), (("severity", float(turn.severity)),))


def _recorder(turn: Turn) -> Refusal | None:
    failed = any(name is Condition.RECORDER_FAILED for name, _ in turn.memory.conditions)
    if turn.policy.arm_requires_recording and failed:
        return Refusal(Code.RECORDER_DOWN, "nothing is recorded, and the policy wants it so")
    return None


def _armed(turn: Turn) -> Refusal | None:
    if turn.memory.armed:
        return None
    return Refusal(Code.NOT_ARMED, "the vehicle is not armed")


def _on_ground(turn: Turn) -> Refusal | None:
    if turn.memory.on_ground:
        return None
    return Refusal(Code.IN_AIR, "the vehicle is not known to stand on the ground")


def _mission(turn: Turn) -> Refusal | None:
    if turn.memory.mission_items > 0:
        return None
    return Refusal(Code.NO_MISSION, "no verified mission is on board: upload one first")


def _known(turn: Turn) -> Refusal | None:
    return _unplaced() if turn.memory.verifier is None else None


CHECKS: Final[Mapping[Check, Callable[[Turn], Refusal | None]]] = MappingProxyType(
    {
        Check.SEVERITY: _severity,
        Check.RECORDER: _recorder,
        Check.ARMED: _armed,
        Check.ON_GROUND: _on_ground,
        Check.HERE: here,
        Check.TAKE_OFF: _climb,
        Check.MISSION: _mission,
        Check.VERIFIER: _known,
    }
)


def cleared_no_more(memory: Memory, verifier: Verifier, was: Verifier | None) -> Refusal | None:
    """Does what is flown still clear, now that `verifier` took the place of `was`?

    Of a mission only its fence is known here: another one means that it was not verified.
    """
    if memory.pos_ned is None or memory.v_ned is None:
        return None
    judged: Cleared | Refusal | None = None
    goal, hold = memory.goal, memory.hold
    if memory.flies is State.TAKING_OFF:
        top_ned = (*memory.pos_ned[:2], memory.top_down_m)
        judged = verifier.hold_point(top_ned, STANDING, floor_applies=True)
    elif memory.flies is State.FLYING_MISSION:
        same = was is not None and (was.fence_on, len(was.zones)) == (True, len(verifier.zones))
        if verifier.fence_on and not same:
            return Refusal(Code.BAD_MISSION, "the mission was not verified by this fence")
    elif goal is not None:
        judged = verifier.goal(goal.pos_ned, goal.yaw_rad, memory.pos_ned, memory.v_ned)
    elif hold is not None:
        judged = verifier.hold_point(hold.pos_ned, STANDING, floor_applies=True)
    return judged if isinstance(judged, Refusal) else None


def within(turn: Turn, goal_ned: Vec3) -> bool:
    """Strictly inside the arrival radius, and slow enough where the policy asks for it."""
    memory, arrival = turn.memory, turn.policy.arrival
    if memory.pos_ned is None or memory.v_ned is None:
        return False
    near = math.dist(memory.pos_ned, goal_ned) < arrival.radius_m
    return near and (arrival.speed_m_s is None or math.hypot(*memory.v_ned) <= arrival.speed_m_s)


def _arrived(turn: Turn) -> bool:
    since_ns = turn.memory.within_since_ns
    if since_ns is None or turn.stale:
        return False
    return turn.now_ns - since_ns >= round(turn.policy.arrival.dwell_s * SECOND_NS)


def _above_top_m(turn: Turn) -> float | None:
    """How high above the top of the climb it flies; None where nobody knows."""
    memory = turn.memory
    if turn.stale or memory.pos_ned is None:
        return None
    return memory.top_down_m - memory.pos_ned[2]


def _slow(turn: Turn) -> bool:
    v_ned = turn.memory.v_ned
    return v_ned is not None and math.hypot(*v_ned) < CLIMB_ENDED_M_S


def _says_climbed(turn: Turn) -> bool:
    """The vehicle says by its mode that the climb is over: px4 holds then."""
    memory = turn.memory
    shown = memory.asked_mode is None  # else the mode is still that of before the take-off
    return memory.lifted and shown and memory.mode is FlightMode.HOLD


def _at_height(turn: Turn) -> bool:
    above_m = _above_top_m(turn)
    if not turn.memory.airborne or above_m is None:
        return False
    return abs(above_m) < turn.policy.arrival.radius_m and (_says_climbed(turn) or _slow(turn))


def _climb_short(turn: Turn) -> bool:
    above_m = _above_top_m(turn)
    if not turn.memory.airborne or above_m is None or not (_says_climbed(turn) and _slow(turn)):
        return False
    side = "below" if above_m < 0.0 else "above"
    sentence = f"the vehicle ended its climb {abs(above_m):.1f} m {side} the height asked for"
    turn.why = Refusal(Code.VEHICLE_REFUSED, sentence, (("above_top_m", above_m),))
    return True


def _climbs_on(turn: Turn) -> bool:
    above_m = _above_top_m(turn)
    return above_m is not None and above_m > turn.policy.arrival.radius_m + OVERSHOOT_M


def _task_in(*kinds: Event) -> Callable[[Turn], bool]:
    return lambda turn: turn.memory.task is not None and turn.memory.task.kind in kinds


def _mode(mode: FlightMode) -> Callable[[Turn], bool]:
    return lambda turn: turn.memory.mode is mode


def _safe(turn: Turn) -> bool:
    memory = turn.memory
    return not memory.armed and memory.task is None and not memory.outstanding


def _late_take_off(turn: Turn) -> bool:
    return turn.now_ns < turn.memory.takeoff_until_ns


def _stands(turn: Turn) -> bool:
    memory = turn.memory
    may_climb = memory.back_to is not None or (memory.armed and _late_take_off(turn))
    return memory.on_ground and not may_climb


def _wants_hold(turn: Turn) -> bool:
    """A hold that goes with a disarm is not what the request waits for."""
    disarms = any(kind is CommandKind.DISARM for _, kind in turn.memory.outstanding)
    return not disarms and _task_in(Event.HOLD, Event.ABORT)(turn)


def _retarget(turn: Turn) -> bool:
    task, requested = turn.memory.task, turn.requested
    return (
        turn.policy.retarget == "replace"
        and task is not None
        and requested is not None
        and task.requested.source == requested.source
    )


def _force_unconfirmed(turn: Turn) -> bool:
    asked_ns = turn.memory.force_asked_ns
    return asked_ns is None or turn.now_ns - asked_ns > FORCE_REPEAT_S * SECOND_NS


def _mode_natural(turn: Turn) -> bool:
    memory = turn.memory
    state = memory.flies
    if memory.mode is None:
        return False
    if state is State.HOVERING and memory.control is Control.TAKING:
        return memory.mode in (FlightMode.GUIDED, FlightMode.HOLD)
    return memory.mode in NATURAL.get(state, frozenset())


def _mission_goes_on(turn: Turn) -> bool:
    memory = turn.memory
    return memory.mode is FlightMode.MISSION and _task_in(Event.MISSION)(turn)


def _mode_pending(turn: Turn) -> bool:
    memory = turn.memory
    return memory.asked_mode is not None and turn.now_ns < memory.asked_until_ns


def _grace_over(turn: Turn) -> bool:
    until_ns = turn.memory.grace_until_ns
    return until_ns is not None and turn.now_ns >= until_ns


def _known_facts() -> dict[Guard, Callable[[Memory], bool]]:
    return {
        Guard.HEARD_ONCE: lambda m: m.heard_before,
        Guard.AIRBORNE: lambda m: m.airborne,
        Guard.NOT_AIRBORNE: lambda m: not m.airborne,
        Guard.ON_GROUND: lambda m: m.on_ground,
        Guard.ARMED: lambda m: m.armed,
        Guard.DISARMED: lambda m: not m.armed,
        Guard.LIFTED: lambda m: m.lifted,
        Guard.OURS: lambda m: m.control is Control.OURS,
        Guard.TAKING: lambda m: m.control is Control.TAKING,
        Guard.TASK: lambda m: m.task is not None,
        Guard.PENDING: lambda m: m.pending is not None,
        Guard.ACTIVE_GOAL: lambda m: m.goal is not None,
        Guard.HOLD_AWAITED: lambda m: m.hold_again_ns is not None,
        Guard.MISSION_OVER: lambda m: m.mission_over,
        Guard.IN_GRACE: lambda m: m.grace_until_ns is not None,
        Guard.RETURNS_TO_STATE: lambda m: m.back_to is not None,
        Guard.FLIES_ON: lambda m: m.back_to not in (None, State.HOLDING),
        Guard.OPERATOR_GONE: lambda m: m.deserted,
        Guard.PHOTO_OK: lambda m: m.photo_ok,
    }


def _of_memory(fact: Callable[[Memory], bool]) -> Callable[[Turn], bool]:
    return lambda turn: fact(turn.memory)


GUARDS: Final[Mapping[Guard, Callable[[Turn], bool]]] = MappingProxyType(
    {
        **{guard: _of_memory(fact) for guard, fact in _known_facts().items()},
        Guard.STANDS: _stands,
        Guard.SAFE: _safe,
        Guard.LATE_TAKE_OFF: _late_take_off,
        Guard.GUIDED_LATE: lambda turn: turn.now_ns < turn.memory.guided_until_ns,
        Guard.TASK_IS_ARM: _task_in(Event.ARM),
        Guard.TASK_WANTS_MODE: lambda turn: (
            turn.memory.task is not None and turn.memory.task.waiting is not None
        ),
        Guard.TASK_WANTS_HOLD: _wants_hold,
        Guard.TASK_HAS_LANDED: _task_in(Event.LAND, Event.RETURN, Event.MISSION),
        Guard.TASK_ENDS_DISARMED: _task_in(
            Event.LAND,
            Event.RETURN,
            Event.MISSION,
            Event.DISARM,
            Event.FORCE_DISARM,
            Event.ABORT,
        ),
        Guard.MISSION_GOES_ON: _mission_goes_on,
        Guard.ARRIVED: _arrived,
        Guard.AT_HEIGHT: _at_height,
        Guard.CLIMB_SHORT: _climb_short,
        Guard.CLIMBS_ON: _climbs_on,
        Guard.HERE_CLEARS: lambda turn: here(turn) is None,
        Guard.PATH_CLEARS: lambda turn: _path_home(turn) is None,
        Guard.RTL_FORWARD: lambda turn: turn.policy.rtl_blocked == "forward",
        Guard.RTL_LAND: lambda turn: turn.policy.rtl_blocked == "land",
        Guard.RETARGET: _retarget,
        Guard.FENCE_SWITCHABLE: lambda turn: turn.policy.fence_switchable,
        Guard.FORCE_FORBIDDEN: lambda turn: not turn.policy.allow_force_disarm,
        Guard.FORCE_UNCONFIRMED: _force_unconfirmed,
        Guard.SEVERITY_PERMITS: lambda turn: turn.severity < Severity.HOLD,
        Guard.SEVERITY_RETURNS: lambda turn: turn.severity >= Severity.RETURN,
        Guard.MODE_PENDING: _mode_pending,
        Guard.MODE_NATURAL: _mode_natural,
        Guard.GRACE_OVER: _grace_over,
        Guard.MODE_GUIDED: _mode(FlightMode.GUIDED),
        Guard.MODE_RETURN: _mode(FlightMode.RETURN),
        Guard.MODE_LAND: _mode(FlightMode.LAND),
    }
)
"""Total over `Guard`, which a test asserts."""
