"""A client's arming for a component that is not the vehicle's autopilot arms nothing."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.session import inputs
from gcs.wire.codec import decode
from gcs.wire.messages import CommandLong
from tests.loopback.bridged import BridgedFlight, Client
from tests.loopback.flight import PERSONALITIES, Personality

ACCEPTED, UNSUPPORTED = 0, 3
ARM = 400
CAMERA = 100

pytestmark = pytest.mark.parametrize("personality", PERSONALITIES)


def connected(personality: Personality) -> tuple[BridgedFlight, Client]:
    flight = BridgedFlight(personality)
    client = flight.join()
    flight.connected()
    return flight, client


def test_of_one_that_was_never_heard_it_is_refused(personality: Personality) -> None:
    flight, client = connected(personality)
    client.command(ARM, 1, target=(1, 77))
    flight.run(3)
    (ack,) = client.acks(ARM)
    assert ack.result == UNSUPPORTED
    assert (ack.get_srcSystem(), ack.get_srcComponent()) == (1, 77)
    assert "there is no component 77 of system 1" in client.texts()
    assert [one.code for one in flight.decisions("refused")] == ["UNSUPPORTED"]
    assert not flight.vehicle.armed
    sent = [decode(frame) for frame in flight.to_vehicle("COMMAND_LONG")]
    assert not [one for one in sent if isinstance(one, CommandLong) and one.command == ARM]


def test_of_one_that_is_there_it_is_not_the_autopilots(personality: Personality) -> None:
    flight, client = connected(personality)
    camera = dialect.MAVLink(None, srcSystem=1, srcComponent=CAMERA)
    beat = dialect.MAVLink_heartbeat_message(30, 8, 0, 0, 4, 3).pack(camera)
    flight.feed(inputs.Datagram(0, beat))
    client.command(ARM, 1, target=(1, CAMERA))
    flight.run(3)
    assert [ack.result for ack in client.acks(ARM)] == [UNSUPPORTED]
    assert "component 100 flies nothing" in client.texts()
    assert not flight.vehicle.armed


def test_for_all_components_it_arms(personality: Personality) -> None:
    flight, client = connected(personality)
    client.command(ARM, 1, target=(1, 0))
    flight.run(10)
    assert [ack.result for ack in client.acks(ARM)][-1] == ACCEPTED
    assert flight.vehicle.armed
