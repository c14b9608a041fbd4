"""Where a mission may be flown beside its legs: cut corners, curves, rings, rally points."""

from __future__ import annotations

import math
import random
from dataclasses import replace

import pytest
import shapely

from gcs.frames import Vec3
from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.airspace.verifier import verifier_for
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.zonespec import CircleSpec
from gcs.gate.refusal import Code, Refusal
from gcs.plan.commands import KINDS, WITH_PLACE
from gcs.plan.flown.circles import circle_ends, entries, first_arc, way_on
from gcs.plan.flown.curves import Neighbours, Onward, pieces, splines
from gcs.plan.flown.path import flight_path
from gcs.plan.flown.returns import landing_places
from gcs.plan.flown.turns import blend, turning_places
from gcs.plan.items import ROWS, Flown, flown_as
from gcs.plan.legs import FlightPath, FlightSettings, Ground, LandingPlace, RegionKind
from gcs.plan.model import AutopilotName, Frame, Geographic, Item, Local, Plan
from gcs.plan.verify import Verification, verify
from gcs.wire.ids import Cmd
from vehicle_sim.autopilot.tasks.spline import curve as flown_curve

ORIGIN = Origin(47.397742, 8.545594, 488.0)
HOME = (0.0, 0.0, 0.0)
TWO_METRES = FlightSettings(accept_m=2.0)


def ground(
    autopilot: AutopilotName = "px4",
    settings: FlightSettings = TWO_METRES,
    rally: tuple[LandingPlace, ...] = (),
    start_ned: Vec3 = (0.0, 0.0, -10.0),
    *,
    on_ground: bool = False,
) -> Ground:
    projection = Projection(ORIGIN, autopilot).north_east
    return Ground(
        autopilot,
        HOME,
        start_ned,
        projection,
        488.0,
        30.0,
        settings,
        rally,
        on_ground,
    )


def item(command: int, north: float, east: float, up: float = 10.0, *params: float) -> Item:
    p1, p2, p3, p4 = (*params, 0.0, 0.0, 0.0, 0.0)[:4]
    return Item(command, Frame.LOCAL, (p1, p2, p3, p4), Local(north, east, up), 0)


def plan(*items: Item) -> Plan:
    numbered = tuple(replace(one, do_jump_id=i) for i, one in enumerate(items, start=1))
    return Plan("a", None, None, numbered)


def path(on: Ground, *items: Item) -> FlightPath:
    return flight_path(plan(*items), on)


def checked(on: Ground, zone: CircleSpec, *items: Item) -> Verification:
    verifier = verifier_for(DEFAULT, on.autopilot, HOME, ORIGIN, (zone,))
    return verify(plan(*items), on, verifier)


def refused(found: Verification) -> Refusal:
    assert found.refusal is not None
    return found.refusal


def mast(north: float, east: float, radius_m: float = 5.0) -> CircleSpec:
    return CircleSpec(radius_m, (east, north), name="mast", inclusion=False)


# ------------------------------------------------------------------ corners that are cut

CORNER = (item(16, 100, 0, 10.0, 0.0, 80.0), item(16, 100, 100))
"""clients.md, row 1: an acceptance radius of 80 m in the plan itself."""


def test_a_wide_acceptance_radius_leads_through_a_zone_that_no_leg_touches() -> None:
    """From 20 m north the vehicle goes straight to the second waypoint."""
    found = checked(ground(), mast(70.0, 40.0), *CORNER)
    refusal = refused(found)
    assert refusal.code is Code.LEG_LEAVES_FENCE
    assert refusal.zone == "mast"
    assert refusal.sentence.startswith(
        "item 2: the turn towards (100.00 E, 100.00 N, 10.00 U) goes"
    )
    assert dict(refusal.numbers)["margin_m"] == 2.0
    exact = checked(ground(), mast(70.0, 40.0), item(16, 100, 0), item(16, 100, 100))
    assert exact.refusal is None


def test_the_vehicle_s_own_radius_counts_where_the_plan_has_none() -> None:
    far = replace(TWO_METRES, accept_m=60.0)
    way = (item(16, 100, 0), item(16, 100, 100))
    for autopilot in ("px4", "ardupilot"):
        assert refused(checked(ground(autopilot, far), mast(80.0, 30.0), *way)).zone == "mast"
        assert checked(ground(autopilot), mast(80.0, 30.0), *way).refusal is None


