"""The velocities of an orbit, flown by a point mass that has each a little later."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import pytest

from gcs.gate.airspace.stopping import travel_m
from gcs.gate.airspace.stream_samples import sample_counts_s
from gcs.gate.policy.parse import DEFAULT
from gcs.orbit.circle import Nose, Orbit
from gcs.orbit.guidance import Guidance, Place, Setpoint, speed_to_rest

TICK_S = 0.05
PX4 = DEFAULT.braking_of("px4")
RULES = DEFAULT.stream
CENTRE = (10.0, -5.0, -15.0)


def circle(radius_m: float, speed_m_s: float, turn_rad: float | None = None) -> Orbit:
    way = 1 if radius_m > 0.0 else -1
    return Orbit(CENTRE, abs(radius_m), way, speed_m_s, turn_rad, Nose.CENTRE, 0.3)


@dataclass
class PointMass:
    """It comes to each velocity asked for with a time constant, in a wind that it does not know."""

    guidance: Guidance
    pos: tuple[float, float, float]
    lag_s: float
    drift: tuple[float, float] = (0.0, 0.0)
    v: tuple[float, float, float] = (0.0, 0.0, 0.0)
    away_m: list[float] = field(default_factory=list)
    asked: list[tuple[Place, Setpoint]] = field(default_factory=list)
    approached: int = 0
    """How many of these came before the circle."""

    def fly(self, seconds: float) -> None:
        for _ in range(round(seconds / TICK_S)):
            place = Place(self.pos, self.v, 0.0)
            setpoint = self.guidance.step(place, TICK_S)
            self.asked.append((place, setpoint))
            self.approached += not self.guidance.circling
            share = TICK_S / self.lag_s
            n, e, d = (v + share * (s - v) for v, s in zip(self.v, setpoint.v_ned, strict=True))
            self.v = (n, e, d)
            moved = (n + self.drift[0], e + self.drift[1], d)
            self.pos = tuple(x + TICK_S * v for x, v in zip(self.pos, moved, strict=True))  # type: ignore[assignment]
            self.away_m.append(math.dist(self.pos[:2], CENTRE[:2]))


@pytest.mark.parametrize("lag_s", [0.1, 0.3, 0.6])
@pytest.mark.parametrize(
    ("radius_m", "speed_m_s"), [(20.0, 3.0), (-20.0, 3.0), (5.0, 2.0), (50.0, 10.0), (2.0, 1.0)]
)
def test_it_stays_on_its_circle(radius_m: float, speed_m_s: float, lag_s: float) -> None:
    guidance = Guidance(circle(radius_m, speed_m_s), (0.0, 0.0, -10.0), PX4, RULES)
    mass = PointMass(guidance, (0.0, 0.0, -10.0), lag_s)
    mass.fly(90.0)
    assert max(abs(away - abs(radius_m)) for away in mass.away_m[-400:]) < 0.25
    assert mass.pos[2] == pytest.approx(-15.0, abs=0.05)
    north, east = mass.pos[0] - CENTRE[0], mass.pos[1] - CENTRE[1]
    along = (north * mass.v[1] - east * mass.v[0]) / math.hypot(north, east)
    assert along == pytest.approx(math.copysign(speed_m_s, radius_m), rel=0.05)


def test_a_drift_is_learnt() -> None:
    guidance = Guidance(circle(20.0, 4.0), (0.0, 0.0, -15.0), PX4, RULES)
    mass = PointMass(guidance, (0.0, 0.0, -15.0), 0.3, drift=(0.3, -0.2))
    mass.fly(120.0)
    assert max(abs(away - 20.0) for away in mass.away_m[-600:]) < 0.6


@pytest.mark.parametrize(
    "start", [(0.0, 0.0, -10.0), (100.0, 40.0, -40.0), (11.0, -5.0, -15.0), (10.0, -5.0, -2.0)]
)
def test_on_its_way_it_can_always_rest_at_its_entry(start: tuple[float, float, float]) -> None:
    """Every sample counts, is followed by a hold, and the vehicle brakes: v held + v^2 / (2 a)."""
    orbit = circle(20.0, 3.0)
    guidance = Guidance(orbit, start, PX4, RULES)
    entry = orbit.entry_ned(start)
    mass = PointMass(guidance, start, 0.3)
    mass.fly(120.0)
    assert guidance.circling
    held_s = sample_counts_s(0.0, RULES) + PX4.react_s
    on_the_way = mass.asked[: mass.approached]
    assert on_the_way
    for place, setpoint in on_the_way:
        left_m = math.dist(place.pos_ned[:2], entry[:2])
        rests_m = travel_m(math.hypot(*setpoint.v_ned[:2]), held_s, PX4.a_brake_h_m_s2)
        assert rests_m <= left_m + 1e-6
    for place, setpoint in mass.asked:
        left_m = abs(place.pos_ned[2] - entry[2])
        assert travel_m(setpoint.v_ned[2], held_s, PX4.a_brake_v_m_s2) <= left_m + 1e-6


def test_no_sample_asks_for_more_than_the_policy_allows() -> None:
    guidance = Guidance(circle(60.0, RULES.max_speed_h_m_s * (1 - 1e-6)), (0, 0, 0), PX4, RULES)
    mass = PointMass(guidance, (400.0, 300.0, -80.0), 0.6)
    mass.fly(200.0)
    for _, setpoint in mass.asked:
        north, east, down = setpoint.v_ned
        assert math.hypot(north, east) <= RULES.max_speed_h_m_s
        assert -RULES.max_speed_up_m_s <= down <= RULES.max_speed_down_m_s


def test_it_is_done_after_its_turns_and_not_before() -> None:
    guidance = Guidance(circle(-10.0, 3.0, 2.5 * math.tau), (20.0, -5.0, -15.0), PX4, RULES)
    mass = PointMass(guidance, (20.0, -5.0, -15.0), 0.3)
    while not guidance.done:
        mass.fly(TICK_S)
        assert len(mass.asked) < 2000
    assert guidance.swept_rad == pytest.approx(2.5 * math.tau, abs=0.05)
    flown_s = 2.5 * math.tau * 10.0 / 3.0
    assert len(mass.asked) * TICK_S == pytest.approx(flown_s, abs=4.0)


@pytest.mark.parametrize(
    ("nose", "yaw_deg"),
    [
        (Nose.CENTRE, -90.0),
        (Nose.ALONG, 180.0),
        (Nose.INITIAL, math.degrees(0.3)),
        (Nose.FREE, None),
    ],
)
def test_the_nose_east_of_the_centre(nose: Nose, yaw_deg: float | None) -> None:
    """Clockwise, a vehicle in the east of the centre flies south."""
    orbit = Orbit(CENTRE, 20.0, 1, 3.0, None, nose, 0.3)
    east_of_it = (CENTRE[0], CENTRE[1] + 20.0, CENTRE[2])
    guidance = Guidance(orbit, east_of_it, PX4, RULES)
    setpoint = guidance.step(Place(east_of_it, (0.0, 0.0, 0.0), 0.0), TICK_S)
    if yaw_deg is None:
        assert setpoint.yaw_rad is None
    else:
        assert setpoint.yaw_rad is not None
        off_deg = math.degrees(setpoint.yaw_rad) - yaw_deg
        assert math.remainder(off_deg, 360.0) == pytest.approx(0.0, abs=1e-6)
    assert setpoint.v_ned[0] < 0.0, "southward"


@pytest.mark.parametrize(("way", "begins_m_s"), [(1, 3.0), (-1, TICK_S)])
def test_one_that_flies_round_already_goes_on_at_its_speed(way: int, begins_m_s: float) -> None:
    """Southward in the east of the centre is clockwise; the other way round it begins anew."""
    orbit = Orbit(CENTRE, 20.0, way, 3.0, None, Nose.FREE, None)
    east_of_it = (CENTRE[0], CENTRE[1] + 20.0, CENTRE[2])
    guidance = Guidance(orbit, east_of_it, PX4, RULES)
    setpoint = guidance.step(Place(east_of_it, (-3.0, 0.0, 0.0), 0.0), TICK_S)
    assert math.hypot(*setpoint.v_ned[:2]) == pytest.approx(begins_m_s)


def test_an_old_position_is_taken_on_by_its_velocity() -> None:
    assert Place((1.0, 2.0, 3.0), (2.0, -4.0, 1.0), 0.5).now_ned == (2.0, 0.0, 3.5)


@pytest.mark.parametrize("left_m", [0.0, 0.1, 1.0, 30.0])
def test_the_speed_to_rest_is_the_stopping_distance_turned_round(left_m: float) -> None:
    speed_m_s = speed_to_rest(left_m, 1.25, 2.0)
    assert travel_m(speed_m_s, 1.25, 2.0) == pytest.approx(left_m)
