"""An estimate at rest, made by hand."""

from __future__ import annotations

from typing import Final

from vehicle_sim.estimation.estimated import Estimated

G: Final = 9.80665
BEGAN_S: Final = 10.0


def flying(**values: float) -> Estimated:
    """Level, at rest, aligned long ago, with a position."""
    est = Estimated(age_s=BEGAN_S, placed=True, gps_used=True, accuracy_m=0.4)
    for name, value in values.items():
        setattr(est, name, value)
    return est
