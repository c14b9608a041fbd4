"""What a person can set in a viewer: how high a clicked goal is, and how far a step goes."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec

LIMITS: Mapping[str, tuple[float, float]] = {
    "goal_height_m": (0.0, 1_000.0),
    "step_m": (0.01, 100.0),
}


class Parameters(msgspec.Struct, frozen=True):
    """Parameters by the names that a viewer shows."""

    goal_height_m: float = 0.0  # above the local origin; 0 = the height that the vehicle has
    step_m: float = 1.0  # of the service `step`

    def changed(self, asked: Mapping[str, object]) -> tuple[Parameters, list[str]]:
        """With the values that make sense; and a sentence about each of the others."""
        now, mistakes = self, []
        for name, value in asked.items():
            if name not in LIMITS:
                mistakes.append(f"there is no parameter {name[:40]!r}")
                continue
            low, high = LIMITS[name]
            is_number = isinstance(value, int | float) and not isinstance(value, bool)
            if is_number and low <= value <= high:  # type: ignore[operator]
                now = msgspec.structs.replace(now, **{name: float(value)})  # type: ignore[arg-type]
            else:
                kept = getattr(self, name)
                mistakes.append(f"{name} is a number from {low:g} to {high:g}; it stays {kept:g}")
        return now, mistakes
