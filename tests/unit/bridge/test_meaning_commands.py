"""What commands of clients ask for: MAVLink common.xml, and what real autopilots did."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest
from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.translate.translate import meaning_of
from gcs.gate.refusal import Code
from gcs.gate.states import State
from gcs.protocol.autopilot import GENERIC, PX4
from gcs.wire.messages import Message
from tests.unit.bridge.rows import BOTH, A, P, Row, air, ground, hold, table
from tests.unit.bridge.vehicles import (
    NAN,
    UNSET,
    command_int,
    command_long,
    flying,
    goal,
    px4_mode,
    refusal,
)

HOLDING, MISSION, EXTERNAL = State.HOLDING, State.FLYING_MISSION, State.EXTERNAL
GLOBAL = mavlink.MAV_FRAME_GLOBAL
RELATIVE = mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT
CHANGE_MODE = 1.0
INF = math.inf
NANS = (NAN,) * 6

# 100 m north and 50 m east of the origin of `flying`.  Computed apart from this program: on a
# sphere of 6,371,000 m a degree of latitude is 111,194.9266 m; ArduPilot counts
# 111,318.84502145034 m a degree.  Of longitude times the cosine of 47.3978 degrees.
PX4_LAT, PX4_LON = 47.397742 + 100 / 111_194.9266, 8.545594 + 50 / (111_194.9266 * 0.67692)
ARDU_LAT = 47.397742 + 100 / 111_318.84502145034
ARDU_LON = 8.545594 + 50 / (111_318.84502145034 * math.cos(math.radians(47.397742 + 0.000449)))


def e7(degrees: float) -> int:
    return round(degrees * 1e7)


def arm(*params: float) -> Message:
    return command_long(400, *params)


def climb(height_m: float, lat: float = NAN, lon: float = NAN) -> Message:
    return command_long(22, 0, 0, 0, NAN, lat, lon, height_m)


def there(flags: float, yaw: float, lat: float, lon: float, alt: float) -> Message:
    """DO_REPOSITION as COMMAND_LONG."""
    return command_long(192, -1, flags, 0, yaw, lat, lon, alt)


def at(
    frame: int, x: int, y: int, z: float, flags: float = CHANGE_MODE, p4: float = NAN
) -> Message:
    """DO_REPOSITION as COMMAND_INT."""
    return command_int(192, frame, (-1.0, flags, 0.0, p4), x, y, z)


TO_PX4_PLACE = (e7(PX4_LAT), e7(PX4_LON))
TO_ARDU_PLACE = (e7(ARDU_LAT), e7(ARDU_LON))
OFF_THE_MAP: list[tuple[tuple[float, float], str]] = [
    ((91, 8), "BAD_PARAMETER"),
    ((47, 181), "BAD_PARAMETER"),
    ((NAN, 8), "NON_FINITE"),
    ((47, INF), "NON_FINITE"),
]
CLICK = there(CHANGE_MODE, NAN, PX4_LAT, PX4_LON, 505.0)
EAST, NORTH, UP = goal(meaning_of(CLICK, flying(PX4)))
GOES_THERE = "goto 50 100 17"
CLICKED = "goto 49.98 99.82 17"
"""Degrees as float32 are up to 0.4 m off."""
TO_CLICK: dict[str, Any] = {"goal_ned": (NORTH, EAST, -UP)}
MINE_NOT: dict[str, Any] = {"in_control": False}
START, SKIP = command_long(300), command_long(189)
STOPS = {
    "DO_PAUSE_CONTINUE": command_long(193, 0.0),
    "OVERRIDE_GOTO": command_long(252, 0.0, 2.0),
    "NAV_LOITER_UNLIM": command_long(17),
    "NAV_GUIDED_ENABLE off": command_long(92, 0.0),
}

COMMANDS = {
    "arming": [
        Row(BOTH, ground(), arm(1), "arm"),
        Row(BOTH, ground(), arm(1, 21196), "arm", note="checks are not skipped"),
        # Seen of MAVSDK 4.1.0: what it does not use is NaN, and it is not forced.
        Row(BOTH, ground(), arm(1, *NANS), "arm"),
        Row(BOTH, air(), arm(0, *NANS), "disarm"),
        Row(BOTH, air(), arm(0), "disarm"),
        Row(BOTH, air(), arm(0, 21196), "disarm by force"),
        # ArduCopter 4.7, recorded: 2989 in p2 does not disarm in the air.
        Row(BOTH, air(), arm(0, 2989), "disarm"),
        *(Row(BOTH, ground(), arm(p1), "UNSUPPORTED") for p1 in (0.6, 2.0, -1.0, NAN, INF)),
    ],
    "take-off of a PX4, to a height above the sea": [
        # It stands 500 m above the sea; 510 is 10 m above it.
        Row(P, ground(), climb(510), "takeoff 10"),
        Row(P, ground(), climb(NAN), "takeoff 2.5"),
        # PX4 1.14.3, recorded (commands_px4.json, "takeoff in air"): "Using minimum takeoff
        # altitude: 2.50 m".  A script that means 10 m above home gets that.
        *(Row(P, ground(), climb(m), "takeoff 2.5", "too low") for m in (10, 0, 500, 502)),
        # It would fly to the place after its climb, along a leg that nobody verified.
        Row(P, ground(), climb(510, 47.397751, 8.5456206), "takeoff 10"),
        Row(P, ground(), climb(510, PX4_LAT, PX4_LON), "UNSUPPORTED: DO_REPOSITION"),
        Row(P, ground(), climb(510, 0, 0), "takeoff 10"),
        Row(P, ground(origin=None), climb(510), "NO_ORIGIN"),
        Row(P, ground(pos_ned=None), climb(510), "NO_POSITION"),
    ],
    "take-off of an ArduPilot, to a height above home": [
        Row(A, ground(), command_long(22, 0, 0, 0, 0, 0, 0, 10), "takeoff 10"),
        Row(A, ground(pos_ned=(1, 2, -15)), command_long(22, 0, 0, 0, 0, 0, 0, 10), "takeoff 7"),
        Row(A, ground(home_ned=None, home_amsl_m=None), climb(10), "takeoff 10"),
        # GCS_Mavlink.cpp: any other frame of COMMAND_INT is DENIED; places are ignored.
        Row(A, ground(), command_int(22, RELATIVE, x=e7(48), y=e7(9), z=10), "takeoff 10"),
        Row(A, ground(), command_int(22, GLOBAL, z=510), "UNSUPPORTED"),
    ],
    "landing, return": [
        # PX4 1.14.3, recorded: "Landing at current position".
        Row(BOTH, air(), command_long(21), "land"),
        Row(BOTH, air(), command_long(21, 0, 0, 0, NAN, NAN, NAN, 0), "land"),
        Row(BOTH, air(), command_long(21, 0, 0, 0, 0, 48, 9, 0), "land", "not at the place"),
        Row(BOTH, air(), command_long(20), "rtl"),
        Row(BOTH, air(), command_long(191), "UNSUPPORTED: hold"),
    ],
    # Invariant 10: `hold` is a word that everybody may say, and that is never refused.
    "a stop is a hold in every state": [
        Row(BOTH, air(state), stop, "hold", None) for state in State for stop in STOPS.values()
    ],
    "going on": [
        Row(BOTH, air(HOLDING), command_long(193, 1), "resume", "hovers under control"),
        Row(
            BOTH,
            air(HOLDING, mission_paused=True),
            command_long(193, 1),
            "resume, mission_start",
            "begins anew",
        ),
        Row(BOTH, air(HOLDING), command_long(193, 0.5), "UNSUPPORTED"),
    ],
    "reposition of a PX4": [
        # 505 m above the sea is 5 m above home and 17 m above the origin.
        Row(P, air(), at(GLOBAL, *TO_PX4_PLACE, 505), GOES_THERE),
        Row(P, air(), at(5, *TO_PX4_PLACE, 505), GOES_THERE),
        Row(P, air(), at(RELATIVE, *TO_PX4_PLACE, 5), GOES_THERE),
        Row(P, air(), at(6, *TO_PX4_PLACE, 5), GOES_THERE),
        # Its heading is in radians; what is not given stays as it is.
        Row(P, air(), there(1, math.pi / 2, PX4_LAT, PX4_LON, 505), f"{CLICKED} yaw 90"),
        Row(P, air(), at(RELATIVE, UNSET, UNSET, 15), "goto 2 1 27"),
        Row(P, air(), at(RELATIVE, *TO_PX4_PLACE, NAN), "goto 50 100 22"),
        # QGroundControl's "pause" (from memory: pauseVehicle of its PX4 plug-in).
        Row(P, air(State.MOVING), there(1, NAN, NAN, NAN, NAN), "hold"),
        # PX4 1.14.3, recorded: flags 0 is UNSUPPORTED in every mode (scenarios_px4.json).
        *(
            Row(P, air(), there(flags, NAN, PX4_LAT, PX4_LON, 505), "UNSUPPORTED")
            for flags in (0, 2, 3, NAN)
        ),
        Row(P, air(origin=None), CLICK, "NO_ORIGIN"),
        *(
            Row(P, air(), there(1, NAN, *place, 505), f"{code}: no place on the map")
            for place, code in OFF_THE_MAP
        ),
        # 0x7FF80000 is the upper half of a NaN; PX4 denies it ("x/y invalid of command").
        Row(
            P, air(), at(RELATIVE, 0x7FF80000, 0x7FF80000, 5), "BAD_PARAMETER: no place on the map"
        ),
    ],
    "reposition of an ArduPilot": [
        Row(A, air(), at(RELATIVE, *TO_ARDU_PLACE, 5, 0.0, 1.0), GOES_THERE),
        # ArduCopter 4.7, recorded: UNSUPPORTED on the ground and in the air.
        Row(A, air(), there(1, NAN, ARDU_LAT, ARDU_LON, 5), "UNSUPPORTED: COMMAND_INT"),
    ],
    # Recorded for 8 and 2: UNSUPPORTED (PX4), DENIED, "Unknown mavlink coordinate frame"
    # (ArduCopter).  Heights above terrain need data that nobody here has.
    "reposition in frames that neither takes": [
        Row(BOTH, air(), at(frame, *TO_PX4_PLACE, 5), "UNSUPPORTED")
        for frame in (1, 2, 7, 8, 9, 10, 11, 12, 20, 99, 255)
    ],
    # Both recorded: with flag 1 it is taken in every mode and changes it.
    "reposition with the flag leaves a hold": [
        row
        for state in (HOLDING, EXTERNAL)
        for row in (
            Row(P, air(state), CLICK, f"resume, {CLICKED}"),
            Row(A, air(state), at(RELATIVE, *TO_ARDU_PLACE, 5, p4=0), f"resume, {GOES_THERE}"),
            Row(A, air(state), at(RELATIVE, *TO_ARDU_PLACE, 5, 0.0, 0), GOES_THERE),
        )
    ],
    # The autopilot would take it; here a pilot's sticks outrank a click on the map, and the gate
    # refuses the go-to: NOT_IN_CONTROL.
    "reposition takes no vehicle from a pilot": [
        Row(P, air(EXTERNAL, mode_name="POSCTL"), CLICK, CLICKED),
        Row(P, air(EXTERNAL, mode_name="STABILIZED"), CLICK, CLICKED),
        Row(P, air(EXTERNAL, mode_name="AUTO.LOITER"), CLICK, f"resume, {CLICKED}"),
    ],
    # A client whose acknowledgement was lost sends it again; what another one flies is refused.
    "a repeated reposition asks for nothing more": [
        Row(P, air(State.MOVING, **TO_CLICK), CLICK, ""),
        Row(P, air(HOLDING, **TO_CLICK), CLICK, f"resume, {CLICKED}"),
        Row(P, air(State.MOVING, **TO_CLICK, **MINE_NOT), CLICK, CLICKED),
        Row(P, air(State.HOVERING, **TO_CLICK, **MINE_NOT), CLICK, CLICKED),
    ],
    "heights": [
        Row(P, air(), command_long(186, 530, GLOBAL), "goto 2 1 42"),
        Row(P, air(), command_long(186, 30, RELATIVE), "goto 2 1 42"),
        Row(P, air(HOLDING), command_long(186, 530, GLOBAL), "resume, goto 2 1 42"),
        # ArduCopter 4.7, recorded: 186 is UNSUPPORTED on the ground and in the air.
        Row(A, air(), command_long(186, 530, GLOBAL), "UNSUPPORTED"),
    ],
    # It points east (90) and holds its goal; relative angles turn clockwise unless p3 is -1.
    "headings": [
        *(
            Row(A, air(), command_long(115, *params), f"goto 2 1 22 yaw {yaw_deg}", note)
            for params, yaw_deg, note in (
                ((270, 10, 1, 0), -90, "at the vehicle's own rate"),
                ((0, 0, 0, 0), 0, ""),
                ((45, 0, 1, 1), 135, ""),
                ((45, 0, -1, 1), 45, ""),
                ((180, 0, 1, 1), -90, ""),
            )
        ),
        *(
            Row(A, air(), command_long(115, *params), "UNSUPPORTED")
            for params in ((-1.0,), (361.0,), (NAN,), (90.0, 0.0, 0.0, 2.0))
        ),
        # PX4 1.14.3, recorded: UNSUPPORTED in the air and on the ground (commands_px4.json).
        Row(P, air(), command_long(115, 90), "UNSUPPORTED"),
    ],
    # `control` is the request that is refused OTHER_OPERATOR, as it should be.
    "looking somewhere is forwarded, of the client in control": [
        *(Row(BOTH, air(), command_long(n), "forwarded") for n in (195, 196, 197, 198, 201)),
        Row(BOTH, air(**MINE_NOT), command_long(195), "control"),
    ],
    "speeds": [
        *(Row(BOTH, air(), command_long(178, 1, v), "forwarded") for v in (5, 1, 2, -1, -2)),
        *(Row(BOTH, air(**MINE_NOT), command_long(178, 1, v), "control") for v in (2, -1)),
        Row(BOTH, air(), command_long(178, 1, 5.5), "POLICY: 5.5 m/s"),
        Row(BOTH, air(max_speed_m_s=0.0), command_long(178, 1, 0.5), "POLICY"),
        # ArduCopter 4.7, recorded: 2 is climb, 3 descent, 4 DENIED.  PX4 1.14.3: the kind is
        # ignored, "type 2 (climb) 1 m/s makes the horizontal cruise 1.05 m/s".
        *(Row(A, air(), command_long(178, kind, 1), "POLICY") for kind in (2, 3, 4, NAN)),
        *(Row(P, air(), command_long(178, kind, 1), "forwarded") for kind in (2, 3, 4, NAN)),
        # ArduCopter 4.7, recorded: DO_CHANGE_SPEED NaN aborts it, a floating point exception.
        *(Row(BOTH, air(), command_long(178, 1, v), "NON_FINITE") for v in (NAN, INF, -INF)),
        Row(BOTH, air(MISSION), command_long(178, 1, 1), "POLICY"),
    ],
    "starting a mission": [
        Row(BOTH, air(), START, "mission_start"),
        Row(BOTH, ground(), command_long(300, 3), "UNSUPPORTED"),
        # C10_mission_start_px4, recorded: MISSION_START 1, 1 ACCEPTED.  ArduCopter denies it.
        Row(P, air(), command_long(300, 3), "mission_set_current 3, mission_start"),
        Row(
            P,
            air(HOLDING, mode_name="AUTO.LOITER"),
            command_long(300, 3),
            "resume, mission_set_current 3, mission_start",
        ),
        Row(A, air(), command_long(300, 3), "UNSUPPORTED: no items"),
        # Commander.cpp: switches to the mission and arms.  ArduCopter 4.7, recorded: ACCEPTED
        # disarmed, and nothing flies.  What is on board is verified before the motors run.
        Row(P, ground(), START, "mission_check, arm, mission_start"),
        Row(P, ground(armed=True), START, "mission_start"),
        Row(A, ground(), START, "mission_start"),
        Row(A, air(), command_long(300, 0, 5), "UNSUPPORTED"),  # GCS_Mavlink.cpp: DENIED
    ],
    "the current item": [
        # Whether there is such an item, and whether the vehicle stands, the station says.
        *(
            Row(BOTH, how, command_long(224, float(item)), f"mission_set_current {item}")
            for how in (ground(), air(mission_items=5))
            for item in (0, 4)
        ),
        Row(
            BOTH,
            air(MISSION, mission_items=5),
            command_long(224, 2),
            "hold, resume, mission_set_current 2, mission_start",
            "stopped first",
        ),
        Row(
            BOTH,
            air(MISSION, mission_items=5),
            command_long(224, 5),
            "BAD_MISSION: there is no item 5: the last one is 4",
        ),
        Row(
            BOTH,
            air(MISSION, mission_items=5, **MINE_NOT),
            command_long(224, 2),
            "mission_set_current 2",
        ),
        *(
            Row(BOTH, ground(), command_long(224, item), "UNSUPPORTED")
            for item in (-1, 0.5, NAN, 65536, 1e38)
        ),
    ],
    # MAVLink common: DO_LAND_START as a command lands with the mission's landing pattern.
    "a landing by the mission begins at its marker": [
        *(
            Row(
                BOTH,
                air(state, mission_items=9, land_starts=(6,)),
                SKIP,
                f"{before}mission_set_current 6, mission_start",
                "stopped first" if state is MISSION else "",
            )
            for state, before in (
                (State.HOVERING, ""),
                (HOLDING, "resume, "),
                (MISSION, "hold, resume, "),
            )
        ),
        Row(BOTH, air(mission_items=0, land_starts=(6,)), SKIP, "NO_MISSION"),
        Row(BOTH, air(mission_items=9), SKIP, "BAD_MISSION"),
        Row(BOTH, air(mission_items=9, land_starts=(3, 6)), SKIP, "UNSUPPORTED: items 3, 6"),
        Row(BOTH, air(mission_items=9, land_starts=(6,), on_ground=True), SKIP, "NOT_FLYING"),
    ],
    "what has no row": [
        Row(BOTH, air(), command_long(command), "UNSUPPORTED")
        for command in (16, 82, 177, 185, 208, 209, 3000, 65535)
    ],
}


@table(COMMANDS)
def test_what_a_command_asks_for(rows: Sequence[Row]) -> None:
    hold(rows)


@pytest.mark.parametrize("message", [arm(1.0), px4_mode("RTL")], ids=["arming", "a mode"])
def test_a_vehicle_that_cannot_be_commanded(message: Message) -> None:
    meaning = meaning_of(message, replace(flying(PX4), autopilot=GENERIC))
    assert refusal(meaning).startswith(Code.UNSUPPORTED_VEHICLE)
