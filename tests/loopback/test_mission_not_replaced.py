"""A mission that is flown is neither replaced nor cleared."""

from __future__ import annotations

import math

import pytest
from msgspec import structs
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.policy.parse import DEFAULT
from gcs.gate.states import State
from gcs.vehicle.missions.missions import Missions
from tests.loopback.bridged import VEHICLE
from tests.loopback.flight import PERSONALITIES, Personality
from tests.loopback.plan_clients import Mavsdk, PlanFlight, mission
from tests.loopback.random_missions import on_board
from tests.loopback.test_set_current import FIELD, flown, wait, with_square
from vehicle_sim.autopilot.firmware import Firmware

# ------------------------------------------------------------------------------
# Another station puts a mission on board past the bridge, while the one before is flown.
#
# The vehicle flies it at once.  It is held as soon as the vehicle tells of another number of items,
# or another number of the mission (`mission_id`), which the recorded ones do not tell.  Where that
# does not show: outside the box round what was verified nothing says that it slows down for a
# waypoint of its own, so the gate brakes by what a hold takes.  By its approach, an ArduCopter at
# 10 m/s came to rest 22 m outside.

FAR_M = 400.0
MARGIN_M = 2.0
TOLD_EVERY_S = 1.0
"""MISSION_CURRENT of either."""


def replaced(flight: PlanFlight, *places_m: tuple[float, float, float]) -> PlanFlight:
    """Take-off, these waypoints and a return are on board now, all of a sudden."""
    items = mission(flight.personality, *places_m)
    flight.vehicle.load_plan(on_board(items))
    return flight


def test_another_number_of_items_shows_at_once(personality: Personality) -> None:
    """A PX4 1.14 tells neither number nor count: there it does not show."""
    tells: Firmware | None = "1.15" if personality == "px4" else None
    flight = replaced(flown(with_square(personality, firmware=tells)), (20.0, 0.0, 10.0))
    flight.beating(TOLD_EVERY_S + 0.5)
    assert flight.is_in(State.HOLDING)
    assert [each.code for each in flight.decisions("aborted")] == ["BAD_MISSION"]
    (line,) = [each for each in flight.lines("mission") if "While its mission is flown" in each]
    assert "another mission" in line


def test_an_ardupilot_says_that_it_was_sent_one() -> None:
    """scenarios_arducopter.json: "Flight plan received" to all, whoever uploaded it."""
    square = [(30.0, 0.0, 10.0), (30.0, 30.0, 10.0), (0.0, 30.0, 10.0)]
    flight = replaced(flown(with_square("ardupilot")), *square)
    flight.beating(0.5)
    assert flight.is_in(State.HOLDING)
    assert [each.code for each in flight.decisions("aborted")] == ["BAD_MISSION"]


def test_another_mission_of_as_many_items_shows_where_missions_have_numbers() -> None:
    square = [(30.0, 0.0, 10.0), (30.0, 30.0, 10.0), (0.0, 30.0, 10.0)]
    flight = replaced(flown(with_square("px4", firmware="1.15")), *square)
    flight.beating(TOLD_EVERY_S + 0.5)
    assert flight.is_in(State.HOLDING)
    assert [each.code for each in flight.decisions("aborted")] == ["BAD_MISSION"]


def test_the_same_mission_flies_on(personality: Personality) -> None:
    flight = flown(with_square(personality))
    flight.beating(0.5)
    flight.beating(5.0)
    assert flight.is_in(State.FLYING_MISSION)


def test_else_the_vehicle_is_stopped_inside_the_fence(
    personality: Personality, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Missions, "said", lambda *_: [])
    flight = flown(with_square(personality, structs.replace(DEFAULT, fence=(FIELD,))))
    replaced(flight, (FAR_M, 0.0, 10.0), (FAR_M, 0.0, 10.0), (FAR_M, 0.0, 10.0))
    farthest_m = 0.0
    for _ in range(300):
        flight.clients[1].beat()
        flight.run(0.2)
        farthest_m = max(farthest_m, math.hypot(*flight.truth_enu()[:2]))
    assert flight.is_in(State.HOLDING)
    assert 60.0 < farthest_m < FIELD.radius_m + MARGIN_M
    assert [each.code for each in flight.decisions("aborted")] == ["FENCE_BREACH"]


# ------------------------------------------------------------------------------
# The mission that a pilot flies, past the gate, is neither replaced nor cleared under the vehicle.
#
# It goes on with the item that it had of the mission before: a way that nobody has verified.

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
