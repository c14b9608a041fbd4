"""Mission items by themselves: what each makes the vehicle do, and when."""

from __future__ import annotations

from math import atan2, degrees, hypot, nan, remainder, sqrt

import pytest

from tests.unit.autopilot.flight import Flight, item
from tests.unit.autopilot.test_mission import either, numbered, reached, reached_now, started
from vehicle_sim.autopilot.interface import Landed, PlanItem, Result
from vehicle_sim.autopilot.mission.plan import check
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.tasks.spline import curve

TAKE_OFF = item(0, 22, up_m=5.0)
that_waits = pytest.mark.parametrize("personality", ["ardupilot"])
"""PX4 1.14 stores conditions and does not fly them (C9)."""


def heading_deg(flight: Flight) -> float:
    return degrees(flight.vehicle.estimate.heading_rad)


@that_waits
def test_a_condition_delays_what_follows_it_and_not_the_flight(personality: Personality) -> None:
    flight = started(
        personality,
        TAKE_OFF,
        item(1, 16, 5.0, 0.0, 5.0),
        item(2, 112, p1=3.0),
        item(3, 2000, p3=1.0),
        item(4, 16, 60.0, 0.0, 5.0),
    )
    flight.fly(30.0, lambda: reached_now(flight) == [0, 1])
    flight.fly(2.5)
    assert flight.vehicle.images_captured == 0
    assert not flight.capturing()
    assert flight.speed_m_s > 3.0, "it flies on meanwhile"
    flight.fly(1.0)
    assert flight.capturing(), "three seconds after the waypoint"


@that_waits
def test_what_a_condition_holds_up_too_long_is_left_out(personality: Personality) -> None:
    flight = started(
        personality,
        TAKE_OFF,
        item(1, 112, p1=60.0),
        item(2, 2000, p3=1.0),
        item(3, 16, 8.0, 0.0, 5.0),
    )
    flight.fly(40.0, lambda: flight.vehicle.mission_state == 5)
    flight.fly(60.0)
    assert flight.vehicle.images_captured == 0


@that_waits
def test_what_follows_the_last_flown_item_is_done_before_the_end(personality: Personality) -> None:
    flight = started(
        personality,
        TAKE_OFF,
        item(1, 16, 5.0, 0.0, 5.0),
        item(2, 112, p1=4.0),
        item(3, 2000, p3=1.0),
    )
    flight.fly(30.0, lambda: reached_now(flight) == [0, 1])
    flight.fly(3.0)
    assert flight.vehicle.mission_state == 3
    flight.fly(3.0, lambda: flight.vehicle.mission_state == 5)
    assert flight.capturing()


@that_waits
def test_a_distance_is_counted_to_the_next_waypoint(personality: Personality) -> None:
    flight = started(
        personality,
        TAKE_OFF,
        item(1, 114, p1=12.0),
        item(2, 2000, p3=1.0),
        item(3, 16, 40.0, 0.0, 5.0),
    )
    flight.fly(30.0, flight.capturing)
    assert 40.0 - flight.pos[0] == pytest.approx(12.0, abs=1.0)


@that_waits
def test_the_nose_turns_while_it_flies_on(personality: Personality) -> None:
    flight = started(
        personality,
        TAKE_OFF,
        item(1, 115, p1=90.0, p2=30.0, p3=1.0),
        item(2, 16, 40.0, 0.0, 5.0, p4=float("nan")),
    )
    flight.fly(20.0, lambda: reached_now(flight) == [0])
    flight.fly(5.0)
    assert heading_deg(flight) == pytest.approx(90.0, abs=5.0)
    assert flight.speed_m_s > 3.0


@either
def test_a_delay_waits_where_it_is(personality: Personality) -> None:
    flight = started(
        personality, TAKE_OFF, item(1, 16, 8.0, 0.0, 5.0), item(2, 93, p1=5.0), item(3, 16, 20.0)
    )
    flight.fly(30.0, lambda: reached_now(flight) == [0, 1])
    flight.fly(4.8)
    assert reached_now(flight) == [0, 1]
    assert flight.off((8.0, 0.0, -5.0)) < 0.5
    flight.fly(0.5, lambda: reached_now(flight) == [0, 1, 2])


