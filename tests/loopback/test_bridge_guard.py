"""What a client may change of the vehicle's set-up, through the whole bridge."""

from __future__ import annotations

import struct
from typing import Any

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from tests.loopback.bridged import VEHICLE, BridgedFlight, Client
from tests.loopback.flight import PERSONALITIES, Personality

ACCEPTED, DENIED = 0, 2
ARM, TAKE_OFF, SET_MODE, REQUEST_CONTROL = 400, 22, 176, 32100
FENCE_OFF = {"px4": ("GF_ACTION", 0, 6), "ardupilot": ("FENCE_ENABLE", 0, 2)}
"""Name, value, type of the parameter that switches the vehicle's own fence off."""
FREE = {"px4": ("SDLOG_MODE", 2, 6), "ardupilot": ("LOG_DISARMED", 1, 2)}

pytestmark = pytest.mark.parametrize("personality", PERSONALITIES)


def joined(personality: Personality, rules: str = "") -> tuple[BridgedFlight, Client]:
    policy = parse_policy(f"[bridge]\n{rules}", "my.toml")
    flight = BridgedFlight(personality, policy=policy)
    client = flight.join()
    flight.connected()
    return flight, client


def param_set(flight: BridgedFlight, client: Client, name: str, value: int, kind: int) -> None:
    """As this autopilot wants integers: px4 their bytes, ardupilot their value."""
    wire = float(value)
    if flight.personality == "px4":
        (wire,) = struct.unpack("<f", struct.pack("<i", value))
    client.send(dialect.MAVLink_param_set_message(*VEHICLE, name.encode(), wire, kind))


def values(client: Client, name: str) -> list[float]:
    """What PARAM_VALUE told the client of that parameter, as it is on the wire."""
    told: list[Any] = client.messages("PARAM_VALUE")
    return [one.param_value for one in told if one.param_id == name]


def test_the_vehicle_s_fence_cannot_be_switched_off(personality: Personality) -> None:
    flight, client = joined(personality)
    name, value, kind = FENCE_OFF[personality]
    told_before = len(values(client, name))
    before = flight.vehicle.parameters.get(name)
    param_set(flight, client, name, value, kind)
    flight.run(1.0)
    assert flight.to_vehicle("PARAM_SET") == []
    assert flight.vehicle.parameters.get(name) == before
    assert len(values(client, name)) == told_before + 1, "the old value, from the vehicle itself"
    (error,) = client.messages("PARAM_ERROR")[-1:]
    assert (error.param_id, error.error) == (name, 3)
    assert f"{name} is guarded" in client.texts()
    (refused,) = flight.decisions("refused")
    assert refused.code == "POLICY"
    assert name in refused.sentence


def test_a_parameter_that_nothing_stands_on_is_written_and_told(personality: Personality) -> None:
    flight, client = joined(personality)
    name, value, kind = FREE[personality]
    client.send(dialect.MAVLink_param_request_read_message(*VEHICLE, name.encode(), -1))
    flight.run(0.5)
    before = flight.vehicle.parameters.get(name)
    param_set(flight, client, name, value, kind)
    flight.run(1.0)
    assert flight.vehicle.parameters.get(name) == value
    assert f"{name} was {before:g} and is {value:g} now: written by 245/190" in flight.told()
    assert flight.decisions("refused") == []


def test_files_are_read_and_not_written(personality: Personality) -> None:
    flight, client = joined(personality)
    listing, removing = 3, 8
    for opcode in (listing, removing):
        head = struct.pack("<HBBBBBxI", 7, 0, opcode, 1, 0, 0, 0)
        payload = list((head + b"/").ljust(251, b"\0"))
        client.send(dialect.MAVLink_file_transfer_protocol_message(0, *VEHICLE, payload))
        flight.run(0.5)
    answers = [bytes(one.payload) for one in client.messages("FILE_TRANSFER_PROTOCOL")]
    by_request = {answer[5]: answer for answer in answers}
    assert by_request[removing][3] == 129, "NAK"
    assert by_request[removing][12] == 9, "FileProtected"
    assert by_request[listing][3] in (128, 129)
    assert len(flight.to_vehicle("FILE_TRANSFER_PROTOCOL")) == 1


@pytest.mark.parametrize(
    ("command", "param1"),
    [(179, 1.0), (185, 1.0), (207, 0.0), (245, 2.0), (246, 1.0), (420, 1.0)],
    ids=["home", "termination", "fence off", "reset parameters", "reboot", "failure"],
)
def test_commands_that_change_the_set_up_are_denied(
    personality: Personality, command: int, param1: float
) -> None:
    flight, client = joined(personality)
    assert client.ask(command, param1) == DENIED
    sent = [_command(frame.payload, frame.name) for frame in flight.to_vehicle()]
    assert command not in sent
    assert [one.code for one in flight.decisions("refused")] == ["POLICY"]


