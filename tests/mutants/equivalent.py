"""Mutants that change nothing that can be seen from outside, each with the reason.

Both lists are by target.  An entry that names no mutant is an error of the run, and so is an
equivalent mutant that a test kills.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tests.unit.gate import unreached as gate_table

EQUIVALENT: Final[Mapping[str, Mapping[str, str]]] = {
    "gate": {
        (
            "gcs/gate/airspace/judge.py FenceJudge._point_measures: m.start_m - wide_m -> "
            "m.start_m + wide_m"
        ): "the start of a point's measure is not read",
        (
            "gcs/gate/airspace/projection.py _azimuthal_forward: math.atan2(sin_c, up) / sin_c if "
            "sin_c > 0.0 else 1.0 -> math.atan2(sin_c, up) / sin_c if sin_c > 0.0 else 1.5"
        ): "sin c is zero only where north and east are, which the scale multiplies",
        (
            "gcs/gate/airspace/stopping.py stop_point: run_h / speed_h if speed_h > 0.0 else 0.0 "
            "-> run_h / speed_h if speed_h > 0.0 else 1.0"
        ): "a speed of zero has no north and no east to multiply",
        (
            "gcs/gate/airspace/zones.py _place: _east_north_up(home_ned or (0.0, 0.0, 0.0)) -> "
            "_east_north_up(home_ned or (1.0, 0.0, 0.0))"
        ): "without home, only zones that do not count from it get so far",
        (
            "gcs/gate/airspace/zones.py _place: _east_north_up(home_ned or (0.0, 0.0, 0.0)) -> "
            "_east_north_up(home_ned or (0.0, 1.0, 0.0))"
        ): "without home, only zones that do not count from it get so far",
        (
            "gcs/gate/airspace/zones.py _place: _east_north_up(home_ned or (0.0, 0.0, 0.0)) -> "
            "_east_north_up(home_ned or (0.0, 0.0, 1.0))"
        ): "without home, only zones that do not count from it get so far",
        "gcs/gate/effects.py SendCommand: 0.0 -> 1.0": (
            "read of a TAKE_OFF alone, which always gives it"
        ),
        (
            "gcs/gate/geometry.py side: clearance_m >= margin_m + TOLERANCE_M -> clearance_m > "
            "margin_m + TOLERANCE_M"
        ): "at exactly the tolerance either answer is allowed",
        "gcs/gate/geometry.py side: clearance_m < -TOLERANCE_M -> clearance_m <= -TOLERANCE_M": (
            "at exactly the tolerance either answer is allowed"
        ),
        (
            "gcs/gate/geometry.py Polygon.contains: (_turn(a, b, p) > 0.0) == (b[1] > a[1]) -> "
            "(_turn(a, b, p) > 0.0) != (b[1] > a[1])"
        ): "crossings of the ray to the west: as odd or even as those to the east",
        (
            "gcs/gate/geometry.py Polygon.contains: (_turn(a, b, p) > 0.0) == (b[1] > a[1]) -> "
            "(_turn(a, b, p) >= 0.0) == (b[1] > a[1])"
        ): "differs on the boundary only, where the answer means nothing",
        (
            "gcs/gate/geometry.py Polygon.contains: (_turn(a, b, p) > 0.0) == (b[1] > a[1]) -> "
            "(_turn(a, b, p) > 0.0) == (b[1] >= a[1])"
        ): "the heights of the ends differ: one is above p and one is not",
        "gcs/gate/geometry.py Polygon._middles: gap > TOLERANCE_M -> gap >= TOLERANCE_M": (
            "at exactly the tolerance either answer is allowed"
        ),
        (
            "gcs/gate/geometry.py Polygon._meetings: point_segment_distance(c, a, b) <= "
            "TOLERANCE_M -> point_segment_distance(c, a, b) < TOLERANCE_M"
        ): "at exactly the tolerance either answer is allowed",
        (
            "gcs/gate/geometry.py crossing: (a_side > 0.0) == (b_side > 0.0) -> (a_side >= 0.0) == "
            "(b_side > 0.0)"
        ): "a side of zero is no crossing, as the next condition says",
        (
            "gcs/gate/geometry.py crossing: (a_side > 0.0) == (b_side > 0.0) -> (a_side > 0.0) == "
            "(b_side >= 0.0)"
        ): "a side of zero is no crossing, as the next condition says",
        (
            "gcs/gate/geometry.py crossing: (c_side > 0.0) == (d_side > 0.0) -> (c_side >= 0.0) == "
            "(d_side > 0.0)"
        ): "a side of zero is no crossing, as the next condition says",
        (
            "gcs/gate/geometry.py crossing: (c_side > 0.0) == (d_side > 0.0) -> (c_side > 0.0) == "
            "(d_side >= 0.0)"
        ): "a side of zero is no crossing, as the next condition says",
        (
            "gcs/gate/geometry.py polygon_fault: _distance(a, b) <= TOLERANCE_M -> _distance(a, b) "
            "< TOLERANCE_M"
        ): "at exactly the tolerance either answer is allowed",
        (
            "gcs/gate/geometry.py polygon_fault: min(point_segment_distance(c, a, b), "
            "point_segment_distance(a, b, c)) <= TOLERANCE_M -> min(point_segment_distance(c, a, "
            "b), point_segment_distance(a, b, c)) < TOLERANCE_M"
        ): "at exactly the tolerance either answer is allowed",
        (
            "gcs/gate/geometry.py polygon_fault: segment_distance(a, b, *edges[j]) <= TOLERANCE_M "
            "-> segment_distance(a, b, *edges[j]) < TOLERANCE_M"
        ): "at exactly the tolerance either answer is allowed",
        "gcs/gate/geometry.py _projection: 0.0 -> 1.0": "the ends are the same place",
        "gcs/gate/states.py Control: 2 -> 3": "only compared for identity, and recorded by name",
    }
}
"""Reasons by the mutant's key."""

UNREACHED: Final[Mapping[str, Mapping[str, str]]] = {
    "gate": {
        entry: unreached.why for unreached in gate_table.UNREACHED for entry in unreached.entries
    }
}
"""Reasons by the name that the table's alterations give to an entry."""
