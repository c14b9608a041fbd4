"""How far a flight is: whether it is at its goal, and whether its climb is over."""

from __future__ import annotations

import math
from operator import sub

from gcs.gate.inputs import AccuracySeen
from gcs.gate.machine.events import Event
from gcs.gate.machine.memory import SECOND_NS
from gcs.gate.machine.step_context import StepContext
from gcs.gate.policy.policy import Arrival
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import FlightMode

CLIMB_ENDED_M_S = 0.3
"""Near its top a climb is over when the vehicle is slower than this: it overshoots no more."""

HEIGHT_WITHIN_M = 0.35
"""A take-off is complete so near the height that was asked for, whatever the arrival radius.  A
PX4 1.14.3 that is sent its height in OFFBOARD rested up to 0.28 m beside it (recorded)."""

LAST_SHARE = 0.1
"""Of a climb.  DroneKit's scripts fly on at 95 % of it."""

OVERSHOOT_M = 1.0
"""How far above its top, the arrival radius added, a climb may overshoot."""


def arrival_radius_h_m(arrival: Arrival, seen: AccuracySeen) -> float | None:
    """How near beside a goal counts as there, by what the vehicle says of its accuracy.

    Never less than the policy's radius, nor more than its greatest one or than the vehicle's own
    acceptance radius where that is greater.  None where the vehicle says nothing.
    """
    accuracy_m = seen.accuracy_h_m
    if accuracy_m is None or not math.isfinite(accuracy_m) or accuracy_m < 0.0:
        return None
    most_m = arrival.max_radius_m
    if seen.acceptance_m is not None and math.isfinite(seen.acceptance_m):
        most_m = min(most_m, seen.acceptance_m)
    return max(arrival.radius_m, min(arrival.radius_m + accuracy_m, most_m))


def within_arrival(step: StepContext) -> bool:
    """Strictly inside the arrival radius of the goal that is flown; slow enough, and turned to the
    heading that it names, where the policy asks for it.

    With the vehicle's accuracy the sphere about the goal grows sideways: an ellipsoid.
    """
    memory, arrival = step.memory, step.policy.arrival
    if memory.goal is None or memory.pos_ned is None or memory.v_ned is None:
        return False
    narrower = arrival.radius_m / (memory.arrival_h_m or arrival.radius_m)
    north_m, east_m, down_m = map(sub, memory.pos_ned, memory.goal.pos_ned)
    near = math.hypot(north_m * narrower, east_m * narrower, down_m) < arrival.radius_m
    slow = arrival.speed_m_s is None or math.hypot(*memory.v_ned) <= arrival.speed_m_s
    return near and slow and memory.turn_left_deg(arrival.yaw_deg) == 0.0


def arrived(step: StepContext) -> bool:
    """At the goal for as long as the policy asks, by a fresh position."""
    since_ns = step.memory.within_since_ns
    if since_ns is None or step.stale or not _at_height_asked_for(step):
        return False
    return step.now_ns - since_ns >= round(step.policy.arrival.dwell_s * SECOND_NS)


def _at_height_asked_for(step: StepContext) -> bool:
    """Of a take-off; another goal has no height of its own."""
    task, above_m = step.memory.task, _above_top_m(step)
    if task is None or task.kind is not Event.TAKE_OFF:
        return True
    return above_m is not None and abs(above_m) < HEIGHT_WITHIN_M


def at_height(step: StepContext) -> bool:
    """The climb is over, at its top, or as far below it as the vehicle itself ends a climb."""
    memory, radius_m = step.memory, step.policy.arrival.radius_m
    above_m = _above_top_m(step)
    if not memory.airborne or above_m is None:
        return False
    if abs(above_m) < radius_m:
        return _shows_hold(step) or _slow(step)
    ends_there = -(radius_m + memory.climb_ends_within_m) < above_m < 0.0
    return ends_there and _shows_hold(step) and _slow(step)


def nearly_at_height(step: StepContext) -> bool:
    """In the last tenth of the climb, or within the arrival radius of its top."""
    memory, above_m = step.memory, _above_top_m(step)
    if above_m is None or memory.ground_down_m is None:
        return False
    climb_m = memory.ground_down_m - memory.top_ned[2]
    return above_m > -max(step.policy.arrival.radius_m, LAST_SHARE * climb_m)


def climb_ended_elsewhere(step: StepContext) -> bool:
    """The vehicle shows that its climb is over, and stands still in the air.

    To be asked after `at_height`: it does not look at the height itself.
    """
    above_m = _above_top_m(step)
    if not step.memory.airborne or above_m is None or not (_shows_hold(step) and _slow(step)):
        return False
    side = "below" if above_m < 0.0 else "above"
    sentence = f"the vehicle ended its climb {abs(above_m):.1f} m {side} the height asked for"
    step.why = Refusal(Code.VEHICLE_REFUSED, sentence, (("above_top_m", above_m),))
    return True


def climbs_too_high(step: StepContext) -> bool:
    """Further above the top of the climb than an overshoot explains."""
    above_m = _above_top_m(step)
    return above_m is not None and above_m > step.policy.arrival.radius_m + OVERSHOOT_M


def _above_top_m(step: StepContext) -> float | None:
    """Metres above the top of the climb, negative below it; None where the position is too old."""
    memory = step.memory
    if step.stale or memory.pos_ned is None:
        return None
    return memory.top_ned[2] - memory.pos_ned[2]


def _slow(step: StepContext) -> bool:
    v_ned = step.memory.v_ned
    return v_ned is not None and math.hypot(*v_ned) < CLIMB_ENDED_M_S


def _shows_hold(step: StepContext) -> bool:
    """The heartbeat shows hold mode, as px4 does after a climb.

    As long as the take-off mode is awaited, a hold mode is still that of before the take-off.
    """
    memory = step.memory
    shown = memory.asked_mode is None
    return memory.lifted and shown and memory.mode is FlightMode.HOLD
