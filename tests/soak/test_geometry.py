"""A million random cases of the gate's geometry, against exact arithmetic and against shapely.

`make test` asks a share of them, `make soak` all, and tells how many were too close to say.
"""

from __future__ import annotations

import random
from typing import Final

import pytest

from gcs.gate.airspace import fence_check
from gcs.gate.airspace.clearance import Measure, Motion, swept_body_measure
from gcs.gate.airspace.hulls import ground_track, hull_inside, hull_outside
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import TOLERANCE_M, Point, Polygon, along
from tests.soak import exact, geometry_cases, zone_cases
from tests.soak.exact import Grid
from tests.soak.seeds import base_seed
from tests.soaking import SOAKING, Counted

CHUNKS = 50
CASES_A_CHUNK = 18_000 if SOAKING else 1_600
ZONE_CASES_A_CHUNK = 2_000 if SOAKING else 400

chunks = pytest.mark.parametrize(
    "chunk", [pytest.param(n, marks=[pytest.mark.soak] if n else []) for n in range(CHUNKS)]
)


@chunks
def test_no_answer_of_the_plane_geometry_is_unsafe_unjust_or_timid(
    chunk: int, record_property: Counted
) -> None:
    tally = geometry_cases.run(base_seed() + chunk, CASES_A_CHUNK)
    print(f"seed {base_seed() + chunk}: {tally.told()}")
    for (_, found), count in tally.found.items():
        record_property(f"geometry, {found}", count)
    assert not tally.bad, tally.told()
    assert tally.cases >= CASES_A_CHUNK
    assert tally.share("certain") > 0.1, tally.told()
    assert tally.share("too close to say") < 0.4, tally.told()


@chunks
def test_whatever_the_judge_clears_beside_a_zone_is_clear(
    chunk: int, record_property: Counted
) -> None:
    counts = zone_cases.run(base_seed() + chunk, ZONE_CASES_A_CHUNK)
    print(f"seed {base_seed() + chunk}: {sorted(counts.items())}")
    for (_, answer), count in counts.items():
        record_property(f"beside a zone, {answer}", count)
    for what in ("point", "leg", "hull", "stop"):
        assert counts[what, "cleared"] > 0.02 * ZONE_CASES_A_CHUNK, counts


NEEDLE: Final = Polygon(
    (
        (0.0, -150.0),
        (150.0, -150.0),
        (150.0, 0.0),
        (75.07533853701842, 0.0),
        (75.0, -149.92466146298156),
        (45.0, 0.0),
        (0.0, 0.0),
    )
)


def test_a_hull_that_is_almost_a_line_is_not_refused_for_a_corner_far_off_on_it() -> None:
    """Found by seed 780771000048: the corner (0, -150) is on the line, 81 m behind the hull."""
    places = (
        (-7.686692506642456, 0.0),
        (-6.099562740796934, -30.971638929370545),
        (-4.158401062181505, -68.85194330484752),
    )
    found_m = hull_outside(NEEDLE, ground_track(places))
    assert found_m == pytest.approx(4.158401062181505)  # the polygon's west side is at 0


@pytest.mark.parametrize("seed", range(20))
def test_slivers_beside_a_polygon_are_judged_as_exact_arithmetic_does(seed: int) -> None:
    """Three places almost on a line through a corner of the polygon, before it, on it or behind."""
    dice, sure = random.Random(seed), 0
    for _ in range(100):
        corner = dice.choice(NEEDLE.corners_en)
        start = (corner[0] + dice.uniform(-90, 90), corner[1] + dice.uniform(-90, 90))
        places = [along(start, corner, dice.uniform(-0.5, 1.2)) for _ in range(3)]
        track = ground_track(places)
        grid = Grid.of(x for place in (*NEEDLE.corners_en, *places) for x in place)
        ring, hull = grid.ring(NEEDLE.corners_en), exact.hull(grid.ring(places))
        outside_m, inside_m = hull_outside(NEEDLE, track), hull_inside(NEEDLE, track)
        if abs(outside_m) > TOLERANCE_M:
            assert exact.hull_outside_polygon(ring, hull, 0) == (outside_m > 0.0), places
        if abs(inside_m) > TOLERANCE_M:
            assert exact.hull_in_polygon(ring, hull, 0) == (inside_m > 0.0), places
        sure += abs(outside_m) > TOLERANCE_M
    assert sure > 30


# ---------------------------------------------------------------- can these tests fail?


def test_a_leg_of_which_only_the_ends_are_looked_at_is_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Polygon, "_gap", lambda self, a, b: 1e9)
    monkeypatch.setattr(Polygon, "_middles", lambda self, a, b, gap: [])
    found = {kind for (_, kind) in geometry_cases.run(1, 1_000).found}
    assert "unsafe" in found


def test_an_edge_that_is_a_little_off_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    clearance = Polygon.clearance

    def generous(polygon: Polygon, p: Point) -> float:
        return clearance(polygon, p) + 2e-6

    monkeypatch.setattr(Polygon, "clearance", generous)
    found = {kind for (_, kind) in geometry_cases.run(1, 2_000).found}
    assert "unsafe" in found


def test_a_region_of_which_only_some_corners_are_looked_at_is_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(fence_check, "ground_track", lambda points: ground_track(points[:1]))
    with pytest.raises(AssertionError, match="seed 1: hull of"):
        zone_cases.run(1, 2_000)


def test_a_leg_that_is_looked_at_at_the_height_of_its_start_is_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def level(zone: Zone, motion: Motion, beside_m: float) -> Measure | None:
        return swept_body_measure(zone, motion._replace(b_up_m=motion.a_up_m), beside_m)

    monkeypatch.setattr(fence_check, "swept_body_measure", level)
    with pytest.raises(AssertionError, match="seed 1: leg of"):
        zone_cases.run(1, 2_000)
