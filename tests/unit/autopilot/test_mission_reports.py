"""MISSION_ITEM_REACHED and the end of a mission, by which MAVSDK tells that all is over."""

from __future__ import annotations

from tests.unit.autopilot.flight import item
from tests.unit.autopilot.test_mission import reached, started
from vehicle_sim.autopilot.modes import Personality

CHANGE_SPEED, IMAGE_STOP, RETURN = 178, 2001, 20


def flown(personality: Personality) -> tuple[list[int], int]:
    """What was reached, and MISSION_STATE once the vehicle goes home."""
    flight = started(
        personality,
        item(0, 22, up_m=4.0),
        item(1, CHANGE_SPEED, p1=1.0, p2=3.0),
        item(2, 16, 6.0, 0.0, 4.0),
        item(3, CHANGE_SPEED, p1=1.0, p2=2.0),
        item(4, IMAGE_STOP),
        item(5, RETURN),
    )
    flight.fly(60.0, lambda: flight.vehicle.mission_current == len(flight.vehicle.plan) - 1)
    flight.fly(1.0)
    return reached(flight), flight.vehicle.mission_state


def test_px4_counts_what_is_done_at_once_as_reached_and_is_complete_when_it_returns() -> None:
    assert flown("px4") == ([0, 1, 2, 3, 4, 5], 5)


def test_ardupilot_counts_what_is_flown_and_is_active_while_it_returns() -> None:
    assert flown("ardupilot") == ([0, 2], 3)
