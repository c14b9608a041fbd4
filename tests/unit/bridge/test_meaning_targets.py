"""Setpoints in every frame and mask, as MAVSDK, DroneKit, MAVProxy and QGroundControl send them.

Which frames and masks an autopilot flies: `mavlink_receiver.cpp` of PX4 1.14 and `GCS_Mavlink.cpp`
of ArduCopter 4.5 to 4.7, read for these tests.
"""

from __future__ import annotations

import math

import pytest
from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.translate.meaning import Sample, Words
from gcs.bridge.translate.translate import meaning_of
from gcs.gate.states import State
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.wire.messages import Message
from tests.unit.bridge.vehicles import NAN, flying, goal, refusal, sent, words

BOTH = pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT], ids=lambda a: a.name)

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
EVERYTHING_IGNORED = 0b110111111111


def local(
    mask: int,
    place: tuple[float, float, float] = (0.0, 0.0, 0.0),
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0),
    acceleration: tuple[float, float, float] = (0.0, 0.0, 0.0),
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
    mask: int,
    lat_deg: float = 0.0,
    lon_deg: float = 0.0,
    alt_m: float = 0.0,
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0),
    frame: int = RELATIVE_INT,
) -> Message:
    lat, lon = round(lat_deg * 1e7), round(lon_deg * 1e7)
    return sent(
        mavlink.MAVLink_set_position_target_global_int_message(
            0, 1, 1, frame, mask, lat, lon, alt_m, *velocity, 0.0, 0.0, 0.0, 0.0, 0.0
        )
    )


def sample(meaning: object) -> Sample:
    if isinstance(meaning, Words):
        assert meaning.if_repeated is not None
        return meaning.if_repeated
    assert isinstance(meaning, Sample), meaning
    return meaning


# ------------------------------------------------------------------------------- local frame


@BOTH
def test_velocity_in_the_local_frame(autopilot: Autopilot) -> None:
    meaning = meaning_of(local(VELOCITY, velocity=(3.0, -1.0, 0.5)), flying(autopilot))
    assert meaning == Sample(v_ned=(3.0, -1.0, 0.5))


@BOTH
def test_yaw_and_yaw_rate_come_with_it_where_the_mask_leaves_them(autopilot: Autopilot) -> None:
    velocity = (3.0, 0.0, 0.0)
    yaw = meaning_of(local(VELOCITY & YAW_GIVEN, velocity=velocity, yaw=1.5), flying(autopilot))
    assert yaw == Sample(v_ned=velocity, yaw_rad=1.5)
    turning = local(VELOCITY & YAW_RATE_GIVEN, velocity=velocity, yaw_rate=0.25)
    assert meaning_of(turning, flying(autopilot)) == Sample(v_ned=velocity, yaw_rate_rad_s=0.25)


@BOTH
def test_position_and_velocity_and_acceleration(autopilot: Autopilot) -> None:
    place, velocity, acceleration = (4.0, 5.0, -20.0), (1.0, 0.0, 0.0), (0.5, 0.0, 0.0)
    both = local(POSITION_VELOCITY, place, velocity)
    assert meaning_of(both, flying(autopilot)) == Sample(place, velocity)
    three = local(ALL_THREE, place, velocity, acceleration)
    assert meaning_of(three, flying(autopilot)) == Sample(place, velocity, acceleration)
    alone = local(ACCELERATION, acceleration=acceleration)
    assert meaning_of(alone, flying(autopilot)) == Sample(a_ned=acceleration)


def test_position_with_acceleration_alone_is_not_ardupilots() -> None:
    message = local(POSITION_ACCELERATION, (4.0, 5.0, -20.0), acceleration=(0.5, 0.0, 0.0))
    assert sample(meaning_of(message, flying(PX4))).a_ned == (0.5, 0.0, 0.0)
    assert refusal(meaning_of(message, flying(ARDUPILOT))).startswith("UNSUPPORTED")


def test_a_position_is_a_sample_to_px4_and_a_go_to_to_ardupilot() -> None:
    """ArduCopter's GUIDED flies on to a position that came once; PX4's OFFBOARD falls back."""
    message = local(POSITION & YAW_GIVEN, (4.0, 5.0, -20.0), yaw=math.pi / 2)
    stream = Sample((4.0, 5.0, -20.0), yaw_rad=pytest.approx(math.pi / 2))  # type: ignore[arg-type]
    assert meaning_of(message, flying(PX4)) == stream
    once = meaning_of(message, flying(ARDUPILOT))
    assert goal(once) == (5.0, 4.0, 20.0)
    assert isinstance(once, Words)
    assert once.asks[0].yaw_deg == pytest.approx(90.0, abs=1e-4)
    assert once.if_repeated == stream


