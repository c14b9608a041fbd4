"""A place where the vehicle's own return may end."""

from __future__ import annotations

from dataclasses import dataclass

from gcs.frames import Vec3

HOME = "home"


@dataclass(frozen=True, slots=True)
class ReturnPlace:
    """`ground_ned` is where the vehicle comes down, local NED; the height of the way there counts
    from it, and is `over_up_m` at least (metres), however low the vehicle's return height is."""

    name: str
    ground_ned: Vec3
    over_up_m: float = 0.0
