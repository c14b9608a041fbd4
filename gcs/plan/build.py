"""Seven numbers and a frame -> an `Item`: the one check that items of every format pass."""

from __future__ import annotations

import math
from collections.abc import Sequence

from gcs.plan import commands
from gcs.plan.commands import KINDS, Kind
from gcs.plan.errors import PlanError
from gcs.plan.model import UNSET, Frame, Geographic, Item, Place, Plain

_FRAMES: dict[int, Frame] = {
    0: Frame.AMSL,
    5: Frame.AMSL,
    3: Frame.HOME,
    6: Frame.HOME,
    10: Frame.TERRAIN,
    11: Frame.TERRAIN,
    2: Frame.MISSION,
}
_FRAMES_TOLD = "0 or 5 (AMSL), 3 or 6 (above home), 10 or 11 (terrain), 2 (no position)"
_FLOAT32_MAX = 3.4e38
_INT32_MAX = 2**31 - 1
_COMMAND_MAX = 65535
ALTITUDE_MAX_M = 100_000.0


def item_from_numbers(
    file: str,
    where: str,
    command: int,
    frame_number: int,
    numbers: Sequence[float],
    do_jump_id: int,
    autocontinue: bool = True,
) -> Item:
    """`numbers` are the seven MAVLink parameters, latitude and longitude in degrees, NaN = unset.

    Raises PlanError for a frame that missions do not have, a place that is not on Earth, and
    a number that does not fit its field.
    """
    label = commands.name(command)
    if not 0 <= command <= _COMMAND_MAX:
        raise PlanError(file, where, "command", f"{command} is no MAV_CMD", f"0..{_COMMAND_MAX}")
    if frame_number not in _FRAMES:
        raise PlanError(
            file, where, label, f"frame {frame_number} is none of a mission", _FRAMES_TOLD
        )
    p1, p2, p3, p4, x, y, z = (UNSET if math.isnan(n) else float(n) for n in numbers)
    for position, value in enumerate((p1, p2, p3, p4), start=1):
        if abs(value) > _FLOAT32_MAX:
            raise PlanError(file, where, label, f"param{position} is {value:g}", "a finite number")
    frame = _FRAMES[frame_number]
    place: Place
    if commands.has_place(command, frame_number) and frame is not Frame.MISSION:
        place = _geographic(file, where, label, x, y, z)
    elif KINDS.get(command) is Kind.MOVE:
        raise PlanError(
            file, where, label, "frame 2 has no position, but this item flies to one", _FRAMES_TOLD
        )
    else:
        place = _plain(file, where, label, x, y, z)
    return Item(command, frame, (p1, p2, p3, p4), place, do_jump_id, autocontinue, where)


def _geographic(file: str, where: str, label: str, x: float, y: float, z: float) -> Geographic:
    check_lat_lon(file, where, label, x, y)
    if abs(z) > ALTITUDE_MAX_M:
        raise PlanError(
            file, where, label, f"altitude {z:g} m", f"at most {ALTITUDE_MAX_M:.0f} m either way"
        )
    return Geographic(x, y, z)


def check_lat_lon(file: str, where: str, label: str, lat_deg: float, lon_deg: float) -> None:
    """NaN passes: it is "unset".  Raises PlanError for what is not on Earth."""
    if abs(lat_deg) > 90.0:
        hint = "latitude comes before longitude" if abs(lon_deg) <= 90.0 else ""
        raise PlanError(file, where, label, f"latitude {lat_deg:g}", "-90..90 degrees", hint)
    if abs(lon_deg) > 180.0:
        raise PlanError(file, where, label, f"longitude {lon_deg:g}", "-180..180 degrees")


def _plain(file: str, where: str, label: str, x: float, y: float, z: float) -> Plain:
    for position, value in ((5, x), (6, y)):
        if abs(value) > _INT32_MAX:
            raise PlanError(file, where, label, f"param{position} is {value:g}", "a 32-bit integer")
    if abs(z) > _FLOAT32_MAX:
        raise PlanError(file, where, label, f"param7 is {z:g}", "a finite number")
    return Plain(x, y, z)