def test_messages_that_change_the_set_up_go_nowhere(personality: Personality) -> None:
    flight, client = joined(personality)
    for message in (
        dialect.MAVLink_set_gps_global_origin_message(1, 473977420, 85455940, 488000),
        dialect.MAVLink_set_home_position_message(1, 1, 1, 1, 0, 0, 0, [1, 0, 0, 0], 0, 0, 0),
        dialect.MAVLink_setup_signing_message(*VEHICLE, [7] * 32, 1),
        dialect.MAVLink_fence_point_message(*VEHICLE, 0, 4, 47.0, 8.0),
        dialect.MAVLink_rally_point_message(*VEHICLE, 0, 1, 1, 1, 20, 0, 0, 0),
        dialect.MAVLink_gps_rtcm_data_message(0, 3, [1] * 180),
        dialect.MAVLink_mission_count_message(*VEHICLE, 3, 1),
        dialect.MAVLink_mission_count_message(*VEHICLE, 3, 2),
    ):
        sent_before = len(flight.to_vehicle(message.get_type()))
        client.send(message)
        flight.run(0.2)
        assert len(flight.to_vehicle(message.get_type())) == sent_before, message.get_type()
    assert len(flight.decisions("refused")) == 8
    fence, rally = client.messages("MISSION_ACK")
    assert [(ack.type, ack.mission_type) for ack in (fence, rally)] == [(14, 1), (14, 2)]


def test_a_mode_that_sticks_fly_is_not_for_a_client_in_the_air(personality: Personality) -> None:
    flight, client = joined(personality)
    base, mode = (1.0, (3.0, 0.0)) if personality == "px4" else (1.0, (2.0,))
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    up_m = 5.0 if personality == "ardupilot" else float("nan")
    assert client.ask(TAKE_OFF, 0, 0, 0, 0, 0, 0, up_m) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOVERING))
    assert client.ask(SET_MODE, base, *mode) == DENIED
    assert flight.state is State.HOVERING
    assert "bridge.manual_modes" in client.texts()


def _command(payload: bytes, name: str) -> int | None:
    if name not in ("COMMAND_LONG", "COMMAND_INT"):
        return None
    number: int = struct.unpack_from("<H", payload.ljust(33, b"\0"), 28)[0]
    return number


def test_only_the_client_in_control_sets_up(personality: Personality) -> None:
    """Nor does another one calibrate, or write what anybody in control may write."""
    flight, first = joined(personality)
    second = flight.join(246)
    assert first.ask(REQUEST_CONTROL, 1, 1) == ACCEPTED
    name, value, kind = FREE[personality]
    told_before = len(values(second, name))
    param_set(flight, second, name, value, kind)
    second.command(dialect.MAV_CMD_PREFLIGHT_CALIBRATION, 1)
    flight.run(1.0)
    assert flight.to_vehicle("PARAM_SET") == []
    assert [one.code for one in flight.decisions("refused")] == ["OTHER_OPERATOR"] * 2
    assert [ack.result for ack in second.acks(241)] == [dialect.MAV_RESULT_TEMPORARILY_REJECTED]
    assert second.messages("PARAM_ERROR")
    assert len(values(second, name)) == told_before + 1, "the old value, from the vehicle itself"
    param_set(flight, first, name, value, kind)
    flight.run(1.0)
    assert len(flight.to_vehicle("PARAM_SET")) == 1


@pytest.mark.parametrize("version", [1, 2])
def test_a_command_that_is_hidden_in_a_tune_does_not_leave(
    personality: Personality, version: int
) -> None:
    """A vehicle that loses one byte of the tune would take it: a forced disarm."""
    flight, client = joined(personality)
    disarm = dialect.MAVLink_command_long_message(*VEHICLE, ARM, 0, 0, 21196, 0, 0, 0, 0, 0)
    hidden = bytes(disarm.pack(client.mav, force_mavlink1=version == 1))
    client.send(dialect.MAVLink_play_tune_message(*VEHICLE, b"MFT200L8", b""))
    client.send(dialect.MAVLink_play_tune_message(*VEHICLE, b"MFT200L8", hidden + b"L8"))
    flight.run(0.5)
    assert len(flight.to_vehicle("PLAY_TUNE")) == 1
    assert not any(hidden in sent.data for sent in flight.sent)
    assert [one.code for one in flight.decisions("refused")] == ["POLICY"]
    assert "a whole message stands in its bytes" in client.texts().replace("\n", "")


@pytest.mark.parametrize("kind", [1, 2], ids=["fence", "rally"])
def test_an_empty_plan_where_there_is_none_is_accepted_and_goes_nowhere(
    personality: Personality, kind: int
) -> None:
    """QGroundControl sends an empty fence and empty rally points with every plan."""
    flight, client = joined(personality)
    flight.run(2.0)
    for message in (
        dialect.MAVLink_mission_count_message(*VEHICLE, 0, kind),
        dialect.MAVLink_mission_clear_all_message(*VEHICLE, kind),
    ):
        client.send(message)
        flight.run(0.5)
        ack = client.messages("MISSION_ACK")[-1]
        assert (ack.type, ack.mission_type) == (0, kind)
        assert flight.to_vehicle(message.get_type()) == []
    assert flight.decisions("refused") == []
