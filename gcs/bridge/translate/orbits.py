"""DO_ORBIT: a circle, which the station flies itself as a stream of verified velocities.

By MAVLink's common.xml: what is NaN, or INT32_MAX, is the vehicle's default, or as it is flown
already.  A height is above sea level whatever the frame says: a PX4 takes it so (from memory), and
MAVSDK 4.1.0 relies on it, which sends such heights in frame 3 (seen through the bridge).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

from gcs import ipc
from gcs.bridge.translate.command import Command
from gcs.bridge.translate.meaning import Meaning, Reject, Seen, Words
from gcs.bridge.translate.places import Datum, datum_of, down_of, north_east_of
from gcs.bridge.translate.says import comes_back, refuse, unsupported
from gcs.gate.refusal import Code, Refusal

NOSES: Final[Mapping[int, str]] = {
    0: "centre",
    1: "initial",
    2: "free",
    3: "along",
    5: "",  # unchanged
}
"""ORBIT_YAW_BEHAVIOUR."""
BY_STICKS: Final = 4
ABOVE_SEA: Final = "the height is taken as above sea level, as a PX4 does, whatever the frame"


def orbit(command: Command, seen: Seen) -> Meaning:
    """What is not given is left to the station, which knows what is flown already."""
    if any(map(math.isinf, (command.p1, command.p2, command.p4, command.p7))):
        return refuse(Code.NON_FINITE, "an orbit with a number that is infinite")
    nose = "" if math.isnan(command.p3) else NOSES.get(_whole(command, command.p3))
    if nose is None:
        if command.p3 == BY_STICKS:
            return unsupported("a nose that the sticks turn: no sticks are heard in this mode")
        return unsupported(f"yaw behaviour {command.p3:g}: 0, 1, 2, 3 or 5")
    centre_enu = _centre(command, seen)
    if isinstance(centre_enu, Refusal):
        return Reject(centre_enu)
    turn_rad = _given(command.p4)
    circle = ipc.Circle(
        centre_enu=centre_enu,
        radius_m=_given(command.p1),
        speed_m_s=_given(command.p2),
        turns=None if turn_rad is None else turn_rad / math.tau,
        nose=nose,
    )
    wanted = ipc.Ask(0, "orbit", orbit=circle)
    by_home = command.frame is not None and datum_of(command.frame) is Datum.HOME
    note = ABOVE_SEA if by_home and not math.isnan(command.p7) else ""
    if comes_back(seen) and not seen.on_ground:
        return Words((ipc.Ask(0, "resume"), wanted), note)
    return Words((wanted,), note)


def _centre(command: Command, seen: Seen) -> ipc.Maybe3 | Refusal:
    """East, north, up; what is not given is None."""
    level = math.isnan(command.p7)
    if level and not command.has_place:
        return (None, None, None)
    datum = Datum.SEA if command.frame is None else datum_of(command.frame)
    if isinstance(datum, Refusal):
        return datum
    up_m = None
    if not level:
        down_m = down_of(seen, command.p7, Datum.SEA)
        if isinstance(down_m, Refusal):
            return down_m
        up_m = -down_m
    if not command.has_place:
        return (None, None, up_m)
    flat = north_east_of(seen, command.p5, command.p6)
    if isinstance(flat, Refusal):
        return flat
    return (flat[1], flat[0], up_m)


def _given(value: float) -> float | None:
    return None if math.isnan(value) else value


def _whole(command: Command, value: float) -> int:
    number = command.whole(value)
    return -1 if number is None else number