@either
def test_loiter_to_altitude_climbs_at_the_place(personality: Personality) -> None:
    flight = started(personality, TAKE_OFF, item(1, 31, 12.0, 0.0, 9.0), item(2, 16, 0.0, 0.0, 9.0))
    flight.fly(20.0, lambda: flight.pos[0] > 10.0)
    assert flight.up_m == pytest.approx(5.0, abs=0.5), "first there, then up"
    flight.fly(20.0, lambda: reached_now(flight) == [0, 1])
    assert flight.off((12.0, 0.0, -9.0)) < 1.0


@either
def test_a_circle_keeps_its_nose_to_the_centre_and_its_direction(
    personality: Personality,
) -> None:
    flight = started(
        personality, TAKE_OFF, item(1, 18, 0.0, 0.0, 5.0, p1=1.5, p3=-6.0), item(2, 17, up_m=5.0)
    )
    flight.fly(20.0, lambda: hypot(flight.pos[0], flight.pos[1]) > 5.5)
    flight.fly(4.0)
    turned, last = 0.0, atan2(flight.pos[1], flight.pos[0])
    while reached_now(flight) == [0]:
        flight.fly(0.1)
        n, e, _ = flight.pos
        turned += remainder(atan2(e, n) - last, 2.0 * 3.141592653589793)
        last = atan2(e, n)
        nose_off = heading_deg(flight) - degrees(atan2(-e, -n))
        assert abs(remainder(nose_off, 360.0)) < 25.0
        assert flight.vehicle.time_ns < 90e9
    assert turned < -5.0, "counter-clockwise"


@either
def test_px4_takes_off_and_then_goes_to_the_items_place_and_ardupilot_stays(
    personality: Personality,
) -> None:
    flight = started(personality, item(0, 22, 10.0, 0.0, 5.0), item(1, 17, 10.0, 0.0, 5.0))
    flight.fly(20.0, lambda: flight.landed() is Landed.IN_AIR)
    assert abs(flight.pos[0]) < 1.0
    flight.fly(20.0, lambda: reached_now(flight) == [0])
    north_m = flight.pos[0]
    assert north_m > 7.0 if personality == "px4" else north_m < 1.0


@either
def test_home_moves_and_the_nose_looks_at_a_place(personality: Personality) -> None:
    flight = started(
        personality,
        TAKE_OFF,
        item(1, 179, p1=1.0),
        item(2, 195, 20.0, 30.0, 0.0),
        item(3, 16, 20.0, 0.0, 5.0),
        item(4, 197),
        item(5, 16, 40.0, 0.0, 5.0),
    )
    flight.fly(30.0, lambda: 3 in reached_now(flight))
    assert heading_deg(flight) == pytest.approx(90.0, abs=12.0)
    home = flight.vehicle.home_pos_ned
    assert home is not None
    # PX4's climb is over within NAV_MC_ALT_RAD of its height.
    assert -home[2] == pytest.approx(4.35 if personality == "px4" else 5.0, abs=0.35)
    flight.fly(4.0)
    assert abs(remainder(heading_deg(flight), 360.0)) < 12.0


# --------------------------------------------------------------------------------- splines


def test_a_curve_goes_through_its_ends_with_its_tangents() -> None:
    bow = curve((0.0, 0.0, -5.0), (10.0, 10.0, -6.0), (-10.0, 0.0, -5.0), (20.0, 0.0, -5.0))
    assert bow.at(0.0) == (0.0, 0.0, -5.0)
    assert bow.at(1.0) == pytest.approx((10.0, 10.0, -6.0))
    assert bow.tangent(0.0) == pytest.approx((10.0, 5.0, -0.5))
    assert bow.tangent(1.0) == pytest.approx((10.0, 0.0, 0.0))
    h = 1e-5
    for u in (0.2, 0.5, 0.9):
        ahead, behind = bow.at(u + h), bow.at(u - h)
        slope = tuple((a - b) / (2 * h) for a, b in zip(ahead, behind, strict=True))
        assert bow.tangent(u) == pytest.approx(slope, abs=1e-5)
        ahead, behind = bow.tangent(u + h), bow.tangent(u - h)
        slope = tuple((a - b) / (2 * h) for a, b in zip(ahead, behind, strict=True))
        assert bow.bend(u) == pytest.approx(slope, abs=1e-4)
    ends_straight = curve(
        (0.0, 0.0, -5.0), (10.0, 10.0, -6.0), None, (20.0, 0.0, -5.0), after_is_spline=False
    )
    assert ends_straight.tangent(1.0) == pytest.approx((5.0, -5.0, 0.5))
    straight = curve((0.0, 0.0, 0.0), (3.0, 4.0, 0.0), None, None)
    assert straight.length_from(0.0) == pytest.approx(5.0)
    assert straight.length_from(1.0) == 0.0


