"""When a guard of the table holds, and what a check objects."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from gcs.frames import Vec3
from gcs.gate.core import Core
from gcs.gate.events import Event
from gcs.gate.limits import STANDING
from gcs.gate.memory import SECOND_NS, Memory
from gcs.gate.rules import Check, Guard
from gcs.gate.types import (
    Code,
    CommandKind,
    Condition,
    Control,
    FlightMode,
    Refusal,
    Severity,
    State,
    TakeOff,
)
from gcs.gate.verifier import Cleared, Verifier

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


def allow(core: Core, judged: Cleared | Refusal) -> Refusal | None:
    """Keep the verifier's numbers for the verdict, and its refusal if it is one."""
    if isinstance(judged, Refusal):
        core.why = judged
        return judged
    core.evidence = judged.evidence
    return None


def _unplaced() -> Refusal:
    return Refusal(Code.NO_ORIGIN, "home and fence are not known yet")


def here(core: Core) -> Refusal | None:
    """May the vehicle stay where it is?  A position too old is no position."""
    memory = core.memory
    if memory.verifier is None:
        return allow(core, _unplaced())
    if core.stale or memory.pos_ned is None or memory.v_ned is None:
        return allow(core, Refusal(Code.STALE, "the vehicle's position is too old"))
    return allow(core, memory.verifier.hold_point(memory.pos_ned, memory.v_ned, floor_applies=True))


def _path_home(core: Core) -> Refusal | None:
    memory = core.memory
    if memory.verifier is None or memory.home_ned is None:
        return allow(core, Refusal(Code.RTL_BLOCKED, "home or fence is not known: land instead"))
    if memory.return_up_m is None:
        return allow(
            core,
            Refusal(Code.RTL_BLOCKED, "the vehicle's return height is not known: land instead"),
        )
    if core.stale or memory.pos_ned is None:
        return allow(core, Refusal(Code.RTL_BLOCKED, "the position is too old: land instead"))
    judged = memory.verifier.return_path(memory.pos_ned, memory.home_ned, memory.return_up_m)
    if isinstance(judged, Refusal):
        sentence = f"{judged.sentence}: land instead"
        judged = Refusal(Code.RTL_BLOCKED, sentence, judged.numbers, judged.zone)
    return allow(core, judged)


def _climb(core: Core) -> Refusal | None:
    memory = core.memory
    assert core.request is not None
    assert isinstance(core.request.wish, TakeOff)
    if memory.verifier is None:
        return allow(core, _unplaced())
    if core.stale or memory.pos_ned is None:
        return allow(core, Refusal(Code.STALE, "the vehicle's position is too old"))
    return allow(core, memory.verifier.takeoff(core.request.wish.up_m, memory.pos_ned))


def _severity(core: Core) -> Refusal | None:
    if core.severity < Severity.HOLD:
        return None
    return Refusal(Code.SEVERITY, core.severity_sentence(), (("severity", float(core.severity)),))


def _recorder(core: Core) -> Refusal | None:
    failed = any(name is Condition.RECORDER_FAILED for name, _ in core.memory.conditions)
    if core.policy.arm_requires_recording and failed:
        return Refusal(Code.RECORDER_DOWN, "nothing is recorded, and the policy wants it so")
    return None


def _armed(core: Core) -> Refusal | None:
    if core.memory.armed:
        return None
    return Refusal(Code.NOT_ARMED, "the vehicle is not armed")


def _on_ground(core: Core) -> Refusal | None:
    if core.memory.on_ground:
        return None
    return Refusal(Code.IN_AIR, "the vehicle is not known to stand on the ground")


def _mission(core: Core) -> Refusal | None:
    if core.memory.mission_items > 0:
        return None
    return Refusal(Code.NO_MISSION, "no verified mission is on board: upload one first")


def _known(core: Core) -> Refusal | None:
    return _unplaced() if core.memory.verifier is None else None


