"""A link on which an answer comes seconds after the question, or never.

Landing and return are repeated for as long as their mode may be awaited, and flown to their end.
"""

from __future__ import annotations

import math

import pytest
from msgspec import structs

from gcs.gate.policy.parse import DEFAULT
from gcs.gate.states import State
from gcs.session import inputs
from gcs.wire.frame import Frame, split
from tests.loopback.flight import Flight, Personality
from tests.loopback.lossy_link import Weather

SLOW = Weather(delay_s=(1.5, 1.5))
PATIENT = structs.replace(DEFAULT, position_age_s=5.0)
"""By the default nothing is flown on such a link: its positions are too old."""
AWAY_M = 12.0


def away_from_home(personality: Personality) -> Flight:
    """Hovering; from now on an answer comes 3 s after its command.

    The way up is slow only now: an arming and a take-off are not tried for as long.
    """
    flight = Flight(personality, policy=PATIENT, down=SLOW).hovering(5.0)
    assert flight.done(flight.goto(AWAY_M, 0.0, 5.0)) == "complete"
    flight.up.weather = SLOW
    return flight


@pytest.mark.parametrize(("word", "from_home_m"), [("land", AWAY_M), ("rtl", 0.0)])
def test_it_comes_down_on_a_link_with_a_round_trip_of_three_seconds(
    personality: Personality, word: str, from_home_m: float
) -> None:
    flight = away_from_home(personality)
    since_ns = flight.now_ns
    assert flight.done(flight.say(word), 120.0) == "complete", flight.told()
    assert flight.is_in(State.GROUNDED)
    assert not {"HOLDING", "EXTERNAL", "STALE"} & set(flight.states(since_ns))
    east_m, north_m, up_m = flight.truth_enu()
    assert math.hypot(east_m - from_home_m, north_m) < 2.0
    assert up_m < 0.5


class WithoutAnswers(Flight):
    """The vehicle's COMMAND_ACKs can be lost; everything else arrives."""

    answers_lost = False

    def feed(self, given: inputs.Input) -> None:
        if isinstance(given, inputs.Datagram) and self.answers_lost:
            frames = [item for item in split(given.data) if isinstance(item, Frame)]
            kept = b"".join(frame.raw for frame in frames if frame.name != "COMMAND_ACK")
            if not kept:
                return
            given = inputs.Datagram(given.link, kept)
        super().feed(given)


@pytest.mark.parametrize("word", ["land", "rtl"])
def test_it_comes_down_though_every_answer_is_lost(personality: Personality, word: str) -> None:
    """The heartbeat shows the mode, and that is enough."""
    flight = WithoutAnswers(personality)
    flight.hovering(5.0)
    flight.answers_lost = True
    since_ns = flight.now_ns
    assert flight.done(flight.say(word), 120.0) == "complete", flight.told()
    assert not {"HOLDING", "EXTERNAL"} & set(flight.states(since_ns))


def test_a_hold_that_is_asked_for_meanwhile_is_not_landed_out_of(personality: Personality) -> None:
    """No try of the landing leaves after the hold, and those before it are older than it."""
    flight = away_from_home(personality)
    flight.say("land")
    flight.run(2.0)
    held = flight.say("hold")
    assert flight.done(held) == "complete"
    flight.run(10.0)
    assert flight.is_in(State.HOLDING)
    assert flight.truth_enu()[2] > 1.0
