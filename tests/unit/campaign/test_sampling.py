"""Which flights are flown: samples cover what they say, and are the same every time."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs.campaign.plan import Choice, Range
from gcs.campaign.sampling import grid_size, latin, places_of, uniform
from tests.shares import examples
from tests.unit.campaign.campaigns import TEXT, planned


@given(st.integers(0, 2**40), st.text(max_size=8), st.integers(1, 200))
@settings(max_examples=examples(60), deadline=None)
def test_a_latin_sample_has_one_place_in_each_part(seed: int, what: str, count: int) -> None:
    places = latin(seed, what, count)
    assert sorted(int(place * count) for place in places) == list(range(count))
    assert places == latin(seed, what, count)


def test_chance_is_even_and_no_axis_is_like_another() -> None:
    """1,000 numbers: the mean is within 5 standard errors, 0.289 / sqrt(1000)."""
    ours = [uniform(1, "wind_m_s", number) for number in range(1000)]
    others = [uniform(1, "gust_m_s", number) for number in range(1000)]
    assert all(0.0 <= each < 1.0 for each in ours)
    assert abs(sum(ours) / 1000 - 0.5) < 5 * 0.289 / 1000**0.5
    together = sum((a - 0.5) * (b - 0.5) for a, b in zip(ours, others, strict=True)) / 1000
    assert abs(together) < 5 * (1 / 12) / 1000**0.5


def test_a_grid_has_every_combination_once(tmp_path: Path) -> None:
    text = TEXT.replace('"latin"', '"grid"').replace("flights = 40\n", "")
    text = text.replace("to = 8 }", "to = 8, steps = 5 }").replace(
        "{ from = 0, to = 1.5 }", "[0, 1]"
    )
    plan = planned(tmp_path, text)
    choices = [axis.values for axis in plan.axes if isinstance(axis, Choice)]
    assert len(choices) == len(plan.axes)
    assert plan.flights == grid_size(plan.axes) == 2 * 1 * 5 * 2 * 2
    places = places_of(plan)
    flown = [tuple(plan.inputs(places(n)).values()) for n in range(plan.flights)]
    assert flown == list(product(*choices))


@pytest.mark.parametrize("sample", ["random", "latin"])
def test_another_axis_changes_nothing_of_those_that_are_there(sample: str, tmp_path: Path) -> None:
    plan = planned(tmp_path, TEXT.replace('"latin"', f'"{sample}"'))
    more = msgspec.structs.replace(plan, axes=(*plan.axes, Range("payload_kg", 0.0, 1.0)))
    before, after = places_of(plan), places_of(more)
    assert [after(n)[:-1] for n in range(40)] == [before(n) for n in range(40)]


@given(st.floats(-1e6, 1e6), st.floats(1e-3, 1e6), st.floats(0.0, 1.0))
def test_a_range_keeps_its_ends(low: float, wide: float, place: float) -> None:
    axis = Range("x", low, low + wide)
    value = axis.at(place)
    assert isinstance(value, float)
    slack = 1e-5 * max(abs(low), abs(low + wide))
    assert low - slack <= value <= low + wide + slack
