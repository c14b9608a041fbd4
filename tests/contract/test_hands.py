"""Flown from outside: setpoints, sticks, camera, time, silence, keys, and many at once."""

from __future__ import annotations

import hashlib
import math

import pytest
from pymavlink.dialects.v20 import all as mavlink

from tests.contract.client import (
    ACCEPTED,
    BOTH,
    TEMPORARILY_REJECTED,
    UNIX_START_NS,
    Client,
    Message,
    Sky,
    connected,
)
from tests.contract.test_commands import mode, set_mode
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire.signing import EPOCH_UNIX_NS, SigningKey

either = pytest.mark.parametrize("personality", BOTH)

POSITION_ONLY = 0b110111111000
VELOCITY_ONLY = 0b110111000111
ATTITUDE_ONLY = 0b00000111


def local(frame: int, mask: int, *values: float) -> Message:
    """SET_POSITION_TARGET_LOCAL_NED with x, y, z, vx, vy, vz."""
    six = (*values, *(0.0,) * (6 - len(values)))
    return mavlink.MAVLink_set_position_target_local_ned_message(
        0, 1, 1, frame, mask, *six, 0, 0, 0, 0, 0
    )


def velocity(frame: int, north: float, east: float, down: float) -> Message:
    return local(frame, VELOCITY_ONLY, 0, 0, 0, north, east, down)


def stream(client: Client, message: Message, seconds: float) -> None:
    """At 20 Hz, as MAVSDK does."""
    for _ in range(round(seconds * 20)):
        client.send(message)
        client.sky.run(0.05)


def from_outside(client: Client, message: Message) -> None:
    """Enter OFFBOARD, or be in GUIDED."""
    if client.sky.personality == "px4":
        stream(client, message, 1.5)
        assert set_mode(client, "OFFBOARD") == [ACCEPTED]
        client.send(message)
        client.sky.run(0.1)
        assert client.sky.truth().mode == "OFFBOARD"


# -------------------------------------------------------------------------------- setpoints


@either
def test_setpoints_are_flown(personality: Personality) -> None:
    """SET_POSITION_TARGET_LOCAL_NED / GLOBAL_INT, SET_ATTITUDE_TARGET."""
    client = connected(personality)
    client.take_off(8.0)
    goal = local(1, POSITION_ONLY, 6.0, -4.0, -8.0)
    from_outside(client, goal)
    stream(client, goal, 10.0)
    assert client.sky.truth().pos_ned == pytest.approx((6.0, -4.0, -8.0), abs=1.5)

    lat, lon = client.sky.home.lat_deg, client.sky.home.lon_deg
    there = mavlink.MAVLink_set_position_target_global_int_message(
        0, 1, 1, 6, POSITION_ONLY, round(lat * 1e7), round(lon * 1e7), 10.0, *(0.0,) * 8
    )
    stream(client, there, 10.0)
    assert client.sky.truth().pos_ned == pytest.approx((0.0, 0.0, -10.0), abs=1.5)

    stream(client, velocity(1, 2.0, 0.0, 0.0), 4.0)
    assert client.sky.truth().v_ned == pytest.approx((2.0, 0.0, 0.0), abs=0.5)

    before = client.sky.truth()
    stream(client, local(10, POSITION_ONLY, 100.0, 0.0, -10.0), 0.5)
    assert client.sky.truth().v_ned[0] < before.v_ned[0] + 0.5, "terrain frames are refused"


@either
def test_body_frames_follow_the_nose(personality: Personality) -> None:
    client = connected(personality)
    client.take_off(8.0)
    forward = velocity(8, 2.0, 0.0, 0.0)
    if personality == "px4":
        home = client.sky.home
        x, y = round(home.lat_deg * 1e7), round(home.lon_deg * 1e7)
        east = client.int_(192, -1, 1, 0, math.pi / 2, x=x, y=y, z=8.0, frame=6)
    else:
        east = client.long(115, 90, 60, 1, 0)
    assert east == [ACCEPTED]
    client.sky.run(4.0)
    from_outside(client, forward)
    stream(client, forward, 4.0)
    assert client.sky.truth().v_ned[1] == pytest.approx(2.0, abs=0.6)


def test_ardupilot_takes_goals_as_offsets() -> None:
    client = connected("ardupilot")
    client.take_off(8.0)
    client.send(local(7, POSITION_ONLY, 5.0, 0.0, 0.0))
    client.sky.run(8.0)
    assert client.sky.truth().pos_ned == pytest.approx((5.0, 0.0, -8.0), abs=1.5)