def test_an_arducopter_has_no_radius_of_a_waypoint_s_own() -> None:
    assert checked(ground("ardupilot"), mast(70.0, 40.0), *CORNER).refusal is None


def test_a_vehicle_in_the_hull_of_its_turn_stays_in_the_region() -> None:
    """Any smooth way from where it turns towards the next waypoint, carried on by its speed."""
    flown = path(ground(), *CORNER)
    region, *_ = [one for one in flown.regions if one.item == 1]
    hull = shapely.MultiPoint([point[:2] for point in region.points]).convex_hull
    dice = random.Random(1)
    for _ in range(20):
        at, speed = [20.0, 0.0], [dice.uniform(0.0, 12.0), 0.0]
        for _ in range(400):
            off = (100.0 - at[0], 100.0 - at[1])
            size = math.hypot(*off)
            want = [6.0 * part / size for part in off]
            pull = [4.0 * (w - v) for w, v in zip(want, speed, strict=True)]
            most = max(1.0, math.hypot(*pull) / 3.0)
            speed = [v + 0.05 * p / most for v, p in zip(speed, pull, strict=True)]
            at = [a + 0.05 * v for a, v in zip(at, speed, strict=True)]
            assert hull.distance(shapely.Point(at)) < 0.05
            if math.dist(at, (100.0, 100.0)) < 2.0:
                break


def test_places_within_the_radius_are_kept_as_they_are() -> None:
    assert turning_places(((0.0, 0.0, 0.0),), (1.0, 0.0, 0.0), 2.0, None) == ((0.0, 0.0, 0.0),)
    assert turning_places(((0.0, 0.0, 0.0),), (10.0, 0.0, 0.0), 2.0, None) == ((8.0, 0.0, 0.0),)
    assert turning_places(((0.0, 0.0, 0.0),), (10.0, 0.0, 0.0), 0.0, None) == ()


def test_px4_turns_where_distance_and_height_are_near_enough_at_the_latest() -> None:
    """A climb of 10 m straight up is over 0.8 m below its end by PX4's rule, 2 m by ours."""
    assert turning_places(((0.0, 0.0, 0.0),), (0.0, 0.0, -10.0), 2.0, 0.8) == ((0.0, 0.0, -8.0),)
    slanting = turning_places(((0.0, 0.0, 0.0),), (10.0, 0.0, -1.0), 2.0, 0.8)
    assert slanting == ((8.0, 0.0, -0.8),)


def test_a_loop_of_jumps_comes_back_to_itself() -> None:
    back = replace(item(177, 0, 0, 0.0, 1.0, -1.0), frame=Frame.MISSION)
    flown = path(ground(), item(16, 30, 0), item(16, 30, 30), item(16, 0, 30), back)
    assert flown.problems == ()
    assert len(flown.regions) < 20


def test_arducopter_s_blended_corner_is_in_its_triangle() -> None:
    """Both legs' quadratic motions at once, the apex 2 m from the corner (a turn of 90 degrees)."""
    before, corner, after = (-50.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 50.0, 0.0)
    begin, end = blend(before, corner, after, 2.0)
    triangle = shapely.Polygon([begin[:2], corner[:2], end[:2]])
    reach_m = 4.0 * 2.0 / (2.0 * math.sin(math.radians(45.0)))
    for step in range(101):
        s = step / 100
        at = (-reach_m * (1 - s) ** 2, reach_m * s**2)
        assert triangle.distance(shapely.Point(at)) < 1e-9
    assert blend(before, corner, (50.0, 0.0, 0.0), 2.0)[0] == before


def test_an_item_without_a_place_is_flown_wherever_the_vehicle_turned() -> None:
    """ArduCopter reads 0, 0 as "here" (C1_items_at_zero_position): 2 m before the waypoint."""
    here = Item(21, Frame.HOME, (0.0, 0.0, 0.0, 0.0), Geographic(0.0, 0.0, 0.0), 0)
    flown = path(ground("ardupilot"), item(16, 30, 0), here)
    landing = [region for region in flown.regions if region.kind is RegionKind.LANDING]
    assert (28.0, 0.0, 0.0) in landing[0].points
    turns = Item(18, Frame.HOME, (1.0, 0.0, 9.0, 0.0), Geographic(0.0, 0.0, 10.0), 0)
    flown = path(ground("ardupilot"), item(16, 30, 0), turns)
    assert {circle.centre_ned[0] for circle in flown.circles} == {28.0, 30.0}


