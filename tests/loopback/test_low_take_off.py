"""Take-offs hover at their height, and a return climbs, whatever the vehicle's parameters."""

from __future__ import annotations

import random

import pytest

from gcs.gate.states import State
from tests.loopback.flight import Flight, Personality
from tests.shares import seeds
from vehicle_sim.autopilot.firmware import Firmware

# ------------------------------------------------------------------------------
# A take-off hovers at the height that was asked for, wherever the vehicle ends its climb.
#
# PX4 ends it within NAV_MC_ALT_RAD, 0.8 m by default, of its height (autopilots.md, defect 1 of the
# station: 0.3 to 0.7 m were recorded).

ASKED_WITHIN_M = 0.2
TAKE_OFFS = 24
TAKE_OFFS_IN_EACH_RUN = 6


def takes_off(flight: Flight, up_m: float) -> float:
    """Take off to `up_m`; metres that it hovers too low."""
    flight.hovering(up_m)
    flight.run(3.0)
    assert flight.is_in(State.HOVERING)
    return up_m - flight.truth_enu()[2]


@pytest.mark.parametrize("seed", seeds(3, TAKE_OFFS_IN_EACH_RUN, TAKE_OFFS))
def test_a_climb_that_ends_low_by_chance_hovers_at_the_height_that_was_asked_for(seed: int) -> None:
    chance = random.Random(seed)
    up_m, low_m = chance.uniform(1.5, 6.0), chance.uniform(0.05, 0.8)
    flight = Flight("px4", seed=seed, params={"NAV_MC_ALT_RAD": low_m})
    assert abs(takes_off(flight, up_m)) < ASKED_WITHIN_M


@pytest.mark.parametrize("up_m", [1.0, 1.5, 3.0])
def test_a_take_off_hovers_at_the_height_that_was_asked_for(
    personality: Personality, up_m: float
) -> None:
    """newcomer.md 13: 1, 1.5 and 3 m became 0.83, 1.35 and 2.85."""
    assert abs(takes_off(Flight(personality), up_m)) < ASKED_WITHIN_M


def test_a_vehicle_that_ends_its_climb_lower_still_says_so_itself() -> None:
    """NAV_MC_ALT_RAD is read, not assumed."""
    flight = Flight("px4", params={"NAV_MC_ALT_RAD": 2.0})
    assert abs(takes_off(flight, 4.0)) < ASKED_WITHIN_M


# ------------------------------------------------------------------------------
# What the station makes of an ArduCopter whose parameters have the names of 4.5, or of 4.7.


@pytest.mark.parametrize("firmware", ["4.5", "4.7"])
def test_an_ardupilot_returns_with_the_names_of_either_firmware(
    firmware: Firmware,
) -> None:
    flight = Flight("ardupilot", firmware=firmware).hovering(5.0)
    assert flight.done(flight.say("rtl"), 120.0) == "complete"
    assert flight.is_in(State.GROUNDED)
