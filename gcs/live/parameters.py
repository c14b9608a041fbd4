"""What a person can set in a viewer: how high a clicked goal is, and how far a step goes."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec

MAX_STEP_M = 100.0
MAX_HEIGHT_M = 1_000.0


class Parameters(msgspec.Struct, frozen=True):
    """Parameters by the names that a viewer shows.  A new value is taken whole or not at all."""

    goal_height_m: float = 0.0  # above the local origin; 0 = the height that the vehicle has
    step_m: float = 1.0  # of the service `step`

    def changed(self, asked: Mapping[str, object]) -> Parameters:
        """With the values that make sense; an unknown name or a bad value changes nothing."""
        now = self
        for name, value in asked.items():
            if _fits(name, value):
                now = msgspec.structs.replace(now, **{name: float(value)})  # type: ignore[arg-type]
        return now


def _fits(name: str, value: object) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    match name:
        case "goal_height_m":
            return 0.0 <= value <= MAX_HEIGHT_M
        case "step_m":
            return 0.0 < value <= MAX_STEP_M
        case _:
            return False
