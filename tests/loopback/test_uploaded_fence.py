"""A fence that was uploaded to a vehicle before the station came: read at its start, and told."""

from __future__ import annotations

import pytest

from gcs.gate.condition import Condition
from tests.loopback.flight import Flight, Personality
from tests.loopback.stranger import stranger_fences

NARROW: dict[Personality, dict[str, float]] = {
    "px4": {"GF_ACTION": 2.0, "GF_MAX_HOR_DIST": 0.0, "GF_MAX_VER_DIST": 50.0},
    "ardupilot": {"FENCE_ENABLE": 1.0, "FENCE_TYPE": 5.0, "FENCE_ALT_MAX": 50.0},
}
"""A height, and no circle."""


def fence_told(flight: Flight) -> list[str]:
    """What was said of its own fence, in the order in which it was."""
    told = [line for line in flight.lines("link") if "the vehicle's own failsafes" in line]
    return [part for line in told for part in line.split("; ") if part.startswith("geofence:")]


def weak(flight: Flight) -> str:
    """What the gate has as the reason of the condition now."""
    return dict(flight.session.gate.reasons)[Condition.VEHICLE_FAILSAFE_WEAK]


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_one_as_narrow_as_the_policy_s_is_told_and_is_not_weak(personality: Personality) -> None:
    flight = Flight(personality, params=NARROW[personality])
    stranger_fences(flight, 70.0)
    flight.connected()
    flight.run(5.0)
    said = fence_told(flight)[-1]
    assert "uploaded: 1 to stay in, 0 to stay out of, up to 99 m from home" in said
    assert "policy's is 150 m" not in said.split("uploaded")[1]
    assert "geofence:" not in weak(flight)


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_a_wider_one_is_weak(personality: Personality) -> None:
    flight = Flight(personality, params=NARROW[personality])
    stranger_fences(flight, 300.0)
    flight.connected()
    flight.run(5.0)
    assert "m from home, the policy's is 150 m" in weak(flight)


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_of_a_vehicle_without_one_nothing_is_said(personality: Personality) -> None:
    flight = Flight(personality, params=NARROW[personality])
    flight.connected()
    flight.run(5.0)
    assert fence_told(flight)
    assert not any("uploaded" in line for line in fence_told(flight))
