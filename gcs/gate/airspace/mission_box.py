"""Where a vehicle that flies its mission ought to be: a box round the whole verified path.

Outside it, it flies something else (another station put another mission on board past the
bridge, or it was pushed off its way), and nothing says that it slows down before the fence.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from gcs.frames import Vec3

BESIDE_M: Final = 5.0
"""A vehicle may be so far beside its path: overshoot, gusts and the error of its position.
Of 79 recorded flights of real autopilots the farthest was 1.7 m (`tests/real/facts`)."""


@dataclass(frozen=True, slots=True)
class MissionBox:
    """From the least to the greatest corner; local NED, metres."""

    least_ned: Vec3
    most_ned: Vec3

    def holds(self, pos_ned: Vec3) -> bool:
        """Whether a vehicle there may be on its path, or a little beside it."""
        return all(
            least - BESIDE_M <= x <= most + BESIDE_M
            for least, x, most in zip(self.least_ned, pos_ned, self.most_ned, strict=True)
        )


def box_round(points_ned: Iterable[Vec3]) -> MissionBox:
    """The least box that has all of them, of which there is one at least."""
    norths, easts, downs = zip(*points_ned, strict=True)
    return MissionBox((min(norths), min(easts), min(downs)), (max(norths), max(easts), max(downs)))
