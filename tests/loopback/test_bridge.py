"""MAVLink clients fly a vehicle through the gate, and what they must not do does not reach it."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.states import State
from tests.loopback.bridged import (
    ACCEPTED,
    ARM,
    ARRIVES_M,
    STATION,
    BridgedFlight,
    Client,
    flying,
    joined,
    north_of_home,
)
from tests.loopback.flight import PERSONALITIES, Personality

LAND = 21

pytestmark = pytest.mark.parametrize("personality", PERSONALITIES)


def test_a_client_sees_the_vehicle_as_it_is(personality: Personality) -> None:
    """Every byte of the vehicle reaches the client, and the station's own talk does not."""
    _, client = joined(BridgedFlight(personality))
    names = {one.message.get_type() for one in client.heard}
    assert {"HEARTBEAT", "LOCAL_POSITION_NED", "GLOBAL_POSITION_INT"} <= names
    assert {
        (one.message.get_srcSystem(), one.message.get_srcComponent()) for one in client.heard
    } == {(1, 1)}
    assert not client.messages("COMMAND_ACK"), "answers to the station are the station's"


def test_a_client_flies_a_square_and_lands(personality: Personality) -> None:
    flight, client = flying(personality)
    client.fly_to(*north_of_home(flight, 10, 6))
    flight.until(lambda: flight.is_in(State.MOVING), 1)
    assert [ack.result for ack in client.acks(192)] == [ACCEPTED]
    flight.until(lambda: flight.is_in(State.HOVERING))
    assert flight.truth_enu()[1] == pytest.approx(10, abs=ARRIVES_M[personality])
    assert client.ask(LAND) == ACCEPTED
    flight.until(lambda: flight.is_in(State.GROUNDED) and not flight.vehicle.armed, 60)


def test_only_the_station_speaks_of_motion_to_the_vehicle(personality: Personality) -> None:
    flight, client = flying(personality)
    client.command(LAND)
    flight.run(1)
    for name in ("COMMAND_LONG", "COMMAND_INT", "SET_POSITION_TARGET_LOCAL_NED"):
        for frame in flight.to_vehicle(name):
            assert (frame.sysid, frame.compid) == STATION


def test_a_harmless_question_goes_through_and_its_answer_comes_back(
    personality: Personality,
) -> None:
    flight = BridgedFlight(personality)
    first, second = flight.join(), flight.join(255, 190)
    flight.connected()
    assert first.ask(512, 148) == ACCEPTED  # REQUEST_MESSAGE AUTOPILOT_VERSION
    assert first.messages("AUTOPILOT_VERSION")
    assert not second.acks(512), "an answer goes to whom it is for"


def test_the_second_client_may_stop(personality: Personality) -> None:
    flight, first = flying(personality)
    second = flight.join(255, 190)
    assert second.ask(LAND) == ACCEPTED
    assert flight.is_in(State.LANDING)
    assert not first.acks(999)


def test_a_client_that_goes_silent_in_control_is_held_for(personality: Personality) -> None:
    flight, _ = flying(personality)
    flight.run(12)
    assert flight.is_in(State.HOLDING)


def test_the_same_command_again_is_answered_and_not_done_twice(personality: Personality) -> None:
    flight, client = flying(personality)
    for _ in range(3):
        client.fly_to(*north_of_home(flight, 10, 6))
        flight.run(0.3)
    assert [ack.result for ack in client.acks(192)] == [ACCEPTED] * 3
    assert len([one for one in flight.decisions() if one.word == "goto"]) == 1


def test_a_command_for_the_bridge_itself_is_answered_by_it(personality: Personality) -> None:
    flight, client = joined(BridgedFlight(personality))
    client.command(dialect.MAV_CMD_REQUEST_MESSAGE, 0.0, target=STATION)
    flight.run(0.5)
    (ack,) = client.acks(dialect.MAV_CMD_REQUEST_MESSAGE)
    assert ack.result == dialect.MAV_RESULT_UNSUPPORTED
    assert (ack.get_srcSystem(), ack.get_srcComponent()) == STATION


def test_an_arming_for_all_components_arms(personality: Personality) -> None:
    flight, client = joined(BridgedFlight(personality))
    client.command(ARM, 1, target=(1, 0))
    flight.run(10)
    assert [ack.result for ack in client.acks(ARM)][-1] == ACCEPTED
    assert flight.vehicle.armed


def test_who_plays_the_vehicle_is_not_believed(personality: Personality) -> None:
    flight, client = flying(personality)
    position = flight.session.telemetry.pos_ned if flight.session.telemetry else None
    liar = flight.join(1, 1)
    liar.send(dialect.MAVLink_local_position_ned_message(10**9, 500, 0, -5, 0, 0, 0))
    telemetry = flight.session.telemetry
    assert telemetry is not None
    assert telemetry.pos_ned == position
    assert client.link != liar.link


def test_no_client_makes_the_gates_own_streams_slower(personality: Personality) -> None:
    """MAVProxy asks an ArduPilot for all streams at 4 Hz, another client for no positions."""
    flight, client = flying(personality)
    looks_on = flight.join(255, 190)
    client.send(dialect.MAVLink_request_data_stream_message(1, 1, 0, 4, 1))
    assert client.ask(511, 32, -1) == ACCEPTED  # SET_MESSAGE_INTERVAL LOCAL_POSITION_NED
    flight.run(1)
    before = len(looks_on.messages("LOCAL_POSITION_NED"))
    flight.run(4)
    assert len(looks_on.messages("LOCAL_POSITION_NED")) - before >= 29 * 4, "it asked for nothing"


def heard(client: Client, name: str) -> int:
    return len(client.messages(name))


def test_a_client_gets_a_stream_as_often_as_it_asked_for_it(personality: Personality) -> None:
    """QGroundControl's groups at 2 to 3 Hz came at the 30 and 20 Hz that the gate needs."""
    flight = BridgedFlight(personality)
    single, groups, none = flight.join(), flight.join(255, 190), flight.join(254, 190)
    flight.connected()
    for msgid, interval_us in ((30, 500_000), (32, 500_000)):
        assert single.ask(511, msgid, interval_us) == ACCEPTED
        assert none.ask(511, msgid, -1) == ACCEPTED
    for group, hz in ((6, 3), (10, 10)):
        groups.send(dialect.MAVLink_request_data_stream_message(1, 1, group, hz, 1))
    flight.run(2)
    names = ("LOCAL_POSITION_NED", "ATTITUDE")
    clients = (single, groups, none)
    before = [[heard(client, name) for name in names] for client in clients]
    flight.beating(10)
    counts = [
        [heard(client, name) - was for name, was in zip(names, each, strict=True)]
        for client, each in zip(clients, before, strict=True)
    ]
    assert counts[0] == pytest.approx([20, 20], abs=1)
    assert counts[1] == pytest.approx([30, 100], abs=1)
    assert counts[2] == [0, 0]
    assert none.ask(512, 32) == ACCEPTED  # REQUEST_MESSAGE
    flight.run(1)
    assert heard(none, "LOCAL_POSITION_NED") == before[2][0] + 1
