"""Commands that arm, lift off, land, or fly somewhere."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

from gcs import ipc
from gcs.bridge.translate.command import Command
from gcs.bridge.translate.meaning import Meaning, Reject, Seen, Words
from gcs.bridge.translate.modes import hold, meaning_named, mission_started
from gcs.bridge.translate.places import Datum, datum_of, down_of, place_of
from gcs.bridge.translate.says import ask, go_to, refuse, resume_and_go_to, unsupported
from gcs.frames import Vec3
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import FlightMode
from gcs.wire.ids import MavFrame

FORCE: Final = 21196.0
"""param2 of COMPONENT_ARM_DISARM: arm without checks, disarm in the air (MAVLink common)."""
CHANGE_MODE: Final = 1
"""MAV_DO_REPOSITION_FLAGS_CHANGE_MODE."""
PLACE_OF_TAKEOFF_M: Final = 5.0
"""A take-off at a place no farther from here than this is a take-off here."""
ANEW: Final = "the mission begins anew, at its first item"
OWN_SPEED: Final = "flown at the vehicle's own speed"


def arm_or_disarm(command: Command, seen: Seen) -> Meaning:
    """`arm` never skips the vehicle's checks; a forced disarm is the gate's to decide.

    ArduCopter 4.7 and older PX4 take other numbers than 21196 for force, too; MAVSDK fills p2 with
    NaN, which is none.
    """
    if command.p1 == 1.0:
        forced = command.p2 != 0.0 and math.isfinite(command.p2)
        return ask("arm", "the vehicle's own checks are not skipped" if forced else "")
    if command.p1 == 0.0:
        return Words((ipc.Ask(0, "disarm", force=command.p2 == FORCE),))
    return unsupported(f"{command.p1:g} is neither arm (1) nor disarm (0)")


# ---------------------------------------------------------------------------------- take-off


def take_off_px4(command: Command, seen: Seen) -> Meaning:
    """Height above sea level; NaN, and all below the vehicle's own default, is that default.

    PX4 1.14, recorded: "Using minimum takeoff altitude: 2.50 m".
    """
    datum = Datum.SEA if command.frame is None else datum_of(command.frame)
    elsewhere = _elsewhere(command, seen)
    if elsewhere is not None:
        return elsewhere
    default = Words((ipc.Ask(0, "takeoff", up_m=seen.takeoff_up_m),))
    if math.isnan(command.p7):
        return default
    if isinstance(datum, Refusal):
        return Reject(datum)
    up_m = _up_m(command.p7, datum, seen)
    if isinstance(up_m, Refusal):
        return Reject(up_m)
    if up_m < seen.takeoff_up_m:
        note = f"{command.p7:g} m is too low: to its own {seen.takeoff_up_m:g} m"
        return Words(default.asks, note)
    return Words((ipc.Ask(0, "takeoff", up_m=up_m),))


def take_off_ardupilot(command: Command, seen: Seen) -> Meaning:
    """Height above home.  COMMAND_INT in any other frame is denied (GCS_Mavlink.cpp)."""
    if command.frame not in (None, MavFrame.GLOBAL_RELATIVE_ALT):
        return unsupported(f"ArduCopter takes off in frame 3 (above home), not {command.frame}")
    up_m = _up_m(command.p7, Datum.HOME, seen) if seen.home_ned is not None else command.p7
    if isinstance(up_m, Refusal):
        return Reject(up_m)
    return Words((ipc.Ask(0, "takeoff", up_m=up_m),))


def _up_m(height_m: float, datum: Datum, seen: Seen) -> float | Refusal:
    """Above the place where the vehicle stands."""
    if seen.pos_ned is None:
        return Refusal(Code.NO_POSITION, "where the vehicle stands is not known yet")
    down_m = down_of(seen, height_m, datum)
    return down_m if isinstance(down_m, Refusal) else seen.pos_ned[2] - down_m


def _elsewhere(command: Command, seen: Seen) -> Reject | None:
    """px4 flies to the place of a take-off after its climb; the gate verifies only the climb."""
    if not command.has_place:
        return None
    place = place_of(seen, command.p5, command.p6, math.nan, Datum.SEA)
    if isinstance(place, Refusal):
        return Reject(place)
    assert seen.pos_ned is not None
    away_m = math.dist(place[:2], seen.pos_ned[:2])
    if away_m <= PLACE_OF_TAKEOFF_M:
        return None
    return refuse(
        Code.UNSUPPORTED,
        f"a take-off to a place {away_m:.0f} m away: take off here, then DO_REPOSITION",
        ("away_m", away_m),
    )


# -------------------------------------------------------------------------- landing and return


def land(command: Command, seen: Seen) -> Meaning:
    """Both autopilots land where they are, whatever place the command has; so does the gate."""
    return ask("land", "landed where it is, not at the place given" if command.has_place else "")


def return_home(command: Command, seen: Seen) -> Meaning:
    """In the vehicle's own return mode, if its way is clear."""
    return ask("rtl")


