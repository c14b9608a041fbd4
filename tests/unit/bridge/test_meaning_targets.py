"""Setpoints and single items in every frame and mask, as MAVSDK, DroneKit, MAVProxy and
QGroundControl send them.

Which frames and masks an autopilot flies: `mavlink_receiver.cpp` of PX4 1.14 and `GCS_Mavlink.cpp`
of ArduCopter 4.5 to 4.7, read for these tests.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from pymavlink.dialects.v20 import all as mavlink

from gcs.gate.states import State
from gcs.wire.messages import Message
from tests.unit.bridge.rows import BOTH, A, P, Row, air, hold, table
from tests.unit.bridge.vehicles import NAN, sent

LOCAL_NED, LOCAL_OFFSET, BODY, BODY_OFFSET = 1, 7, 8, 9
GLOBAL, GLOBAL_INT, RELATIVE, RELATIVE_INT, TERRAIN, TERRAIN_INT = 0, 5, 3, 6, 10, 11

# MAV_POSITION_TARGET_TYPEMASK: a set bit is ignored.
POSITION = 0b110111111000  # 3576, as DroneKit and MAVProxy send it
VELOCITY = 0b110111000111
ACCELERATION = 0b110000111111
POSITION_VELOCITY = 0b110111000000
POSITION_ACCELERATION = 0b110000111000
ALL_THREE = 0b110000000000
YAW_GIVEN, YAW_RATE_GIVEN = ~0b010000000000, ~0b100000000000
FORCE = 0b001000000000
NOTHING = 0b110111111111
BAD = (NAN, math.inf, -math.inf)
NANS = (NAN, NAN, NAN)
Triple = tuple[float, float, float]
ZERO: Triple = (0.0, 0.0, 0.0)
HERE, NORTHWARD, LITTLE = (4, 5, -20), (1, 0, 0), (0.5, 0, 0)
LAT, LON = 47.398742, 8.545594
"""0.001 degrees north of the origin of `flying`."""


def local(
    mask: int,
    place: Triple = ZERO,
    velocity: Triple = ZERO,
    acceleration: Triple = ZERO,
    yaw: float = 0.0,
    yaw_rate: float = 0.0,
    frame: int = LOCAL_NED,
) -> Message:
    return sent(
        mavlink.MAVLink_set_position_target_local_ned_message(
            0, 1, 1, frame, mask, *place, *velocity, *acceleration, yaw, yaw_rate
        )
    )


def on_the_map(
    mask: int, place: Triple = ZERO, velocity: Triple = ZERO, frame: int = RELATIVE_INT
) -> Message:
    """Degrees, degrees, metres."""
    lat, lon = round(place[0] * 1e7), round(place[1] * 1e7)
    return sent(
        mavlink.MAVLink_set_position_target_global_int_message(
            0, 1, 1, frame, mask, lat, lon, place[2], *velocity, *[0.0] * 5
        )
    )


def item(
    current: int, frame: int = 3, lat: float = LAT, alt: float = 5.0, command: int = 16
) -> Message:
    """DroneKit's `simple_goto` and MAVProxy's `guided`: NAV_WAYPOINT, `current` 2."""
    head = (1, 1, 0, frame, command, current, 0, 0, 0, 0, 0)
    return sent(mavlink.MAVLink_mission_item_message(*head, lat, LON, alt))


EXACT_ITEM = sent(
    mavlink.MAVLink_mission_item_int_message(
        1, 1, 0, 6, 16, 2, 0, 0, 0, 0, 0, round(LAT * 1e7), round(LON * 1e7), 5.0
    )
)
TARGETS = {
    "in the local frame": [
        Row(BOTH, air(), local(VELOCITY, velocity=(3, -1, 0.5)), "sample v 3 -1 0.5"),
        # Yaw and yaw rate come with it where the mask leaves them.
        Row(
            BOTH,
            air(),
            local(VELOCITY & YAW_GIVEN, velocity=NORTHWARD, yaw=1.5),
            "sample v 1 0 0 yaw 1.5",
        ),
        Row(
            BOTH,
            air(),
            local(VELOCITY & YAW_RATE_GIVEN, velocity=NORTHWARD, yaw_rate=0.25),
            "sample v 1 0 0 rate 0.25",
        ),
        Row(
            BOTH,
            air(),
            local(POSITION_VELOCITY, HERE, NORTHWARD),
            "sample pos 4 5 -20 v 1 0 0",
        ),
        Row(
            BOTH,
            air(),
            local(ALL_THREE, HERE, NORTHWARD, LITTLE),
            "sample pos 4 5 -20 v 1 0 0 a 0.5 0 0",
        ),
        Row(BOTH, air(), local(ACCELERATION, acceleration=LITTLE), "sample a 0.5 0 0"),
        Row(
            P,
            air(),
            local(POSITION_ACCELERATION, HERE, acceleration=LITTLE),
            "sample pos 4 5 -20 a 0.5 0 0",
        ),
        Row(A, air(), local(POSITION_ACCELERATION, HERE, acceleration=LITTLE), "UNSUPPORTED"),
    ],
    # ArduCopter's GUIDED flies on to a position that came once; PX4's OFFBOARD falls back.
    "a position is a sample to PX4 and a go-to to ArduPilot": [
        Row(
            P,
            air(),
            local(POSITION & YAW_GIVEN, HERE, yaw=math.pi / 2),
            "sample pos 4 5 -20 yaw 1.5708",
        ),
        Row(
            A,
            air(),
            local(POSITION & YAW_GIVEN, HERE, yaw=math.pi / 2),
            "goto 5 4 20 yaw 90 / sample pos 4 5 -20 yaw 1.5708",
        ),
        # GCS_Mavlink.cpp: outside GUIDED such a message is not read.
        Row(A, air(State.HOLDING), local(POSITION, HERE), "goto 5 4 20 / sample pos 4 5 -20"),
    ],
    # It points east: forward is east, right is south; down stays down.
    "in the body frame": [
        Row(
            BOTH,
            air(),
            local(VELOCITY, velocity=(3, 1, 0.5), frame=BODY),
            "sample v -1 3 0.5",
        ),
        Row(
            BOTH, air(yaw_rad=None), local(VELOCITY, velocity=NORTHWARD, frame=BODY), "NO_POSITION"
        ),
        # 10 m forward and 2 m up, from (1, 2, -22); yaw is relative.
        *(
            Row(
                A,
                air(),
                local(POSITION & YAW_GIVEN, (10, 0, -2), yaw=math.pi / 4, frame=frame),
                "goto 12 1 24 yaw 135 / sample pos 1 12 -24 yaw 2.35619",
            )
            for frame in (BODY, BODY_OFFSET)
        ),
        # QGroundControl changes ArduPilot's height so, with type_mask 0xFFF8 (from memory).
        Row(
            A,
            air(),
            local(0xFFF8, (0, 0, -5), frame=LOCAL_OFFSET),
            "goto 2 1 27 / sample pos 1 2 -27",
        ),
        Row(A, air(pos_ned=None), local(0xFFF8, (0, 0, -5), frame=LOCAL_OFFSET), "NO_POSITION"),
        Row(P, air(), local(POSITION_VELOCITY, NORTHWARD, NORTHWARD, frame=BODY), "UNSUPPORTED"),
        # PX4's yaw is from north in the body frame too.
        Row(
            P,
            air(),
            local(VELOCITY & YAW_GIVEN, velocity=NORTHWARD, yaw=0.5, frame=BODY),
            "sample v 0 1 0 yaw 0.5",
        ),
    ],
    "frames that are not flown": [
        Row(who, air(), local(VELOCITY, velocity=NORTHWARD, frame=f), f"UNSUPPORTED: frame {f}")
        for who, frames in (
            (P, (LOCAL_OFFSET, BODY_OFFSET)),
            (BOTH, (0, 2, 3, 4, 6, 12, 20, 255)),
        )
        for f in frames
    ],
    "masks": [
        Row(BOTH, air(), local(ACCELERATION | FORCE, acceleration=NORTHWARD), "UNSUPPORTED: force"),
        Row(BOTH, air(), local(VELOCITY | FORCE, velocity=NORTHWARD), "sample v 1 0 0"),
        *(
            Row(BOTH, air(), local(mask), "UNSUPPORTED: nothing to fly to")
            for mask in (NOTHING, NOTHING & YAW_GIVEN, 0xFFFF)
        ),
        # PX4 leaves such an axis uncontrolled; ArduPilot ignores the whole triple.
        *(
            Row(
                BOTH,
                air(),
                local(ALL_THREE | 1 << bit, HERE, NORTHWARD, LITTLE),
                "UNSUPPORTED: single axes",
            )
            for bit in range(9)
        ),
        # MAVSDK fills what it does not use with NaN or zero.
        Row(
            BOTH,
            air(),
            local(VELOCITY, NANS, NORTHWARD, NANS, yaw=NAN, yaw_rate=NAN),
            "sample v 1 0 0",
        ),
    ],
    "numbers that are none": [
        Row(BOTH, air(), message, "NON_FINITE")
        for bad in BAD
        for message in (
            local(VELOCITY, velocity=(0, bad, 0)),
            local(POSITION, (0, 0, bad)),
            on_the_map(POSITION, (47.397742, LON, bad)),
        )
    ],
    # PX4 1.14 takes NaN as no heading, as mavpilot 0.3.0 sends it; an infinite one it may fly.
    "a heading that is no number": [
        Row(who, air(), message, asks_for)
        for who, bad, asks_for in (
            (P, NAN, "sample v 1 0 0"),
            (A, NAN, "NON_FINITE"),
            (BOTH, math.inf, "NON_FINITE"),
            (BOTH, -math.inf, "NON_FINITE"),
        )
        for message in (
            local(VELOCITY & YAW_GIVEN, velocity=NORTHWARD, yaw=bad),
            local(VELOCITY & YAW_RATE_GIVEN, velocity=NORTHWARD, yaw_rate=bad),
        )
    ],
    # 111.19 m north by PX4's sphere, 111.32 m by ArduPilot's factor; 5 m above home is 17 m above
    # the origin.
    "a place on the map": [
        *(
            row
            for frame, alt_m in ((GLOBAL_INT, 505), (RELATIVE_INT, 5))
            for place in (on_the_map(POSITION, (LAT, LON, alt_m), frame=frame),)
            for row in (
                Row(P, air(), place, "sample pos 111.195 0 -17"),
                Row(A, air(), place, "goto 0 111.319 17 / sample pos 111.319 0 -17"),
            )
        ),
        # ArduPilot takes the frames without INT too, PX4 does not.
        *(
            row
            for frame, alt_m in ((GLOBAL, 505), (RELATIVE, 5))
            for place in (on_the_map(POSITION, (LAT, LON, alt_m), frame=frame),)
            for row in (
                Row(A, air(), place, "goto 0 111.319 17 / sample pos 111.319 0 -17"),
                Row(P, air(), place, "UNSUPPORTED"),
            )
        ),
        *(
            Row(BOTH, air(), on_the_map(POSITION, (LAT, LON, 5), frame=frame), "UNSUPPORTED")
            for frame in (TERRAIN, TERRAIN_INT, LOCAL_NED, BODY, 255)
        ),
        Row(BOTH, air(), on_the_map(VELOCITY, velocity=(1, 2, -0.5)), "sample v 1 2 -0.5"),
        Row(BOTH, air(origin=None), on_the_map(POSITION, (LAT, LON, 5)), "NO_ORIGIN"),
        Row(
            BOTH,
            air(home_ned=None, home_amsl_m=None),
            on_the_map(POSITION, (LAT, LON, 5)),
            "NO_ORIGIN",
        ),
        Row(BOTH, air(), on_the_map(POSITION, (100, 8, 5)), "BAD_PARAMETER: no place on the map"),
    ],
    "a guided item of an ArduPilot is a go-to": [
        Row(A, air(), EXACT_ITEM, "goto 0 111.319 17"),
        Row(A, air(), item(2), "goto 0.0162 111.394 17"),  # a float32 is good to 0.4 m
        # ArduCopter: "only process guided waypoint if we are in guided mode" (its mode_auto).
        Row(A, air(State.HOLDING), EXACT_ITEM, "goto 0 111.319 17"),
        # `current` 3 is another height.
        Row(A, air(), item(3, alt=8), "goto 2 1 20"),
        Row(A, air(State.MOVING, goal_ned=(30, 40, -22)), item(3, alt=8), "goto 40 30 20"),
    ],
    "items that are no go-to": [
        Row(P, air(), item(2), "UNSUPPORTED"),
        Row(A, air(), item(2, frame=10), "UNSUPPORTED"),
        Row(A, air(), item(0), "BAD_MISSION"),
        Row(A, air(), item(2, lat=NAN), "NON_FINITE"),
        Row(A, air(), item(2, alt=NAN), "NON_FINITE"),
        Row(A, air(), item(2, command=21), "UNSUPPORTED"),
        Row(P, air(), sent(mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)), "UNSUPPORTED"),
    ],
}


@table(TARGETS)
def test_what_a_setpoint_or_an_item_asks_for(rows: Sequence[Row]) -> None:
    hold(rows)
