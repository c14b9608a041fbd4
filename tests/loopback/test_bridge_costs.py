"""What a MAVLink client may cost the others: the link to the vehicle, and control."""

from __future__ import annotations

import struct

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from tests.loopback.bridged import VEHICLE, BridgedFlight, Client
from tests.loopback.flight import PERSONALITIES, Personality

ACCEPTED, TEMPORARILY_REJECTED, DENIED = 0, 1, 2
ARM, TAKE_OFF, INTERVAL, MOUNT, LOGGING_START = 400, 22, 511, 205, 2510
NAN = float("nan")

pytestmark = pytest.mark.parametrize("personality", PERSONALITIES)


def joined(personality: Personality, rules: str = "") -> tuple[BridgedFlight, Client]:
    policy = parse_policy(f"[bridge]\n{rules}", "my.toml")
    flight = BridgedFlight(personality, policy=policy)
    client = flight.join()
    flight.connected()
    return flight, client


def armed(flight: BridgedFlight, client: Client) -> None:
    if flight.personality == "ardupilot":
        client.ask(176, 1.0, 4.0)
    assert client.ask(ARM, 1.0) == ACCEPTED


def log_data(client: Client) -> None:
    client.send(dialect.MAVLink_log_request_data_message(*VEHICLE, 1, 0, 90))


def burst(client: Client) -> None:
    head = struct.pack("<HBBBBBxI", 7, 0, 15, 0, 0, 0, 0)
    payload = list(head.ljust(251, b"\0"))
    client.send(dialect.MAVLink_file_transfer_protocol_message(0, *VEHICLE, payload))


def test_logs_and_files_are_read_on_the_ground_only(personality: Personality) -> None:
    flight, client = joined(personality)
    log_data(client)
    burst(client)
    flight.run(0.5)
    read = ("LOG_REQUEST_DATA", "FILE_TRANSFER_PROTOCOL")
    assert [len(flight.to_vehicle(name)) for name in read] == [1, 1]
    armed(flight, client)
    log_data(client)
    burst(client)
    flight.run(0.5)
    assert [len(flight.to_vehicle(name)) for name in read] == [1, 1]
    assert "reading a log is allowed while the vehicle is disarmed" in client.texts()
    assert "reading a file is allowed while the vehicle is disarmed" in client.texts()
    assert client.ask(LOGGING_START) == TEMPORARILY_REJECTED


def test_the_policy_may_let_them_be_read_in_the_air(personality: Personality) -> None:
    flight, client = joined(personality, 'downloads = "forward"')
    armed(flight, client)
    log_data(client)
    burst(client)
    flight.run(0.5)
    read = ("LOG_REQUEST_DATA", "FILE_TRANSFER_PROTOCOL")
    assert [len(flight.to_vehicle(name)) for name in read] == [1, 1]


def test_a_client_s_rates_are_bounded(personality: Personality) -> None:
    flight, client = joined(personality)
    assert client.ask(INTERVAL, 105.0, 100.0) == ACCEPTED
    asked = [
        struct.unpack_from("<ff", frame.payload)
        for frame in flight.to_vehicle("COMMAND_LONG")
        if frame.sysid == 245
    ]
    assert asked[-1] == (105.0, 20_000.0)
    client.send(dialect.MAVLink_request_data_stream_message(*VEHICLE, 0, 200, 1))
    flight.run(0.5)
    assert flight.to_vehicle("REQUEST_DATA_STREAM") == []
    assert "bridge.messages_hz" in client.texts()


def test_only_the_client_in_control_points_the_camera(personality: Personality) -> None:
    flight, client = joined(personality)
    other = flight.join(246)
    before = len(flight.to_vehicle("COMMAND_LONG"))
    other.command(MOUNT, 0.0, 0.0, 90.0, 0.0, 0.0, 0.0, 2.0)
    flight.run(0.5)
    mount = [frame for frame in flight.to_vehicle("COMMAND_LONG")[before:] if frame.sysid == 246]
    assert len(mount) == 1, "nobody is in control"
    armed(flight, client)
    assert other.ask(MOUNT, 0.0, 0.0, 80.0, 0.0, 0.0, 0.0, 2.0) == TEMPORARILY_REJECTED
    assert "points the camera" in other.texts()
    client.command(MOUNT, 0.0, 0.0, 70.0, 0.0, 0.0, 0.0, 2.0)
    flight.run(0.5)
    points = [
        frame.sysid for frame in flight.to_vehicle("COMMAND_LONG") if frame.sysid in (245, 246)
    ]
    assert points[-1] == 245
    assert flight.session.gate.state is State.GROUNDED