# ------------------------------------------------------------------------------- curves


def outlines(
    at: Vec3, to: Vec3, neighbours: Neighbours
) -> tuple[list[shapely.Geometry], float, float]:
    """The pieces' ground tracks, and the least and the greatest of their heights (down)."""
    found = pieces(splines((at,), to, neighbours), 0.0)
    downs = [point[2] for piece in found for point in piece]
    tracks = [shapely.MultiPoint([p[:2] for p in piece]).convex_hull for piece in found]
    return tracks, min(downs), max(downs)


def beside(point: Vec3, tracks: list[shapely.Geometry]) -> float:
    return min(float(track.distance(shapely.Point(point[:2]))) for track in tracks)


@pytest.mark.parametrize("seed", range(50))
def test_the_pieces_of_a_spline_hold_the_curve_that_is_flown(seed: int) -> None:
    dice = random.Random(seed)
    at, to, before, after = (
        (dice.uniform(-50, 50), dice.uniform(-50, 50), dice.uniform(-20, 0)) for _ in range(4)
    )
    for begun in (before, None):
        for ended in (after, None):
            for curved in (True, False):
                onward = () if ended is None else (Onward(after, curved),)
                neighbours = Neighbours(begun, True, True, onward, ended is None)
                tracks, lowest, highest = outlines(at, to, neighbours)
                curve = flown_curve(at, to, begun, ended, after_is_spline=curved)
                for step in range(41):
                    point = curve.at(step / 40)
                    assert beside(point, tracks) < 1e-9
                    assert lowest - 1e-9 <= point[2] <= highest + 1e-9


@pytest.mark.parametrize("seed", range(50))
def test_the_pieces_hold_arducopter_s_own_hermite_solution(seed: int) -> None:
    """SplineCurve::update_solution, with the tangents of AC_WPNav::set_spline_destination."""
    dice = random.Random(seed)
    at, to, before, after = ((dice.uniform(-50, 50), dice.uniform(-50, 50), 0.0) for _ in range(4))

    def minus(a: Vec3, b: Vec3) -> Vec3:
        return (a[0] - b[0], a[1] - b[1], a[2] - b[2])

    for curved in (True, False):
        neighbours = Neighbours(before, curved, True, (Onward(after, curved),), may_stop=True)
        tracks, _, _ = outlines(at, to, neighbours)
        entering = minus(to, before) if curved else minus(at, before)
        leaving = minus(after, at) if curved else minus(after, to)
        for origin_vel in (HOME, entering):
            for end_vel in (HOME, leaving):
                long_m = math.hypot(*origin_vel) + math.hypot(*end_vel)
                way_m = 4.0 * math.dist(at, to)
                scale = way_m / long_m if long_m > way_m else 1.0
                v0, v1 = ([scale * part for part in vel] for vel in (origin_vel, end_vel))
                for step in range(41):
                    t = step / 40
                    n, e, d = (
                        p
                        + v * t
                        + (-3 * p - 2 * v + 3 * q - w) * t**2
                        + (2 * p + v - 2 * q + w) * t**3
                        for p, v, q, w in zip(at, v0, to, v1, strict=True)
                    )
                    assert beside((n, e, d), tracks) < 1e-9


def test_the_pieces_of_a_spline_are_much_less_than_the_hull_of_its_control_points() -> None:
    neighbours = Neighbours(
        (-30.0, -30.0, 0.0), True, False, (Onward((30.0, -60.0, 0.0), True),), False
    )
    found = splines(((0.0, 0.0, 0.0),), (40.0, 0.0, 0.0), neighbours)
    tracks, _, _ = outlines((0.0, 0.0, 0.0), (40.0, 0.0, 0.0), neighbours)
    controls = [point[:2] for one in found for point in one.controls]
    whole = shapely.MultiPoint(controls).convex_hull
    assert shapely.union_all(tracks).area < 0.5 * whole.area


def test_a_spline_is_verified_by_its_curve_and_not_by_its_chord() -> None:
    way = (item(82, 50, 0), item(82, 50, 50), item(16, 0, 50))
    found = checked(ground("ardupilot"), mast(60.0, 20.0), *way)
    assert refused(found).sentence.startswith("item 2: the curve to ")
    assert checked(ground("ardupilot"), mast(110.0, 20.0), *way).refusal is None


# ---------------------------------------------------------------------- where speed carries

QUICK = replace(TWO_METRES, speed_m_s=10.0)


