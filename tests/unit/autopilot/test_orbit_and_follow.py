"""Circles, leaders and regions of interest, flown."""

from __future__ import annotations

from math import atan2, cos, hypot, inf, nan, pi, remainder, sin

import pytest

from tests.unit.autopilot.hand_flight import HandFlight
from vehicle_sim.autopilot.interface import Geodetic, Landed, OrbitRequest, Result
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.numerics.vectors import Vec3


def asked(
    radius_m: float | None = 10.0,
    speed_m_s: float | None = 3.0,
    nose: int | None = 0,
    centre_ne: tuple[float, float] | None = (20.0, 0.0),
    down_m: float | None = -6.0,
) -> OrbitRequest:
    return OrbitRequest(radius_m, speed_m_s, nose, centre_ne, down_m)


def bearing_from(flight: HandFlight, north: float, east: float) -> float:
    return atan2(flight.pos[1] - east, flight.pos[0] - north)


def off_nose(flight: HandFlight, wanted_rad: float) -> float:
    return abs(remainder(flight.vehicle.estimate.heading_rad - wanted_rad, 2.0 * pi))


@pytest.mark.parametrize("radius_m", [10.0, -10.0])
def test_px4_orbits_round_a_centre_at_radius_speed_and_height(radius_m: float) -> None:
    """A positive radius is clockwise seen from above; the nose points at the centre."""
    flight = HandFlight.hovering("px4", 5.0)
    assert flight.vehicle.orbit(asked(radius_m)) is Result.ACCEPTED
    assert flight.vehicle.mode_name == "POSCTL.ORBIT"
    flight.fly(12.0)
    way = 1.0 if radius_m > 0.0 else -1.0
    for _ in range(20):
        before = bearing_from(flight, 20.0, 0.0)
        flight.fly(1.0)
        turned = remainder(bearing_from(flight, 20.0, 0.0) - before, 2.0 * pi)
        assert way * turned == pytest.approx(0.3, abs=0.1)
        away_m = hypot(flight.pos[0] - 20.0, flight.pos[1])
        assert away_m == pytest.approx(10.0, abs=0.8)
        assert flight.up_m == pytest.approx(6.0, abs=0.8)
        assert off_nose(flight, bearing_from(flight, 20.0, 0.0) + pi) < 0.25
    told = flight.vehicle.orbiting
    assert told is not None
    assert told.radius_m == radius_m
    assert told.centre_ned == pytest.approx((20.0, 0.0, -6.0))


def test_px4_keeps_the_nose_as_asked_and_changes_an_orbit_in_flight() -> None:
    flight = HandFlight.hovering("px4", 5.0)
    heading = flight.vehicle.estimate.heading_rad
    assert flight.vehicle.orbit(asked(nose=1)) is Result.ACCEPTED
    flight.fly(25.0)
    assert off_nose(flight, heading) < 0.3
    along = asked(15.0, None, 3, None, None)
    assert flight.vehicle.orbit(along) is Result.ACCEPTED
    flight.fly(25.0)
    assert hypot(flight.pos[0] - 20.0, flight.pos[1]) == pytest.approx(15.0, abs=0.8)
    velocity = flight.vehicle.truth.v_ned
    assert off_nose(flight, atan2(velocity[1], velocity[0])) < 0.35


def test_px4_orbits_where_it_is_when_no_centre_is_given() -> None:
    flight = HandFlight.hovering("px4", 5.0)
    north, east, _ = flight.pos
    assert flight.vehicle.orbit(asked(5.0, 2.0, 0, None, None)) is Result.ACCEPTED
    flight.fly(15.0)
    assert hypot(flight.pos[0] - north, flight.pos[1] - east) == pytest.approx(5.0, abs=1.0)


