"""Who is there: heartbeat, version, modes, metadata."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from pymavlink import mavutil
from pymavlink.dialects.v20 import all as mavlink

from tests.contract.client import (
    ACCEPTED,
    BOTH,
    DENIED,
    FAILED,
    UNSUPPORTED,
    Client,
    Sky,
    connected,
)
from vehicle_sim.autopilot.modes import MODES, Personality
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.split import Counters, split

either = pytest.mark.parametrize("personality", BOTH)
NEVER_ASKED_FOR = (3, 25, 105_000, 140, 400, 9999)


def own(client: Client) -> list[m.Message]:
    """What was heard, with the vehicle's own codec: the supplement is not in pymavlink."""
    frames = split(bytes(client.raw), Counters())
    return [known for frame in frames if (known := frame.message()) is not None]


@either
def test_heartbeat(personality: Personality) -> None:
    """nothing."""
    client = connected(personality)
    client.forget()
    client.sky.run(5.0)
    beats = client.all("HEARTBEAT")
    assert len(beats) == 5
    for beat in beats:
        assert beat.type == mavlink.MAV_TYPE_QUADROTOR
        assert beat.autopilot == (12 if personality == "px4" else 3)
        assert not beat.base_mode & 128
        assert beat.system_status == mavlink.MAV_STATE_STANDBY
        assert "Mode(" not in mavutil.mode_string_v10(beat)
    client.take_off(4.0)
    beat = client.last("HEARTBEAT")
    assert beat.base_mode & 128
    assert beat.system_status == mavlink.MAV_STATE_ACTIVE


@either
def test_every_mode_is_one_that_pymavlink_knows(personality: Personality) -> None:
    for mode in MODES[personality].values():
        beat = mavlink.MAVLink_heartbeat_message(
            2, PROFILES[personality].autopilot, mode.flags, mode.custom_mode, 3, 3
        )
        name = mavutil.mode_string_v10(beat)
        assert "Mode(" not in name, mode.name
        assert name != "UNKNOWN"


@either
def test_the_autopilots_version_is_told_on_request(personality: Personality) -> None:
    """REQUEST_MESSAGE(AUTOPILOT_VERSION) and the old command 520."""
    client = connected(personality)
    result, (version,) = client.request_message(148)
    assert result == ACCEPTED
    assert version.get_type() == "AUTOPILOT_VERSION"
    assert version.flight_sw_version >> 24 == (1 if personality == "px4" else 4)
    client.forget()
    assert client.long(520, 1) == [ACCEPTED]
    again = client.last("AUTOPILOT_VERSION")
    assert again.capabilities == version.capabilities


def test_modes_are_listed_one_message_each() -> None:
    """REQUEST_MESSAGE(AVAILABLE_MODES, 0)."""
    assert connected("px4").request_message(435, 0)[0] == DENIED, "not in PX4 1.14"
    personality: Personality = "ardupilot"
    client = connected(personality)
    client.forget()
    result, listed = client.request_message(435, 0)
    assert result == ACCEPTED
    modes = [each for each in listed if each.get_type() == "AVAILABLE_MODES"]
    assert [each.mode_index for each in modes] == list(range(1, len(MODES[personality]) + 1))
    assert {each.number_modes for each in modes} == {len(modes)}
    assert len({each.custom_mode for each in modes}) == len(modes)
    assert all(each.mode_name for each in modes)
    result, (third,) = client.request_message(435, 3)
    assert (result, third.mode_index) == (ACCEPTED, 3)
    assert client.request_message(435, len(modes) + 1) == (ACCEPTED, [])
    client.forget()
    client.sky.run(10.0)
    assert client.all("CURRENT_MODE") == [], "arducopter_4_7_flight.tlog has none"
    assert client.request_message(437)[0] == ACCEPTED


