"""Commands: one final ack for every frame, and the change that it promises."""

from __future__ import annotations

import math

import pytest
from pymavlink.dialects.v20 import all as mavlink

from tests.contract.client import (
    ACCEPTED,
    BOTH,
    DENIED,
    FAILED,
    IN_PROGRESS,
    NAN,
    TEMPORARILY_REJECTED,
    UNSUPPORTED,
    UNSUPPORTED_MAV_FRAME,
    Client,
    S,
    Sky,
    connected,
)
from vehicle_sim.autopilot.modes import MODES, Personality
from vehicle_sim.services.profile import PROFILES

either = pytest.mark.parametrize("personality", BOTH)

NEVER_ENDED = {"px4": {212}, "ardupilot": set[int]()}
"""DO_AUTOTUNE_ENABLE: the one ack that was recorded of a PX4 is IN_PROGRESS; no tuning follows."""
UNHEARD_AS_SENT = {"px4": {310}, "ardupilot": set[int]()}
"""ACTUATOR_TEST of no actuator: recorded of a PX4, which answers others."""


def mode(client: Client) -> str:
    """The mode that the last heartbeat tells, by the autopilot's own name."""
    number = client.last("HEARTBEAT").custom_mode
    known = MODES[client.sky.personality].values()
    return next(each.name for each in known if each.custom_mode == number)


def set_mode(client: Client, name: str) -> list[int]:
    number = MODES[client.sky.personality][name].custom_mode
    if client.sky.personality == "ardupilot":
        return client.long(176, 1, number)
    return client.long(176, 1, number >> 16 & 0xFF, number >> 24)


@either
def test_every_command_frame_gets_one_final_ack(personality: Personality) -> None:
    """any command, LONG and INT."""
    client = connected(personality)
    assert client.long(31999) == [UNSUPPORTED]
    assert client.int_(31999) == [UNSUPPORTED]
    assert client.long(400, 1, target=2) == [], "not for this vehicle"
    lat, lon = (round(value * 1e7) for value in (client.sky.home.lat_deg, client.sky.home.lon_deg))
    refused = UNSUPPORTED if personality == "px4" else DENIED
    for frame in (1, 7, 8, 10, 11, 99):
        asked = client.int_(192, -1, 1, 0, NAN, x=lat, y=lon, z=5.0, frame=frame)
        assert asked == [refused]
        asked = client.int_(195, 0, 0, 0, NAN, x=lat, y=lon, z=5.0, frame=frame)
        assert asked == [UNSUPPORTED_MAV_FRAME]
    assert client.long(192, -1, 0, 0, NAN, NAN, NAN, NAN) == [UNSUPPORTED]


@either
def test_a_repeated_arm_or_take_off_is_accepted_again(personality: Personality) -> None:
    client = connected(personality)
    client.take_off(5.0)
    height_m = 5.0 if personality == "ardupilot" else client.sky.home.alt_amsl_m + 5.0
    for _ in range(2):
        assert client.long(400, 1) == [ACCEPTED]
        again = ACCEPTED if personality == "px4" else FAILED
        assert client.long(22, 0, 0, 0, NAN, NAN, NAN, height_m) == [again]
    client.sky.run(3.0)
    # PX4 ends its climb NAV_MC_ALT_RAD lower.
    hovers_m = 5.0 if personality == "ardupilot" else 5.0 - 0.65
    assert -client.sky.truth().pos_ned[2] == pytest.approx(hovers_m, abs=0.35)


@either
def test_a_retry_gets_the_same_result_without_a_second_effect(personality: Personality) -> None:
    client = connected(personality, parameters={"CAM_EXPOSURE_S": 0.2})
    assert client.long(2000, 0, 0, 1, sequence=40) == [ACCEPTED]
    client.sky.run(0.5)
    assert client.long(2000, 0, 0, 1, sequence=40) == [ACCEPTED], "the network repeats it"
    assert client.long(2000, 0, 0, 1, confirmation=1) == [ACCEPTED], "the client does"
    client.sky.run(3.0)
    assert len(client.all("CAMERA_IMAGE_CAPTURED")) == 1
    assert client.long(2000, 0, 0, 1) == [ACCEPTED], "a new one is a new picture"
    client.sky.run(3.0)
    assert len(client.all("CAMERA_IMAGE_CAPTURED")) == 2


@either
def test_what_is_busy_says_so_for_the_moment(personality: Personality) -> None:
    client = connected(personality)
    assert client.long(2000, 0, 0, 1) == [ACCEPTED]
    assert client.long(2000, 0, 0, 2) == [TEMPORARILY_REJECTED]
    client.sky.run(3.0)
    assert client.long(2000, 0, 0, 2) == [ACCEPTED]


