"""Where a mission goes on to from a spline waypoint without a stop."""

from __future__ import annotations

from contextlib import suppress

from gcs.frames import Vec3
from gcs.plan.commands import KINDS, Kind
from gcs.plan.curves import Onward
from gcs.plan.item_places import ItemPlaces, PlaceUnknownError
from gcs.plan.items import Flown, flown_as
from gcs.plan.jumps import jump_target
from gcs.plan.model import AutopilotName, Plan

_THROUGH = (Flown.STRAIGHT, Flown.STAYS, Flown.CURVE)


def ways_on(
    plan: Plan, index: int, places: ItemPlaces, autopilot: AutopilotName, pos_ned: Vec3
) -> tuple[tuple[Onward, ...], bool]:
    """Where it may go on to from item `index`, which ends at `pos_ned`, by every jump; and whether
    it may end at rest."""
    if plan.items[index].params[0] > 0.0:
        return (), True
    found: list[Onward] = []
    waiting, seen = [index + 1], set[int]()
    while waiting:
        at = waiting.pop()
        if at in seen or at >= len(plan.items):
            continue
        seen.add(at)
        item = plan.items[at]
        if KINDS.get(item.command) in (Kind.MOVE, Kind.RETURN, Kind.WAIT):
            flown = flown_as(item.command, autopilot)
            if flown in _THROUGH:
                with suppress(PlaceUnknownError):  # told when the walk comes to it
                    found.append(Onward(places.place(item, pos_ned), flown is Flown.CURVE))
            continue
        waiting.append(at + 1)
        target = jump_target(plan, item) if KINDS.get(item.command) is Kind.JUMP else None
        if target is not None:
            waiting.append(target)
    after = plan.items[index + 1] if index + 1 < len(plan.items) else None
    at_once = after is not None and flown_as(after.command, autopilot) in _THROUGH
    return tuple(found), not (at_once and found)