@pytest.mark.parametrize("command", [16, 82])
@pytest.mark.parametrize("away_m", [0.3, 1.0, 1.9])
def test_no_vehicle_begins_from_where_it_swings_to(command: int, away_m: float) -> None:
    """A way that begins near a boundary may be as near; a swing, or the part of a curve, not."""
    way = (item(command, 60, 0), item(command, 60, 60), item(16, 0, 60))
    on = ground("ardupilot", QUICK)
    north_m = path_north_m(path(on, *way))
    assert north_m > 61.2
    found = checked(on, mast(north_m + away_m + 9e4, 30.0, 9e4), *way)
    assert refused(found).code is Code.TOO_CLOSE
    assert checked(on, mast(north_m + 3.0 + 9e4, 30.0, 9e4), *way).refusal is None


def path_north_m(flown: FlightPath) -> float:
    return max(point[0] for one in flown.regions for point in one.points)


def test_a_speed_that_an_item_asks_for_counts_from_there_on() -> None:
    slow = item(178, 0, 0, 0.0, 1.0, 2.0)
    way = (item(16, 60, 0), item(16, 0, 60), item(16, 60, 60))

    def widest(*items: Item) -> float:
        """How far north of its two northern places it may be."""
        return path_north_m(path(ground("ardupilot", QUICK), *items)) - 60.0

    assert widest(slow, *way) < 0.5 * widest(*way)
    assert widest(*way, slow) == widest(*way)
    back = item(178, 0, 0, 0.0, 1.0, -2.0)
    assert widest(slow, back, *way) == widest(*way)


def test_a_loop_of_two_near_places_comes_to_an_end() -> None:
    """PX4's random mission 77: two LOITER_TIME 2.5 m apart, and a jump back."""
    back = replace(item(177, 0, 0, 0.0, 2.0, 1.0), frame=Frame.MISSION)
    quick = ground("px4", replace(TWO_METRES, speed_m_s=5.0, accel_m_s2=3.0))
    flown = path(quick, item(19, 68, -31), item(19, 52.7, 0.1), item(19, 50.4, 1.1), back)
    assert flown.problems == ()
    assert all(math.hypot(*point[:2]) < 100.0 for one in flown.regions for point in one.points)


# -------------------------------------------------------------------------------- rings


def test_a_loiter_circle_may_go_round_a_mast() -> None:
    turns = item(18, 40, 0, 10.0, 2.0, 0.0, 15.0)
    assert checked(ground("ardupilot"), mast(40.0, 0.0), turns).refusal is None
    tight = item(18, 40, 0, 10.0, 2.0, 0.0, 6.0)
    refusal = refused(checked(ground("ardupilot"), mast(40.0, 0.0), tight))
    assert (refusal.zone, refusal.code) == ("mast", Code.TOO_CLOSE)


def test_the_way_onto_a_circle_and_off_it_are_legs_and_regions() -> None:
    turns = item(18, 40, 0, 10.0, 1.5, 0.0, 15.0)
    flown = path(ground("ardupilot", QUICK), turns, item(16, 80, 0))
    assert flown.legs[0].to_ned == pytest.approx((25, 0, -10))
    assert flown.legs[1].from_ned == pytest.approx((55, 0, -10))
    onward = [one for one in flown.regions if one.item == 1 and one.kind is RegionKind.TURN]
    hulls = [shapely.MultiPoint([p[:2] for p in one.points]).convex_hull for one in onward]
    for start in (55.0, 25.0):  # after 1.5 turns, and after the one that an ArduCopter flew
        for short_rad in (-0.41, 0.41):  # the worst recorded
            north = 40.0 + (start - 40.0) * math.cos(short_rad)
            place = shapely.Point(north, 15.0 * math.sin(short_rad))
            assert min(hull.distance(place) for hull in hulls) < 0.3


def test_a_vehicle_that_gains_speed_on_a_circle_is_inside_it_at_first() -> None:
    """Random mission 188 of ArduCopter: 2.1 m inside a circle of 20 m, 9 m after its entry."""
    begun = ((-20.0, 0.0, 0.0),)
    arc = shapely.MultiPoint([p[:2] for p in (*begun, *first_arc(begun, HOME, 20.0))]).convex_hull
    for angle, reach_m in ((0.2, 18.9), (0.4, 18.0), (0.6, 18.3), (0.9, 19.6)):
        east, north = -reach_m * math.sin(angle), -reach_m * math.cos(angle)
        assert arc.distance(shapely.Point(north, east)) < 0.3
        assert arc.distance(shapely.Point(north, -east)) > 1.0
    assert not arc.contains(shapely.Point(-15.0, 0.0))


