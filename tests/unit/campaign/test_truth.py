"""How near a flight came to its fence, by another library's geometry."""

from __future__ import annotations

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from shapely import LineString, Point, Polygon

from gcs.campaign.simulators import Truth
from gcs.campaign.truth import LOOK_NS, Looks, zones_about
from gcs.frames import Vec3
from gcs.gate.policy.parse import parse_policy

HOME = (47.397742, 8.545594, 488.0)
POLICY = parse_policy(
    """
name = "yard"
max_up_m = 40
[[fence]]
name = "yard"
kind = "polygon"
corners = [[-20, -20], [20, -20], [20, 0], [5, 0], [5, 20], [-20, 20]]
ceiling_up_m = 30
[[fence]]
name = "mast"
kind = "circle"
inclusion = false
centre = [-10, 5]
radius_m = 3
ceiling_up_m = 10
""",
    "yard.toml",
)
YARD = Polygon([(-20, -20), (20, -20), (20, 0), (5, 0), (5, 20), (-20, 20)])
MAST = Point(-10, 5)
MAST_RADIUS_M = 3.0

Metre = st.integers(-3000, 3000).map(lambda cm: cm / 100)
Place = st.tuples(Metre, Metre, st.integers(50, 3500).map(lambda cm: cm / 100))


def truth(enu: Vec3, *, landed: bool = False, sink_m_s: float = 0.0) -> Truth:
    east, north, up = enu
    return Truth((north, east, -up), (0.0, 0.0, sink_m_s), HOME, True, landed, 0.0)


def looked(path: list[Vec3]) -> Looks:
    looks = Looks(zones_about(HOME, POLICY, "px4"), 0)
    for number, place in enumerate(path):
        looks.look(truth(place), number * LOOK_NS)
    return looks


@given(Place, Place)
def test_the_closest_is_that_of_another_library(a: Vec3, b: Vec3) -> None:
    """Of a straight way, level over or under the mast; where it leaves the yard, that it does, and
    that neither end is farther outside."""
    assume(a[:2] != b[:2])
    track = LineString([a[:2], b[:2]])
    found = looked([a, b]).nearest.clear_m
    beside_m = track.distance(MAST) - MAST_RADIUS_M
    above_m = min(a[2], b[2]) - 10.0
    ceilings_m = 30.0 - max(a[2], b[2])
    others_m = min(max(beside_m, above_m), ceilings_m)
    if track.covered_by(YARD):
        sides_m = YARD.exterior.distance(track)
        assert found == pytest.approx(min(sides_m, others_m), abs=1e-6)
    else:
        outside_m = max(YARD.distance(Point(end)) for end in (a[:2], b[:2]))
        assert found < 1e-6
        assert found <= min(others_m, -outside_m) + 1e-6


def test_what_it_was_near_to_and_when() -> None:
    looks = looked([(0.0, 0.0, 5.0), (-6.0, 5.0, 5.0), (0.0, 0.0, 5.0)])
    assert looks.nearest.of == "inside exclusion circle 'mast'"
    assert looks.nearest.clear_m == pytest.approx(1.0)
    assert looks.nearest.at_s == pytest.approx(0.1)


def test_who_stands_is_near_to_nothing_and_a_touch_down_is_measured() -> None:
    looks = Looks(zones_about(HOME, POLICY, "px4"), 0)
    looks.look(truth((0, 0, 0), landed=True), 0)
    looks.look(truth((0, 0, 0), landed=True), LOOK_NS)
    assert looks.nearest.clear_m == math.inf
    assert not looks.flew
    for step, (up_m, sink_m_s) in enumerate([(3.0, 4.0), (0.4, 1.5), (0.1, 0.9)], start=2):
        looks.look(truth((0, 0, up_m), sink_m_s=sink_m_s), step * LOOK_NS)
    looks.look(truth((0, 0, 0), landed=True), 5 * LOOK_NS)
    assert looks.touchdown_m_s == 1.5
    assert looks.down_s == pytest.approx(0.5)
