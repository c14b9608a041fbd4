"""Would the vehicle come to rest outside, and where is it braked or held instead?"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

from gcs.frames import Vec3
from gcs.gate.airspace.bounds import STANDING, Bounds, Cleared, beyond_reach
from gcs.gate.airspace.prediction import bad_stop
from gcs.gate.airspace.questions.back_inside import leaves_way_back
from gcs.gate.airspace.questions.positions import hold_point
from gcs.gate.airspace.stopping import OnWayBack, Path, StopBy

BRAKE_STEPS: Final = 16
"""How many positions between the predicted stop and the vehicle are tried for the brake."""


@dataclass(frozen=True)
class Breach:
    """The vehicle would stop outside the fence, or is outside already.

    `by` is the best way of stopping.  `towards` is the way to where that ends, and what it was
    judged by; None where that is not finite.
    """

    zone: str
    sentence: str
    numbers: tuple[tuple[str, float], ...]
    by: StopBy
    towards: WayToStop | None

    @cached_property
    def brake_pos_ned(self) -> Vec3 | None:
        """A verified position to stop at.  None where there is none, because the vehicle is outside
        or its position is not finite: then only hold mode is left.

        Looked for when it is asked for: a vehicle that is held already is not braked again, and its
        breach is predicted with every position."""
        way = self.towards
        if way is None:
            return None
        return brake_point(way.bounds, way.pos_ned, way.stop_ned, floor_applies=way.floor_applies)


@dataclass(frozen=True, slots=True)
class WayToStop:
    """From where to where, within which bounds, and whether their floors count."""

    bounds: Bounds
    pos_ned: Vec3
    stop_ned: Vec3
    floor_applies: bool


def predicted_stop(
    bounds: Bounds,
    pos_ned: Vec3,
    v_ned: Vec3,
    path: Path = None,
    late_s: float = 0.0,
    *,
    floor_applies: bool,
) -> Breach | None:
    """Would the vehicle on this `path` come to rest outside however it is stopped, or is it outside
    already?

    `late_s` is how old the position is, and how late it would hear of a stop.  Where the floor does
    not apply, the stop is no lower than the ground: a landing ends there.
    """
    unusable = bounds.unusable(position=pos_ned, velocity=v_ned) or beyond_reach(pos_ned, v_ned)
    if unusable is not None:
        return Breach(unusable.zone, unusable.sentence, unusable.numbers, StopBy.HOLD, None)
    bad = bad_stop(bounds, pos_ned, v_ned, path, late_s, floor_applies=floor_applies)
    if bad is None:
        return None
    if isinstance(path, OnWayBack):
        astray = leaves_way_back(bounds, pos_ned, v_ned, path.to_ned)
        if astray is None:
            return None
        return Breach(bad.measure.zone.name, astray.sentence, astray.numbers, StopBy.HOLD, None)
    way = WayToStop(bounds, pos_ned, bad.stop_ned, floor_applies)
    return Breach(bad.measure.zone.name, bad.sentence, bad.numbers, bad.by, way)


def hold_ahead(bounds: Bounds, pos_ned: Vec3, v_ned: Vec3, age_s: float) -> Vec3 | None:
    """Where to hold a vehicle that flies: where it is when the hold reaches it, if it may hover
    there, else as far on the way there as it may; None where no place clears.

    It flies past that while it brakes, and back.  A place farther ahead would send it on: px4
    in OFFBOARD flies the faster to a position the farther that is away.
    """
    if bounds.unusable(position=pos_ned, velocity=v_ned) or beyond_reach(pos_ned, v_ned):
        return None
    heard_s = age_s + bounds.policy.approach_of(bounds.autopilot).react_s
    north, east, down = (x + v * heard_s for x, v in zip(pos_ned, v_ned, strict=True))
    return brake_point(bounds, pos_ned, (north, east, down), floor_applies=True)


def brake_point(
    bounds: Bounds, pos_ned: Vec3, stop_ned: Vec3, *, floor_applies: bool
) -> Vec3 | None:
    """Where to brake: the predicted stop, or the first position back from it towards the
    vehicle that would be accepted as a goal; else the vehicle's position, if it may stay
    there; else None."""
    judge = bounds.judge
    for step in range(BRAKE_STEPS, -1, -1):
        t = step / BRAKE_STEPS
        n, e, d = (a + t * (b - a) for a, b in zip(pos_ned, stop_ned, strict=True))
        point_ned = (n, e, _above_ground(bounds, d, floor_applies=floor_applies))
        if (
            bounds.beyond_limits("brake", point_ned, floor_applies=floor_applies) is None
            and judge.point("brake", point_ned, floor_applies=floor_applies) is None
            and judge.leg("brake", pos_ned, point_ned, judge.margins, floor_applies=floor_applies)
            is None
        ):
            return point_ned
    n, e, d = pos_ned
    here_ned = (n, e, _above_ground(bounds, d, floor_applies=floor_applies))
    here = hold_point(bounds, here_ned, STANDING, floor_applies=floor_applies)
    return here_ned if isinstance(here, Cleared) else None


def _above_ground(bounds: Bounds, down_m: float, *, floor_applies: bool) -> float:
    """No brake leads below the ground, even where the floor does not apply."""
    if floor_applies or bounds.home_ned is None:
        return down_m
    return min(down_m, bounds.home_ned[2])
