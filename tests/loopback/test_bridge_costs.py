"""What a MAVLink client may cost the others: the link to the vehicle, and control."""

from __future__ import annotations

import struct

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs import ipc
from gcs.gate.condition import Condition
from gcs.gate.states import State
from gcs.session import inputs
from tests.loopback.bridged import STATION, VEHICLE, BridgedFlight, Client, flying, joined
from tests.loopback.flight import PERSONALITIES, Personality
from tests.loopback.test_bridge_streams import in_control, velocity

ACCEPTED, TEMPORARILY_REJECTED, DENIED = 0, 1, 2
ARM, INTERVAL, MOUNT, LOGGING_START = 400, 511, 205, 2510
NAN = float("nan")

pytestmark = pytest.mark.parametrize("personality", PERSONALITIES)


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
    """And none is read on in the air."""
    flight, client = joined(BridgedFlight(personality))
    log_data(client)
    burst(client)
    flight.run(0.5)
    read = ("LOG_REQUEST_DATA", "FILE_TRANSFER_PROTOCOL")
    assert [len(flight.to_vehicle(name)) for name in read] == [1, 1]
    armed(flight, client)
    assert flight.to_vehicle("LOG_REQUEST_END") == []
    flight.run(1.5)
    assert len(flight.to_vehicle("LOG_REQUEST_END")) == 1
    assert any("the reading of its log is ended" in line for line in flight.told())
    log_data(client)
    burst(client)
    flight.run(0.5)
    assert [len(flight.to_vehicle(name)) for name in read] == [1, 1]
    assert "reading a log is allowed while the vehicle is disarmed" in client.texts()
    assert "reading a file is allowed while the vehicle is disarmed" in client.texts()
    assert client.ask(LOGGING_START) == TEMPORARILY_REJECTED


def test_a_client_s_rates_are_bounded(personality: Personality) -> None:
    flight, client = joined(BridgedFlight(personality))
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
    flight, client = joined(BridgedFlight(personality))
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


def test_what_cannot_be_read_takes_no_control(personality: Personality) -> None:
    flight, client = joined(BridgedFlight(personality))
    flight.feed(inputs.OperatorLine(1, ipc.Ask(7, "goto")))
    flight.feed(inputs.OperatorLine(1, ipc.Ask(8, "no such word")))
    flight.run(0.2)
    assert in_control(flight) == 0
    assert client.ask(ARM, 1.0) in (ACCEPTED, TEMPORARILY_REJECTED, DENIED, 4)
    assert in_control(flight) == 1000


def test_who_takes_over_need_not_wait_for_the_end_of_a_stream(personality: Personality) -> None:
    flight, client = flying(personality)
    other = flight.join(246)
    velocity(client, 1.0, 40)
    assert flight.is_in(State.STREAMING)
    assert other.ask(32100, 1.0, 1.0) == ACCEPTED
    flight.run(0.1)
    assert flight.is_in(State.HOVERING)
    assert "The stream of operator 1000 is over" in flight.told()
    velocity(client, 1.0, 2)
    assert flight.is_in(State.HOVERING), "its samples are refused"


def test_who_waits_for_the_reading_of_a_plan_is_told_so_by_the_protocol(
    personality: Personality,
) -> None:
    flight, client = joined(BridgedFlight(personality))
    other = flight.join(246)
    flight.run(3.0)
    for _ in range(4):
        client.send(dialect.MAVLink_mission_request_list_message(*VEHICLE, 0))
        other.send(dialect.MAVLink_mission_request_list_message(*VEHICLE, 0))
        flight.run(0.5)
    acks = other.messages("MISSION_ACK")
    assert [(ack.type, ack.mission_type) for ack in acks] == [(1, 0)], "MAV_MISSION_ERROR"
    assert "another client reads a plan" in other.texts()
    assert client.messages("MISSION_ACK") == []


def test_a_second_bridge_of_the_same_address_is_told_on_both_sides(
    personality: Personality,
) -> None:
    """Two in a row, neither with --sysid: nothing that the outer one sends would arrive."""
    flight = BridgedFlight(personality)
    flight.connected()
    outer = flight.join(*STATION)
    for _ in range(6):
        outer.beat()
        flight.run(1.0)
    (line,) = [line for line in flight.told() if "as this station does" in line]
    assert "start one of the two with another --sysid" in line
    heard = [one for one in outer.messages("STATUSTEXT") if one.get_srcComponent() == STATION[1]]
    assert 3 <= len(heard) / 2 <= 4, "every two seconds, in two pieces"
    assert all(one.get_srcSystem() == STATION[0] for one in heard)

    inner = BridgedFlight(personality)
    inner.connected()
    for one in heard[:2]:
        inner.feed(inputs.Datagram(0, bytes(one.get_msgbuf())))
    inner.run(0.2)
    assert Condition.OTHER_STATION in inner.conditions
    assert any("another --sysid" in line for line in inner.told())
