"""A million random cases of the gate's geometry, against exact arithmetic and against shapely.

`make test` asks a share of them, `make soak` all.  `-s` shows what was counted.
"""

from __future__ import annotations

import pytest

from gcs.gate.airspace import judge
from gcs.gate.geometry import Point, Polygon
from tests.soak import geometry_cases, zone_cases
from tests.soak.seeds import SOAKING, base_seed

CHUNKS = 50
CASES_A_CHUNK = 18_000 if SOAKING else 1_600
ZONE_CASES_A_CHUNK = 2_000 if SOAKING else 400

chunks = pytest.mark.parametrize(
    "chunk", [pytest.param(n, marks=[pytest.mark.soak] if n else []) for n in range(CHUNKS)]
)


@chunks
def test_no_answer_of_the_plane_geometry_is_unsafe_unjust_or_timid(chunk: int) -> None:
    tally = geometry_cases.run(base_seed() + chunk, CASES_A_CHUNK)
    print(f"seed {base_seed() + chunk}: {tally.told()}")
    assert not tally.bad, tally.told()
    assert tally.cases >= CASES_A_CHUNK
    assert tally.share("certain") > 0.1, tally.told()
    assert tally.share("too close to say") < 0.4, tally.told()


@chunks
def test_whatever_the_judge_clears_beside_a_zone_is_clear(chunk: int) -> None:
    counts = zone_cases.run(base_seed() + chunk, ZONE_CASES_A_CHUNK)
    print(f"seed {base_seed() + chunk}: {sorted(counts.items())}")
    for what in ("point", "leg", "hull", "stop"):
        assert counts[what, "cleared"] > 0.02 * ZONE_CASES_A_CHUNK, counts


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


def test_a_region_that_forgets_what_is_at_a_height_is_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(judge, "ground_track_between", lambda points, low, high: ())
    with pytest.raises(AssertionError, match="seed 1: hull of"):
        zone_cases.run(1, 2_000)
