"""Rally points: other places than home that the vehicle may return to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import hypot, isfinite

from vehicle_sim.autopilot.fence.zones import check_place, place_ne
from vehicle_sim.autopilot.geo import Projection
from vehicle_sim.autopilot.interface import Flaw, PlanItem, Refusal
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.numerics.vectors import Vec3

_RALLY_POINT = 5100  # MAV_CMD_NAV_RALLY_POINT
_RELATIVE = frozenset({3, 6})  # MAV_FRAME_GLOBAL_RELATIVE_ALT, _INT


def check(items: tuple[PlanItem, ...]) -> Refusal | None:
    """The first item that is no rally point; None when all are."""
    for item in items:
        if item.command != _RALLY_POINT:
            why = f"command {item.command} is not for a rally point"
            return Refusal(item.seq, Flaw.COMMAND, why)
        refusal = check_place(item)
        if refusal is not None:
            return refusal
        if not isfinite(item.z):
            return Refusal(item.seq, Flaw.PLACE, "the altitude is not a number")
    return None


@dataclass(frozen=True, slots=True)
class Point:
    """North and east of the origin [m]; `up_m` above home if `relative`, else above sea level."""

    north_m: float
    east_m: float
    up_m: float
    relative: bool


def build(items: tuple[PlanItem, ...], projection: Projection) -> tuple[Point, ...]:
    """The points of items that `check` has passed."""
    return tuple(
        Point(*place_ne(item, projection), item.z, item.frame in _RELATIVE) for item in items
    )


@dataclass(frozen=True, slots=True)
class LandingSite:
    """Where a return ends: the ground there [m, NED], and how low [m, NED] it may be flown to.

    `over_d` is the least height of the way there, None where only the parameters say it.
    """

    ground_ned: Vec3
    over_d: float | None = None


def landing_site(
    points: tuple[Point, ...],
    pos_ned: Vec3,
    home_ned: Vec3,
    origin_amsl_m: float,
    parameters: Parameters,
    allowed: Callable[[float, float], bool],
) -> LandingSite:
    """The nearest of home and the rally points, as the personality chooses.

    ArduCopter (AP_Rally): the nearest rally point that the fence allows, unless it is further off
    than RALLY_LIMIT_KM, or home is nearer and RALLY_INCL_HOME is set; its altitude is the least
    height of the way, the landing goes down to the ground.  PX4 (RTL_TYPE 0): the nearest of
    home and all points; RTL_TYPE 1: the nearest that is not home.  Its altitude is the ground's.
    """
    inside_fence_only = parameters.rules.rally_inside_fence_only
    known = [p for p in points if not inside_fence_only or allowed(p.north_m, p.east_m)]
    if not known:
        return LandingSite(home_ned)

    def off_m(point: Point) -> float:
        return hypot(point.north_m - pos_ned[0], point.east_m - pos_ned[1])

    nearest = min(known, key=off_m)
    home_off_m = hypot(home_ned[0] - pos_ned[0], home_ned[1] - pos_ned[1])
    down = home_ned[2] - nearest.up_m if nearest.relative else origin_amsl_m - nearest.up_m
    site = _RALLY_SITES[parameters.personality]
    return site(parameters, nearest, off_m(nearest), home_ned, home_off_m, down)


def _px4_site(
    parameters: Parameters,
    nearest: Point,
    off_m: float,
    home_ned: Vec3,
    home_off_m: float,
    down: float,
) -> LandingSite:
    if parameters.get("RTL_TYPE") == 0 and home_off_m <= off_m:
        return LandingSite(home_ned)
    return LandingSite((nearest.north_m, nearest.east_m, down))


def _copter_site(
    parameters: Parameters,
    nearest: Point,
    off_m: float,
    home_ned: Vec3,
    home_off_m: float,
    down: float,
) -> LandingSite:
    too_far = 0.0 < 1000.0 * parameters.get("RALLY_LIMIT_KM") < off_m
    if too_far or (parameters.get("RALLY_INCL_HOME") != 0 and home_off_m <= off_m):
        return LandingSite(home_ned)
    return LandingSite((nearest.north_m, nearest.east_m, home_ned[2]), down)


_RALLY_SITES: dict[
    Personality, Callable[[Parameters, Point, float, Vec3, float, float], LandingSite]
] = {"px4": _px4_site, "ardupilot": _copter_site}
"""Whether the return ends at the nearest point: how far off it is and how far home is, horizontally
[m], and `down`, the height [m, NED] that the point says."""