@either
def test_two_senders_of_one_command_are_each_answered(personality: Personality) -> None:
    client = connected(personality)
    other = client.sky.client("other", system=245, component=7)
    assert client.long(511, 30, 1e5) == [ACCEPTED]
    assert other.long(511, 30, 2e5) == [ACCEPTED]
    client.forget()
    other.forget()
    client.sky.run(5.0)
    assert (client.rate_hz("ATTITUDE", 5.0), other.rate_hz("ATTITUDE", 5.0)) == (10.0, 5.0)


@either
def test_nothing_is_ever_left_in_progress(personality: Personality) -> None:
    """A final ack for each frame that was answered IN_PROGRESS, but for those listed."""
    client = connected(personality)
    client.take_off(5.0)
    unheard = PROFILES[personality].ignored_commands | UNHEARD_AS_SENT[personality]
    for command in range(600):
        if command in (185, 246, 400, 420):
            continue
        client.forget()
        results = client.long(command, *(NAN,) * 7)
        assert len(results) == (command not in unheard)
        if not results:
            continue
        if results[0] == IN_PROGRESS:
            client.sky.run(30.0)
            finals = [ack.result for ack in client.all("COMMAND_ACK")]
            if command in NEVER_ENDED[personality]:
                assert finals == [IN_PROGRESS]
                continue
            assert len(finals) == 2
            assert finals[-1] != IN_PROGRESS


# ---------------------------------------------------------------------------------- flights


@either
def test_arming_and_the_flights_that_are_asked_for(personality: Personality) -> None:
    """ARM/DISARM, modes and flights."""
    client = connected(personality)
    client.take_off(10.0)
    beat = client.last("HEARTBEAT")
    assert beat.base_mode & 128
    assert client.long(400, 0) != [ACCEPTED], "not in the air"
    hold = "AUTO.LOITER" if personality == "px4" else "GUIDED"
    lat, lon = client.sky.home.lat_deg + 2e-4, client.sky.home.lon_deg
    x, y = round(lat * 1e7), round(lon * 1e7)
    assert client.int_(192, -1, 1, 0, NAN, x=x, y=y, z=12.0, frame=6) == [ACCEPTED]
    client.sky.run(15.0)
    assert mode(client) == hold
    assert client.sky.truth().pos_ned[0] == pytest.approx(22.2, abs=1.5)
    assert -client.sky.truth().pos_ned[2] == pytest.approx(12.0, abs=1.0)

    assert client.long(178, 1, 2.0, -1) == [ACCEPTED]
    x = round(client.sky.home.lat_deg * 1e7)
    assert client.int_(192, -1, 1, 0, NAN, x=x, y=y, z=12.0, frame=6) == [ACCEPTED]
    client.sky.run(4.0)
    assert abs(client.sky.truth().v_ned[0]) == pytest.approx(2.0, abs=0.4)

    if personality == "px4":
        assert client.long(186, 8.0, 3) == [ACCEPTED]
        client.sky.run(8.0)
        assert -client.sky.truth().pos_ned[2] == pytest.approx(8.0, abs=0.8)
        assert client.long(115, 90, 30, 1, 0) == [UNSUPPORTED]
    else:
        assert client.long(186, 8.0, 3) == [UNSUPPORTED]
        assert client.long(115, 90, 30, 1, 0) == [ACCEPTED]
        client.sky.run(6.0)
        heading_deg = client.sky.vehicles[0].estimate.heading_rad * 180.0 / math.pi
        assert heading_deg == pytest.approx(90.0, abs=5.0)

    assert client.long(21) == [ACCEPTED]
    client.sky.run(40.0, lambda: not client.sky.truth().armed)
    assert client.sky.truth().landed


@either
def test_return_goes_home_and_lands(personality: Personality) -> None:
    client = connected(personality)
    client.take_off(10.0)
    lat, lon = client.sky.home.lat_deg + 2e-4, client.sky.home.lon_deg
    client.int_(192, -1, 1, 0, NAN, x=round(lat * 1e7), y=round(lon * 1e7), z=10.0, frame=6)
    client.sky.run(10.0)
    assert client.long(20) == [ACCEPTED]
    client.sky.run(2.0)
    assert mode(client) == ("AUTO.RTL" if personality == "px4" else "RTL")
    client.sky.run(120.0, lambda: not client.sky.truth().armed)
    north, east, _ = client.sky.truth().pos_ned
    assert math.hypot(north, east) < 2.0


