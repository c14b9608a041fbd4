"""Orbits that are clear, and those that are not: the way, the circle, the room to stop."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from msgspec import structs

from gcs.gate.airspace.bounds import Cleared
from gcs.gate.airspace.stream_samples import StreamSample
from gcs.gate.airspace.verifier import Verifier, verifier_for
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Policy
from gcs.gate.policy.zonespec import CircleSpec
from gcs.orbit.circle import Nose, Orbit
from gcs.orbit.clearance import why_not
from tests.shares import one_in

FIELD = CircleSpec(90.0, (0.0, 0.0), name="field", inclusion=True, ceiling_up_m=50.0)
TOWER = CircleSpec(3.0, (0.0, 25.0), name="tower", inclusion=False)
"""25 m north."""
HOME = (0.0, 0.0, 0.0)
HERE = (0.0, 0.0, -10.0)
REST = (0.0, 0.0, 0.0)
both = pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
SLOW = [(1, 1.0), (-1, 1.0), (1, 3.0), (-1, 3.0)]
FAST = [(-1, 9.9), (1, 9.9), (-1, 6.0), (1, 6.0)]
"""Way round and speed; each takes a second, and the first of four is flown by `make quick`."""


def verifier(autopilot: str, policy: Policy = DEFAULT) -> Verifier:
    fenced = structs.replace(policy, fence=(FIELD, TOWER))
    return verifier_for(fenced, autopilot, HOME, None)


def circle(north_m: float, east_m: float, radius_m: float, speed_m_s: float = 2.0) -> Orbit:
    return Orbit((north_m, east_m, -10.0), radius_m, 1, speed_m_s, None, Nose.CENTRE, 0.0)


def reason(orbit: Orbit, autopilot: str) -> str:
    refusal = why_not(orbit, verifier(autopilot), HERE, REST)
    return "" if refusal is None else f"{refusal.zone}: {refusal.sentence}"


@both
def test_clear_round_the_tower_and_beside_it(autopilot: str) -> None:
    assert reason(circle(25.0, 0.0, 12.0), autopilot) == ""
    assert reason(circle(0.0, 40.0, 15.0), autopilot) == ""


@both
def test_through_the_tower_or_past_the_fence(autopilot: str) -> None:
    assert reason(circle(12.5, 0.0, 12.5), autopilot).startswith("tower: the circle of 12.5 m")
    assert reason(circle(0.0, 60.0, 40.0), autopilot).startswith("field: the circle of 40.0 m")


@both
def test_beyond_the_tower(autopilot: str) -> None:
    assert reason(circle(50.0, 0.0, 10.0), autopilot).startswith("tower: the leg to")


@both
def test_an_entry_outside(autopilot: str) -> None:
    assert reason(circle(0.0, 120.0, 20.0), autopilot).startswith("field: goal")


@both
def test_room_to_stop_depends_on_the_speed(autopilot: str) -> None:
    """42 m about a place 40 m south ends 8 m before the fence."""
    assert reason(circle(-40.0, 0.0, 42.0, 9.0), autopilot).startswith("field: the room to stop")
    assert reason(circle(-40.0, 0.0, 42.0, 2.0), autopilot) == ""


@both
def test_too_high(autopilot: str) -> None:
    orbit = replace(circle(0.0, 40.0, 15.0), centre_ned=(0.0, 40.0, -49.9))
    assert "field: goal" in reason(orbit, autopilot)


@both
@pytest.mark.parametrize(("way", "speed_m_s"), one_in(4, SLOW + FAST))
def test_every_sample_of_a_cleared_orbit_clears(autopilot: str, speed_m_s: float, way: int) -> None:
    """The largest circle about a place that is cleared, flown a metre beside it, by a position as
    old as a stream's may be."""
    asked = verifier(autopilot)
    radius_m = max(
        (r / 4.0 for r in range(120, 340) if _is_clear(r / 4.0, speed_m_s, asked)), default=0.0
    )
    assert radius_m > 30.0
    for degrees in range(0, 360, 3):
        angle = math.radians(degrees)
        for away_m in (radius_m - 1.0, radius_m, radius_m + 1.0):
            pos = (away_m * math.cos(angle), away_m * math.sin(angle), -10.0)
            v = (-way * speed_m_s * math.sin(angle), way * speed_m_s * math.cos(angle), 0.0)
            age_s = DEFAULT.stream.position_age_s
            answer = asked.stream_sample(StreamSample(v_ned=v), pos, v, age_s)
            assert isinstance(answer, Cleared), (radius_m, answer)


def _is_clear(radius_m: float, speed_m_s: float, asked: Verifier) -> bool:
    orbit = circle(0.0, 0.0, radius_m, speed_m_s)
    return why_not(orbit, asked, (0.0, radius_m, -10.0), REST) is None