def test_ardupilots_go_to_does_not_leave_a_hold() -> None:
    """GCS_Mavlink.cpp: outside GUIDED such a message is not read."""
    held = flying(ARDUPILOT, state=State.HOLDING)
    assert words(meaning_of(local(POSITION, (4.0, 5.0, -20.0)), held)) == ["goto"]


# -------------------------------------------------------------------------------- body frame


@BOTH
def test_velocity_in_the_body_frame_turns_with_the_nose(autopilot: Autopilot) -> None:
    """It points east: forward is east, right is south; down stays down."""
    message = local(VELOCITY, velocity=(3.0, 1.0, 0.5), frame=BODY)
    flown = sample(meaning_of(message, flying(autopilot)))
    assert flown.v_ned == pytest.approx((-1.0, 3.0, 0.5), abs=1e-6)


@BOTH
def test_the_body_frame_needs_a_heading(autopilot: Autopilot) -> None:
    message = local(VELOCITY, velocity=(3.0, 1.0, 0.5), frame=BODY)
    assert refusal(meaning_of(message, flying(autopilot, yaw_rad=None))).startswith("NO_POSITION")


@pytest.mark.parametrize("frame", [BODY, BODY_OFFSET])
def test_ardupilots_body_positions_count_from_here_and_turn_with_the_nose(frame: int) -> None:
    """10 m forward and 2 m up, from (1, 2, -22), facing east; yaw is relative."""
    message = local(POSITION & YAW_GIVEN, (10.0, 0.0, -2.0), yaw=math.pi / 4, frame=frame)
    meaning = meaning_of(message, flying(ARDUPILOT))
    assert goal(meaning) == pytest.approx((12.0, 1.0, 24.0), abs=1e-5)
    assert isinstance(meaning, Words)
    assert meaning.asks[0].yaw_deg == pytest.approx(135.0, abs=1e-4)


def test_ardupilots_offset_positions_count_from_here() -> None:
    """QGroundControl changes ArduPilot's height so, with type_mask 0xFFF8 (from memory)."""
    message = local(0xFFF8, (0.0, 0.0, -5.0), frame=LOCAL_OFFSET)
    assert goal(meaning_of(message, flying(ARDUPILOT))) == (2.0, 1.0, 27.0)
    unknown = flying(ARDUPILOT, pos_ned=None)
    assert refusal(meaning_of(message, unknown)).startswith("NO_POSITION")


def test_px4_flies_no_position_in_the_body_frame() -> None:
    message = local(POSITION_VELOCITY, (1.0, 0.0, 0.0), (1.0, 0.0, 0.0), frame=BODY)
    assert refusal(meaning_of(message, flying(PX4))).startswith("UNSUPPORTED")


def test_px4s_yaw_is_from_north_in_the_body_frame_too() -> None:
    message = local(VELOCITY & YAW_GIVEN, velocity=(1.0, 0.0, 0.0), yaw=0.5, frame=BODY)
    assert sample(meaning_of(message, flying(PX4))).yaw_rad == 0.5


@pytest.mark.parametrize(
    ("autopilot", "frame"),
    [
        (PX4, LOCAL_OFFSET),
        (PX4, BODY_OFFSET),
        *(
            (autopilot, frame)
            for autopilot in (PX4, ARDUPILOT)
            for frame in (0, 2, 3, 4, 6, 12, 20, 255)
        ),
    ],
)
def test_frames_that_are_not_flown(autopilot: Autopilot, frame: int) -> None:
    message = local(VELOCITY, velocity=(1.0, 0.0, 0.0), frame=frame)
    assert f"frame {frame}" in refusal(meaning_of(message, flying(autopilot)))


# ------------------------------------------------------------------------------------- masks


@BOTH
def test_a_force_is_refused_but_its_bit_alone_means_nothing(autopilot: Autopilot) -> None:
    force = local(ACCELERATION | FORCE, acceleration=(1.0, 0.0, 0.0))
    assert "force" in refusal(meaning_of(force, flying(autopilot)))
    bit = local(VELOCITY | FORCE, velocity=(1.0, 0.0, 0.0))
    assert meaning_of(bit, flying(autopilot)) == Sample(v_ned=(1.0, 0.0, 0.0))


@BOTH
@pytest.mark.parametrize("mask", [EVERYTHING_IGNORED, EVERYTHING_IGNORED & YAW_GIVEN, 0xFFFF])
def test_a_mask_that_leaves_nothing_to_fly_to(autopilot: Autopilot, mask: int) -> None:
    assert "nothing to fly to" in refusal(meaning_of(local(mask), flying(autopilot)))


@BOTH
@pytest.mark.parametrize("bit", range(9))
def test_single_axes_are_refused(autopilot: Autopilot, bit: int) -> None:
    """PX4 leaves such an axis uncontrolled; ArduPilot ignores the whole triple."""
    message = local(ALL_THREE | 1 << bit, (4.0, 5.0, -20.0), (1.0, 0.0, 0.0), (0.5, 0.0, 0.0))
    assert "single axes" in refusal(meaning_of(message, flying(autopilot)))


