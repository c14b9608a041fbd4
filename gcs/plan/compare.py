"""Is what came back from the vehicle what was sent?  In meaning, not in bytes.

Autopilots store less than MISSION_ITEM_INT can say.  ArduPilot puts its own home at index 0,
gives frame 6 back as 3, items that have no place back with frame 0, forgets parameters that the
item does not use, and keeps heights in centimetres.  Everything passes through float32.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass

from gcs.plan import commands
from gcs.plan.model import AutopilotName
from gcs.plan.wire import WireItem
from gcs.wire.ids import Cmd, MavFrame

_DATUM: dict[int, str] = {
    MavFrame.GLOBAL: "AMSL",
    MavFrame.GLOBAL_INT: "AMSL",
    MavFrame.GLOBAL_RELATIVE_ALT: "above home",
    MavFrame.GLOBAL_RELATIVE_ALT_INT: "above home",
    MavFrame.GLOBAL_TERRAIN_ALT: "above terrain",
    MavFrame.GLOBAL_TERRAIN_ALT_INT: "above terrain",
    MavFrame.MISSION: "no position",
}
_ARDUPILOT_USES: dict[int, tuple[int, ...]] = {
    Cmd.NAV_WAYPOINT: (1,),
    Cmd.NAV_LOITER_UNLIM: (3,),
    Cmd.NAV_LOITER_TURNS: (1, 3),
    Cmd.NAV_LOITER_TIME: (1, 3),
    Cmd.NAV_RETURN_TO_LAUNCH: (),
    Cmd.NAV_LAND: (1,),
    Cmd.NAV_TAKEOFF: (1,),
    Cmd.NAV_SPLINE_WAYPOINT: (1,),
    Cmd.DO_JUMP: (1, 2),
    Cmd.DO_CHANGE_SPEED: (1, 2),
    Cmd.DO_SET_HOME: (1,),
    Cmd.CONDITION_DELAY: (1,),
    Cmd.DO_SET_CAM_TRIGG_DIST: (1, 3),
    Cmd.IMAGE_START_CAPTURE: (2, 3),
}
"""Parameters that ArduCopter flies by; of commands that are not here, all four."""

_DEGREE_UNITS = 1
_HEIGHT_TOLERANCE_M = 0.011


@dataclass(frozen=True, slots=True)
class Difference:
    """At `seq`, `field` was sent as one thing and came back as another, both in words."""

    seq: int
    field: str
    sent: str
    received: str

    def __str__(self) -> str:
        return f"item {self.seq}: {self.field}: sent {self.sent}, received {self.received}"


def same_meaning(
    sent: Sequence[WireItem], received: Sequence[WireItem], autopilot: AutopilotName
) -> list[Difference]:
    """Every difference that would change the flight; an empty list means the same mission."""
    differences: list[Difference] = []
    if len(sent) != len(received):
        differences.append(
            Difference(min(len(sent), len(received)), "items", str(len(sent)), str(len(received)))
        )
    home_items = 1 if autopilot == "ardupilot" else 0
    for ours, theirs in list(zip(sent, received, strict=False))[home_items:]:
        differences.extend(_differences(ours, theirs, autopilot))
    return differences


def _differences(ours: WireItem, theirs: WireItem, autopilot: AutopilotName) -> list[Difference]:
    if ours.command != theirs.command:
        named = commands.name(ours.command), commands.name(theirs.command)
        return [Difference(ours.seq, "command", *named)]
    found: list[Difference] = []

    def differ(field: str, sent: object, received: object) -> None:
        found.append(Difference(ours.seq, field, str(sent), str(received)))

    uses: tuple[int, ...] = (1, 2, 3, 4)
    if autopilot == "ardupilot":
        uses = _ARDUPILOT_USES.get(ours.command, uses)
    params = zip(_params(ours), _params(theirs), strict=True)
    for number, (sent, back) in enumerate(params, start=1):
        if number in uses and not _same_float(sent, back):
            differ(f"param{number}", f"{sent:g}", f"{back:g}")
    if autopilot == "px4" and ours.autocontinue != theirs.autocontinue:
        differ("autocontinue", ours.autocontinue, theirs.autocontinue)

    has_place = commands.has_place(ours.command, ours.frame) and ours.frame != MavFrame.MISSION
    if not has_place:
        if autopilot == "px4" and (ours.x, ours.y) != (theirs.x, theirs.y):
            differ("param5, param6", (ours.x, ours.y), (theirs.x, theirs.y))
        return found
    datums = [_DATUM.get(frame, f"frame {frame}") for frame in (ours.frame, theirs.frame)]
    if datums[0] != datums[1]:
        differ("frame", *datums)
    for axis, here, there in (("latitude", ours.x, theirs.x), ("longitude", ours.y, theirs.y)):
        if abs(here - there) > _DEGREE_UNITS:
            differ(axis, f"{here / 1e7:.7f}", f"{there / 1e7:.7f}")
    if not _same_height(ours.z, theirs.z):
        differ("altitude", f"{ours.z:g} m", f"{theirs.z:g} m")
    return found


def _params(item: WireItem) -> tuple[float, float, float, float]:
    return (item.param1, item.param2, item.param3, item.param4)


def _same_float(a: float, b: float) -> bool:
    """Equal as the wire carries them: float32, with NaN equal to NaN."""
    return (math.isnan(a) and math.isnan(b)) or _float32(a) == _float32(b)


def _same_height(a: float, b: float) -> bool:
    if math.isnan(a) or math.isnan(b):
        return math.isnan(a) and math.isnan(b)
    return abs(a - b) <= max(_HEIGHT_TOLERANCE_M, abs(a) * 1e-6)


def _float32(value: float) -> float:
    number: float = struct.unpack("<f", struct.pack("<f", value))[0]
    return number