# ------------------------------------------------------------------------------- reposition


def reposition_px4(command: Command, seen: Seen) -> Meaning:
    """NaN in a coordinate keeps it; all of them: stop here.  p4 is a heading in radians.

    Recorded of PX4 1.14: without the flag to change the mode UNSUPPORTED, with it taken in every
    mode, as COMMAND_LONG as well.
    """
    if command.whole(command.p2) != CHANGE_MODE:
        return unsupported(
            "param2 is to be 1, MAV_DO_REPOSITION_FLAGS_CHANGE_MODE; PX4 takes no other flags"
        )
    if all(map(math.isnan, (command.p5, command.p6, command.p7))):
        return hold(seen)
    datum = Datum.SEA if command.frame is None else datum_of(command.frame)
    if isinstance(datum, Refusal):
        return Reject(datum)
    if math.isinf(command.p4):
        return refuse(Code.NON_FINITE, "a heading that is no number")
    goal_ned = place_of(seen, command.p5, command.p6, command.p7, datum)
    yaw_rad = None if math.isnan(command.p4) else command.p4
    return _reposition(goal_ned, yaw_rad, command, seen, resume=True)


def reposition_ardupilot(command: Command, seen: Seen) -> Meaning:
    """As COMMAND_INT only; every coordinate must be given; the heading is ignored.

    Recorded of ArduCopter 4.7: COMMAND_LONG UNSUPPORTED; outside GUIDED it needs the flag.
    """
    if command.frame is None:
        return unsupported("ArduCopter takes DO_REPOSITION as COMMAND_INT only")
    if not (command.has_place and math.isfinite(command.p7)):
        return unsupported("ArduCopter's DO_REPOSITION needs latitude, longitude and height")
    datum = datum_of(command.frame)
    if isinstance(datum, Refusal):
        return Reject(datum)
    goal_ned = place_of(seen, command.p5, command.p6, command.p7, datum)
    changes_mode = bool((command.whole(command.p2) or 0) & CHANGE_MODE)
    return _reposition(goal_ned, None, command, seen, resume=changes_mode)


def _reposition(
    goal_ned: Vec3 | Refusal, yaw_rad: float | None, command: Command, seen: Seen, resume: bool
) -> Meaning:
    if isinstance(goal_ned, Refusal):
        return Reject(goal_ned)
    note = OWN_SPEED if command.p1 > 0.0 else ""
    return (resume_and_go_to if resume else go_to)(seen, goal_ned, yaw_rad, note)


# ------------------------------------------------------------------------ heights and headings


def change_altitude_px4(command: Command, seen: Seen) -> Meaning:
    """As DO_REPOSITION with a height alone (navigator_main.cpp); p2 is the frame of p1."""
    frame = command.whole(command.p2)
    datum = datum_of(-1 if frame is None else frame)
    if isinstance(datum, Refusal):
        return Reject(datum)
    if math.isnan(command.p1):
        return hold(seen)
    goal_ned = place_of(seen, math.nan, math.nan, command.p1, datum)
    if isinstance(goal_ned, Refusal):
        return Reject(goal_ned)
    return resume_and_go_to(seen, goal_ned, None)


