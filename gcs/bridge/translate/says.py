"""Short ways to say a meaning: requests in the operators' words, and refusals."""

from __future__ import annotations

import math
from typing import Final

from gcs import ipc
from gcs.bridge.translate.meaning import Forward, Reject, Seen, Words
from gcs.frames import Vec3, as_on_the_wire, enu_from_ned
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import FlightMode, State
from gcs.protocol.autopilot import mode_named

SAME_GOAL_M: Final = 0.01
SAME_YAW_RAD: Final = 0.01

FLOWN_TO: Final = frozenset({State.HOVERING, State.VERIFYING, State.MOVING})
"""States in which `Seen.goal_ned` is what the last go-to asked for."""
NOT_FLOWN_BY_US: Final = frozenset({State.HOLDING, State.EXTERNAL})
"""States that a request to fly leaves only after `resume`."""

DONE: Final = Words(())
"""Nothing to ask: it is so already, or asks for nothing."""


def ask(word: str, note: str = "") -> Words:
    """One request without arguments."""
    return Words((ipc.Ask(0, word),), note)


def hover_again(seen: Seen, *then: ipc.Ask, note: str = "") -> Words | Reject:
    """Stop what is flown, and take control of the vehicle where it is; `then` what follows.

    Where the gate would not give control, nothing is stopped: the vehicle may be on its way home
    because of what forbids it.
    """
    refusal = seen.why_not_resume()
    if refusal is not None:
        return Reject(refusal)
    return Words((ipc.Ask(0, "hold"), ipc.Ask(0, "resume"), *then), note)


def mode(name: str) -> Words:
    """The request for a mode by the autopilot's own name."""
    return Words((ipc.Ask(0, "mode", mode=name),))


def forward(seen: Seen) -> Forward | Words:
    """Unchanged to the vehicle, for a client who is in control; else the refusal that it is not."""
    return Forward() if seen.in_control else ask("control")


def go_to(seen: Seen, goal_ned: Vec3, yaw_rad: float | None, note: str = "") -> Words:
    """Fly to a place, in the mode that the vehicle is in.

    The goal is rounded as the wire carries it, so that what is asked for, shown and flown is one.
    A vehicle that is on its way there already is asked for nothing: a client that got no answer
    sends the same again.  One that is not in control asks all the same, and is refused.
    """
    goal = _as_sent(goal_ned)
    if seen.in_control and _is_flown_to(seen, goal, yaw_rad):
        return Words((), note)
    degrees = None if yaw_rad is None else math.degrees(yaw_rad)
    wanted = ipc.Ask(0, "goto", goal_enu=enu_from_ned(goal), yaw_deg=degrees)
    return Words((wanted,), note)


def resume_and_go_to(
    seen: Seen, goal_ned: Vec3, yaw_rad: float | None, note: str = ""
) -> Words | Reject:
    """The same of a message that also asks to leave whatever mode the vehicle is in.

    A hold, which another client may have set, is not lifted for a goal that will be refused.
    """
    words = go_to(seen, goal_ned, yaw_rad, note)
    if not comes_back(seen):
        return words
    refusal = seen.why_not_go_to(_as_sent(goal_ned), yaw_rad) if seen.in_control else None
    if refusal is not None:
        return Reject(refusal)
    return Words((ipc.Ask(0, "resume"), *words.asks), note)


def _as_sent(goal_ned: Vec3) -> Vec3:
    north, east, down = (as_on_the_wire(metres) for metres in goal_ned)
    return (north, east, down)


def comes_back(seen: Seen) -> bool:
    """Whether a message that asks to fly somewhere, and so for another mode, resumes the vehicle.

    It ends a hold.  It takes no vehicle from a pilot who flies it with sticks: that takes a mode
    that is asked for by itself.
    """
    if seen.state is State.EXTERNAL:
        shown = mode_named(seen.autopilot, seen.mode_name)
        return shown is not None and shown.meaning is not FlightMode.OTHER
    return seen.state is State.HOLDING


def _is_flown_to(seen: Seen, goal_ned: Vec3, yaw_rad: float | None) -> bool:
    if seen.state not in FLOWN_TO or seen.goal_ned is None:
        return False
    if not math.dist(goal_ned, seen.goal_ned) <= SAME_GOAL_M:
        return False
    if yaw_rad is None:
        return True
    now = seen.goal_yaw_rad
    return now is not None and abs(turn_rad(now, yaw_rad)) <= SAME_YAW_RAD


def turn_rad(start: float, end: float) -> float:
    """The shorter way from one heading to another, -pi .. pi; NaN for headings that are none."""
    difference = end - start
    return math.remainder(difference, math.tau) if math.isfinite(difference) else math.nan


def refuse(code: Code, sentence: str, *numbers: tuple[str, float]) -> Reject:
    """Not to be put in words; the sentence is for whoever reads the client's screen."""
    return Reject(Refusal(code, sentence, numbers))


def unsupported(sentence: str) -> Reject:
    """The most common of them."""
    return refuse(Code.UNSUPPORTED, sentence)
