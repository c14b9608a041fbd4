"""What is doubtful or wrong about a plan before any vehicle is asked.

The distances here are rough, on a sphere, and only find absurd values; what may be flown is
judged elsewhere, in the vehicle's own projection.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Protocol

from gcs.plan.commands import FLOWN, KINDS, Kind, item_label
from gcs.plan.errors import Finding, Level
from gcs.plan.feasibility import never_starts
from gcs.plan.items import Flown, flown_as
from gcs.plan.jumps import lint_jumps
from gcs.plan.legs import ProblemKind
from gcs.plan.lint_fence import distance_m, lint_fence
from gcs.plan.model import AutopilotName, Frame, Geodetic, Geographic, Item, Local, Plan
from gcs.wire.ids import Cmd

FAR_M = 2_000.0
ABSURD_M = 20_000.0
HIGH_M = 500.0
LOWEST_GROUND_AMSL_M = -430.0
"""The shore of the Dead Sea, the lowest ground on Earth."""

_HERE_ALLOWED = frozenset(
    {Cmd.NAV_LAND, Cmd.NAV_TAKEOFF, Cmd.NAV_LOITER_UNLIM, Cmd.NAV_LOITER_TIME}
)

_ENDS: dict[int, str] = {
    Cmd.NAV_RETURN_TO_LAUNCH: "ends the flight; what follows is only reached by a jump",
    Cmd.NAV_LAND: "lands and stops its motors; what follows is only flown after a new start, or "
    "is reached by a jump",
}
_LANDS_AND_GOES_ON = "lands, and takes off again by itself for what follows"


class _Finder(Protocol):
    """Makes a finding about the item at hand."""

    def __call__(self, level: Level, what: str, hint: str = "") -> Finding: ...


def lint(
    plan: Plan, autopilot: AutopilotName | None = None, home: Geodetic | None = None
) -> list[Finding]:
    """The reader's notes and everything found here, in the order of the file's sections.

    `home` is where the vehicle will take off, if that is known; else the planned home counts.
    """
    who = autopilot or plan.firmware
    at_home = home or plan.home
    findings = [*plan.notes]
    if autopilot and plan.firmware and autopilot != plan.firmware:
        what = f"was written for {plan.firmware} and is checked for {autopilot}"
        findings.append(Finding(Level.WARNING, "", "plan", what))
    findings += _whole_mission(plan, who)
    for index, item in enumerate(plan.items):
        findings += _one_item(index, item, who, at_home)
    findings += lint_jumps(plan)
    findings += _distances(plan, at_home)
    findings += lint_fence(plan, at_home)
    return findings


def worst(findings: list[Finding]) -> Level | None:
    return max((finding.level for finding in findings), default=None)


def _whole_mission(plan: Plan, autopilot: AutopilotName | None) -> Iterator[Finding]:
    if not plan.items:
        if not plan.fence.zones and not plan.rally:
            yield Finding(
                Level.WARNING, "", "plan", "holds neither mission, fence nor rally points"
            )
        return
    kinds = [KINDS.get(item.command) for item in plan.items]
    stuck = [] if autopilot is None else list(never_starts(plan, autopilot))
    moving = [i for i, kind in enumerate(kinds) if kind in (Kind.MOVE, Kind.RETURN)]
    if not moving:
        yield Finding(Level.WARNING, "", "mission", "no item flies anywhere")
    elif plan.items[moving[0]].command != Cmd.NAV_TAKEOFF and not stuck:
        yield _no_take_off(moving[0], plan.items[moving[0]], autopilot)
    for index, why in stuck:
        item = plan.items[index]
        what = f"{autopilot} stores it and never starts the mission: {why}"
        yield Finding(Level.WARNING, item.where, item_label(index, item.command), what, index=index)
    yield from _ends_before_the_last(plan, autopilot)
    ids = [item.do_jump_id for item in plan.items]
    if ids != list(range(1, len(ids) + 1)) and any(
        item.command == Cmd.DO_JUMP for item in plan.items
    ):
        what = "do not count 1, 2, 3 ...; jumps go to the id, not to the position"
        yield Finding(Level.NOTE, "", "doJumpIds", what)


def _ends_before_the_last(plan: Plan, autopilot: AutopilotName | None) -> Iterator[Finding]:
    """The first return and the first landing that something is to be flown after.

    What becomes of such a landing is from memory of the autopilots (and done so by vehicle-sim).
    """
    flown = [i for i, item in enumerate(plan.items) if KINDS.get(item.command) in FLOWN]
    told: set[int] = set()
    for index in flown[:-1]:
        item = plan.items[index]
        if item.command not in _ENDS or item.command in told:
            continue
        told.add(item.command)
        amid_px4 = autopilot == "px4" and item.command == Cmd.NAV_LAND
        what = _LANDS_AND_GOES_ON if amid_px4 else _ENDS[item.command]
        yield Finding(Level.WARNING, item.where, item_label(index, item.command), what, index=index)


def _no_take_off(index: int, first: Item, autopilot: AutopilotName | None) -> Finding:
    """Recorded: PX4 takes off by itself (C6, C12), ArduCopter says "Missing Takeoff Cmd" (C3)."""
    what = "is the first to fly, and no take-off comes before it"
    level, hint = Level.WARNING, "a vehicle on the ground will not start this mission"
    if autopilot == "px4":
        level, hint = Level.NOTE, "on the ground, px4 climbs first to the height of this item"
    return Finding(level, first.where, item_label(index, first.command), what, hint, index)


def _one_item(
    index: int, item: Item, autopilot: AutopilotName | None, home: Geodetic | None
) -> Iterator[Finding]:
    label = item_label(index, item.command)

    def finding(level: Level, what: str, hint: str = "") -> Finding:
        return Finding(level, item.where, label, what, hint, index)

    kind = KINDS.get(item.command)
    if kind is None:
        why = ProblemKind.NOT_FLOWN
        if item.command == Cmd.NAV_PAYLOAD_PLACE:
            why = ProblemKind.OWN_DESCENT
        yield finding(Level.ERROR, why.value)
    elif kind is Kind.SET_HOME:
        yield finding(Level.WARNING, "moves home in mid-flight, so that later heights move too")
    elif item.command == Cmd.DO_FENCE_ENABLE and item.params[0] != 1.0:
        what = "switches the vehicle's own fence off, in part or whole"
        yield finding(Level.WARNING, what, "the legs are verified here all the same")
    if autopilot is not None and flown_as(item.command, autopilot) is Flown.REFUSED:
        yield finding(Level.WARNING, f"{autopilot} refuses this item at upload")
    if item.frame is Frame.TERRAIN:
        what = "its height is above terrain, which is not known here"
        yield finding(Level.WARNING, what, "heights above home can be checked")
    if kind is not Kind.MOVE:
        return
    if isinstance(item.place, Geographic):
        yield from _geographic(item, item.place, autopilot, home, finding)
    elif isinstance(item.place, Local) and item.command != Cmd.NAV_LAND:
        yield from _height_above_home(item.place.up_m, finding)


def _geographic(
    item: Item,
    place: Geographic,
    autopilot: AutopilotName | None,
    home: Geodetic | None,
    finding: _Finder,
) -> Iterator[Finding]:
    if place.here and item.command not in _HERE_ALLOWED:
        if autopilot == "ardupilot":
            yield finding(Level.WARNING, "has no position (0, 0): flown as: stay where you are")
        else:
            what = "has no position (0, 0), which is in the Gulf of Guinea"
            yield finding(Level.ERROR, what, "give a latitude and a longitude")
    if math.isnan(place.alt_m):
        what = "has no altitude"
        if autopilot == "px4" and item.command == Cmd.NAV_TAKEOFF:
            yield finding(Level.WARNING, f"{what}: the vehicle takes its own (MIS_TAKEOFF_ALT)")
        else:
            yield finding(Level.ERROR, what, "give it in metres")
    elif item.frame is Frame.AMSL:
        yield from _amsl_height(item, place.alt_m, home, finding)
    elif item.frame is Frame.HOME and item.command != Cmd.NAV_LAND:
        yield from _height_above_home(place.alt_m, finding)


def _amsl_height(
    item: Item, alt_amsl_m: float, home: Geodetic | None, finding: _Finder
) -> Iterator[Finding]:
    ground_m = home.alt_amsl_m if home is not None else None
    if ground_m is None:
        if alt_amsl_m < LOWEST_GROUND_AMSL_M:
            yield finding(Level.ERROR, f"{alt_amsl_m:g} m AMSL is underground anywhere on Earth")
        else:
            what = f"{alt_amsl_m:g} m AMSL cannot be compared with the ground: home is not known"
            yield finding(Level.WARNING, what, "give --home LAT,LON,ALT")
        return
    above_m = alt_amsl_m - ground_m
    if above_m < 0.0 and item.command != Cmd.NAV_LAND:
        what = f"{alt_amsl_m:g} m AMSL is underground: home is {-above_m:.1f} m higher"
        yield finding(Level.ERROR, what, "was a height above home meant (frame 3)?")
    elif above_m > HIGH_M:
        yield finding(Level.WARNING, f"is {above_m:.0f} m above home")


def _height_above_home(up_m: float, finding: _Finder) -> Iterator[Finding]:
    if up_m < 0.0:
        yield finding(Level.WARNING, f"is {-up_m:g} m lower than home")
    elif up_m > HIGH_M:
        yield finding(Level.WARNING, f"is {up_m:.0f} m above home", "was AMSL meant (frame 0)?")


def _distances(plan: Plan, home: Geodetic | None) -> Iterator[Finding]:
    before: tuple[float, float] | None = None
    before_told = "home"
    if home is not None:
        before = (home.lat_deg, home.lon_deg)
    for index, item in enumerate(plan.items):
        place = item.place
        if KINDS.get(item.command) is not Kind.MOVE or not isinstance(place, Geographic):
            continue
        if place.here:
            continue
        here = (place.lat_deg, place.lon_deg)
        if before is not None:
            far_m = distance_m(before, here)
            if far_m > FAR_M:
                level = Level.ERROR if far_m > ABSURD_M else Level.WARNING
                what = f"is {far_m / 1000:.1f} km from {before_told}"
                hint = "are latitude and longitude in this order, and home right?"
                yield Finding(level, item.where, item_label(index, item.command), what, hint, index)
        before, before_told = here, f"item {index + 1}"