def test_from_the_middle_of_a_circle_it_may_begin_anywhere() -> None:
    places = ((0.1, 0.0, 0.0), (-0.1, 0.0, 0.0), (0.0, 0.1, 0.0))
    begun = entries(places, HOME, 10.0)
    around = way_on(places, begun, HOME, 10.0)
    outline = shapely.MultiPoint([point[:2] for point in around]).convex_hull
    assert outline.contains(shapely.Point(0.0, 0.0).buffer(9.999))
    leaves, _ = circle_ends(begun, HOME, 10.0, 2.0, 1.3)
    assert set(begun) <= set(leaves)


# ---------------------------------------------------------------------------- the return

BACK = replace(item(20, 0, 0, 0.0), frame=Frame.MISSION)


def rally_point(north: float, east: float, name: str = "rally point 1") -> LandingPlace:
    return LandingPlace(name, (north, east, 0.0))


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_a_rally_point_in_a_zone_is_refused_by_its_name(autopilot: AutopilotName) -> None:
    """clients.md, row 2: the mission itself never comes near it."""
    on = ground(autopilot, rally=(rally_point(-40.0, 0.0),))
    refusal = refused(checked(on, mast(-40.0, 0.0), item(16, 20, 0)))
    assert refusal.sentence.startswith("rally point 1: ")
    assert refusal.zone == "mast"
    assert refusal.numbers
    outside = ground(autopilot, rally=(rally_point(-400.0, 0.0),))
    assert refused(checked(outside, mast(-40.0, 0.0), item(16, 20, 0))).code is Code.OUTSIDE_FENCE


def test_a_rally_point_is_refused_where_only_the_beginning_of_the_way_down_is_too_near() -> None:
    """It is reached 30 m up, 0.2 m below the crane: a leg that leads away from there is clear."""
    crane = CircleSpec(
        radius_m=5.0, centre=(0.0, -40.0), name="crane", inclusion=False, floor_up_m=30.2
    )
    on = ground(rally=(rally_point(-40.0, 0.0),))
    refusal = refused(checked(on, crane, item(16, 20, 0)))
    assert refusal.sentence.startswith("rally point 1: waypoint (0.00 E, -40.00 N, 30.00 U)")
    assert refusal.zone == "crane"


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_a_return_through_a_zone_to_the_nearest_rally_point_is_refused(
    autopilot: AutopilotName,
) -> None:
    """From 60 m north to a rally point 50 m north-east of it; home is clear."""
    on = ground(autopilot, rally=(rally_point(80.0, 50.0),))
    found = checked(on, mast(70.0, 25.0), item(16, 60, 0), BACK)
    refusal = refused(found)
    assert refusal.sentence.startswith("item 2: ")
    assert refusal.zone == "mast"
    assert checked(ground(autopilot), mast(70.0, 25.0), item(16, 60, 0), BACK).refusal is None


def test_px4_returns_to_the_nearest_of_home_and_the_rally_points() -> None:
    on = ground(rally=(rally_point(100.0, 50.0),))
    near_home = path(on, item(16, 20, 0), BACK)
    assert near_home.legs[-1].to_ned == HOME
    near_rally = path(on, item(16, 90, 40), BACK)
    assert near_rally.legs[-1].to_ned == (100.0, 50.0, 0.0)


@pytest.mark.parametrize(("east", "ends"), [(140.0, ["home", "rally point 1"]), (400.0, ["home"])])
def test_a_return_may_end_at_what_is_nearest_to_any_of_its_places(
    east: float, ends: list[str]
) -> None:
    """The third place is far from the middle of the three, and nearer to the rally point."""
    places = tuple((0.0, place, -10.0) for place in (0.0, 10.0, 100.0))
    found = landing_places(ground(rally=(rally_point(0.0, east),)), places)
    assert [each.name for each in found] == ends


def test_a_failsafe_return_to_a_rally_point_through_a_zone_refuses_the_mission() -> None:
    on = ground(rally=(rally_point(80.0, 50.0),))
    found = checked(on, mast(70.0, 25.0), item(16, 60, 0))
    assert "to rally point 1: return blocked" in refused(found).sentence
    assert found.return_warning is not None
    assert "to rally point 1: return blocked" in found.return_warning[1]


