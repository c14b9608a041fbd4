"""The topics beside the raw frames that let a viewer show the flight at once."""

from __future__ import annotations

from importlib.util import find_spec

from gcs.record.fence_topic import FenceTopic
from gcs.record.json_topics import JsonTopics
from gcs.record.topics import Deriver, Out
from gcs.report import RecordItem


class Derived:
    """All derivers as one.  Without foxglove-sdk there are the JSON topics only."""

    def __init__(self) -> None:
        self._parts: list[Deriver] = [JsonTopics(), FenceTopic()]
        if find_spec("foxglove"):
            from gcs.record.foxglove_topics import FoxgloveTopics

            self._parts.append(FoxgloveTopics())

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        return [out for part in self._parts for out in part.handle(item, now_ns)]

    def tick(self, now_ns: int) -> list[Out]:
        return [out for part in self._parts for out in part.tick(now_ns)]

    def close(self, now_ns: int) -> list[Out]:
        return [out for part in self._parts for out in part.close(now_ns)]
