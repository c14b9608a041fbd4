"""Plan -> QGroundControl's .plan, with a list of what that format cannot keep."""

from __future__ import annotations

import json
import math

from gcs.plan import commands
from gcs.plan.errors import PlanError
from gcs.plan.formats.json_cursor import Json
from gcs.plan.formats.losses import Losses, Written
from gcs.plan.model import Circle, EastNorth, Fence, Frame, Geodetic, Item, LatLon, Local, Plan

_FIRMWARE_NUMBER = {"px4": 12, "ardupilot": 3, None: 0}
_ALTITUDE_MODE = {Frame.HOME: 1, Frame.AMSL: 2, Frame.TERRAIN: 4}
_QUADROTOR = 2


def write_plan(plan: Plan) -> Written:
    """Raises PlanError for a plan in a local frame: place it first (`georeference`)."""
    losses = Losses(plan)
    losses.heights_of_zones()
    home = plan.home or Geodetic(0.0, 0.0, 0.0)
    mission: dict[str, Json] = {
        "cruiseSpeed": plan.cruise_speed_m_s,
        "firmwareType": _FIRMWARE_NUMBER[plan.firmware],
        "globalPlanAltitudeMode": 0,
        "hoverSpeed": plan.hover_speed_m_s,
        "items": [_item(plan, item) for item in plan.items],
        "plannedHomePosition": [home.lat_deg, home.lon_deg, home.alt_amsl_m],
        "vehicleType": _QUADROTOR,
        "version": 2,
    }
    points: list[Json] = [[r.lat_deg, r.lon_deg, r.alt_above_home_m] for r in plan.rally]
    document: dict[str, Json] = {
        "fileType": "Plan",
        "geoFence": _fence(plan, plan.fence),
        "groundStation": "mavgate",
        "mission": mission,
        "rallyPoints": {"points": points, "version": 2},
        "version": 1,
    }
    text = json.dumps(document, indent=4, allow_nan=False)
    return Written(text.encode() + b"\n", losses.found())


def local_refused(plan: Plan, where: str, item: str) -> PlanError:
    return PlanError(
        plan.source or plan.name,
        where,
        item,
        "is in metres from the take-off point, which this format cannot say",
        hint="give the place of home (--home LAT,LON,ALT), so that it can be placed on Earth",
    )


def _number(value: float) -> Json:
    """NaN is null; whole numbers without a point, as QGroundControl writes them."""
    if math.isnan(value):
        return None
    return int(value) if value == int(value) and not _negative_zero(value) else value


def _negative_zero(value: float) -> bool:
    return value == 0.0 and math.copysign(1.0, value) < 0.0


def _item(plan: Plan, item: Item) -> Json:
    if isinstance(item.place, Local):
        raise local_refused(plan, item.where, commands.name(item.command))
    params: list[Json] = [_number(value) for value in (*item.params, *item.place)]
    entry: dict[str, Json] = {
        "autoContinue": item.autocontinue,
        "command": item.command,
        "doJumpId": item.do_jump_id,
        "frame": int(item.frame),
        "params": params,
        "type": "SimpleItem",
    }
    if item.frame in _ALTITUDE_MODE and commands.has_place(item.command, item.frame):
        entry["AMSLAltAboveTerrain"] = None
        entry["Altitude"] = params[6]
        entry["AltitudeMode"] = _ALTITUDE_MODE[item.frame]
    return entry


def _fence(plan: Plan, fence: Fence) -> Json:
    polygons: list[Json] = []
    circles: list[Json] = []
    for zone in fence.zones:
        entry: dict[str, Json] = {"inclusion": zone.inclusion, "version": 1}
        if isinstance(zone.shape, Circle):
            centre = _lat_lon(plan, zone.where, zone.shape.centre)
            entry["circle"] = {"center": centre, "radius": zone.shape.radius_m}
            circles.append(entry)
        else:
            entry["polygon"] = [_lat_lon(plan, zone.where, c) for c in zone.shape.corners]
            polygons.append(entry)
    section: dict[str, Json] = {"circles": circles, "polygons": polygons, "version": 2}
    if fence.breach_return is not None:
        to = fence.breach_return
        section["breachReturn"] = [to.lat_deg, to.lon_deg, to.alt_above_home_m]
    return section


def _lat_lon(plan: Plan, where: str, point: LatLon | EastNorth) -> Json:
    if isinstance(point, EastNorth):
        raise local_refused(plan, where, "fence zone")
    return [point.lat_deg, point.lon_deg]
