"""The bridge between two keys: the gate alone has the vehicle's, and clients have another."""

from __future__ import annotations

import math

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs import ipc
from gcs.audit.audit import audit
from gcs.audit.messages import Tape
from gcs.gate.states import State
from gcs.record.writer import Recorder
from gcs.wire.frame import split
from tests.loopback import pymavlink_decoder
from tests.loopback.bridged import BridgedFlight, Client, joined
from tests.loopback.flight import PERSONALITIES, Flight, Personality
from tests.loopback.observed import START_NS
from vehicle_sim.simulation.world import Datagram

VEHICLE_KEY, CLIENT_KEY, OTHER = bytes(range(32)), bytes(32 * [5]), bytes(32 * [7])
ACCEPTED = 0
ARM, TAKE_OFF, LAND = 400, 22, 21
EPOCH_NS = 1_420_070_400 * 10**9  # of signatures: 2015
LINK_IDS = {100, 200}  # of setpoints and of all else, + the vehicle's link

both = pytest.mark.parametrize("personality", PERSONALITIES)


def signing(client: Client, key: bytes, link_id: int = 0) -> Client:
    """The client signs from now on, and takes only what is signed."""
    client.mav.signing.secret_key = key
    client.mav.signing.link_id = link_id
    client.mav.signing.timestamp = (client.flight.now_ns - EPOCH_NS) // 10_000
    client.mav.signing.sign_outgoing = True
    return client


def flown(flight: BridgedFlight, client: Client) -> None:
    flight.connected()
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    up_m = math.nan if flight.personality == "px4" else 5.0
    assert client.ask(TAKE_OFF, 0, 0, 0, math.nan, math.nan, math.nan, up_m) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOVERING))
    assert client.ask(LAND) == ACCEPTED
    flight.until(lambda: flight.is_in(State.GROUNDED) and not flight.vehicle.armed, 60)


@both
def test_a_client_without_a_key_flies_a_vehicle_that_obeys_only_the_gate(
    personality: Personality,
) -> None:
    flight = BridgedFlight(personality, vehicle_key=VEHICLE_KEY, station_key=VEHICLE_KEY)
    client = flight.join()
    flown(flight, client)
    client.send(dialect.MAVLink_param_request_read_message(1, 1, b"SYSID_THISMAV", -1))
    flight.run(0.5)
    forwarded = flight.to_vehicle("PARAM_REQUEST_READ")[-1]
    assert (forwarded.sysid, forwarded.compid) == (245, 190)
    assert {frame.signature[0] for frame in flight.to_vehicle()} == LINK_IDS
    assert flight.garbage() == []


@both
@pytest.mark.parametrize("key", [None, OTHER, CLIENT_KEY], ids=["unsigned", "another", "clients'"])
def test_who_goes_round_the_bridge_gets_nothing(
    personality: Personality, key: bytes | None
) -> None:
    """Straight at the vehicle: arming, a mode, a mission, a parameter."""
    flight = BridgedFlight(
        personality, vehicle_key=VEHICLE_KEY, station_key=VEHICLE_KEY, client_key=CLIENT_KEY
    )
    flight.connected()
    mav = dialect.MAVLink(None, srcSystem=255, srcComponent=190)
    if key is not None:
        mav.signing.secret_key, mav.signing.sign_outgoing = key, True
        mav.signing.timestamp = 1 << 47
    heard = []
    for message in (
        dialect.MAVLink_command_long_message(1, 1, ARM, 0, 1, 21196, 0, 0, 0, 0, 0),
        dialect.MAVLink_mission_count_message(1, 1, 3, 0),
        dialect.MAVLink_param_set_message(1, 1, b"COM_ARM_AUTH_REQ", 0, 9),
    ):
        mav.seq = (mav.seq + 1) & 0xFF
        data = Datagram(0, "stranger", bytes(message.pack(mav)))
        for output in flight.world.handle(data, flight.now_ns):
            heard += split(getattr(output, "data", b""))
    names = {getattr(item, "name", "") for item in heard}
    assert not names & {"COMMAND_ACK", "MISSION_REQUEST_INT", "MISSION_REQUEST", "PARAM_VALUE"}
    flight.run(2.0)
    assert not flight.vehicle.armed


