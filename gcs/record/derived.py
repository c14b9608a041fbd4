"""Everything that is recorded beside the raw frames, so that a viewer shows the flight at once."""

from __future__ import annotations

from importlib.util import find_spec

from gcs.record.items import RecordItem
from gcs.record.readings import Readings
from gcs.record.topics import Deriver, Out


class Derived:
    """All derivers as one.  Without a foxglove wheel there is no protobuf, only the readings."""

    def __init__(self) -> None:
        self._parts: list[Deriver] = [Readings()]
        if find_spec("foxglove"):
            from gcs.record.pictures import Pictures

            self._parts.append(Pictures())

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        return [out for part in self._parts for out in part.handle(item, now_ns)]

    def tick(self, now_ns: int) -> list[Out]:
        return [out for part in self._parts for out in part.tick(now_ns)]

    def close(self, now_ns: int) -> list[Out]:
        return [out for part in self._parts for out in part.close(now_ns)]
