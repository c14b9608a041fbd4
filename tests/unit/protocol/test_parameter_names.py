"""Renamed parameters: against the other program's table, and the names that a 4.7 listed."""

from __future__ import annotations

import pytest

from gcs.protocol.parameter_names import RENAMED, ParameterName, names_of
from vehicle_sim.autopilot.parameters.tables.renamed import COPTER_4_7

LISTED_BY_4_7 = {
    "ATC_ANGLE_MAX",
    "CIRCLE_RADIUS_M",
    "LAND_ALT_LOW_M",
    "LAND_SPD_HIGH_MS",
    "LAND_SPD_MS",
    "LOIT_SPEED_MS",
    "MAV_GCS_SYSID",
    "MAV_OPTIONS",
    "MAV_SYSID",
    "PSC_JERK_NE",
    "PSC_NE_POS_P",
    "PSC_NE_VEL_D",
    "PSC_NE_VEL_I",
    "PSC_NE_VEL_P",
    "RTL_ALT_FINAL_M",
    "RTL_ALT_M",
    "RTL_CLIMB_MIN_M",
    "RTL_SPEED_MS",
    "WP_ACC",
    "WP_ACC_Z",
    "WP_JERK",
    "WP_RADIUS_M",
    "WP_SPD",
    "WP_SPD_DN",
    "WP_SPD_UP",
}
"""Of arducopter_4_7_params.json; none of the old names is in it."""


def test_the_new_names_are_those_that_a_4_7_has() -> None:
    assert {row.new for row in RENAMED} == LISTED_BY_4_7
    assert not {row.old for row in RENAMED} & LISTED_BY_4_7


@pytest.mark.parametrize("row", RENAMED, ids=lambda row: row.new)
def test_both_programs_mean_the_same_parameter_and_unit(row: object) -> None:
    (same,) = [other for other in COPTER_4_7 if other.new == getattr(row, "new", "")]
    assert (same.old, same.factor) == (getattr(row, "old", ""), getattr(row, "scale", 0.0))


def test_the_newest_name_is_asked_first() -> None:
    assert names_of("RTL_ALT_M") == (ParameterName("RTL_ALT_M"), ParameterName("RTL_ALT", 0.01))
    assert names_of("RTL_RETURN_ALT") == (ParameterName("RTL_RETURN_ALT"),)
