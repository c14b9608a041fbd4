"""Invariants over random flights on a lossy link; the lab's checkpoint L17 is among them.

Full vehicles, 20 s and more each: `make soak` flies 2,000 new ones,
`make test` and `make thorough` the same 20 each.
"""

from __future__ import annotations

import pytest

from tests.loopback.random_flight import flown
from tests.shares import seeds
from tests.soak.seeds import base_seed
from tests.soaking import Counted

CHUNKS = 100
CHUNKS_IN_EACH_RUN = 2
FLIGHTS_A_CHUNK = 20


@pytest.mark.parametrize("chunk", seeds(CHUNKS_IN_EACH_RUN, CHUNKS_IN_EACH_RUN, CHUNKS))
def test_L17_random_flights_break_no_promise(chunk: int, record_property: Counted) -> None:
    """Each promise is asserted by `CheckedFlight` in the moment in which it is put to the test."""
    setpoints = goals = answered = 0
    first = base_seed() + chunk * FLIGHTS_A_CHUNK
    for index in range(first, first + FLIGHTS_A_CHUNK):
        try:
            flight = flown(index)
            assert flight.finish is not None, "it does not come to an end"
            flight.all_answered()
        except AssertionError as broken:
            raise AssertionError(f"random flight {index}: {broken}") from broken
        setpoints += flight.setpoint_count
        goals += len(flight.goals)
        answered += len(flight.requests)
    assert setpoints > 50 * FLIGHTS_A_CHUNK
    assert goals > 0.5 * FLIGHTS_A_CHUNK
    assert answered > 5 * FLIGHTS_A_CHUNK
    record_property("random flights of full vehicles", FLIGHTS_A_CHUNK)
    record_property("random flights, requests answered", answered)
