"""A plan's fence and rally points -> the items of the mission protocol's other two lists."""

from __future__ import annotations

from typing import Final

from gcs.plan.formats.fence_items import fence_rows
from gcs.plan.model import Fence, RallyPoint
from gcs.plan.wire import WireItem
from gcs.wire.ids import Cmd, MavFrame, MissionType

_SCALE = 1e7
DEEP_M: Final = 50.0


def has_heights(fence: Fence) -> bool:
    """Whether a zone has a floor or a ceiling, which fence items cannot say."""
    return any(
        zone.floor_above_home_m is not None or zone.ceiling_above_home_m is not None
        for zone in fence.zones
    )


def fence_to_wire(source: str, fence: Fence) -> tuple[WireItem, ...]:
    """Raises PlanError for a zone in metres: place it on Earth first (`georeference`)."""
    return tuple(
        _item(
            seq,
            row.command,
            MavFrame.GLOBAL,
            row.p1,
            (row.lat_deg, row.lon_deg, row.alt_m),
            MissionType.FENCE,
        )
        for seq, row in enumerate(fence_rows(source, fence))
    )


def rally_to_wire(
    points: tuple[RallyPoint, ...], home_alt_amsl_m: float | None = None
) -> tuple[WireItem, ...]:
    """Heights above home; for a PX4 above mean sea level, `home_alt_amsl_m` being its home's: it
    tells every rally point so, whatever it was sent in (recorded, 1.14.3)."""
    amsl = home_alt_amsl_m is not None
    frame = MavFrame.GLOBAL if amsl else MavFrame.GLOBAL_RELATIVE_ALT
    return tuple(
        _item(
            seq,
            Cmd.NAV_RALLY_POINT,
            frame,
            0.0,
            (point.lat_deg, point.lon_deg, point.alt_above_home_m + (home_alt_amsl_m or 0.0)),
            MissionType.RALLY,
        )
        for seq, point in enumerate(points)
    )


def is_above_home(item: WireItem, home_alt_amsl_m: float) -> bool:
    """What the height of a rally point on board counts from: home, or mean sea level.

    One that would lie deep below home was sent above home and is told otherwise by a PX4, which
    QGroundControl does.  Where home is near the sea that cannot be seen.
    """
    relative = (MavFrame.GLOBAL_RELATIVE_ALT, MavFrame.GLOBAL_RELATIVE_ALT_INT)
    return item.frame in relative or item.z < home_alt_amsl_m - DEEP_M


def _item(
    seq: int,
    command: int,
    frame: MavFrame,
    p1: float,
    place: tuple[float, float, float],
    kind: MissionType,
) -> WireItem:
    return WireItem(
        seq=seq,
        frame=frame,
        command=command,
        current=0,
        autocontinue=1,
        param1=p1,
        param2=0.0,
        param3=0.0,
        param4=0.0,
        x=round(place[0] * _SCALE),
        y=round(place[1] * _SCALE),
        z=place[2],
        mission_type=kind,
    )