@either
def test_attitude_is_flown(personality: Personality) -> None:
    client = connected(personality)
    client.take_off(15.0)
    half = math.radians(8.0) / 2.0
    thrust = 0.5 if personality == "ardupilot" else 0.45
    lean = mavlink.MAVLink_set_attitude_target_message(
        0, 1, 1, ATTITUDE_ONLY, (math.cos(half), 0.0, -math.sin(half), 0.0), 0, 0, 0, thrust
    )
    from_outside(client, lean)
    stream(client, lean, 1.5)
    _, _, y, _ = client.sky.truth().q_ned_from_frd
    assert y == pytest.approx(-math.sin(half), abs=0.03)


def test_px4_wants_a_proven_stream_and_leaves_offboard_without_it() -> None:
    client = connected("px4")
    client.take_off(8.0)
    hold = velocity(1, 1.0, 0.0, 0.0)
    set_mode(client, "OFFBOARD")
    client.sky.run(0.5)
    assert client.sky.truth().mode != "OFFBOARD"
    stream(client, hold, 1.5)
    assert set_mode(client, "OFFBOARD") == [ACCEPTED]
    client.send(hold)
    client.sky.run(0.2)
    assert client.sky.truth().mode == "OFFBOARD"
    client.sky.run(3.0)
    assert client.sky.truth().mode != "OFFBOARD"


def test_ardupilots_velocity_lasts_three_seconds() -> None:
    client = connected("ardupilot")
    client.take_off(8.0)
    stream(client, velocity(1, 3.0, 0.0, 0.0), 3.0)
    client.sky.run(2.0)
    assert client.sky.truth().v_ned[0] == pytest.approx(3.0, abs=0.5)
    client.sky.run(4.0)
    assert client.sky.truth().v_ned[0] == pytest.approx(0.0, abs=0.4)
    assert mode(client) == "GUIDED"


# ------------------------------------------------------------------------------------ sticks


@either
def test_sticks_are_flown_and_their_loss_is_noticed(personality: Personality) -> None:
    """MANUAL_CONTROL, RC_CHANNELS_OVERRIDE."""
    alone = {"SIM_RC_FAIL": 1.0} if personality == "ardupilot" else {}
    client = connected(personality, parameters=alone)
    client.take_off(10.0)
    centred = mavlink.MAVLink_manual_control_message(1, 0, 0, 500, 0, 0)
    forward = mavlink.MAVLink_manual_control_message(1, 600, 0, 500, 0, 0)
    stream(client, centred, 0.5)
    name = "POSCTL" if personality == "px4" else "LOITER"
    assert set_mode(client, name) == [ACCEPTED]
    stream(client, forward, 3.0)
    assert math.hypot(*client.sky.truth().v_ned[:2]) > 1.5
    client.sky.run(5.0)
    assert client.sky.truth().mode != name, "lost sticks are a failsafe"


def test_ardupilots_receiver_is_heard_after_the_sticks_and_no_loss_is_noticed() -> None:
    """As recorded (B5): its throttle at the bottom sinks a LOITER by 2.5 m/s."""
    client = connected("ardupilot")
    client.take_off(20.0)
    centred = mavlink.MAVLink_manual_control_message(1, 0, 0, 500, 0, 0)
    stream(client, centred, 0.5)
    assert set_mode(client, "LOITER") == [ACCEPTED]
    stream(client, centred, 3.0)
    assert -client.sky.truth().pos_ned[2] == pytest.approx(20.0, abs=0.5)
    client.forget()
    client.sky.run(6.0)
    assert client.sky.truth().v_ned[2] == pytest.approx(2.5, abs=0.1)
    assert mode(client) == "LOITER"
    assert not [each.text for each in client.all("STATUSTEXT") if "Failsafe" in each.text]


def test_overridden_channels_fly_ardupilot() -> None:
    client = connected("ardupilot")
    client.take_off(10.0)
    assert set_mode(client, "LOITER") == [ACCEPTED]
    pushed = mavlink.MAVLink_rc_channels_override_message(1, 1, 1500, 1300, 1500, 1500, 0, 0, 0, 0)
    stream(client, pushed, 3.0)
    assert client.sky.truth().v_ned[0] > 1.0 or math.hypot(*client.sky.truth().v_ned[:2]) > 1.0
    told = client.request_message(65)[1][0]
    assert told.chan2_raw == 1300


# ------------------------------------------------------------------------------------ camera


