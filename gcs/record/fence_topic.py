"""/gate/fence: the fence as numbers, for programs; viewers draw /geofence and its GeoJSON."""

from __future__ import annotations

import msgspec

from gcs.record.backend import Channel
from gcs.record.topics import Out
from gcs.report import FenceItem, RecordItem

_SCHEMA = {
    "title": "gate.Fence",
    "type": "object",
    "properties": {
        "zones": {"type": "array", "items": {"type": "object", "properties": {}}},
        "origin": {"type": "array", "items": {"type": "number"}},
    },
}
_CHANNEL = Channel("/gate/fence", "json", "gate.Fence", "jsonschema", msgspec.json.encode(_SCHEMA))


class FenceTopic:
    """The fields of `FenceItem`."""

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        if not isinstance(item, FenceItem):
            return []
        return [Out(_CHANNEL, msgspec.json.encode(item), latch="fence")]

    def tick(self, now_ns: int) -> list[Out]:
        return []

    def close(self, now_ns: int) -> list[Out]:
        return []
