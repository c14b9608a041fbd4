"""What a client may do with the vehicle's set-up; what it may not, `test_refusals.py` has."""

from __future__ import annotations

import struct

import pytest
from pymavlink.dialects.v20 import all as dialect

from tests.loopback.bridged import VEHICLE, BridgedFlight, Client, joined
from tests.loopback.flight import PERSONALITIES, Personality

FREE = {"px4": ("SDLOG_MODE", 2, 6), "ardupilot": ("LOG_DISARMED", 1, 2)}

pytestmark = pytest.mark.parametrize("personality", PERSONALITIES)


def param_set(flight: BridgedFlight, client: Client, name: str, value: int, kind: int) -> None:
    """As this autopilot wants integers: px4 their bytes, ardupilot their value."""
    wire = float(value)
    if flight.personality == "px4":
        (wire,) = struct.unpack("<f", struct.pack("<i", value))
    client.send(dialect.MAVLink_param_set_message(*VEHICLE, name.encode(), wire, kind))


def test_files_are_read_and_a_tune_is_played(personality: Personality) -> None:
    flight, client = joined(BridgedFlight(personality))
    listing = 3
    head = struct.pack("<HBBBBBxI", 7, 0, listing, 1, 0, 0, 0)
    payload = list((head + b"/").ljust(251, b"\0"))
    client.send(dialect.MAVLink_file_transfer_protocol_message(0, *VEHICLE, payload))
    client.send(dialect.MAVLink_play_tune_message(*VEHICLE, b"MFT200L8", b""))
    flight.run(0.5)
    (answer,) = client.messages("FILE_TRANSFER_PROTOCOL")
    assert answer.payload[5] == listing
    assert answer.payload[3] in (128, 129), "the vehicle's own answer"
    assert len(flight.to_vehicle("FILE_TRANSFER_PROTOCOL")) == 1
    assert len(flight.to_vehicle("PLAY_TUNE")) == 1


def test_a_parameter_that_nothing_stands_on_is_written_and_told(personality: Personality) -> None:
    flight, client = joined(BridgedFlight(personality))
    name, value, kind = FREE[personality]
    client.send(dialect.MAVLink_param_request_read_message(*VEHICLE, name.encode(), -1))
    flight.run(0.5)
    before = flight.vehicle.parameters.get(name)
    param_set(flight, client, name, value, kind)
    flight.run(1.0)
    assert flight.vehicle.parameters.get(name) == value
    assert f"{name} was {before:g} and is {value:g} now: written by 245/190" in flight.told()
    assert flight.decisions("refused") == []


@pytest.mark.parametrize("kind", [1, 2], ids=["fence", "rally"])
def test_an_empty_plan_where_there_is_none_is_accepted_and_goes_nowhere(
    personality: Personality, kind: int
) -> None:
    """QGroundControl sends an empty fence and empty rally points with every plan."""
    flight, client = joined(BridgedFlight(personality))
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
