"""A brake in a return or a landing: its floor is lifted, the ground is not."""

from __future__ import annotations

from gcs.gate.airspace.projection import Origin
from gcs.gate.airspace.verifier import verifier_for
from gcs.gate.policy.parse import DEFAULT


def test_no_brake_points_below_the_ground() -> None:
    verifier = verifier_for(DEFAULT, "px4", (0.0, 0.0, 0.0), Origin(47.0, 8.0, 400.0))
    breach = verifier.predicted_stop((0.0, 130.0, 1.0), (0.0, 20.0, 0.0), floor_applies=False)
    assert breach is not None
    assert breach.brake_pos_ned is not None
    assert breach.brake_pos_ned[2] <= 0.0