def test_long_tangents_are_shortened_alike() -> None:
    """SplineCurve::set_origin_and_destination: to four times the straight way, both together;
    half of it here."""
    bow = curve((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, -6.0, 0.0), (0.0, 2.0, 0.0))
    first, last = bow.tangent(0.0), bow.tangent(1.0)
    assert hypot(*first) + hypot(*last) == pytest.approx(2.0)
    assert (first[1] / first[0], last[0]) == pytest.approx((6.0, 0.0))
    assert hypot(*first) / hypot(*last) == pytest.approx(hypot(1.0, 6.0) / 2.0)


def test_no_speed_is_left_over_where_a_straight_leg_follows_a_spline() -> None:
    """The curve ends along that leg, so the vehicle does not swing past it."""
    flight = started(
        "ardupilot",
        TAKE_OFF,
        item(1, 82, 60.0, 0.0, 5.0),
        item(2, 16, 60.0, 60.0, 5.0),
    )
    farthest_north_m = 0.0
    while flight.vehicle.mission_state == 3:
        flight.fly(0.1)
        if flight.pos[1] > 1.0:
            farthest_north_m = max(farthest_north_m, flight.pos[0])
        assert flight.vehicle.time_ns < 90e9
    assert farthest_north_m < 63.0


def test_a_spline_is_flown_no_faster_than_its_next_bend_allows() -> None:
    """It left this one by 5 m: from 8 m/s into a bend that leads back."""
    end, after = (-21.3, -32.2, -5.0), (-57.0, 45.7, -5.0)
    flight = started(
        "ardupilot",
        TAKE_OFF,
        item(1, 82, end[0], end[1], 5.0),
        item(2, 16, after[0], after[1], 5.0),
    )
    bow = curve((0.0, 0.0, -5.0), end, None, after, after_is_spline=False)
    way = [bow.at(n / 100) for n in range(101)]
    flight.fly(30.0, lambda: reached_now(flight) == [0])
    farthest_m = 0.0
    while 1 not in reached_now(flight):
        flight.fly(0.1)
        n, e, _ = flight.pos
        farthest_m = max(farthest_m, min(hypot(n - at[0], e - at[1]) for at in way))
        assert flight.vehicle.time_ns < 90e9
    assert farthest_m < 2.0


def test_a_mission_that_ends_on_a_circle_stays_where_its_turns_end() -> None:
    flight = started("ardupilot", TAKE_OFF, item(1, 18, 30.0, 0.0, 5.0, p1=0.5, p3=10.0))
    flight.fly(90.0, lambda: flight.vehicle.mission_state == 5)
    flight.fly(8.0)
    there = flight.pos
    assert there[0] > 35.0, "on the far side, not where the circle began"
    flight.fly(3.0)
    assert flight.off(there) < 0.3


