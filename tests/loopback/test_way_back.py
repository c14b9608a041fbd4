"""A vehicle at rest outside its fence is flown back inside by `resume`."""

from __future__ import annotations

import math

import pytest

from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from tests.loopback.flight import Flight, Personality

YARD = """name = "yard"
[[fence]]
name = "yard"
kind = "circle"
inclusion = true
frame = "home"
centre = [0.0, 0.0]
radius_m = 30.0
floor_up_m = 0.0
ceiling_up_m = 40.0
"""


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_resume_flies_it_back_and_it_obeys_again(personality: Personality) -> None:
    flight = Flight(personality, policy=parse_policy(YARD, "yard.toml")).hovering(5.0)
    flight.flown_by_hand()
    flight.run(0.5)
    for _ in range(200):
        if math.hypot(*flight.truth_enu()[:2]) > 33.0:
            break
        flight.vehicle.joystick(700, 0, 500, 0, flight.now_ns)
        flight.run(0.2)
    flight.vehicle.joystick(0, 0, 500, 0, flight.now_ns)
    assert flight.done(flight.say("hold"), 20.0) == "complete"
    flight.run(8.0)
    assert math.hypot(*flight.truth_enu()[:2]) > 31.0
    assert flight.is_in(State.HOLDING)

    refused = flight.goto(0.0, 0.0, 5.0)
    assert flight.done(refused) == "refused OUTSIDE_FENCE"
    [verdict] = flight.verdicts(refused)
    assert "possible: resume (it flies back to" in verdict.sentence

    farthest_m = math.hypot(*flight.truth_enu()[:2])
    assert flight.done(flight.say("resume")) == "complete"
    for _ in range(300):
        flight.run(0.1)
        away_m = math.hypot(*flight.truth_enu()[:2])
        assert away_m < farthest_m + 0.5
    assert away_m < 28.5
    assert flight.is_in(State.HOVERING)
    assert flight.done(flight.goto(0.0, 0.0, 5.0), 60.0) == "complete"
