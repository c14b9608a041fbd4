"""/geofence/zones: the fence as numbers, for programs; viewers draw /geofence and its GeoJSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import msgspec

from gcs.record.backend import Channel
from gcs.record.topics import Out
from gcs.report import FenceItem, FenceShape, RecordItem

FENCE_TOPIC = "/geofence/zones"

_Json: TypeAlias = "str | dict[str, _Json]"
_NUMBER: _Json = {"type": "number"}
_APART = ("zones", "origin")


def _object(**properties: _Json) -> _Json:
    return {"type": "object", "properties": properties}


def _array(items: _Json) -> _Json:
    """Viewers take arrays of objects; an array of arrays is an error to them."""
    return {"type": "array", "items": items}


_POINT = _object(east_m=_NUMBER, north_m=_NUMBER)
_SCHEMA: _Json = {
    "title": "gate.Fence",
    "type": "object",
    "properties": {
        "zones": _array(
            _object(
                name={"type": "string"},
                inclusion={"type": "boolean"},
                corners=_array(_POINT),
                centre=_POINT,
                radius_m=_NUMBER,
                floor_up_m=_NUMBER,
                ceiling_up_m=_NUMBER,
            )
        ),
        "origin": _object(lat_deg=_NUMBER, lon_deg=_NUMBER, alt_amsl_m=_NUMBER),
        **{name: _NUMBER for name in FenceItem.__struct_fields__ if name not in _APART},
    },
}
_CHANNEL = Channel(FENCE_TOPIC, "json", "gate.Fence", "jsonschema", msgspec.json.encode(_SCHEMA))


class FenceTopic:
    """What is None is left out: viewers read one plain type."""

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        if not isinstance(item, FenceItem):
            return []
        values: dict[str, object] = {"zones": [_zone(zone) for zone in item.zones]}
        if item.origin is not None:
            names = ("lat_deg", "lon_deg", "alt_amsl_m")
            values["origin"] = dict(zip(names, item.origin, strict=True))
        for name in item.__struct_fields__:
            if name not in _APART:
                values[name] = getattr(item, name)
        return [Out(_CHANNEL, msgspec.json.encode(values), latch="fence")]

    def tick(self, now_ns: int) -> list[Out]:
        return []

    def close(self, now_ns: int) -> list[Out]:
        return []


def _zone(zone: FenceShape) -> dict[str, object]:
    values = {
        "name": zone.name,
        "inclusion": zone.inclusion,
        "corners": [_point(corner) for corner in zone.corners_en],
        "centre": None if zone.centre_en is None else _point(zone.centre_en),
        "radius_m": None if zone.centre_en is None else zone.radius_m,
        "floor_up_m": zone.floor_up_m,
        "ceiling_up_m": zone.ceiling_up_m,
    }
    return {name: value for name, value in values.items() if value is not None}


def _point(at_en: Sequence[float]) -> dict[str, float]:
    east, north = at_en
    return {"east_m": east, "north_m": north}
