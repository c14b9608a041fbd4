"""What is verified is what is flown: cleared random missions stay clear of every zone, in wind."""

from __future__ import annotations

import pytest

from tests.loopback.flight import Personality
from tests.loopback.random_missions import fly

CHUNKS = 25
FLIGHTS_A_CHUNK = 10
FLIGHTS_IN_EACH_RUN = 5
WITH_STATION = 1
"""The seed of the mission that is flown through the gate."""

chunks = [pytest.param(chunk, marks=[pytest.mark.soak] if chunk else []) for chunk in range(CHUNKS)]


@pytest.mark.parametrize("chunk", chunks)
def test_a_cleared_random_mission_stays_inside_and_outside_as_verified(
    chunk: int, personality: Personality
) -> None:
    """One with the station all the way; else the vehicle flies alone what it was given."""
    count = FLIGHTS_A_CHUNK if chunk else FLIGHTS_IN_EACH_RUN
    flown = 0
    for seed in range(chunk * FLIGHTS_A_CHUNK, chunk * FLIGHTS_A_CHUNK + count):
        found = fly(seed, personality, alone=seed != WITH_STATION)
        if found.refusal is None:
            flown += 1
            assert found.nearest_m > 0.0, f"seed {seed}: {found}"
    assert flown > 0


@pytest.mark.parametrize("seed", [2352, 166])
def test_a_mission_that_once_came_into_a_zone_does_not(seed: int) -> None:
    """2352: 0.6 m into a zone, 3 m beside a leg after a turn of 150 degrees; 166: 0.15 m from a
    mast in 7.9 m/s, as its margin was used up.  Refused, or clear of every zone."""
    found = fly(seed, "ardupilot", alone=True)
    assert found.refusal is not None or found.nearest_m > 0.5, found
