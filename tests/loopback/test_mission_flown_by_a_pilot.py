"""The mission that a pilot flies, past the gate, is neither replaced nor cleared under the vehicle.

It goes on with the item that it had of the mission before: a way that nobody has verified.
"""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.states import State
from tests.loopback.bridged import VEHICLE
from tests.loopback.flight import PERSONALITIES, Personality
from tests.loopback.plan_clients import Mavsdk, PlanFlight, mission
from tests.loopback.test_set_current import flown, wait, with_square

DENIED = 14
"""MAV_MISSION_RESULT."""
BUSY = "the mission on board is being flown"


@pytest.fixture(params=PERSONALITIES)
def flight(request: pytest.FixtureRequest) -> PlanFlight:
    """On its way in the mission's mode, which a pilot has set after a hold."""
    personality: Personality = request.param
    flight = flown(with_square(personality))
    flight.vehicle.set_mode_kind("hold")
    wait(flight, lambda: flight.is_in(State.EXTERNAL), 5.0)
    flight.vehicle.set_mode_kind("mission")
    flight.beating(2.0)
    assert flight.is_in(State.EXTERNAL)
    return flight


def test_no_other_mission_is_put_in_its_place(flight: PlanFlight) -> None:
    client = flight.clients[1]
    upload = Mavsdk(flight, client, mission(flight.personality, (-40.0, 0.0, 10.0)))
    assert upload.ended() == f"refused {DENIED}"
    (refused,) = flight.decisions("refused")
    assert (refused.word, refused.code) == ("mission_upload", "BUSY")
    assert BUSY in client.texts()
    assert not flight.to_vehicle("MISSION_COUNT")[1:], "only the upload before the flight"


def test_it_is_not_cleared(flight: PlanFlight) -> None:
    client = flight.clients[1]
    client.send(dialect.MAVLink_mission_clear_all_message(*VEHICLE, 0))
    flight.beating(2.0)
    (refused,) = flight.decisions("refused")
    assert (refused.word, refused.code) == ("mission_clear", "BUSY")
    assert not flight.to_vehicle("MISSION_CLEAR_ALL")