def condition_yaw(command: Command, seen: Seen) -> Meaning:
    """ArduCopter: p1 degrees, p3 which way if relative, p4 relative (1) or from north (0).

    The goal that is flown to, with this heading; the gate leaves the rate to the vehicle.
    """
    if not 0.0 <= command.p1 <= 360.0 or command.p4 not in (0.0, 1.0):
        return unsupported(f"CONDITION_YAW to {command.p1:g} degrees, relative {command.p4:g}")
    goal_ned = seen.pos_ned if seen.goal_ned is None else seen.goal_ned
    if goal_ned is None or seen.yaw_rad is None:
        return refuse(Code.NO_POSITION, "where the vehicle is, and where it points, is not known")
    yaw_rad = math.radians(command.p1)
    if command.p4 == 1.0:
        yaw_rad = seen.yaw_rad + (-yaw_rad if command.p3 < 0.0 else yaw_rad)
    note = "turned at the vehicle's own rate" if command.p2 > 0.0 else ""
    return go_to(seen, goal_ned, math.remainder(yaw_rad, math.tau), note)


# ------------------------------------------------------------------------- stop and go on


def pause_or_continue(command: Command, seen: Seen) -> Meaning:
    """p1 0: stop; 1: fly the mission that was stopped anew, or hover under control again."""
    if command.p1 == 0.0:
        return hold(seen)
    if command.p1 == 1.0:
        return go_on(seen)
    return unsupported(f"{command.p1:g} is neither pause (0) nor continue (1)")


def go_on(seen: Seen) -> Meaning:
    """After a stop: the mission, if one was stopped.  A goal that was stopped is gone."""
    if seen.mission_paused:
        start = mission_started(seen)
        return replace(start, note=ANEW) if isinstance(start, Words) else start
    return ask("resume", "hovers under control; a goal that was stopped is gone")


def override_goto(command: Command, seen: Seen) -> Meaning:
    """The old command: hold here (p1 0, p2 2) or go on (p1 1).  Another place: DO_REPOSITION."""
    match (command.p1, command.p2):
        case (0.0, 2.0):
            return hold(seen)
        case (1.0, _):
            return go_on(seen)
        case _:
            return unsupported("OVERRIDE_GOTO to a place: use DO_REPOSITION")


def loiter(command: Command, seen: Seen) -> Meaning:
    """ArduCopter changes to LOITER where it is, whatever place is given (GCS_Mavlink.cpp)."""
    asked_for = "LOITER" if seen.autopilot.mode_of_meaning.get(FlightMode.HOLD) == "BRAKE" else ""
    held = hold(seen, asked_for)
    return (
        Words(held.asks, "held where it is, not at the place given") if command.has_place else held
    )


def guided_enable(command: Command, seen: Seen) -> Meaning:
    """p1 1: OFFBOARD or GUIDED; 0: hold."""
    if command.p1 == 1.0:
        return meaning_named(seen, FlightMode.GUIDED)
    if command.p1 == 0.0:
        return hold(seen)
    return unsupported(f"{command.p1:g} is neither on (1) nor off (0)")


_STANDARD_MODES: Final = {
    5: FlightMode.RETURN,  # MAV_STANDARD_MODE_SAFE_RECOVERY
    6: FlightMode.MISSION,
    7: FlightMode.LAND,
    8: FlightMode.TAKEOFF,
}


def standard_mode(command: Command, seen: Seen) -> Meaning:
    """DO_SET_STANDARD_MODE; modes that are flown with sticks are not for a station."""
    number = command.whole(command.p1)
    meaning = None if number is None else _STANDARD_MODES.get(number)
    if meaning is None:
        return unsupported(f"standard mode {command.p1:g} is not one that a station flies")
    return meaning_named(seen, meaning)
