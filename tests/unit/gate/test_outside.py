"""Is a vehicle that flies outside the fence?  For certain, and no longer for certain."""

from __future__ import annotations

import math

import pytest

from gcs.gate.airspace.verifier import verifier_for
from gcs.gate.refusal import Code
from tests.unit.gate.airspace import LAB, OUTER, TOWER, around, at, flying


@pytest.mark.parametrize(
    ("east_m", "up_m", "outside", "for_certain"),
    [
        (149.9, 5.0, False, False),
        (150.1, 5.0, True, False),  # a position may be wrong by 0.5 m beside, 0.2 m above
        (150.4, 5.0, True, False),
        (150.6, 5.0, True, True),
        (0.0, 49.9, False, False),
        (0.0, 50.1, True, False),
        (0.0, 50.3, True, True),
        (0.0, -3.0, False, False),  # the ground is no floor: it may lie lower than home
        (1.0e7, 5.0, True, True),
    ],
)
def test_beside_and_above_an_inclusion_zone(
    east_m: float, up_m: float, outside: bool, for_certain: bool
) -> None:
    verifier = flying()
    assert (verifier.outside(at(east_m, 0, up_m), for_certain=False) is not None) is outside
    assert (verifier.outside(at(east_m, 0, up_m), for_certain=True) is not None) is for_certain


def test_in_an_exclusion_zone() -> None:
    verifier = around(OUTER, TOWER)
    found = verifier.outside(at(25, 0, 5), for_certain=True)
    assert found is not None
    assert (found.code, found.zone) == (Code.INSIDE_EXCLUSION, "tower")
    assert verifier.outside(at(25, 0, 25), for_certain=True) is None
    assert verifier.outside(at(19.8, 0, 5), for_certain=False) is None
    assert verifier.outside(at(20.2, 0, 5), for_certain=True) is None


def test_the_lab_s_vehicles_may_stand_outside_by_their_slack() -> None:
    verifier = verifier_for(LAB, "px4", (0.0, 0.0, 0.0), None)
    assert verifier.outside(at(5.4, 0, 1), for_certain=False) is None
    assert verifier.outside(at(5.6, 0, 1), for_certain=True) is not None


def test_nothing_is_outside_of_no_fence() -> None:
    assert flying(fence_on=False).outside(at(500, 0, 5), for_certain=False) is None
    assert around().outside(at(500, 0, 5), for_certain=False) is None
    assert flying().outside((math.nan, 0.0, 0.0), for_certain=False) is None
