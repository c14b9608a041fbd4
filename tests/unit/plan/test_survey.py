"""Lines over polygons, along lines, round points: worked by hand, and against Shapely."""

from __future__ import annotations

import math

import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs.gate.airspace.projection import Origin, Projection
from gcs.plan.model import Fence, Geodetic, Geographic
from gcs.plan.survey.camera import CAMERAS, Camera, pictures
from gcs.plan.survey.lines import (
    Point,
    corridor_runs,
    easiest_angle_deg,
    length_m,
    nearest_first,
    ring,
    survey_runs,
)
from gcs.plan.survey.mission import Flight, TooManyItemsError, mission_of, picture_count
from tests.shares import examples

FIELD: list[Point] = [(0, 0), (100, 0), (100, 40), (0, 40)]
U_SHAPE: list[Point] = [(0, 0), (30, 0), (30, 30), (20, 30), (20, 10), (10, 10), (10, 30), (0, 30)]


def rounded(runs: list[list[Point]]) -> list[list[Point]]:
    return [[(round(x, 6) + 0.0, round(y, 6) + 0.0) for x, y in run] for run in runs]


def test_lines_over_a_box_are_spread_evenly_and_alternate() -> None:
    """40 m in lines of at most 15 m: three of 13.33 m, along the long side (east, 90 degrees)."""
    assert easiest_angle_deg(FIELD) == 90.0
    third = 40 / 3
    assert rounded(survey_runs(FIELD, 15.0, 90.0)) == rounded(
        [
            [(0, 40 - third / 2), (100, 40 - third / 2)],
            [(100, 20), (0, 20)],
            [(0, third / 2), (100, third / 2)],
        ]
    )


def test_a_concave_field_has_several_pieces_a_line() -> None:
    """East-west lines of a U at 5, 15 and 25 m: one whole, and the two arms."""
    runs = rounded(survey_runs(U_SHAPE, 10.0, 90.0))
    assert runs == [
        [(0, 25), (10, 25)],
        [(20, 25), (30, 25)],
        [(30, 15), (20, 15)],
        [(10, 15), (0, 15)],
        [(0, 5), (30, 5)],
    ]


@st.composite
def star_polygons(draw: st.DrawFn) -> list[Point]:
    """Corners at rising angles about a point inside: concave, and never crossing itself."""
    count = draw(st.integers(3, 9))
    radii = draw(st.lists(st.integers(10, 200), min_size=count, max_size=count))
    turn = draw(st.integers(0, 359))
    angles = [math.radians(turn) + math.tau * i / count for i in range(count)]
    return [(r * math.sin(a), r * math.cos(a)) for r, a in zip(radii, angles, strict=True)]


@settings(max_examples=examples(100))
@given(star_polygons(), st.integers(3, 60), st.integers(0, 359))
def test_every_line_is_what_shapely_cuts(
    corners: list[Point], spacing_m: int, angle_deg: int
) -> None:
    polygon = shapely.Polygon(corners)
    runs = survey_runs(corners, spacing_m, angle_deg)
    along = (math.sin(math.radians(angle_deg)), math.cos(math.radians(angle_deg)))
    across = [x * along[1] - y * along[0] for x, y in corners]
    expected, count = 0.0, math.ceil((max(across) - min(across)) / spacing_m - 1e-9)
    for number in range(count):
        off = min(across) + (number + 0.5) * (max(across) - min(across)) / count
        at = (off * along[1], -off * along[0])
        ends = [(at[0] + far * along[0], at[1] + far * along[1]) for far in (-1000.0, 1000.0)]
        cut = shapely.LineString(ends).intersection(polygon)
        expected += sum(part.length for part in getattr(cut, "geoms", [cut]) if part.length >= 0.1)
    assert sum(map(length_m, runs)) == pytest.approx(expected, abs=1e-6)
    assert all(polygon.buffer(1e-6).contains(shapely.LineString(run)) for run in runs)


def test_a_corridor_has_its_lines_beside_each_other() -> None:
    """A right angle, 20 m wide in two lines: 5 m to either side, with mitred corners."""
    line: list[Point] = [(0, 0), (0, 100), (100, 100)]
    assert rounded(corridor_runs(line, 20.0, 12.0)) == [
        [(-5, 0), (-5, 105), (100, 105)],
        [(100, 95), (5, 95), (5, 0)],
    ]
    assert corridor_runs(line, 20.0, 30.0) == [line]