@both
def test_of_clients_with_a_key_only_who_signs_is_heard_and_answered(
    personality: Personality,
) -> None:
    flight = BridgedFlight(
        personality, vehicle_key=VEHICLE_KEY, station_key=VEHICLE_KEY, client_key=CLIENT_KEY
    )
    stranger = flight.join(sysid=246)
    stranger.command(ARM, 1)
    impostor = signing(flight.join(sysid=247), VEHICLE_KEY)
    impostor.command(ARM, 1)
    client = signing(flight.join(sysid=245), CLIENT_KEY)
    client.beat()
    flown(flight, client)
    assert not stranger.acks(ARM)
    assert not impostor.acks(ARM)
    assert {heard.message.get_type() for heard in client.heard} >= {"HEARTBEAT", "COMMAND_ACK"}
    assert "BAD_DATA" not in {heard.message.get_type() for heard in client.heard}
    refused = {(item.link, item.reason) for item in flight.garbage()}
    assert refused == {(1, "unsigned"), (2, "wrong key"), (2, "unsigned"), (3, "unsigned")}
    lines = "\n".join(flight.lines("signing"))
    assert "246/190 COMMAND_LONG" in lines
    assert "247/190 COMMAND_LONG" in lines
    status = flight.of(ipc.BridgeStatus)[-1].clients
    assert [row.signed for row in status] == ["2 unsigned", "1 unsigned, 1 wrong key", "1 unsigned"]


@both
def test_what_was_recorded_before_the_bridge_began_anew_is_refused(
    personality: Personality,
) -> None:
    """Somebody without the key has listened to a client of the bridge before this one, and sends
    again what it heard ten seconds ago."""
    flight = BridgedFlight(
        personality, vehicle_key=VEHICLE_KEY, station_key=VEHICLE_KEY, client_key=CLIENT_KEY
    )
    recorded = dialect.MAVLink(None, srcSystem=245, srcComponent=190)
    recorded.signing.secret_key, recorded.signing.sign_outgoing = CLIENT_KEY, True
    recorded.signing.timestamp = (flight.now_ns - EPOCH_NS) // 10_000 - 1_000_000
    said = [
        message.pack(recorded)
        for message in (
            dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3),
            dialect.MAVLink_command_long_message(1, 1, ARM, 0, 1, 0, 0, 0, 0, 0, 0),
        )
    ]
    flight.connected()
    replayer = flight.join()
    for data in said * 3:
        replayer.send_raw(data)
    flight.run(5.0)
    assert not flight.vehicle.armed
    assert not replayer.acks(ARM)
    assert {item.reason for item in flight.garbage() if item.link == 1} == {"too old", "unsigned"}


def test_the_audit_of_a_bridge_with_two_keys(monkeypatch: pytest.MonkeyPatch) -> None:
    tape = Tape()
    monkeypatch.setattr(
        Flight, "new_recorder", lambda _flight: Recorder.without_file(tape, START_NS)
    )
    flight = BridgedFlight(vehicle_key=VEHICLE_KEY, station_key=VEHICLE_KEY, client_key=CLIENT_KEY)
    client = signing(flight.join(), CLIENT_KEY)
    impostor = signing(flight.join(sysid=247), OTHER)
    impostor.command(ARM, 1)
    flown(flight, client)
    result = audit(tape.take(), tape.attachments, "test", "")
    assert result.good, (result.notes, result.first[:5])


def test_a_key_that_a_client_sends_is_in_no_record(monkeypatch: pytest.MonkeyPatch) -> None:
    tape = Tape()
    monkeypatch.setattr(
        Flight, "new_recorder", lambda _flight: Recorder.without_file(tape, START_NS)
    )
    flight, client = joined(BridgedFlight())
    client.send(dialect.MAVLink_setup_signing_message(1, 1, OTHER, 12345))
    flight.run(1.0)
    kept = [m for m in tape.take() if m.topic.endswith("SETUP_SIGNING")]
    assert kept
    assert all(bytes(pymavlink_decoder.read(m.raw).secret_key) == bytes(32) for m in kept)
    assert "signing is on" not in flight.told()