@either
def test_metadata_and_protocol_version_or_a_plain_no(personality: Personality) -> None:
    """REQUEST_MESSAGE(COMPONENT_METADATA), PROTOCOL_VERSION, others."""
    client = connected(personality)
    client.forget()
    result, _ = client.request_message(397)
    told = [each for each in own(client) if isinstance(each, m.ComponentMetadata)]
    assert (result, len(told)) == ((ACCEPTED, 1) if personality == "px4" else (FAILED, 0))
    client.forget()
    px4 = personality == "px4"
    assert client.long(519, 1) == [ACCEPTED if px4 else UNSUPPORTED]
    assert client.request_message(300)[0] == (ACCEPTED if px4 else FAILED)
    versions = [each for each in own(client) if isinstance(each, m.ProtocolVersion)]
    assert [each.max_version for each in versions] == ([200] if px4 else [])


@either
def test_every_message_that_can_be_built_can_be_asked_for(personality: Personality) -> None:
    client = connected(personality)
    client.take_off(4.0)
    client.sky.run(8.0)
    silent = set()
    for number, kind in m.TYPES.items():
        if kind in (m.CommandAck, m.RcChannelsRaw):
            continue  # the one comes in any case, the other to peers of MAVLink 1 only
        client.forget()
        result, _ = client.request_message(number)
        came = any(isinstance(each, kind) for each in own(client))
        if result == ACCEPTED and not came:
            silent.add(kind.__name__)
        elif result != ACCEPTED:
            assert result == (DENIED if personality == "px4" else FAILED)
    never = {"ManualControl", "FenceStatus", "CameraImageCaptured", "ParamValue"}
    assert silent <= (set() if personality == "px4" else never)
    unknown = DENIED if personality == "px4" else FAILED
    for number in NEVER_ASKED_FOR:
        assert client.request_message(number)[0] == unknown
    for nonsense in (math.nan, -1.0, 0.5, 1e30):
        assert client.long(512, nonsense) in ([DENIED], [unknown])


ROOT = Path(__file__).parents[2]
NOT_PLAYED = {"PARAM_FLOAT", "TERRAIN", "SET_ACTUATOR_TARGET", "COMPASS_CALIBRATION"}
"""Claimed because the recorded ones do (0xecff, 0xfbef); the vehicle does nothing of it."""
CAPABILITY_TESTS = {
    "MISSION_FLOAT": "tests/contract/test_plans.py",
    "MISSION_INT": "tests/contract/test_plans.py",
    "COMMAND_INT": "tests/contract/test_commands.py",
    "PARAM_ENCODE_BYTEWISE": "tests/contract/test_files_and_parameters.py",
    "PARAM_ENCODE_C_CAST": "tests/contract/test_files_and_parameters.py",
    "FTP": "tests/contract/test_files_and_parameters.py",
    "SET_ATTITUDE_TARGET": "tests/contract/test_hands.py",
    "SET_POSITION_TARGET_LOCAL_NED": "tests/contract/test_hands.py",
    "SET_POSITION_TARGET_GLOBAL_INT": "tests/contract/test_hands.py",
    "FLIGHT_TERMINATION": "tests/contract/test_commands.py",
    "MAVLINK2": "tests/contract/test_identity.py",
    "MISSION_FENCE": "tests/contract/test_plans.py",
    "MISSION_RALLY": "tests/contract/test_plans.py",
}


@either
def test_no_capability_is_claimed_that_no_test_uses(personality: Personality) -> None:
    claimed = {str(bit.name) for bit in PROFILES[personality].capabilities}
    assert claimed <= set(CAPABILITY_TESTS) | NOT_PLAYED
    for name in claimed - NOT_PLAYED:
        assert (ROOT / CAPABILITY_TESTS[name]).is_file()


@either
def test_frames_are_mavlink_2(personality: Personality) -> None:
    sky = Sky(personality)
    client = sky.client()
    client.beat_if_due()
    sky.run(2.0)
    assert client.heard
    assert {each.message.get_msgbuf()[0] for each in client.heard} == {0xFD}