CHECKS: Final[Mapping[Check, Callable[[Core], Refusal | None]]] = MappingProxyType(
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


def within(core: Core, goal_ned: Vec3) -> bool:
    """Strictly inside the arrival radius, and slow enough where the policy asks for it."""
    memory, arrival = core.memory, core.policy.arrival
    if memory.pos_ned is None or memory.v_ned is None:
        return False
    near = math.dist(memory.pos_ned, goal_ned) < arrival.radius_m
    return near and (arrival.speed_m_s is None or math.hypot(*memory.v_ned) <= arrival.speed_m_s)


def _arrived(core: Core) -> bool:
    since_ns = core.memory.within_since_ns
    if since_ns is None or core.stale:
        return False
    return core.now_ns - since_ns >= round(core.policy.arrival.dwell_s * SECOND_NS)


def _above_top_m(core: Core) -> float | None:
    """How high above the top of the climb it flies; None where nobody knows."""
    memory = core.memory
    if core.stale or memory.pos_ned is None:
        return None
    return memory.top_down_m - memory.pos_ned[2]


def _slow(core: Core) -> bool:
    v_ned = core.memory.v_ned
    return v_ned is not None and math.hypot(*v_ned) < CLIMB_ENDED_M_S


def _says_climbed(core: Core) -> bool:
    """The vehicle says by its mode that the climb is over: px4 holds then."""
    memory = core.memory
    shown = memory.asked_mode is None  # else the mode is still that of before the take-off
    return memory.lifted and shown and memory.mode is FlightMode.HOLD


def _at_height(core: Core) -> bool:
    above_m = _above_top_m(core)
    if not core.memory.airborne or above_m is None:
        return False
    return abs(above_m) < core.policy.arrival.radius_m and (_says_climbed(core) or _slow(core))


def _climb_short(core: Core) -> bool:
    above_m = _above_top_m(core)
    if not core.memory.airborne or above_m is None or not (_says_climbed(core) and _slow(core)):
        return False
    side = "below" if above_m < 0.0 else "above"
    sentence = f"the vehicle ended its climb {abs(above_m):.1f} m {side} the height asked for"
    core.why = Refusal(Code.VEHICLE_REFUSED, sentence, (("above_top_m", above_m),))
    return True


def _climbs_on(core: Core) -> bool:
    above_m = _above_top_m(core)
    return above_m is not None and above_m > core.policy.arrival.radius_m + OVERSHOOT_M


def _task_in(*kinds: Event) -> Callable[[Core], bool]:
    return lambda core: core.memory.task is not None and core.memory.task.kind in kinds


def _mode(mode: FlightMode) -> Callable[[Core], bool]:
    return lambda core: core.memory.mode is mode


def _safe(core: Core) -> bool:
    memory = core.memory
    return not memory.armed and memory.task is None and not memory.outstanding


def _late_take_off(core: Core) -> bool:
    return core.now_ns < core.memory.takeoff_until_ns


def _stands(core: Core) -> bool:
    memory = core.memory
    may_climb = memory.back_to is not None or (memory.armed and _late_take_off(core))
    return memory.on_ground and not may_climb


def _wants_hold(core: Core) -> bool:
    """A hold that goes with a disarm is not what the request waits for."""
    disarms = any(kind is CommandKind.DISARM for _, kind in core.memory.outstanding)
    return not disarms and _task_in(Event.HOLD, Event.ABORT)(core)


def _retarget(core: Core) -> bool:
    task, request = core.memory.task, core.request
    return (
        core.policy.retarget == "replace"
        and task is not None
        and request is not None
        and task.request.source == request.source
    )


def _force_unconfirmed(core: Core) -> bool:
    asked_ns = core.memory.force_asked_ns
    return asked_ns is None or core.now_ns - asked_ns > FORCE_REPEAT_S * SECOND_NS


def _mode_natural(core: Core) -> bool:
    memory = core.memory
    state = memory.flies
    if memory.mode is None:
        return False
    if state is State.HOVERING and memory.control is Control.TAKING:
        return memory.mode in (FlightMode.GUIDED, FlightMode.HOLD)
    return memory.mode in NATURAL.get(state, frozenset())


def _mission_goes_on(core: Core) -> bool:
    memory = core.memory
    return memory.mode is FlightMode.MISSION and _task_in(Event.MISSION)(core)


def _mode_pending(core: Core) -> bool:
    memory = core.memory
    return memory.asked_mode is not None and core.now_ns < memory.asked_until_ns


def _grace_over(core: Core) -> bool:
    until_ns = core.memory.grace_until_ns
    return until_ns is not None and core.now_ns >= until_ns


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


def _of_memory(fact: Callable[[Memory], bool]) -> Callable[[Core], bool]:
    return lambda core: fact(core.memory)


GUARDS: Final[Mapping[Guard, Callable[[Core], bool]]] = MappingProxyType(
    {
        **{guard: _of_memory(fact) for guard, fact in _known_facts().items()},
        Guard.STANDS: _stands,
        Guard.SAFE: _safe,
        Guard.LATE_TAKE_OFF: _late_take_off,
        Guard.GUIDED_LATE: lambda core: core.now_ns < core.memory.guided_until_ns,
        Guard.TASK_IS_ARM: _task_in(Event.ARM),
        Guard.TASK_WANTS_MODE: lambda core: (
            core.memory.task is not None and core.memory.task.waiting is not None
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
        Guard.HERE_CLEARS: lambda core: here(core) is None,
        Guard.PATH_CLEARS: lambda core: _path_home(core) is None,
        Guard.RTL_FORWARD: lambda core: core.policy.rtl_blocked == "forward",
        Guard.RTL_LAND: lambda core: core.policy.rtl_blocked == "land",
        Guard.RETARGET: _retarget,
        Guard.FENCE_SWITCHABLE: lambda core: core.policy.fence_switchable,
        Guard.FORCE_FORBIDDEN: lambda core: not core.policy.allow_force_disarm,
        Guard.FORCE_UNCONFIRMED: _force_unconfirmed,
        Guard.SEVERITY_PERMITS: lambda core: core.severity < Severity.HOLD,
        Guard.SEVERITY_RETURNS: lambda core: core.severity >= Severity.RETURN,
        Guard.MODE_PENDING: _mode_pending,
        Guard.MODE_NATURAL: _mode_natural,
        Guard.GRACE_OVER: _grace_over,
        Guard.MODE_GUIDED: _mode(FlightMode.GUIDED),
        Guard.MODE_RETURN: _mode(FlightMode.RETURN),
        Guard.MODE_LAND: _mode(FlightMode.LAND),
    }
)
"""Total over `Guard`, which a test asserts."""