@pytest.mark.parametrize("kind", [2, 4])
def test_a_return_along_the_mission_is_not_verified_and_refused(kind: int) -> None:
    on = ground(settings=replace(TWO_METRES, return_type=kind))
    refusal = refused(checked(on, mast(-40.0, 0.0), item(16, 20, 0), BACK))
    assert "RTL_TYPE" in refusal.sentence


def test_a_return_from_near_by_may_be_lower_than_the_return_height() -> None:
    """PX4's cone, RTL_MIN_DIST: a low roof between the vehicle and home is not flown over."""
    low = ground(settings=replace(TWO_METRES, return_low_within_m=10.0))
    roof = CircleSpec(1.0, (0.0, 4.5), name="roof", inclusion=False, ceiling_up_m=12.0)
    way = (item(16, 9, 0, 9.0), BACK)
    start = replace(low, start_ned=(9.0, 0.0, -9.0))
    assert refused(checked(start, roof, *way)).zone == "roof"
    high = replace(start, settings=TWO_METRES)
    assert checked(high, roof, *way).refusal is None


# ------------------------------------------------------------------------------ take-off


def test_px4_climbs_first_where_the_mission_has_no_take_off() -> None:
    """Scenarios C6 and C12: "Takeoff to 8.0 meters above home", to the height of the first item."""
    on = ground(start_ned=HOME, on_ground=True, settings=replace(TWO_METRES, first_climb_m=2.5))
    flown = path(on, item(16, 15, 0, 8.0))
    assert [(leg.kind.name, leg.to_ned) for leg in flown.legs] == [
        ("CLIMB", (0.0, 0.0, -8.0)),
        ("STRAIGHT", (15.0, 0.0, -8.0)),
    ]
    assert path(on, item(16, 15, 0, 1.0)).legs[0].to_ned == (0.0, 0.0, -2.5)
    assert checked(on, mast(-40.0, 0.0), item(16, 15, 0, 8.0)).refusal is None


def test_the_policy_s_highest_take_off_binds_missions_too() -> None:
    on = ground(start_ned=HOME, on_ground=True)
    refusal = refused(checked(on, mast(-40.0, 0.0), item(22, 0, 0, 31.0), item(16, 9, 0, 31.0)))
    assert refusal.code is Code.TOO_HIGH
    assert refusal.sentence == "item 1: take-off to 31.0 m, the policy's highest is 30.0 m"
    assert checked(on, mast(-40.0, 0.0), item(22, 0, 0, 30.0)).refusal is None


# --------------------------------------------------------------------------------- table


def test_every_known_command_has_one_row() -> None:
    commands = [row.command for row in ROWS]
    assert len(commands) == len(set(commands))
    assert set(commands) == set(KINDS) | set(WITH_PLACE)


@pytest.mark.parametrize(
    ("command", "px4_takes", "copter_takes"),
    [
        (Cmd.NAV_LOITER_TURNS, False, True),
        (Cmd.NAV_SPLINE_WAYPOINT, False, True),
        (Cmd.CONDITION_YAW, False, True),
        (Cmd.DO_FENCE_ENABLE, False, True),
        (Cmd.SET_CAMERA_MODE, True, False),
        (Cmd.NAV_LOITER_TO_ALT, True, True),
        (Cmd.DO_LAND_START, True, True),
        (Cmd.DO_SET_HOME, True, True),
        (Cmd.CONDITION_DISTANCE, True, True),
        (Cmd.DO_JUMP, True, True),
        (Cmd.JUMP_TAG, False, True),
        (Cmd.DO_JUMP_TAG, False, True),
        (Cmd.DO_SET_RELAY, False, True),
        (Cmd.DO_REPEAT_RELAY, False, True),
        (Cmd.DO_SET_SERVO, False, True),
        (Cmd.DO_REPEAT_SERVO, False, True),
        (Cmd.DO_GRIPPER, True, True),
        (Cmd.DO_WINCH, True, True),
        (Cmd.NAV_PAYLOAD_PLACE, False, True),
    ],
)
def test_what_the_vehicles_refused_at_upload_is_in_the_table(
    command: Cmd, px4_takes: bool, copter_takes: bool
) -> None:
    """C8_upload_item_kinds of both vehicles."""
    assert (flown_as(command, "px4") is not Flown.REFUSED) == px4_takes
    assert (flown_as(command, "ardupilot") is not Flown.REFUSED) == copter_takes
