"""Inside or outside, and how far from the border: against shapely."""

from __future__ import annotations

from dataclasses import replace
from math import cos, inf, isinf, nan, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import Point
from shapely.geometry import Polygon as Shape

from vehicle_sim.autopilot.fence import zones as fence
from vehicle_sim.autopilot.fence.zones import CircleZone, Fence, Polygon, Vec2, polygon
from vehicle_sim.autopilot.geo import projection
from vehicle_sim.autopilot.interface import Flaw, Geodetic, PlanItem
from vehicle_sim.autopilot.modes import Personality

HOME = Geodetic(47.397742, 8.545594, 488.0)
EDGE_M = 1e-6


def star(corners: int, seed: int) -> tuple[Vec2, ...]:
    """A concave polygon round the origin; every corner at a distance of its own."""
    away = [
        20.0 + 60.0 * ((seed * 7919 + turn * 104729) % 1000) / 1000.0 for turn in range(corners)
    ]
    angles = [2.0 * pi * turn / corners for turn in range(corners)]
    return tuple((r * cos(a), r * sin(a)) for r, a in zip(away, angles, strict=True))


places = st.tuples(st.floats(-120.0, 120.0), st.floats(-120.0, 120.0))


@given(corners=st.integers(3, 300), seed=st.integers(0, 999), place=places)
def test_a_polygon_is_as_shapely_sees_it(corners: int, seed: int, place: Vec2) -> None:
    vertices = star(corners, seed)
    shape, point = Shape(vertices), Point(place)
    depth = polygon(True, vertices).depth_m(*place, inf)
    border = shape.exterior.distance(point)
    assert abs(depth) == pytest.approx(border, abs=1e-9)
    if border > EDGE_M:
        assert (depth > 0.0) == shape.contains(point)


@given(corners=st.integers(3, 60), seed=st.integers(0, 999), place=places, beyond=st.floats(0, 90))
def test_the_bounding_box_never_says_nearer_than_it_is_nor_inside(
    corners: int, seed: int, place: Vec2, beyond: float
) -> None:
    zone = polygon(False, star(corners, seed))
    exact = zone.depth_m(*place, inf)
    quick = zone.depth_m(*place, beyond)
    assert quick == exact or (exact - 1e-9 <= quick < -beyond)


zones = st.lists(
    st.one_of(
        st.builds(CircleZone, st.booleans(), places, st.floats(1.0, 90.0)),
        st.builds(
            lambda inclusion, corners, seed: polygon(inclusion, star(corners, seed)),
            st.booleans(),
            st.integers(3, 30),
            st.integers(0, 99),
        ),
    ),
    max_size=5,
)


def depth(zone: CircleZone | Polygon, place: Vec2) -> float:
    return zone.depth_m(*place, inf)


@given(given_zones=zones, place=places, union=st.booleans())
def test_inside_every_inclusion_zone_and_outside_every_exclusion_zone(
    given_zones: list[CircleZone | Polygon], place: Vec2, union: bool
) -> None:
    whole = Fence(tuple(given_zones))
    inclusions = [depth(zone, place) >= 0.0 for zone in given_zones if zone.inclusion]
    excluded = any(depth(zone, place) > 0.0 for zone in given_zones if not zone.inclusion)
    included = (any if union and inclusions else all)(inclusions)
    assert (whole.room_m(*place, union) >= 0.0) == (included and not excluded)


@given(
    given_zones=zones,
    place=places,
    union=st.booleans(),
    part=st.floats(0.0, 0.99),
    angle=st.floats(0.0, 2 * pi),
)
def test_within_the_room_nothing_changes(
    given_zones: list[CircleZone | Polygon], place: Vec2, union: bool, part: float, angle: float
) -> None:
    whole = Fence(tuple(given_zones))
    room = whole.room_m(*place, union)
    if isinf(room) or abs(room) < EDGE_M:
        return
    way = part * abs(room)
    there = whole.room_m(place[0] + way * cos(angle), place[1] + way * sin(angle), union)
    assert (there >= 0.0) == (room >= 0.0)