def test_splines_are_flown_smoothly_through_their_points() -> None:
    points = [(15.0, 0.0), (30.0, 15.0), (15.0, 30.0), (0.0, 15.0)]
    flight = started(
        "ardupilot",
        TAKE_OFF,
        *(item(n, 82, north, east, 5.0) for n, (north, east) in enumerate(points, 1)),
    )
    flight.fly(20.0, lambda: reached_now(flight) == [0])
    nearest = dict.fromkeys(points, 99.0)
    slowest, sharpest, last_v = 99.0, 0.0, (0.0, 0.0)
    while flight.vehicle.mission_state == 3:
        flight.fly(0.1)
        n, e, _ = flight.pos
        nearest = {p: min(d, hypot(n - p[0], e - p[1])) for p, d in nearest.items()}
        v = flight.vehicle.truth.v_ned
        under_way = hypot(n, e) > 5.0 and hypot(n - 0.0, e - 15.0) > 6.0
        if under_way:
            slowest = min(slowest, hypot(v[0], v[1]))
            sharpest = max(sharpest, sqrt((v[0] - last_v[0]) ** 2 + (v[1] - last_v[1]) ** 2) / 0.1)
        last_v = (v[0], v[1])
        assert flight.vehicle.time_ns < 90e9
    assert max(nearest.values()) < 1.5, nearest
    assert slowest > 1.0, "it does not stop at the points between"
    assert sharpest < 4.0
    assert reached_now(flight) == [0, 1, 2, 3, 4]


def test_a_spline_with_a_delay_stops_and_waits() -> None:
    flight = started(
        "ardupilot",
        TAKE_OFF,
        item(1, 82, 15.0, 0.0, 5.0, p1=4.0),
        item(2, 82, 15.0, 15.0, 5.0),
    )
    flight.fly(30.0, lambda: flight.off((15.0, 0.0, -5.0)) < 0.6)
    flight.fly(2.5)
    assert flight.off((15.0, 0.0, -5.0)) < 0.6
    flight.fly(20.0, lambda: flight.vehicle.mission_state == 5)


def test_px4_knows_no_splines() -> None:
    refusal = check((TAKE_OFF, item(1, 82, 5.0, 0.0, 5.0)), "px4")
    assert refusal is not None
    assert refusal[0] == 1
    assert check(numbered("ardupilot", TAKE_OFF, item(1, 82, 5.0, 0.0, 5.0)), "ardupilot") is None


@pytest.mark.parametrize(
    ("bad", "word"),
    [
        (item(1, 93, p1=-1.0, p2=12.0), "time of day"),
        (item(1, 112, p1=-2.0), "time"),
        (item(1, 113, p1=1.0), "113"),
        (item(1, 114, p1=-2.0), "distance"),
        (item(1, 178, p1=2.0, p2=-3.0), "speed"),
        (item(1, 179, frame=2, p1=0.0), "missing"),
        (item(1, 18, 5.0, p1=float("inf")), "turns"),
        (item(1, 83, 5.0), "83"),
    ],
)
@either
def test_more_that_is_refused(personality: Personality, bad: PlanItem, word: str) -> None:
    first = 1 if personality == "ardupilot" else 0
    refusal = Flight(personality).vehicle.check_plan(numbered(personality, TAKE_OFF, bad))
    assert refusal is not None
    assert refusal[0] == 1 + first
    assert word in refusal[1]


def fastest_m_s(kind: float, there: PlanItem, personality: Personality) -> tuple[float, float]:
    """Over ground and upwards, on the way there after DO_CHANGE_SPEED to 1 m/s."""
    slow = item(2, 178, p1=kind, p2=1.0)
    flight = started(personality, TAKE_OFF, item(1, 93, p1=2.0), slow, there)
    first = 1 if personality == "ardupilot" else 0
    flight.fly(60.0, lambda: flight.vehicle.mission_current == 3 + first)
    level_m_s = up_m_s = 0.0
    while flight.vehicle.mission_state == 3:
        flight.fly(0.2)
        n, e, d = flight.vehicle.truth.v_ned
        level_m_s, up_m_s = max(level_m_s, hypot(n, e)), max(up_m_s, -d)
        assert flight.vehicle.time_ns < 90e9
    return level_m_s, up_m_s


def test_an_ardupilot_s_mission_says_how_fast_it_climbs() -> None:
    """Recorded of the command (H1_change_speed); that a mission's item does so is from memory."""
    level_m_s, up_m_s = fastest_m_s(2.0, item(3, 16, 15.0, 0.0, 15.0), "ardupilot")
    assert level_m_s > 1.2
    assert up_m_s < 1.2
    assert fastest_m_s(3.0, item(3, 16, 15.0, 0.0, 15.0), "ardupilot")[1] > 1.2