@either
def test_modes_by_command_and_by_the_old_message(personality: Personality) -> None:
    client = connected(personality)
    first, second = ("POSCTL", "AUTO.LOITER") if personality == "px4" else ("GUIDED", "LOITER")
    assert set_mode(client, first) == [ACCEPTED]
    client.sky.run(0.2)
    assert mode(client) == first
    client.forget()
    number = MODES[personality][second].custom_mode
    heard = client.send(mavlink.MAVLink_set_mode_message(1, 1, number))
    acks = [each.command for each in heard if each.get_type() == "COMMAND_ACK"]
    assert acks == ([] if personality == "px4" else [11])
    client.sky.run(0.2)
    assert mode(client) == second
    unknown = (4, 77) if personality == "px4" else (77, 0)
    assert client.long(176, 1, *unknown) != [ACCEPTED]


@either
def test_pause_and_continue_in_the_mission_mode(personality: Personality) -> None:
    client = connected(personality)
    client.take_off(5.0)
    if personality == "px4":
        assert client.long(193, 0) == [UNSUPPORTED]
        return
    assert client.long(193, 7) == [DENIED]
    assert client.long(193, 0) == [ACCEPTED]
    client.sky.run(3.0)
    speed = math.dist(client.sky.truth().v_ned, (0.0, 0.0, 0.0))
    assert speed < 0.3


@either
def test_orbits_are_flown_by_px4_and_unknown_to_ardupilot(personality: Personality) -> None:
    client = connected(personality)
    client.take_off(10.0)
    result = client.int_(34, 8.0, 3.0, 0, NAN, x=0x7FFFFFFF, y=0x7FFFFFFF, z=NAN, frame=5)
    if personality == "ardupilot":
        assert result == [UNSUPPORTED]
        return
    assert result == [ACCEPTED]
    client.sky.run(12.0)
    assert client.last("ORBIT_EXECUTION_STATUS").radius == pytest.approx(8.0)
    assert mode(client) == "POSCTL.ORBIT"


@either
def test_arming_is_forced_by_its_magic_number_only(personality: Personality) -> None:
    client = connected(personality)
    client.sky.run(2.0)
    client.take_off(5.0)
    assert client.long(400, 0, 21195) != [ACCEPTED]
    assert client.long(400, 0, 21196) == [ACCEPTED]
    client.sky.run(0.5)
    assert not client.sky.truth().armed
    assert client.long(400, 2) == [DENIED]


@either
def test_checks_reboot_and_termination(personality: Personality) -> None:
    client = connected(personality)
    assert client.long(401) == [ACCEPTED]
    assert client.long(246, 1) == [ACCEPTED]
    client.sky.run(3.0)
    client.take_off(10.0)
    assert client.long(246, 1) != [ACCEPTED], "not in flight"
    assert client.long(185, 1) == [ACCEPTED]
    client.sky.run(1.0)
    assert client.sky.truth().armed == (personality == "px4"), "PX4 stays armed"
    assert client.sky.truth().v_ned[2] > 1.0, "it falls"
    client.sky.run(2.0)
    terminated, standby = 8, 3
    status = terminated if personality == "px4" else standby
    assert client.last("HEARTBEAT").system_status == status


@either
def test_failures_are_injected_where_that_is_allowed(personality: Personality) -> None:
    client = connected(personality)
    if personality == "px4":
        client.sky.vehicles[0].parameters.set("SYS_FAILURE_EN", 0)  # type: ignore[attr-defined]
        assert client.long(420, 4, 1, 0) != [ACCEPTED], "SYS_FAILURE_EN is off"
        client.sky.vehicles[0].parameters.set("SYS_FAILURE_EN", 1)  # type: ignore[attr-defined]
    assert client.long(420, 4, 1, 0, sequence=77) == [ACCEPTED]
    client.sky.run(4.0)
    assert client.last("GPS_RAW_INT" if personality == "px4" else "HEARTBEAT")
    assert not client.sky.vehicles[0].health.gps_ok
    assert client.long(420, 999, 1, 0) in ([UNSUPPORTED], [DENIED], [FAILED])


def test_a_vehicle_that_is_not_ready_refuses_to_arm_and_says_why() -> None:
    for personality in BOTH:
        sky = Sky(personality)
        client = sky.client()
        client.beat_if_due()
        sky.run(0.3)
        assert client.long(400, 1) in ([TEMPORARILY_REJECTED], [FAILED], [DENIED])
        sky.run(1.0)
        assert client.texts()
        assert sky.now_ns < 2 * S