def test_zones_that_touch_leave_no_way_between_them() -> None:
    """Two squares side by side are not one zone: each wants the vehicle inside itself."""
    left = polygon(True, ((0, 0), (0, 10), (10, 10), (10, 0)))
    right = polygon(True, ((0, 10), (0, 20), (10, 20), (10, 10)))
    both = Fence((left, right))
    assert both.room_m(5.0, 5.0) < 0.0
    assert both.room_m(5.0, 5.0, union=True) == pytest.approx(5.0)
    assert Fence().room_m(0.0, 0.0) == inf


# --------------------------------------------------------------------------------- uploads


def item(seq: int, command: int, p1: float = 0.0, x: int = 473977420, frame: int = 5) -> PlanItem:
    return PlanItem(seq, frame, command, p1, 0.0, 0.0, 0.0, x + 1000 * seq, 85455940, 0.0, 1)


def triangle(first: int, command: int = 5001) -> list[PlanItem]:
    return [item(first + turn, command, 3.0) for turn in range(3)]


def flaw(items: list[PlanItem], personality: Personality = "px4") -> tuple[int, Flaw] | None:
    refusal = fence.check(tuple(items), personality)
    return None if refusal is None else (refusal.seq, refusal.flaw)


@pytest.mark.parametrize(
    ("items", "expected"),
    [
        ([], None),
        (triangle(0), None),
        ([*triangle(0), *triangle(3)], None),
        ([*triangle(0), item(3, 5004, 12.5), item(4, 5000)], None),
        ([item(0, 16)], (0, Flaw.COMMAND)),
        ([item(0, 5001, 2.0), item(1, 5001, 2.0)], (0, Flaw.PARAM1)),
        ([item(0, 5001, 3.5)], (0, Flaw.PARAM1)),
        ([item(0, 5001, nan)], (0, Flaw.PARAM1)),
        (triangle(0)[:2], (0, Flaw.WHOLE)),
        # Two vertices, then three of a next one: three and two, as nothing tells them apart.
        ([*triangle(0)[:2], *triangle(2)], (3, Flaw.WHOLE)),
        ([*triangle(0)[:2], item(2, 5002, 3.0)], (2, Flaw.WHOLE)),
        ([*triangle(0)[:2], item(2, 5001, 4.0)], (2, Flaw.WHOLE)),
        ([item(0, 5003, 9.0, frame=1)], (0, Flaw.FRAME)),
        ([item(0, 5003, 9.0, frame=10)], (0, Flaw.FRAME)),
        ([item(0, 5003, 9.0, x=900_000_001)], (0, Flaw.PLACE)),
    ],
)
def test_what_of_an_upload_is_refused(
    items: list[PlanItem], expected: tuple[int, Flaw] | None
) -> None:
    assert flaw(items) == expected


@pytest.mark.parametrize("radius_m", [0.0, -5.0, nan, inf])
def test_only_ardupilot_minds_a_circle_without_a_radius(radius_m: float) -> None:
    """Scenario F1 of each: px4 takes nearly everything, ardupilot says "Non-positive circle
    radius"."""
    circle = [item(0, 5003, radius_m)]
    assert flaw(circle, "px4") is None
    assert flaw(circle, "ardupilot") == (0, Flaw.PARAM1)


def test_only_ardupilot_minds_a_second_return_point() -> None:
    twice = [item(0, 5000), item(1, 5000)]
    assert flaw(twice, "ardupilot") == (1, Flaw.WHOLE)
    assert flaw(twice, "px4") is None


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_a_fence_lies_where_the_vehicles_own_projection_puts_it(
    personality: Personality,
) -> None:
    own = projection(personality, HOME)
    where = own.to_geodetic((40.0, -30.0, 0.0))
    x, y = round(where.lat_deg * 1e7), round(where.lon_deg * 1e7)
    built = fence.build((replace(item(0, 5003, 25.0), x=x, y=y), item(1, 5000)), own)
    (zone,) = built.zones
    assert isinstance(zone, CircleZone)
    assert zone.centre_ne == pytest.approx((40.0, -30.0), abs=0.02)
    assert built.room_m(40.0, -30.0) == pytest.approx(25.0, abs=0.05)
    assert built.return_ne is not None
