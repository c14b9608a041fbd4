"""Our vehicle beside the real ones, step by step: no difference but those that are listed.

A sample in `make test` and `make thorough`, all of them in `make soak`.
"""

from __future__ import annotations

from typing import get_args

import pytest

from tests.scenarios.agree import compare
from tests.scenarios.facts import recorded
from tests.scenarios.judged import JUDGED, judged
from tests.scenarios.known import known
from tests.scenarios.play import play, playable
from tests.shares import one_in
from tests.soaking import SOAKING
from vehicle_sim.autopilot.modes import Personality

SHORT_S = 22.0
"""Scenarios that are no longer than this are in `make test` and `make thorough`."""
LONGER = ("A3_", "C10_", "F2_", "G3_", "G8_", "H2_")
"""And these, for what no other test asks: places given in other modes, the mission mode without a
mission, two zones, whose heartbeats count, a vehicle that stays armed on the ground."""

SCENARIOS = one_in(
    2,
    [
        pytest.param(personality, name, id=f"{personality}-{name}")
        for personality in get_args(Personality)
        for name, scenario in recorded(personality).items()
        if playable(personality, scenario)
        and (SOAKING or scenario.end_s <= SHORT_S or name.startswith(LONGER))
        and (SOAKING or not name.endswith("(again)"))
    ],
)


def test_the_sample_is_large_enough() -> None:
    assert len(SCENARIOS) >= 30


@pytest.mark.parametrize("personality", get_args(Personality))
def test_every_known_difference_is_judged_and_every_judgement_is_of_use(
    personality: Personality,
) -> None:
    used = set()
    for name, lines in known(personality).items():
        for line in lines:
            found = judged(personality, name, line)
            assert found, f"not judged: {line}"
            used |= set(found)
    assert used == {row for row in JUDGED if row.personality == personality}


@pytest.mark.slow
@pytest.mark.parametrize(("personality", "name"), SCENARIOS)
def test_no_new_difference_and_none_that_is_gone(personality: Personality, name: str) -> None:
    scenario = recorded(personality)[name]
    agreement = compare(scenario, play(personality, scenario))
    assert agreement.differences == known(personality).get(name, [])