@BOTH
@pytest.mark.parametrize("bad", [NAN, math.inf, -math.inf])
def test_numbers_that_are_none(autopilot: Autopilot, bad: float) -> None:
    seen = flying(autopilot)
    for message in (
        local(VELOCITY, velocity=(0.0, bad, 0.0)),
        local(POSITION, (0.0, 0.0, bad)),
        on_the_map(POSITION, 47.397742, 8.545594, bad),
    ):
        assert refusal(meaning_of(message, seen)).startswith("NON_FINITE")


@BOTH
@pytest.mark.parametrize("bad", [NAN, math.inf, -math.inf])
def test_a_heading_that_is_no_number(autopilot: Autopilot, bad: float) -> None:
    """PX4 1.14 takes NaN as no heading, as mavpilot 0.3.0 sends it; an infinite one it may fly."""
    for message in (
        local(VELOCITY & YAW_GIVEN, velocity=(1.0, 0.0, 0.0), yaw=bad),
        local(VELOCITY & YAW_RATE_GIVEN, velocity=(1.0, 0.0, 0.0), yaw_rate=bad),
    ):
        meaning = meaning_of(message, flying(autopilot))
        if autopilot is PX4 and math.isnan(bad):
            assert meaning == Sample(v_ned=(1.0, 0.0, 0.0))
        else:
            assert refusal(meaning).startswith("NON_FINITE")


@BOTH
def test_what_is_ignored_may_be_anything(autopilot: Autopilot) -> None:
    """MAVSDK fills what it does not use with NaN or zero."""
    nans = (NAN, NAN, NAN)
    message = local(VELOCITY, nans, (1.0, 0.0, 0.0), nans, yaw=NAN, yaw_rate=NAN)
    assert meaning_of(message, flying(autopilot)) == Sample(v_ned=(1.0, 0.0, 0.0))


# ------------------------------------------------------------------------------- on the map


@BOTH
@pytest.mark.parametrize(("frame", "alt_m"), [(GLOBAL_INT, 505.0), (RELATIVE_INT, 5.0)])
def test_a_place_on_the_map(autopilot: Autopilot, frame: int, alt_m: float) -> None:
    """111.19 m north by PX4's sphere (0.001 degrees), 111.32 m by ArduPilot's factor; 5 m above
    home is 17 m above the origin."""
    north_m = {"px4": 111.1949, "ardupilot": 111.3188}[autopilot.name]
    message = on_the_map(POSITION, 47.398742, 8.545594, alt_m, frame=frame)
    flown = sample(meaning_of(message, flying(autopilot)))
    assert flown.pos_ned == pytest.approx((north_m, 0.0, -17.0), abs=0.01)


def test_ardupilot_takes_the_frames_without_int_too_px4_does_not() -> None:
    for frame, alt_m in ((GLOBAL, 505.0), (RELATIVE, 5.0)):
        message = on_the_map(POSITION, 47.398742, 8.545594, alt_m, frame=frame)
        assert goal(meaning_of(message, flying(ARDUPILOT)))[2] == pytest.approx(17.0)
        assert refusal(meaning_of(message, flying(PX4))).startswith("UNSUPPORTED")


@BOTH
@pytest.mark.parametrize("frame", [TERRAIN, TERRAIN_INT, LOCAL_NED, BODY, 255])
def test_places_in_frames_that_cannot_be_verified(autopilot: Autopilot, frame: int) -> None:
    message = on_the_map(POSITION, 47.398742, 8.545594, 5.0, frame=frame)
    assert refusal(meaning_of(message, flying(autopilot))).startswith("UNSUPPORTED")


@BOTH
def test_velocities_on_the_map_are_north_east_down(autopilot: Autopilot) -> None:
    message = on_the_map(VELOCITY, velocity=(1.0, 2.0, -0.5))
    assert meaning_of(message, flying(autopilot)) == Sample(v_ned=(1.0, 2.0, -0.5))


@BOTH
def test_a_place_on_the_map_needs_the_origin(autopilot: Autopilot) -> None:
    message = on_the_map(POSITION, 47.398742, 8.545594, 5.0)
    assert refusal(meaning_of(message, flying(autopilot, origin=None))).startswith("NO_ORIGIN")
    homeless = flying(autopilot, home_ned=None, home_amsl_m=None)
    assert refusal(meaning_of(message, homeless)).startswith("NO_ORIGIN")


@BOTH
def test_no_place_on_the_map(autopilot: Autopilot) -> None:
    message = on_the_map(POSITION, 100.0, 8.0, 5.0)
    assert "no place on the map" in refusal(meaning_of(message, flying(autopilot)))