@settings(max_examples=examples(100))
@given(
    st.lists(st.integers(-80, 80), min_size=1, max_size=5),
    st.integers(10, 60),
    st.integers(5, 30),
)
def test_a_corridor_stays_as_near_as_it_is_wide(
    turns: list[int], width_m: int, spacing_m: int
) -> None:
    """Legs of 200 m with turns of up to 80 degrees; Shapely measures how far the lines are."""
    line, heading = [(0.0, 0.0)], 0.0
    for turn in [0, *turns]:
        heading += math.radians(turn)
        x, y = line[-1]
        line.append((x + 200 * math.sin(heading), y + 200 * math.cos(heading)))
    middle = shapely.LineString(line)
    for run in corridor_runs(line, width_m, spacing_m):
        far = [middle.distance(shapely.Point(point)) for point in run]
        assert max(far) <= width_m / 2 / math.cos(math.radians(40)) + 1e-6


def test_a_sharp_corner_is_cut_off() -> None:
    run = corridor_runs([(0, 0), (0, 100), (1, 0)], 20.0, 10.0)[0]
    assert max(math.dist(point, (0, 100)) for point in run if point[1] > 50) < 5.1


def test_a_ring_begins_near_and_goes_clockwise() -> None:
    run = ring((0.0, 50.0), 20.0, 4, 1.0, begin=(0.0, 0.0))
    assert rounded([run]) == [[(0, 30), (-20, 50), (0, 70), (20, 50), (0, 30)]]


def test_the_order_begins_where_home_is_nearest() -> None:
    runs = survey_runs(FIELD, 15.0, 90.0)
    begins = {
        nearest_first(runs, home)[0][0] for home in ((-1, 50), (101, 50), (-1, -1), (101, -1))
    }
    assert rounded([sorted(begins)]) == rounded(
        [[(0, 20 / 3), (0, 100 / 3), (100, 20 / 3), (100, 100 / 3)]]
    )


def test_a_footprint_is_the_ratio_of_sensor_and_lens() -> None:
    """13.2 x 8.8 mm behind 8.8 mm, from 88 m: 132 x 88 m, 2.41 cm of 5472 pixels."""
    camera = CAMERAS["dji-fc6310"]
    seen = pictures(camera.footprint_m(88.0), 75.0, 60.0, camera.width_px)
    sizes_m = [seen.across_m, seen.along_m, seen.spacing_m, seen.trigger_m]
    assert sizes_m == pytest.approx([132.0, 88.0, 52.8, 22.0])
    assert seen.ground_cm_px == pytest.approx(13200 / 5472)
    assert Camera(24.0, 16.0, 16.0).footprint_m(32.0) == (48.0, 32.0)


HOME = Geodetic(47.397742, 8.545594, 488.0)
PLANE = Projection(Origin(47.397742, 8.545594, 488.0), "px4")


def test_the_camera_is_on_along_the_runs_alone() -> None:
    runs: list[list[Point]] = [[(0, 10), (0, 60)], [(20, 60), (20, 10)]]
    plan = mission_of("a", runs, Flight(30.0, 4.0, 12.5), HOME, "px4", PLANE.lat_lon, Fence())

    assert [(item.command, item.params[0]) for item in plan.items] == [
        (22, 0.0),
        (178, 1.0),
        *[(16, 0.0), (206, 12.5), (16, 0.0), (206, 0.0)] * 2,
        (20, 0.0),
    ]
    place = plan.items[4].place
    assert isinstance(place, Geographic)
    assert PLANE.north_east(place.lat_deg, place.lon_deg) == pytest.approx((60.0, 0.0), abs=0.01)
    assert place.alt_m == 30.0
    # 50 m: at 0, 12.5, 25, 37.5 and 50 m of each.
    assert picture_count(runs, 12.5) == 10


def test_round_a_point_it_looks_at_it() -> None:
    run = ring((0.0, 50.0), 20.0, 4, 1.0, begin=(0.0, 0.0))
    flight = Flight(15.0, 4.0, 0.0, (0.0, 50.0))
    plan = mission_of("a", [run], flight, HOME, "px4", PLANE.lat_lon, Fence())

    assert [item.command for item in plan.items] == [22, 178, 195, *[16] * 5, 197, 20]
    assert [item.params[3] for item in plan.items[3:8]] == [0.0, 90.0, 180.0, 270.0, 0.0]


def test_more_items_than_are_stored_are_refused() -> None:
    runs: list[list[Point]] = [[(0, 0), (0, 1)]] * 600
    with pytest.raises(TooManyItemsError, match="more than 2000 items"):
        mission_of("a", runs, Flight(30.0, 4.0, 1.0), HOME, "px4", PLANE.lat_lon, Fence())
