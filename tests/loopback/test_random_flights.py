"""Invariants over random flights on a lossy link; the lab's checkpoint L17 is among them."""

from __future__ import annotations

import pytest

from tests.loopback.chance import flown

CHUNKS = 10
CHUNKS_IN_EACH_RUN = 2
FLIGHTS_A_CHUNK = 20

chunks = [
    pytest.param(chunk, marks=[pytest.mark.soak] if chunk >= CHUNKS_IN_EACH_RUN else [])
    for chunk in range(CHUNKS)
]


@pytest.mark.parametrize("chunk", chunks)
def test_L17_random_flights_break_no_promise(chunk: int) -> None:
    """Each promise is asserted by `WatchedFlight` in the moment in which it is put to the test."""
    setpoints = goals = answered = 0
    for index in range(chunk * FLIGHTS_A_CHUNK, (chunk + 1) * FLIGHTS_A_CHUNK):
        try:
            flight = flown(index)
            assert flight.finish is not None, "it does not come to an end"
            flight.all_answered()
        except AssertionError as broken:
            raise AssertionError(f"random flight {index}: {broken}") from broken
        setpoints += flight.setpoint_count
        goals += len(flight.goals)
        answered += len(flight.requests)
    assert setpoints > 1000
    assert goals > 10
    assert answered > 100
