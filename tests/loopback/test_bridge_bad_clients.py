"""Clients that break the rules: bytes that are no text, streams switched off, names of others."""

from __future__ import annotations

import math
import struct
from typing import Any

import pytest
from pymavlink.dialects.v20 import all as dialect
from pymavlink.generator.mavcrc import x25crc

from gcs.gate.states import State
from gcs.session import inputs
from gcs.session.effects import Finish
from gcs.station.session import MAX_FAULTS
from gcs.wire.frame import Frame, split
from tests.loopback.bridged import VEHICLE, BridgedFlight, Client, flying, joined
from tests.loopback.flight import PERSONALITIES, Personality

NO_TEXT = b"\xff"
"""No character of UTF-8 begins so."""

each = pytest.mark.parametrize("personality", PERSONALITIES)


def send_payload(client: Client, message: Any, payload: bytes) -> None:
    """A good frame of a message (pymavlink's class), whatever its payload says."""
    header = struct.pack("<BBBBBBHB", len(payload), 0, 0, 0, 245, 190, message.id, 0)
    checksum = x25crc(header + payload)
    checksum.accumulate(bytes((message.crc_extra,)))
    client.send_raw(b"\xfd" + header + payload + struct.pack("<H", checksum.crc))


@each
def test_a_text_of_any_bytes_is_refused_and_breaks_nothing(personality: Personality) -> None:
    flight, client = joined(BridgedFlight(personality))
    name = NO_TEXT * 16
    send_payload(
        client,
        dialect.MAVLink_param_set_message,
        struct.pack("<f2B", 1.0, *VEHICLE) + name + b"\x09",
    )
    send_payload(
        client,
        dialect.MAVLink_param_ext_set_message,
        struct.pack("<2B", *VEHICLE) + name + NO_TEXT * 128 + b"\x01",
    )
    assert len(flight.decisions("refused")) == 2
    send_payload(
        client,
        dialect.MAVLink_change_operator_control_message,
        struct.pack("<3B", VEHICLE[0], 0, 0) + NO_TEXT * 25,
    )
    flight.run(0.2)
    (answer,) = client.messages("CHANGE_OPERATOR_CONTROL_ACK")
    assert answer.ack == 0


def test_no_client_ends_the_station_with_frames_that_it_cannot_take() -> None:
    """An internal error that a client's frame causes is a bug; the others go on flying."""
    flight, client = joined(BridgedFlight("px4"))
    report = "Traceback\nValueError: planted"

    def ends(link: int) -> bool:
        done = [flight.fault(inputs.Datagram(link, b"?"), report) for _ in range(2 * MAX_FAULTS)]
        return any(isinstance(effect, Finish) for answer in done for effect in answer)

    assert not ends(client.link)
    assert ends(0), "the vehicle's side"


@each
def test_no_client_makes_the_gate_blind(personality: Personality) -> None:
    """Whatever a client asks not to be sent, the gate goes on seeing position, mode, arming and
    home; the client itself is sent no more of it."""
    flight, client = joined(BridgedFlight(personality))
    for number in (*range(400), 410, 411):
        client.command(dialect.MAV_CMD_SET_MESSAGE_INTERVAL, number - 0.4, -1.0)
        client.command(dialect.MAV_CMD_SET_MESSAGE_INTERVAL, number, -1.0, 1.0)
    flight.beating(4)
    heard_at_ns = flight.now_ns
    client.heard.clear()
    flight.beating(4)
    assert flight.now_ns > heard_at_ns
    names = {one.message.get_type() for one in client.heard}
    assert {"HEARTBEAT", "HOME_POSITION"} <= names
    assert not {"LOCAL_POSITION_NED", "ATTITUDE"} & names
    seen = flight.session.gate.memory.pos_ns
    assert seen is not None
    assert flight.now_ns - seen < 200_000_000
    assert client.ask(400, 1, within_s=5) == 0
    assert flight.session.telemetry is not None
    assert flight.session.telemetry.armed


ARM, HOLD, TAKE_OFF = 400, 17, 22


@each
def test_what_another_one_has_undone_is_not_answered_from_memory(personality: Personality) -> None:
    """ACCEPTED for an arming is remembered, for a client whose answer got lost; not past a stop."""
    flight = BridgedFlight(personality)
    first, second = flight.join(), flight.join(246)
    flight.connected()
    assert first.ask(ARM, 1, within_s=3) == 0
    assert second.ask(ARM, 0, within_s=1) == 0
    asked_before = len([one for one in flight.decisions() if one.word == "arm"])
    first.command(ARM, 1)
    flight.run(0.1)
    assert len([one for one in flight.decisions() if one.word == "arm"]) > asked_before


@each
def test_a_goal_that_was_stopped_is_not_answered_from_memory(personality: Personality) -> None:
    flight, first = flying(personality)
    second = flight.join(246)
    telemetry = flight.session.telemetry
    assert telemetry is not None
    assert telemetry.home is not None
    lat, lon, alt = telemetry.home
    goal = (lat + 15 / 111_319.5, lon, alt + 6)
    first.fly_to(*goal)
    flight.run(0.3)
    assert second.ask(HOLD, within_s=1) == 0
    assert not flight.is_in(State.MOVING)
    first.fly_to(*goal)
    flight.run(0.1)
    answers = [ack.result for ack in first.acks(192)]
    again = [one for one in flight.decisions() if one.word in ("goto", "resume")]
    assert len(again) > 2, (answers, again)


class PoorDownlink(BridgedFlight):
    """No PARAM_VALUE of the vehicle arrives while `deaf`."""

    deaf = False

    def feed(self, given: inputs.Input) -> None:
        if self.deaf and isinstance(given, inputs.Datagram) and given.link == 0:
            kept = [
                item.raw
                for item in split(given.data)
                if not (isinstance(item, Frame) and item.name == "PARAM_VALUE")
            ]
            given = inputs.Datagram(0, b"".join(kept))
        super().feed(given)


def test_no_climb_is_decided_on_before_its_least_height_is_known() -> None:
    """PX4 climbs to MIS_TAKEOFF_ALT at least (recorded), which a client may write on the ground."""
    flight = PoorDownlink("px4")
    client = flight.join()
    flight.connected()
    flight.beating(3)
    flight.deaf = True
    client.send(dialect.MAVLink_param_set_message(*VEHICLE, b"MIS_TAKEOFF_ALT", 28.0, 9))
    flight.run(0.3)
    assert flight.vehicle.parameters.get("MIS_TAKEOFF_ALT") == 28.0
    assert client.ask(ARM, 1, within_s=5) == 0
    assert client.ask(TAKE_OFF, *[math.nan] * 7) == dialect.MAV_RESULT_TEMPORARILY_REJECTED
    flight.deaf = False
    flight.run(0.5)
    client.ask(TAKE_OFF, *[math.nan] * 7)
    flight.until(lambda: flight.truth_enu()[2] > 5.0, 20)
