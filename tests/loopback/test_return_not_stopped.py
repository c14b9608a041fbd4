"""A client's request that would be refused stops no return that a severity has begun."""

from __future__ import annotations

import math

import pytest
from msgspec import structs

from gcs.gate.condition import Condition
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.states import State
from tests.loopback.bridged import ACCEPTED, Client, north_of_home, take_off
from tests.loopback.flight import Personality
from tests.loopback.plan_clients import PlanFlight
from tests.loopback.test_bridge_meaning import (
    GUIDED,
    MISSION_START,
    SET_MODE,
    arrives,
)
from vehicle_sim.simulation.fault_script import fault_of

AWAY_M = 25.0
ACTS_BY_ITSELF = {"px4": ("COM_LOW_BAT_ACT",), "ardupilot": ("BATT_FS_LOW_ACT", "BATT_FS_CRT_ACT")}


def returning(personality: Personality) -> tuple[PlanFlight, Client]:
    """Far from home with a critical battery, which the vehicle itself only tells."""
    limits = structs.replace(DEFAULT.battery, critical_v=13.0)
    flight = PlanFlight(personality, policy=structs.replace(DEFAULT, battery=limits))
    take_off(flight)
    client = flight.clients[1]
    for name in ACTS_BY_ITSELF[personality]:
        flight.vehicle.parameters.set(name, 0)
    lat, lon, alt = north_of_home(flight, AWAY_M)
    client.fly_to(lat, lon, alt + 5)
    arrives(flight, AWAY_M)
    flight.beating(1.0)
    assert flight.world.inject(fault_of("battery", {"cells": 1}, "script"), 1)
    flight.until(lambda: flight.is_in(State.RETURNING), 20)
    assert Condition.BATTERY_CRITICAL in flight.conditions
    flight.run(2.0)
    return flight, client


@pytest.mark.parametrize("asked", ["guided", "mission"])
def test_a_refused_request_leaves_the_return_as_it_is(personality: Personality, asked: str) -> None:
    flight, client = returning(personality)
    since_ns = flight.now_ns
    if asked == "guided":
        result = client.ask(SET_MODE, *GUIDED[personality])
    else:
        result = client.ask(MISSION_START)
    assert result != ACCEPTED
    assert "SEVERITY" in client.texts()
    flight.until(lambda: flight.is_in(State.GROUNDED), 90)
    assert "HOLDING" not in flight.states(since_ns)
    assert math.hypot(*flight.truth_enu()[:2]) < 2.0


def test_a_hold_is_not_refused(personality: Personality) -> None:
    flight, client = returning(personality)
    hold = (129.0, 4.0, 3.0) if personality == "px4" else (129.0, 17.0, 0.0)
    assert client.ask(SET_MODE, *hold) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOLDING), 3)