@either
def test_a_picture_takes_its_time_and_is_told(personality: Personality) -> None:
    """IMAGE_START_CAPTURE (2000)."""
    client = connected(personality)
    client.take_off(6.0)
    client.forget()
    assert client.long(2000, 0, 0, 1) == [ACCEPTED]
    assert client.long(2000, 0, 0, 3) == [TEMPORARILY_REJECTED]
    asked_s = client.sky.now_ns / 1e9
    client.sky.run(0.2)
    assert client.request_message(262)[1][0].image_status == 1
    client.sky.run(4.0, lambda: bool(client.all("CAMERA_IMAGE_CAPTURED")))
    (at_s,) = [
        each.at_s for each in client.heard if each.message.get_type() == "CAMERA_IMAGE_CAPTURED"
    ]
    assert at_s - asked_s == pytest.approx(2.0, abs=0.2)
    picture = client.last("CAMERA_IMAGE_CAPTURED")
    assert (picture.capture_result, picture.image_index) == (1, 0)
    assert picture.relative_alt / 1e3 == pytest.approx(6.0, abs=1.0)
    assert bool(client.all("CAMERA_FEEDBACK")) == (personality == "ardupilot")
    for number in (259, 260, 262):
        assert client.request_message(number)[0] == ACCEPTED
    assert client.request_message(262)[1][0].image_count == 1
    assert client.request_message(263, 0)[1][0].image_index == 0
    assert client.long(2000, 0, 0.5, 0) == [ACCEPTED]
    client.sky.run(7.0)
    assert client.long(2001) == [ACCEPTED]
    client.sky.run(3.0)
    count = len(client.all("CAMERA_IMAGE_CAPTURED"))
    client.sky.run(5.0)
    assert count == len(client.all("CAMERA_IMAGE_CAPTURED")) >= 3


# -------------------------------------------------------------------------- time and silence


@either
def test_time_is_echoed(personality: Personality) -> None:
    """TIMESYNC, PING."""
    client = connected(personality)
    (sync,) = client.send(mavlink.MAVLink_timesync_message(0, 123_456_789))
    assert sync.ts1 == 123_456_789
    assert sync.tc1 == pytest.approx(client.sky.now_ns, abs=10_000_000)
    (pong,) = client.send(mavlink.MAVLink_ping_message(77, 5, 0, 0))
    assert (pong.time_usec, pong.seq) == (77, 5)
    assert (pong.target_system, pong.target_component) == (255, 190)


@either
def test_a_silent_station_leads_to_what_the_parameter_says(personality: Personality) -> None:
    """heartbeats of the ground station stop."""
    settings = {"NAV_DLL_ACT": 2.0} if personality == "px4" else {"FS_GCS_ENABLE": 1.0}
    client = connected(personality, parameters=settings)
    client.take_off(8.0)
    before = client.sky.truth().mode
    client.beats = False
    client.sky.run(4.0)
    assert client.sky.truth().mode == before
    client.sky.run(20.0)
    assert client.sky.truth().mode == ("AUTO.RTL" if personality == "px4" else "RTL")


@either
def test_without_the_parameter_silence_changes_nothing(personality: Personality) -> None:
    client = connected(personality)
    client.take_off(8.0)
    before = client.sky.truth().mode
    client.beats = False
    client.sky.run(40.0)
    assert client.sky.truth().mode == before


# -------------------------------------------------------------------------- keys and fleets


@either
def test_who_does_not_sign_is_not_heard(personality: Personality) -> None:
    """signing set up."""
    secret = hashlib.sha256(b"open sesame").digest()
    sky = Sky(personality, signing=SigningKey(secret))
    client = sky.client()
    stranger = sky.client("stranger", system=254)
    client.mav.signing.secret_key = secret
    client.mav.signing.sign_outgoing = True
    client.mav.signing.timestamp = (UNIX_START_NS - EPOCH_UNIX_NS) // 10_000
    client.beat_if_due()
    sky.run(2.0)
    assert client.all("HEARTBEAT")
    assert all(each.message.get_signed() for each in client.heard)
    # pymavlink checks what it receives by the same key, and counts time up with each frame.
    assert client.long(511, 30, 1e5) == [ACCEPTED]
    assert stranger.long(511, 30, 1e5) == []
    kept = bytes(
        mavlink.MAVLink_command_long_message(1, 1, 511, 0, 31, 1e5, 0, 0, 0, 0, 0).pack(client.mav)
    )
    assert client.send_raw(kept)
    assert client.send_raw(kept) == [], "a replayed timestamp"


@either
def test_many_vehicles_share_a_port(personality: Personality) -> None:
    """more vehicles."""
    sky = Sky(personality, count=3)
    client = sky.client()
    client.beat_if_due()
    sky.run(3.0)
    # pymavlink knows no EVENT (410) and CURRENT_EVENT_SEQUENCE (411), and tells not who sent them.
    known = [each.message for each in client.heard if each.message.get_type()[:7] != "UNKNOWN"]
    assert {each.get_srcSystem() for each in known} == {1, 2, 3}
    if personality == "ardupilot":
        assert client.long(176, 1, 4, target=2) == [ACCEPTED]
    assert client.long(400, 1, target=2) == [ACCEPTED]
    sky.run(1.0)
    assert [sky.truth(system).armed for system in (1, 2, 3)] == [False, True, False]
    client.forget()
    assert client.long(410, target=0) == [ACCEPTED] * 3
    assert len(client.all("HOME_POSITION")) == 3
