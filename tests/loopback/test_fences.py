"""Fences of the policy and of the vehicle: driven out, flown back, uploaded by others."""

from __future__ import annotations

import math

import pytest

from gcs.gate.condition import Condition
from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from tests.loopback.flight import Flight, Personality
from tests.loopback.stranger import stranger_fences

# ------------------------------------------------------------------------------
# A vehicle that is driven out of the fence: what the policy says for that happens.

YARD = """
severities.fence_breached = "{severity}"
[[fence]]
name = "yard"
kind = "circle"
radius_m = 8.0
ceiling_up_m = 20.0
"""


@pytest.mark.parametrize(
    ("severity", "state"),
    [("hold", State.HOLDING), ("return", State.HOLDING), ("land", State.LANDING)],
)
def test_a_vehicle_that_a_gust_drives_out_does_what_the_policy_says(
    personality: Personality, severity: str, state: State
) -> None:
    """A return is blocked from outside: the way home leads through the fence's edge."""
    policy = parse_policy(YARD.format(severity=severity), "my.toml")
    flight = Flight(personality, policy=policy).hovering(4.0)
    flight.push((25.0, 0.0, 0.0))
    flight.until(lambda: Condition.FENCE_BREACHED in flight.conditions)
    east_m, _, _ = flight.truth_enu()
    assert east_m > 8.0
    flight.run(1.0)
    assert flight.state is state


# ------------------------------------------------------------------------------
# A vehicle at rest outside its fence is flown back inside by `resume`.

YARD_WAY = """name = "yard"
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


def test_resume_flies_it_back_and_it_obeys_again(personality: Personality) -> None:
    flight = Flight(personality, policy=parse_policy(YARD_WAY, "yard.toml")).hovering(5.0)
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


# ------------------------------------------------------------------------------
# A fence that was uploaded to a vehicle before the station came: read at its start, and told.

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


@pytest.mark.parametrize("radius_m", [70.0, 300.0, None])
def test_one_that_is_wider_than_the_policy_s_is_weak_and_none_is_not_told(
    personality: Personality, radius_m: float | None
) -> None:
    flight = Flight(personality, params=NARROW[personality])
    if radius_m is not None:
        stranger_fences(flight, radius_m)
    flight.connected()
    flight.run(5.0)
    told = fence_told(flight)
    assert told
    if radius_m is None:
        assert not any("uploaded" in line for line in told)
    elif radius_m < 150.0:
        assert "uploaded: 1 to stay in, 0 to stay out of, up to 99 m from home" in told[-1]
        assert "policy's is 150 m" not in told[-1].split("uploaded")[1]
        assert "geofence:" not in weak(flight)
    else:
        assert "m from home, the policy's is 150 m" in weak(flight)
