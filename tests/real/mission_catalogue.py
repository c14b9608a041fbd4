"""The missions that are flown on the real autopilots to learn how they fly missions.

Places are metres north, east and up of home.  `params` are parameters of the vehicle, in its units.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

TURNS_DEG = (30.0, 60.0, 90.0, 120.0, 150.0, 180.0)
WAYPOINT, UNLIMITED, CIRCLE, HOVER, HOME, LAND, TAKE_OFF, SPLINE = 16, 17, 18, 19, 20, 21, 22, 82
SPEED = 178


@dataclass(frozen=True, slots=True)
class Item:
    """`up_m` None: an item without a place."""

    command: int
    north_m: float = 0.0
    east_m: float = 0.0
    up_m: float | None = None
    params: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Flight:
    """One mission; `wind_m_s` from the west."""

    name: str
    items: tuple[Item, ...]
    params: dict[str, float] = field(default_factory=dict)
    wind_m_s: float = 0.0


def _speed(m_s: float) -> Item:
    return Item(SPEED, params=(1.0, m_s, -1.0, 0.0))


def _at(
    north_m: float, east_m: float, up_m: float, hold_s: float = 0.0, accept_m: float = 0.0
) -> Item:
    return Item(WAYPOINT, north_m, east_m, up_m, (hold_s, accept_m, 0.0, 0.0))


def _corners(legs_m: Sequence[float], turns_deg: Sequence[float]) -> Iterator[tuple[float, float]]:
    """North and east of the end of each leg; the turns are to the right and left by turns."""
    north = east = heading = 0.0
    way = 1.0
    for leg_m, turn_deg in zip(legs_m, (*turns_deg, 0.0), strict=True):
        north += leg_m * math.cos(heading)
        east += leg_m * math.sin(heading)
        yield north, east
        heading += way * math.radians(turn_deg)
        way = -way


def zigzag(
    leg_m: float,
    *,
    up_m: float = 12.0,
    hold_s: float = 0.0,
    accept_m: float = 0.0,
    command: int = WAYPOINT,
    steps_m: Sequence[float] = (0.0,),
) -> tuple[Item, ...]:
    """A leg, a turn of 30 degrees, a leg, a turn of 60 degrees, and so on, to 180; each leg higher
    by the next of `steps_m`."""
    corners = _corners((leg_m,) * (len(TURNS_DEG) + 1), TURNS_DEG)
    found = [Item(TAKE_OFF, up_m=up_m)]
    for number, (north, east) in enumerate(corners):
        up_m += steps_m[number % len(steps_m)]
        found.append(Item(command, north, east, up_m, (hold_s, accept_m, 0.0, 0.0)))
    return tuple(found)


def star(radius_m: float) -> tuple[Item, ...]:
    """Six waypoints on a circle, each far from the one before, and a return."""
    order = (0, 3, 5, 2, 4, 1)
    bearings = [math.radians(60.0 * n) for n in order]
    points = [_at(radius_m * math.cos(b), radius_m * math.sin(b), 12.0) for b in bearings]
    return (Item(TAKE_OFF, up_m=12.0), *points, Item(HOME))


def heights(leg_m: float, step_m: float) -> tuple[Item, ...]:
    """There and back on legs that climb and descend by `step_m`, the last one upright."""
    items = [Item(TAKE_OFF, up_m=8.0)]
    for number in range(4):
        up_m = 8.0 + step_m * (1 - number % 2)
        items.append(_at(leg_m * (1 - number % 2), 5.0 * number, up_m))
    items.append(_at(0.0, 15.0, 8.0 + step_m))
    return tuple(items)


def ups() -> tuple[Item, ...]:
    """Height alone changes, in between the legs; then a return from where it is higher than the
    return height."""
    return (
        Item(TAKE_OFF, up_m=5.0),
        _at(0.0, 0.0, 20.0),
        _at(0.0, 30.0, 20.0),
        _at(0.0, 30.0, 8.0),
        _at(30.0, 30.0, 8.0, 2.0),
        _at(30.0, 0.0, 30.0),
        Item(HOME),
    )


def landing(north_m: float, east_m: float, up_m: float) -> tuple[Item, ...]:
    return (
        Item(TAKE_OFF, up_m=up_m),
        _at(north_m, 0.0, up_m),
        Item(LAND, north_m, east_m, 0.0),
    )


def flights_px4() -> tuple[Flight, ...]:
    """The slowest to fly come last."""
    low = {"RTL_RETURN_ALT": 20.0}
    return (
        Flight("zigzag_40m", zigzag(40.0)),
        Flight("zigzag_40m_8m_s", (_speed(8.0), *zigzag(40.0)), {}),
        Flight("zigzag_80m_12m_s", (_speed(12.0), *zigzag(80.0))),
        Flight("star_56m", star(56.5), low),
        Flight("heights_20m_15m", heights(20.0, 15.0)),
        Flight("ups", ups(), low),
        Flight("zigzag_15m", zigzag(15.0)),
        Flight("zigzag_40m_accept_8m", zigzag(40.0, accept_m=8.0)),
        Flight("zigzag_40m_hold", zigzag(40.0, hold_s=1.0)),
        Flight("landing", landing(30.0, 40.0, 15.0)),
        Flight("zigzag_40m_8m_s_accept_1m", (_speed(8.0), *zigzag(40.0)), {"NAV_ACC_RAD": 1.0}),
        Flight(
            "zigzag_60m_10m_s_accept_6m",
            (_speed(10.0), *zigzag(60.0, steps_m=(4.0, -4.0))),
            {"NAV_ACC_RAD": 6.0},
        ),
        Flight(
            "zigzag_60m_quick",
            zigzag(60.0),
            {"MPC_XY_CRUISE": 8.0, "MPC_ACC_HOR": 5.0, "MPC_JERK_AUTO": 8.0},
        ),
        Flight(
            "zigzag_60m_soft",
            zigzag(60.0),
            {"MPC_XY_CRUISE": 8.0, "MPC_ACC_HOR": 2.0, "MPC_JERK_AUTO": 2.0},
        ),
        Flight("zigzag_10m_8m_s", (_speed(8.0), *zigzag(10.0, steps_m=(3.0, -3.0)))),
        Flight("heights_8m_20m", heights(8.0, 20.0)),
        Flight("heights_60m_20m_10m_s", (_speed(10.0), *heights(60.0, 20.0))),
        Flight("star_30m_10m_s", (_speed(10.0), *star(30.0)), low),
        Flight("return_near", (Item(TAKE_OFF, up_m=10.0), _at(7.0, 0.0, 10.0), Item(HOME)), low),
        Flight("return_high", (Item(TAKE_OFF, up_m=25.0), _at(40.0, 0.0, 25.0), Item(HOME)), low),
        Flight(
            "hover_items",
            (
                Item(TAKE_OFF, up_m=10.0),
                Item(HOVER, 40.0, 0.0, 10.0, (2.0, 0.0, 0.0, 0.0)),
                Item(HOVER, 40.0, 40.0, 16.0, (0.0, 0.0, 0.0, 0.0)),
                Item(HOVER, 0.0, 40.0, 6.0, (0.0, 0.0, 0.0, 0.0)),
                Item(LAND, 0.0, 0.0, 0.0),
            ),
        ),
    )


def splines(leg_m: float, straight: Sequence[int] = ()) -> tuple[Item, ...]:
    """Curves; to the items with these numbers straight legs."""
    items = list(zigzag(leg_m, command=SPLINE, steps_m=(3.0, -3.0, 0.0)))
    for number in straight:
        items[number] = _at(items[number].north_m, items[number].east_m, 12.0)
    return tuple(items)


def circles(turns: float, radii_m: Sequence[float]) -> tuple[Item, ...]:
    items = [Item(TAKE_OFF, up_m=10.0)]
    for number, radius_m in enumerate(radii_m):
        centre = (40.0 * (number + 1), 30.0 * (number % 2))
        items.append(Item(CIRCLE, *centre, 10.0 + 4.0 * number, (turns, 0.0, radius_m, 0.0)))
    items.append(_at(0.0, 0.0, 10.0))
    return tuple(items)


def flights_ardupilot() -> tuple[Flight, ...]:
    low = {"RTL_ALT_M": 20.0}
    calm = [
        Flight("zigzag_40m", zigzag(40.0)),
        Flight("zigzag_80m", zigzag(80.0)),
        Flight("star_54m", star(54.0), low),
        Flight("zigzag_80m_12m_s", (_speed(12.0), *zigzag(80.0))),
        Flight("zigzag_40m_5m_s", (_speed(5.0), *zigzag(40.0))),
        Flight("zigzag_15m", zigzag(15.0)),
        Flight("zigzag_10m_steps", zigzag(10.0, steps_m=(3.0, -3.0))),
        Flight("zigzag_60m_steps", zigzag(60.0, steps_m=(8.0, -8.0))),
        Flight("zigzag_40m_hold", zigzag(40.0, hold_s=1.0)),
        Flight("zigzag_60m_radius_5m", zigzag(60.0), {"WP_RADIUS_M": 5.0}),
        Flight("zigzag_60m_radius_10m", zigzag(60.0), {"WP_RADIUS_M": 10.0}),
        Flight("zigzag_60m_radius_half_m", zigzag(60.0), {"WP_RADIUS_M": 0.5}),
        Flight("zigzag_60m_quick", zigzag(60.0), {"WP_ACC": 5.0, "WP_SPD": 12.0}),
        Flight("zigzag_60m_soft", zigzag(60.0), {"WP_ACC": 1.0, "WP_SPD": 8.0}),
        Flight("zigzag_20m_quick", zigzag(20.0), {"WP_ACC": 5.0, "WP_RADIUS_M": 5.0}),
        Flight("heights_20m_15m", heights(20.0, 15.0)),
        Flight("heights_8m_20m", heights(8.0, 20.0)),
        Flight("heights_60m_20m", heights(60.0, 20.0)),
        Flight("ups", ups(), low),
        Flight("landing", landing(30.0, 40.0, 15.0)),
        Flight("splines_40m", splines(40.0)),
        Flight("splines_15m", splines(15.0)),
        Flight("splines_80m", splines(80.0)),
        Flight("splines_and_legs_40m", splines(40.0, (3, 6))),
        Flight("splines_and_legs_20m", splines(20.0, (3, 6))),
        Flight("splines_hold", zigzag(40.0, command=SPLINE, hold_s=1.0)),
        Flight("splines_40m_quick", splines(40.0), {"WP_ACC": 5.0}),
        Flight("splines_40m_5m_s", (_speed(5.0), *splines(40.0, (3, 6)))),
        Flight("splines_and_legs_80m", splines(80.0, (3, 6))),
        Flight("splines_and_legs_60m", splines(60.0, (2, 4, 6))),
        Flight("legs_and_splines_60m_12m_s", (_speed(12.0), *splines(60.0, (1, 3, 5)))),
        Flight("splines_and_legs_60m_quick", splines(60.0, (2, 5)), {"WP_ACC": 5.0}),
        Flight("splines_and_legs_30m", splines(30.0, (1, 4, 7))),
        Flight("circles", circles(1.0, (10.0, -10.0, 5.0))),
        Flight("circles_part", circles(1.5, (20.0, -6.0, 15.0))),
        Flight("circles_two", circles(2.0, (4.0, -12.0, 20.0))),
        Flight("return_near", (Item(TAKE_OFF, up_m=10.0), _at(7.0, 0.0, 10.0), Item(HOME)), low),
        Flight("return_high", (Item(TAKE_OFF, up_m=25.0), _at(60.0, 0.0, 25.0), Item(HOME)), low),
        Flight("return_up", (Item(TAKE_OFF, up_m=5.0), _at(60.0, 0.0, 5.0), Item(HOME)), low),
        Flight("take_off_high", (Item(TAKE_OFF, up_m=35.0), _at(20.0, 0.0, 35.0))),
        Flight(
            "hover_items",
            (
                Item(TAKE_OFF, up_m=10.0),
                Item(HOVER, 60.0, 0.0, 10.0, (2.0, 0.0, 0.0, 0.0)),
                Item(HOVER, 60.0, 60.0, 16.0, (0.0, 0.0, 0.0, 0.0)),
                Item(HOVER, 0.0, 60.0, 6.0, (0.0, 0.0, 0.0, 0.0)),
                Item(LAND, 0.0, 0.0, 0.0),
            ),
        ),
    ]
    windy = (
        "zigzag_40m",
        "zigzag_80m_12m_s",
        "zigzag_15m",
        "star_54m",
        "splines_40m",
        "splines_and_legs_20m",
        "circles",
        "circles_two",
        "ups",
        "landing",
        "return_high",
        "heights_20m_15m",
        "take_off_high",
        "hover_items",
    )
    blown = [
        Flight(f"{one.name}_wind_{wind:g}", one.items, one.params, wind)
        for wind in (5.0, 8.0)
        for one in calm
        if one.name in windy
    ]
    return (*calm, *blown)


FLIGHTS = {"px4": flights_px4, "ardupilot": flights_ardupilot}