@pytest.mark.parametrize("kind", [2.0, 3.0, 7.0])
def test_a_px4_s_mission_changes_its_speed_whatever_type_it_says(kind: float) -> None:
    """H1b_change_speed_type_ignored, of the command; of a mission's item from memory."""
    level_m_s, _ = fastest_m_s(kind, item(3, 16, 20.0, 0.0, 5.0), "px4")
    assert 0.8 < level_m_s < 1.3


@either
def test_a_landing_amid_a_mission_ends_the_flight_of_an_ardupilot_alone(
    personality: Personality,
) -> None:
    """From memory: PX4's commander does not disarm amid a mission, AP_Mission's landing does."""
    land, on = item(2, 21, 6.0), item(3, 16, 0.0, 0.0, 5.0)
    flight = started(personality, TAKE_OFF, item(1, 16, 6.0, 0.0, 5.0), land, on)
    flight.fly(60.0, lambda: reached_now(flight)[-1:] == [2] or not flight.vehicle.armed)
    flight.fly(30.0)
    flies_on = personality == "px4"
    assert (flight.vehicle.armed, flight.up_m > 3.0) == (flies_on, flies_on)


@either
def test_a_mission_that_is_changed_in_flight_starts_from_its_beginning(
    personality: Personality,
) -> None:
    flight = started(personality, TAKE_OFF, item(1, 16, 60.0, 0.0, 5.0))
    flight.fly(10.0)
    plan = numbered(personality, item(0, 16, 0.0, 10.0, 5.0), item(1, 16, 0.0, 20.0, 5.0))
    assert flight.vehicle.check_plan(plan) is None
    flight.seen.clear()
    flight.vehicle.load_plan(plan)
    flight.fly(40.0, lambda: flight.vehicle.mission_state == 5)
    assert reached_now(flight) == [0, 1]
    assert flight.off((0.0, 20.0, -5.0)) < 3.0


@either
def test_a_jump_for_ever_comes_back_until_it_is_taken_away(personality: Personality) -> None:
    flight = started(
        personality,
        TAKE_OFF,
        item(1, 16, 6.0, 0.0, 5.0),
        item(2, 16, 0.0, 0.0, 5.0),
        item(3, 177, p1=1.0, p2=-1.0),
        item(4, 16, 0.0, 90.0, 5.0),
    )
    flight.fly(40.0)
    assert len(reached_now(flight)) > 6
    assert 4 not in reached(flight)
    flight.vehicle.mission_set_current(4 + (personality == "ardupilot"))
    flight.fly(2.0)
    if personality == "ardupilot":
        assert flight.vehicle.pause() is Result.ACCEPTED
    else:
        assert flight.vehicle.set_mode_kind("hold") is Result.ACCEPTED


@pytest.mark.parametrize("frame", [0, 3])
def test_ardupilot_keeps_its_height_at_an_altitude_of_0(frame: int) -> None:
    """As ArduCopter 4.7 flew a waypoint in frame 3, then a spline, then a waypoint in frame 0."""
    flight = started(
        "ardupilot",
        TAKE_OFF,
        _at(1, 16, 12.0, 0.0, frame),
        _at(2, 82, 12.0, 12.0, frame),
        item(3, 16, 0.0, 12.0, 5.0),
    )
    lowest_m = 5.0
    while not reached(flight)[3:]:
        flight.fly(0.5)
        if reached(flight):
            lowest_m = min(lowest_m, flight.up_m)
    assert lowest_m > 4.0


def _at(seq: int, command: int, north_m: float, east_m: float, frame: int) -> PlanItem:
    """At an altitude of 0."""
    projection = Flight("ardupilot").vehicle.state.projection
    place = projection.to_geodetic((north_m, east_m, 0.0))
    x, y = round(place.lat_deg * 1e7), round(place.lon_deg * 1e7)
    return PlanItem(seq, frame, command, 0.0, 0.0, 0.0, nan, x, y, 0.0, 1)