def test_px4_limits_the_speed_by_what_bends_into_the_circle_and_refuses_wide_circles() -> None:
    flight = HandFlight.hovering("px4", 5.0)
    assert flight.vehicle.orbit(asked(2000.0)) is Result.DENIED
    assert flight.vehicle.orbit(asked(0.5)) is Result.DENIED
    assert flight.vehicle.mode_name == "AUTO.LOITER"
    assert flight.vehicle.orbit(asked(8.0, 20.0)) is Result.ACCEPTED
    flight.fly(20.0)
    # sqrt(2 m/s^2 * 8 m)
    assert hypot(*flight.vehicle.truth.v_ned[:2]) == pytest.approx(4.0, abs=0.5)


def test_the_sticks_change_an_orbit() -> None:
    """Pitch forward draws it in, roll right slows it down and turns it round."""
    flight = HandFlight.hovering("px4", 5.0)
    assert flight.vehicle.orbit(asked()) is Result.ACCEPTED
    flight.fly(15.0)
    flight.hold(1.0, forward=800)
    flight.hold(8.0)
    assert flight.vehicle.mode_name == "POSCTL.ORBIT"
    away_m = hypot(flight.pos[0] - 20.0, flight.pos[1])
    told = flight.vehicle.orbiting
    assert told is not None
    assert told.radius_m < 8.5
    assert away_m == pytest.approx(told.radius_m, abs=1.0)
    flight.hold(3.0, right=1000)
    reversed_ = flight.vehicle.orbiting
    assert reversed_ is not None
    assert reversed_.radius_m < 0.0


def test_an_orbit_wants_a_px4_and_moves_none_on_the_ground() -> None:
    """commands_px4.json: ACCEPTED on the ground."""
    flight = HandFlight("px4")
    flight.fly(20.0)
    assert flight.vehicle.orbit(asked()) is Result.ACCEPTED
    flight.fly(3.0)
    assert flight.landed() is Landed.ON_GROUND
    copter = HandFlight.hovering("ardupilot", 5.0)
    assert copter.vehicle.orbit(asked()) is Result.UNSUPPORTED


def test_ardupilot_circles_round_a_point_ahead() -> None:
    flight = HandFlight.hovering("ardupilot", 5.0)
    heading = flight.vehicle.estimate.heading_rad
    flight.vehicle.parameters.set("CIRCLE_RADIUS", 800)
    centre = (flight.pos[0] + 8.0 * cos(heading), flight.pos[1] + 8.0 * sin(heading))
    assert flight.mode("CIRCLE") is Result.ACCEPTED
    flight.fly(5.0)
    before = bearing_from(flight, *centre)
    flight.fly(3.0)
    turned = remainder(bearing_from(flight, *centre) - before, 2.0 * pi)
    assert turned == pytest.approx(3.0 * 20.0 * pi / 180.0, abs=0.25)
    assert hypot(flight.pos[0] - centre[0], flight.pos[1] - centre[1]) == pytest.approx(
        8.0, abs=1.0
    )
    assert flight.vehicle.orbiting is None, "only PX4 tells of its circles"


class Lead:
    """A leader that goes north-east at 1.5 m/s, and says so at 5 Hz."""

    v_ned: Vec3 = (1.5, 1.5, 0.0)

    def __init__(self, flight: HandFlight, start_ne: tuple[float, float]) -> None:
        self.flight = flight
        self.north, self.east = start_ne

    def walk(self, seconds: float, system: int = 42) -> None:
        home = self.flight.vehicle.home
        assert home is not None
        for _ in range(round(seconds * 5)):
            self.north += self.v_ned[0] * 0.2
            self.east += self.v_ned[1] * 0.2
            where = Geodetic(
                home.lat_deg + self.north / 111_319.5,
                home.lon_deg + self.east / (111_319.5 * cos(home.lat_deg * pi / 180.0)),
                home.alt_amsl_m,
            )
            v = self.flight.vehicle
            v.hear_leader(system, where, self.v_ned, 0.25 * pi, v.time_ns)
            self.flight.fly(0.2)


