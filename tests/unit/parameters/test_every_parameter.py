"""Every parameter that is not inert changes something that can be measured; none is left out."""

from __future__ import annotations

import pytest

from tests.unit.parameters import ardupilot_cases, px4_cases
from tests.unit.parameters.probing import Case
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.tables import TABLES

CASES: dict[Personality, tuple[Case, ...]] = {
    "px4": px4_cases.CASES,
    "ardupilot": ardupilot_cases.CASES,
}
BOTH: tuple[Personality, ...] = ("px4", "ardupilot")


@pytest.mark.parametrize(
    ("personality", "case"),
    [
        pytest.param(personality, case, id=f"{personality}-{case.name}")
        for personality in BOTH
        for case in CASES[personality]
    ],
)
def test_what_is_measured_follows_the_parameter(personality: Personality, case: Case) -> None:
    measured = case.measure(personality)
    assert measured == case.expected
    # And what one value leads to would be wrong for every other.
    for value, found in measured.items():
        for other, expected in case.expected.items():
            assert value == other or found != expected, f"{value:g} is as good as {other:g}"


@pytest.mark.parametrize("personality", BOTH)
def test_every_parameter_that_acts_has_a_case_with_two_values_that_it_acts_on(
    personality: Personality,
) -> None:
    cases = {case.name: case for case in CASES[personality]}
    assert len(cases) == len(CASES[personality])
    acting = [spec for spec in TABLES[personality] if not spec.inert]
    assert set(cases) == {spec.name for spec in acting}
    for spec in acting:
        values = cases[spec.name].expected
        assert len(values) >= 2
        assert all(spec.low <= value <= spec.high for value in values)
