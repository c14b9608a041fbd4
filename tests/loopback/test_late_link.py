"""A link that is late by a constant time from its first byte: the answers to TIMESYNC show it."""

from __future__ import annotations

import pytest

from gcs.gate.states import State
from tests.loopback.flight import PERSONALITIES, Flight, Personality
from tests.loopback.lossy_link import CLEAR, Weather


def late(seconds: float) -> Weather:
    return Weather(delay_s=(seconds, seconds))


@pytest.mark.parametrize("personality", PERSONALITIES)
@pytest.mark.parametrize("ways_s", [(0.0, 3.0), (1.5, 1.5), (3.0, 0.0)])
def test_nothing_is_armed_on_a_link_that_takes_three_seconds(
    personality: Personality, ways_s: tuple[float, float]
) -> None:
    up_s, down_s = ways_s
    flight = Flight(personality, up=late(up_s), down=late(down_s))
    flight.run(12.0)
    assert flight.is_in(State.STALE)
    arm = flight.say("arm")
    flight.run(10.0)
    assert flight.done(arm) == "refused STALE"
    assert not flight.vehicle.armed
    assert any("s late, by" in line and "not used" in line for line in flight.lines("link"))


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_a_link_that_becomes_quick_is_flown_on(personality: Personality) -> None:
    flight = Flight(personality, up=late(1.5), down=late(1.5))
    flight.run(12.0)
    assert flight.is_in(State.STALE)
    flight.up.weather = flight.down.weather = CLEAR
    flight.run(10.0)
    assert flight.is_in(State.GROUNDED)


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_a_quarter_of_a_second_each_way_is_flown(personality: Personality) -> None:
    flight = Flight(personality, up=late(0.25), down=late(0.25)).connected()
    assert flight.is_in(State.GROUNDED)
    flight.say("arm")
    flight.run(4.0)
    assert flight.vehicle.armed