def test_px4_follows_behind_at_its_distance_and_height_and_stops_with_the_leader_gone() -> None:
    flight = HandFlight.hovering("px4", 5.0)
    lead = Lead(flight, (10.0, 10.0))
    lead.walk(1.0)
    assert flight.vehicle.set_mode_kind("follow") is Result.ACCEPTED
    assert flight.vehicle.mode_name == "AUTO.FOLLOW_TARGET"
    lead.walk(25.0)
    behind = (lead.north - 8.0 * 0.7071, lead.east - 8.0 * 0.7071)
    assert hypot(flight.pos[0] - behind[0], flight.pos[1] - behind[1]) < 1.5
    assert flight.up_m == pytest.approx(8.0, abs=1.0)
    assert off_nose(flight, 0.25 * pi) < 0.3
    flight.fly(6.0)
    assert flight.flat_m_s < 0.4
    assert flight.vehicle.mode_name == "AUTO.FOLLOW_TARGET"
    lead.north, lead.east = flight.pos[0], flight.pos[1]
    lead.walk(20.0)
    assert flight.flat_m_s > 1.0, "it goes on when the leader speaks again"


def test_px4_takes_the_side_that_the_parameter_says() -> None:
    flight = HandFlight.hovering("px4", 5.0)
    flight.vehicle.parameters.set("FLW_TGT_FA", 90.0)
    flight.vehicle.parameters.set("FLW_TGT_DST", 5.0)
    lead = Lead(flight, (10.0, 10.0))
    lead.walk(1.0)
    assert flight.vehicle.set_mode_kind("follow") is Result.ACCEPTED
    lead.walk(25.0)
    side = (lead.north - 5.0 * 0.7071, lead.east + 5.0 * 0.7071)
    assert hypot(flight.pos[0] - side[0], flight.pos[1] - side[1]) < 1.5


def test_ardupilot_follows_only_when_enabled_and_only_its_leader() -> None:
    flight = HandFlight.hovering("ardupilot", 5.0)
    assert flight.mode("FOLLOW") is Result.FAILED
    flight.fly(0.1)
    assert "Set FOLL_ENABLE = 1" in flight.texts()
    assert "Mode change to Follow failed: init failed" in flight.texts()
    for name, value in (
        ("FOLL_ENABLE", 1),
        ("FOLL_SYSID", 42),
        ("FOLL_OFS_X", -5.0),
        ("FOLL_OFS_TYPE", 1),
        ("FOLL_OFS_Z", -6.0),
    ):
        flight.vehicle.parameters.set(name, value)
    assert flight.mode("FOLLOW") is Result.ACCEPTED
    other = Lead(flight, (40.0, -40.0))
    other.walk(3.0, system=7)
    assert flight.flat_m_s < 0.5
    lead = Lead(flight, (5.0, 5.0))
    lead.walk(25.0)
    behind = (lead.north - 5.0 * 0.7071, lead.east - 5.0 * 0.7071)
    assert hypot(flight.pos[0] - behind[0], flight.pos[1] - behind[1]) < 1.5
    assert flight.up_m == pytest.approx(6.0, abs=1.0)


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_the_nose_points_at_a_region_of_interest_until_told_otherwise(
    personality: Personality,
) -> None:
    flight = HandFlight.hovering(personality, 5.0)
    assert flight.vehicle.look_at((flight.pos[0], flight.pos[1] - 30.0, 0.0)) is Result.ACCEPTED
    flight.fly(8.0)
    assert off_nose(flight, -0.5 * pi) < 0.15
    assert flight.vehicle.look_at(None) is Result.ACCEPTED
    flight.vehicle.condition_yaw(0.5, False, 1.0, 0)
    flight.fly(6.0)
    assert off_nose(flight, 0.5) < 0.15


@pytest.mark.parametrize("bad", [nan, inf])
def test_a_region_of_interest_that_is_nowhere_is_denied(bad: float) -> None:
    flight = HandFlight.hovering("px4", 5.0)
    assert flight.vehicle.look_at((bad, 0.0, 0.0)) is Result.DENIED
