"""/geofence/zones: the fence as numbers, for programs; viewers draw /geofence and its GeoJSON."""

from __future__ import annotations

import msgspec

from gcs.record.backend import Channel
from gcs.record.topics import Out
from gcs.report import FenceItem, FenceShape, RecordItem

FENCE_TOPIC = "/geofence/zones"

_NUMBER = {"type": "number"}
_POINT = {"type": "array", "items": _NUMBER}
_SCHEMA = {
    "title": "gate.Fence",
    "type": "object",
    "properties": {
        "zones": {
            "type": "array",
            "items": {
                "type": "object",
                "properties": {
                    "name": {"type": "string"},
                    "inclusion": {"type": "boolean"},
                    "corners_en": {"type": "array", "items": _POINT},
                    "centre_en": _POINT,
                    "radius_m": _NUMBER,
                    "floor_up_m": _NUMBER,
                    "ceiling_up_m": _NUMBER,
                },
            },
        },
        "origin": _POINT,
        **{
            name: _NUMBER for name in FenceItem.__struct_fields__ if name not in ("zones", "origin")
        },
    },
}
_CHANNEL = Channel(FENCE_TOPIC, "json", "gate.Fence", "jsonschema", msgspec.json.encode(_SCHEMA))


class FenceTopic:
    """The fields of `FenceItem`; what is None is left out, since viewers read one plain type."""

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        if not isinstance(item, FenceItem):
            return []
        values = _known(item) | {"zones": [_known(zone) for zone in item.zones]}
        return [Out(_CHANNEL, msgspec.json.encode(values), latch="fence")]

    def tick(self, now_ns: int) -> list[Out]:
        return []

    def close(self, now_ns: int) -> list[Out]:
        return []


def _known(fact: FenceItem | FenceShape) -> dict[str, object]:
    values = {name: getattr(fact, name) for name in fact.__struct_fields__}
    return {name: value for name, value in values.items() if value is not None}
