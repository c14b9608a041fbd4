"""Is what came back from the vehicle what was sent?  In meaning, not in bytes.

Autopilots store less than MISSION_ITEM_INT can say; `stored.py` has what each of them keeps of
every parameter.  Both give other frames back than were sent, with the same datum; ArduPilot puts
its own home at index 0, gives items that have no place back with frame 0, and keeps heights in
centimetres.  Of a fence and of rally points PX4 gives no autocontinue back, and every height as one
above the sea, with the number that was sent (recorded, 1.14.3).  Everything passes through float32.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from gcs.plan import commands
from gcs.plan.model import AutopilotName
from gcs.plan.stored import kept
from gcs.plan.wire import WireItem
from gcs.wire.ids import Cmd, MavFrame, MissionType

_DATUM: dict[int, str] = {
    MavFrame.GLOBAL: "AMSL",
    MavFrame.GLOBAL_INT: "AMSL",
    MavFrame.GLOBAL_RELATIVE_ALT: "above home",
    MavFrame.GLOBAL_RELATIVE_ALT_INT: "above home",
    MavFrame.GLOBAL_TERRAIN_ALT: "above terrain",
    MavFrame.GLOBAL_TERRAIN_ALT_INT: "above terrain",
    MavFrame.MISSION: "no position",
}
_DEGREE_UNITS = 1
_HEIGHT_TOLERANCE_M = 0.011


@dataclass(frozen=True, slots=True)
class Difference:
    """At `seq`, `field` was sent as one thing and is stored as another, both in words.

    `item` is the name of the item's command; empty where it is about the whole mission.
    """

    seq: int
    field: str
    sent: str
    received: str
    item: str = ""

    def __str__(self) -> str:
        name = f" ({self.item})" if self.item else ""
        return f"item {self.seq}{name}: {self.field}: sent {self.sent}, stored {self.received}"


def same_meaning(
    sent: Sequence[WireItem], received: Sequence[WireItem], autopilot: AutopilotName
) -> list[Difference]:
    """Every difference that would change the flight; an empty list means the same mission."""
    differences: list[Difference] = []
    if len(sent) != len(received):
        differences.append(
            Difference(min(len(sent), len(received)), "items", str(len(sent)), str(len(received)))
        )
    mission = not sent or sent[0].mission_type == MissionType.MISSION
    home_items = 1 if autopilot == "ardupilot" and mission else 0
    for ours, theirs in list(zip(sent, received, strict=False))[home_items:]:
        differences.extend(_differences(ours, theirs, autopilot))
    return differences


def _differences(ours: WireItem, theirs: WireItem, autopilot: AutopilotName) -> list[Difference]:
    if ours.command != theirs.command:
        named = commands.name(ours.command), commands.name(theirs.command)
        return [Difference(ours.seq, "command", *named)]
    name = commands.name(ours.command)
    found: list[Difference] = []

    def differ(field: str, sent: object, received: object) -> None:
        found.append(Difference(ours.seq, field, str(sent), str(received), name))

    params = zip(kept(ours.command, autopilot), _params(ours), _params(theirs), strict=True)
    for number, (as_stored, sent, back) in enumerate(params, start=1):
        if not as_stored.same(sent, back):
            differ(f"param{number}", f"{sent:g}", f"{back:g}")
    of_fence = autopilot == "px4" and ours.mission_type != MissionType.MISSION
    if autopilot == "px4" and not of_fence and ours.autocontinue != theirs.autocontinue:
        differ("autocontinue", ours.autocontinue, theirs.autocontinue)

    has_place = commands.has_place(ours.command, ours.frame) and ours.frame != MavFrame.MISSION
    if not has_place:
        # What stands in the place of a return means nothing to PX4.
        numbers = autopilot == "px4" and ours.command != Cmd.NAV_RETURN_TO_LAUNCH
        if numbers and (ours.x, ours.y) != (theirs.x, theirs.y):
            differ("param5, param6", (ours.x, ours.y), (theirs.x, theirs.y))
        return found
    datums = [_DATUM.get(frame, f"frame {frame}") for frame in (ours.frame, theirs.frame)]
    if datums[0] != datums[1] and not of_fence:
        differ("frame", *datums)
    for axis, here, there in (("latitude", ours.x, theirs.x), ("longitude", ours.y, theirs.y)):
        if abs(here - there) > _DEGREE_UNITS:
            differ(axis, f"{here / 1e7:.7f}", f"{there / 1e7:.7f}")
    if not _same_height(ours.z, theirs.z):
        differ("altitude", f"{ours.z:g} m", f"{theirs.z:g} m")
    return found


def _params(item: WireItem) -> tuple[float, float, float, float]:
    return (item.param1, item.param2, item.param3, item.param4)


def _same_height(a: float, b: float) -> bool:
    if math.isnan(a) or math.isnan(b):
        return math.isnan(a) and math.isnan(b)
    return abs(a - b) <= max(_HEIGHT_TOLERANCE_M, abs(a) * 1e-6)
