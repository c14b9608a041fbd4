"""Bounds and ranks by published values, and what a summary says of rows."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.campaign.case import ERROR, Row
from gcs.campaign.requirement import RequirementError, parse
from gcs.campaign.sampling import places_of
from gcs.campaign.statistics import rank_correlation, summary, wilson
from tests.each import each
from tests.unit.campaign.campaigns import Pretended, planned

PUBLISHED = [
    (81, 263, 0.2553, 0.3662),
    (15, 148, 0.0624, 0.1605),
    (0, 20, 0.0, 0.1611),
    (1, 29, 0.0061, 0.1718),
]
"""R. G. Newcombe, Two-sided confidence intervals for the single proportion, Statistics in Medicine
17 (1998), table I, method 3."""


@each("row", PUBLISHED)
def test_bounds_are_wilsons(row: tuple[int, int, float, float]) -> None:
    hits, of, low, high = row
    assert wilson(hits, of) == pytest.approx((low, high), abs=5e-5)


@given(st.integers(0, 500), st.integers(0, 500))
def test_bounds_hold_the_share_and_mirror(hits: int, misses: int) -> None:
    low, high = wilson(hits, hits + misses)
    assert 0.0 <= low <= high <= 1.0
    if hits + misses:
        assert low <= hits / (hits + misses) <= high
    assert wilson(misses, hits + misses) == pytest.approx((1.0 - high, 1.0 - low))


def test_rank_correlation_by_hand() -> None:
    """With ties: ranks 1, 2.5, 2.5, 4 and 4, 2, 3, 1; 4.5 of deviations multiplied, by their
    squares 4.5 and 5."""
    assert rank_correlation([1, 2, 2, 9], [9, 3, 5, 1]) == pytest.approx(-4.5 / math.sqrt(22.5))
    assert rank_correlation([1, 2, 3], [2, 4, 8]) == pytest.approx(1.0)
    assert rank_correlation([1, 1, 1], [2, 4, 8]) is None


def test_a_summary_names_the_worst_what_it_depends_on_and_what_is_required(tmp_path: Path) -> None:
    plan = planned(tmp_path)
    places = places_of(plan)
    engine = Pretended(lambda flight: 6.0 - float(flight[1]["wind_m_s"]))
    rows = [engine.row((n, plan.inputs(places(n)))) for n in range(39)]
    rows.append(Row(id=39, inputs=plan.inputs(places(39)), outcome=ERROR))
    told = summary(plan, rows, "")
    breaching = [row for row in rows if float(row.inputs["wind_m_s"]) > 6.0 and row.id < 39]
    worst = max(breaching, key=lambda row: float(row.inputs["wind_m_s"]))
    assert (told.breaches.hits, told.failures) == (len(breaching), 1)
    assert told.worst[0] == worst.id
    assert told.first_breach == breaching[0].id
    assert told.dependences[0].axis == "wind_m_s"
    assert told.dependences[0].rank_correlation == pytest.approx(-1.0)
    assert sum(cell.breaches.of for cell in told.cells) == 40
    assert [level.value for level in told.levels] == ["up", "square", "px4", "ardupilot"]
    assert parse(f"breaches == {len(breaching)}").met(told)
    assert parse("closest_m < 0").met(told)
    assert not parse("failures <= 0").met(told)
    assert parse("breach_bound > 0.1").met(told)


@each(
    "text",
    [
        "breaches",
        "breaches = 0",
        "breaches == zero",
        "breaches == 0 or 1",
        "__import__('os') == 0",
        "breach == 0",
        "",
    ],
)
def test_what_is_no_requirement_is_refused(text: str) -> None:
    with pytest.raises(RequirementError) as caught:
        parse(text)
    assert caught.value.hint
