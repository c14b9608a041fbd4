"""Mutants that change nothing that can be seen from outside, each with the reason.

Both lists are by target.  An entry that names no mutant is an error of the run, and so is an
equivalent mutant that a test kills.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tests.unit.gate import unreached as gate_table

_AIRSPACE: Final[Mapping[str, tuple[str, ...]]] = {
    "sin c is zero only where north and east are, which the scale multiplies": (
        (
            "gcs/gate/airspace/projection.py _azimuthal_forward: math.atan2(sin_c, up) / "
            "sin_c if sin_c > 0.0 else 1.0 -> math.atan2(sin_c, up) / sin_c if sin_c > 0.0 "
            "else 1.5"
        ),
    ),
    "a speed of zero has no north and no east to multiply": (
        (
            "gcs/gate/airspace/stopping.py stop_point: run_h / speed_h if speed_h > 0.0 else "
            "0.0 -> run_h / speed_h if speed_h > 0.0 else 1.0"
        ),
    ),
    "without home, only zones that do not count from it get so far": (
        (
            "gcs/gate/airspace/zones.py _place: _east_north_up(home_ned or (0.0, 0.0, 0.0)) "
            "-> _east_north_up(home_ned or (1.0, 0.0, 0.0))"
        ),
        (
            "gcs/gate/airspace/zones.py _place: _east_north_up(home_ned or (0.0, 0.0, 0.0)) "
            "-> _east_north_up(home_ned or (0.0, 1.0, 0.0))"
        ),
        (
            "gcs/gate/airspace/zones.py _place: _east_north_up(home_ned or (0.0, 0.0, 0.0)) "
            "-> _east_north_up(home_ned or (0.0, 0.0, 1.0))"
        ),
    ),
    "read of a TAKE_OFF alone, which always gives it": (
        "gcs/gate/effects.py SendCommand: 0.0 -> 1.0",
    ),
    "at exactly the tolerance either answer is allowed": (
        (
            "gcs/gate/geometry.py side: clearance_m >= margin_m + TOLERANCE_M -> clearance_m "
            "> margin_m + TOLERANCE_M"
        ),
        "gcs/gate/geometry.py side: clearance_m < -TOLERANCE_M -> clearance_m <= -TOLERANCE_M",
        "gcs/gate/geometry.py Polygon._middles: gap > TOLERANCE_M -> gap >= TOLERANCE_M",
        (
            "gcs/gate/geometry.py Polygon._meetings: point_segment_distance(c, a, b) <= "
            "TOLERANCE_M -> point_segment_distance(c, a, b) < TOLERANCE_M"
        ),
        (
            "gcs/gate/geometry.py polygon_fault: _distance(a, b) <= TOLERANCE_M -> "
            "_distance(a, b) < TOLERANCE_M"
        ),
        (
            "gcs/gate/geometry.py polygon_fault: min(point_segment_distance(c, a, b), "
            "point_segment_distance(a, b, c)) <= TOLERANCE_M -> min(point_segment_distance(c, "
            "a, b), point_segment_distance(a, b, c)) < TOLERANCE_M"
        ),
    ),
    "crossings of the ray to the west: as odd or even as those to the east": (
        (
            "gcs/gate/geometry.py Polygon.contains: (_turn(a, b, p) > 0.0) == (b[1] > a[1]) "
            "-> (_turn(a, b, p) > 0.0) != (b[1] > a[1])"
        ),
    ),
    "differs on the boundary only, where the answer means nothing": (
        (
            "gcs/gate/geometry.py Polygon.contains: (_turn(a, b, p) > 0.0) == (b[1] > a[1]) "
            "-> (_turn(a, b, p) >= 0.0) == (b[1] > a[1])"
        ),
    ),
    "the heights of the ends differ: one is above p and one is not": (
        (
            "gcs/gate/geometry.py Polygon.contains: (_turn(a, b, p) > 0.0) == (b[1] > a[1]) "
            "-> (_turn(a, b, p) > 0.0) == (b[1] >= a[1])"
        ),
    ),
    "a side of zero is no crossing, as the next condition says": (
        (
            "gcs/gate/geometry.py crossing: (a_side > 0.0) == (b_side > 0.0) -> (a_side >= "
            "0.0) == (b_side > 0.0)"
        ),
        (
            "gcs/gate/geometry.py crossing: (a_side > 0.0) == (b_side > 0.0) -> (a_side > "
            "0.0) == (b_side >= 0.0)"
        ),
        (
            "gcs/gate/geometry.py crossing: (c_side > 0.0) == (d_side > 0.0) -> (c_side >= "
            "0.0) == (d_side > 0.0)"
        ),
        (
            "gcs/gate/geometry.py crossing: (c_side > 0.0) == (d_side > 0.0) -> (c_side > "
            "0.0) == (d_side >= 0.0)"
        ),
    ),
    "the ends are the same place": ("gcs/gate/geometry.py _projection: 0.0 -> 1.0",),
    "only compared for identity, and recorded by name": ("gcs/gate/states.py Control: 2 -> 3",),
}
"""Keys of the mutants by the reason: of geometry, airspace, policies and the closed words."""

_STATE_MACHINE: Final[Mapping[str, tuple[str, ...]]] = {
    "nothing to climb takes no time at either speed": (
        (
            "gcs/gate/machine/actions.py _flight_s: speeds.descend_m_s if down_m > 0.0 else "
            "speeds.climb_m_s -> speeds.descend_m_s if down_m >= 0.0 else speeds.climb_m_s"
        ),
    ),
    "an unknown autopilot arms in every mode, so no mode is commanded first": (
        (
            "gcs/gate/machine/commanding.py _arm_or_its_mode: (frozenset(FlightMode), "
            "CommandKind.HOLD) -> (frozenset(FlightMode), CommandKind.GUIDED)"
        ),
    ),
    "a stop is predicted with control, and there is none in GROUNDED": (
        "gcs/gate/machine/observe.py module: with State.GROUNDED -> without",
    ),
    "in LANDING a predicted breach changes nothing": (
        "gcs/gate/machine/observe.py module: with State.LANDING -> without",
    ),
    "the outcome has the branch's code; of this reason only the sentence is read": (
        (
            "gcs/gate/machine/observe.py _photo: Refusal(Code.VEHICLE_REFUSED, 'the camera took no "
            "picture') -> Refusal(Code.NO_ANSWER, 'the camera took no picture')"
        ),
        "gcs/gate/machine/observe.py _position: Code.FENCE_BREACH -> Code.ESTIMATOR_RESET",
        "gcs/gate/machine/observe.py _command_answer: Code.VEHICLE_REFUSED -> Code.NO_ANSWER",
        (
            "gcs/gate/machine/progress.py climb_ended_elsewhere: Code.VEHICLE_REFUSED -> "
            "Code.NO_ANSWER"
        ),
    ),
    "position, velocity and their time are stored together and forgotten together": (
        (
            "gcs/gate/machine/observe.py _faster_than_allowed: memory.pos_ned is None or "
            "memory.pos_ns is None -> memory.pos_ned is None and memory.pos_ns is None"
        ),
        (
            "gcs/gate/machine/progress.py within_arrival: memory.pos_ned is None or memory.v_ned "
            "is None -> memory.pos_ned is None and memory.v_ned is None"
        ),
    ),
    "both events change nothing in any state": (
        ("gcs/gate/machine/observe.py _command_answer: Event.HOLD_UNANSWERED -> Event.LATE_ANSWER"),
    ),
    "the event that follows, SEVERITY_EASED, changes nothing in any state": (
        "gcs/gate/machine/gate.py Gate._demand: after < before -> after <= before",
    ),
    "asked in STALE of a breach, which needs control, and so a state to return to": (
        "gcs/gate/machine/guards.py Guard: with None -> without",
    ),
    "it is read in FLYING_MISSION only, and the start of a mission sets it": (
        "gcs/gate/machine/memory.py Memory: False -> True #6",
    ),
    "every picture sets it before it is read": (
        "gcs/gate/machine/memory.py Memory: False -> True #7",
    ),
    "every heartbeat sets it, and a mode that changes comes with one": (
        "gcs/gate/machine/memory.py Memory: False -> True #5",
    ),
    "whatever gives us control is a request, which sets it": (
        "gcs/gate/machine/memory.py Memory: False -> True #9",
    ),
    "it is read while a mode is awaited, and set with that mode": (
        "gcs/gate/machine/memory.py Memory: 0 -> 1 #7",
    ),
    "it is read during a take-off, which sets it": (
        "gcs/gate/machine/memory.py Memory: (0.0, 0.0, 0.0) -> (1.0, 0.0, 0.0)",
        "gcs/gate/machine/memory.py Memory: (0.0, 0.0, 0.0) -> (0.0, 1.0, 0.0)",
        "gcs/gate/machine/memory.py Memory: (0.0, 0.0, 0.0) -> (0.0, 0.0, 1.0)",
    ),
    "exactly at the height `at_height` holds, and its branches come first": (
        (
            "gcs/gate/machine/progress.py climb_ended_elsewhere: 'below' if above_m < 0.0 else "
            "'above' -> 'below' if above_m <= 0.0 else 'above'"
        ),
    ),
    (
        "the guard before it left the verifier's refusal, which has this code, and that one is "
        "given"
    ): (
        "TABLE GROUNDED / return, branch 5: refused RTL_BLOCKED -> refused CANNOT_STOP",
        "TABLE GROUNDED / return, branch 6: refused RTL_BLOCKED -> refused CANNOT_STOP",
        (
            "TABLE TAKING_OFF / return and 8 more, branch 4: refused RTL_BLOCKED -> refused "
            "CANNOT_STOP"
        ),
        (
            "TABLE TAKING_OFF / return and 8 more, branch 5: refused RTL_BLOCKED -> refused "
            "CANNOT_STOP"
        ),
        "TABLE LANDING / return, branch 4: refused RTL_BLOCKED -> refused CANNOT_STOP",
    ),
    "in GROUNDED there is no control to let go, and its commands end with the request": (
        "TABLE GROUNDED / abort, branch 3: do let control go -> do nothing",
        "TABLE GROUNDED / airborne, branch 10: do let control go -> do nothing",
    ),
    "it is in GROUNDED already": ("TABLE GROUNDED / abort, branch 3: -> GROUNDED -> -> stay",),
    "a grace that is over is a grace": (
        ("TABLE STALE / position aged, branch 1: if a verified stream is in its grace -> always"),
    ),
    "the next action, to forget what was interrupted, lets control go as well": (
        "TABLE STALE / guided mode and 4 more, branch 4: do let control go -> do nothing",
    ),
    "a goal is flown to, and a climb judged, by a position that has come": (
        "gcs/gate/machine/progress.py within_arrival: False -> True",
        "gcs/gate/machine/progress.py nearly_at_height: False -> True",
    ),
}
"""Keys of the mutants by the reason: of the gate's state machine and its table."""

EQUIVALENT: Final[Mapping[str, Mapping[str, str]]] = {
    "gate": {
        key: reason
        for reason, keys in (*_AIRSPACE.items(), *_STATE_MACHINE.items())
        for key in keys
    }
}
"""Reasons by the mutant's key."""

UNREACHED: Final[Mapping[str, Mapping[str, str]]] = {
    "gate": {
        entry: unreached.why for unreached in gate_table.UNREACHED for entry in unreached.entries
    }
}
"""Reasons by the name that the table's alterations give to an entry."""
