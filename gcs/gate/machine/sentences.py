"""The sentences of the gate's own refusals and outcomes.

Refusals by the verifier carry sentences of their own (`gcs/gate/airspace/explain.py`).
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from gcs.enu_text import place
from gcs.frames import enu_from_ned
from gcs.gate.effects import CommandKind
from gcs.gate.machine.events import Event, event_of
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import BeginStream, Disarm, GoTo, Request, SetMode, SwitchFence
from gcs.gate.states import FlightMode, State

REFUSED: Final[Mapping[Code, str]] = MappingProxyType(
    {
        Code.BUSY: "another request is under way",
        Code.NO_VEHICLE: "no vehicle is heard",
        Code.STALE: "the vehicle's position is too old",
        Code.NOT_IN_CONTROL: "somebody else flies the vehicle: take control first",
        Code.CONTROL_PENDING: "control is being taken, the heartbeat has not confirmed it yet",
        Code.NOT_FLYING: "the vehicle is not flying: arm and take off first",
        Code.ALREADY_FLYING: "the vehicle flies already",
        Code.HOLDING: "the vehicle is held: resume first",
        Code.IN_AIR: "the vehicle is not known to stand on the ground",
        Code.OPERATOR_LOST: "the operator is gone: only hold, land, abort and disarm are left",
        Code.POLICY: "the policy does not allow it",
        Code.UNSUPPORTED: "this station does not send it",
        Code.RTL_BLOCKED: "the way home is not clear: land instead",
        Code.CANNOT_STOP: "the vehicle could not stop inside the fence",
        Code.OTHER_OPERATOR: "another client's stream is flown",
    }
)
"""Why a request is refused in this state."""

ENDED: Final[Mapping[Code, str]] = MappingProxyType(
    {
        Code.IN_AIR: "the vehicle lifted off",
        Code.NO_POSITION: "no position came in time (is the estimator still starting?)",
        Code.OPERATOR: "stopped by the operator",
        Code.OPERATOR_LOST: "the operator is lost",
        Code.SUPERSEDED: "a later request took its place",
        Code.DEADLINE: "it took longer than its deadline",
        Code.NO_ANSWER: "whether the vehicle does it is not known: it was not shown in time",
        Code.VEHICLE_REFUSED: "the vehicle refused",
        Code.STALE: "the vehicle's position is too old",
        Code.LINK_LOST: "the vehicle is not heard any more",
        Code.MODE_CHANGED: "the vehicle's mode was changed by somebody else",
        Code.NOT_ARMED: "the vehicle disarmed",
        Code.NOT_FLYING: "the vehicle stands on the ground",
        Code.ESTIMATOR_RESET: "the vehicle's position jumped",
        Code.HOME_MOVED: "home moved while the vehicle flew",
        Code.FENCE_BREACH: "the vehicle would have left the fence",
        Code.TOO_HIGH: "the vehicle climbed above the height that was verified",
        Code.TOO_CLOSE: "no verified place to hover",
        Code.SEVERITY: "severity forbids motion",
    }
)
"""Why a request ended otherwise than complete."""

NO_POSITION_YET: Final = Refusal(
    Code.NO_POSITION, "the vehicle has no position yet (the estimator is starting)"
)


def no_fresh_position(memory: Memory, policy: Policy, now_ns: int) -> Refusal:
    """There never was a position, or the last one is too old."""
    if memory.pos_ned is None:
        return NO_POSITION_YET
    return position_too_old(memory.position_age_ns(now_ns), policy)


def position_too_old(age_ns: int | None, policy: Policy) -> Refusal:
    """With its age, of which none is left once the vehicle was lost, and the most it may have."""
    numbers: tuple[tuple[str, float], ...] = (("max_age_s", policy.position_age_s),)
    if age_ns is not None:
        numbers = (("position_age_s", age_ns / SECOND_NS), *numbers)
    return Refusal(Code.STALE, REFUSED[Code.STALE], numbers)


def refusal_of(
    code: Code, request: Request, memory: Memory, policy: Policy, now_ns: int
) -> Refusal:
    """The refusal of `request` with `code`, in the words for what stands in its way."""
    if code is Code.STALE:
        return no_fresh_position(memory, policy, now_ns)
    sentence = REFUSED[code]
    numbers: tuple[tuple[str, float], ...] = ()
    if code is Code.NO_VEHICLE and memory.heard_before:
        sentence += " any more: hold, land and abort are sent to it all the same"
    elif code is Code.NOT_IN_CONTROL and memory.state in (State.RETURNING, State.LANDING):
        doing = "returns" if memory.state is State.RETURNING else "lands"
        sentence = (
            f"the vehicle {doing}, and not at our request: `hold` stops it, then `resume` takes "
            "control"
        )
    elif code is Code.BUSY:
        sentence = _what_is_under_way(request, memory, policy)
        flown = memory.goal or memory.hold
        if flown is not None:
            names = ("goal_east_m", "goal_north_m", "goal_up_m")
            numbers = tuple(zip(names, enu_from_ned(flown.pos_ned), strict=True))
    elif code is Code.POLICY:
        sentence += _key_of_policy(request)
    elif code is Code.NOT_FLYING and isinstance(request, SetMode):
        sentence = (
            f"{request.name} is not sent to a vehicle that stands on the ground: take off first "
            "(NAV_TAKEOFF, MAVSDK's action.takeoff), then ask for it again"
        )
    elif code is Code.UNSUPPORTED and isinstance(request, SetMode):
        sentence = _mode_not_sent(request)
    return Refusal(code, sentence, numbers)


def _what_is_under_way(request: Request, memory: Memory, policy: Policy) -> str:
    flown = memory.goal or memory.hold
    goal = "" if flown is None else f", goal {place(flown.pos_ned)}"
    replace = isinstance(request, GoTo | BeginStream) and memory.state is State.MOVING
    under_way = f"{REFUSED[Code.BUSY]}: {memory.state.name}{goal}"
    if not replace:
        return under_way
    if policy.retarget != "replace":
        return f'{under_way} (policy: retarget = "{policy.retarget}")'
    if memory.pending is not None and not isinstance(request, GoTo):
        return under_way  # a stream does not begin before the goal that waits is decided
    return (
        f"another operator's request is flown: {memory.state.name}{goal}: hold it first, or wait "
        'for its end (retarget = "replace" is for one\'s own)'
    )


def _key_of_policy(request: Request) -> str:
    match request:
        case SwitchFence():
            return ": fence_switchable = false"
        case Disarm():
            return " in the air: allow_force_disarm = false"
        case _:
            return ""


def _mode_not_sent(asked: SetMode) -> str:
    if asked.instead:
        return f"{asked.name} is never sent: this station sends {asked.instead} in its place"
    if asked.meaning is FlightMode.TAKEOFF:
        return f"{asked.name} is never sent: `takeoff` climbs to a height that is verified"
    return (
        f"{asked.name} is never sent, and no key of the policy allows it: this station sends the "
        "modes for hold, control, mission, return and landing"
    )


def turn_left(left_deg: float) -> str:
    """What kept a goal with a heading from its end."""
    return f"the nose points {left_deg:.0f} deg from the heading that was asked for"


def not_shown(request: Request, memory: Memory) -> bool:
    """It is a mode by its name, and not the one that the vehicle is in."""
    return isinstance(request, SetMode) and request.name != memory.mode_name


_DONE: Final[Mapping[Event, str]] = MappingProxyType(
    {
        Event.CONTROL: "control is ours already",
        Event.RESUME: "control is ours already",
        Event.ARM: "the vehicle is armed already",
        Event.DISARM: "the vehicle is disarmed already",
        Event.FORCE_DISARM: "the vehicle is disarmed already",
        Event.LAND: "the vehicle stands on the ground",
        Event.RETURN: "the vehicle stands on the ground",
        Event.ABORT: "the vehicle stands on the ground, disarmed",
        Event.STREAM_BEGIN: "its stream is flown already",
        Event.STREAM_END: "no stream is flown any more",
    }
)


def done_at_once(request: Request) -> str:
    """What is so already, or was done at once."""
    if isinstance(request, SwitchFence):
        return f"the fence is {'on' if request.on else 'off'}"
    if isinstance(request, SetMode):
        return f"the vehicle shows {request.name} already"
    return _DONE.get(event_of(request), "nothing is left to do")


ASKED_FOR: Final[Mapping[CommandKind, str]] = MappingProxyType(
    {
        CommandKind.HOLD: "hold mode",
        CommandKind.GUIDED: "guided mode",
        CommandKind.ARM: "arming",
        CommandKind.DISARM: "disarming",
        CommandKind.FORCE_DISARM: "the forced disarm",
        CommandKind.TAKE_OFF: "take-off",
        CommandKind.LAND: "landing",
        CommandKind.RETURN: "the return",
        CommandKind.PHOTO: "the picture",
        CommandKind.START_MISSION: "the mission",
        CommandKind.SET_MODE: "the mode",
    }
)
"""What a command asks for, for "the vehicle refused ..." and "No answer to the request for ..."."""

RESULTS: Final[Mapping[int, str]] = MappingProxyType(
    {
        1: "TEMPORARILY_REJECTED",
        2: "DENIED",
        3: "UNSUPPORTED",
        4: "FAILED",
        6: "CANCELLED",
        7: "COMMAND_LONG_ONLY",
        8: "COMMAND_INT_ONLY",
        9: "COMMAND_UNSUPPORTED_MAV_FRAME",
        10: "NOT_IN_CONTROL",
    }
)
"""MAV_RESULT, as an answer is told; ACCEPTED and IN_PROGRESS are told by what follows."""


def result_word(result: int) -> str:
    """MAV_RESULT in a word; a number that no standard knows as it came."""
    return RESULTS.get(result, f"result {result}")
