"""/log, and /events: each request from its verdict to its ending, as foxglove.Event.

A refusal is an event without a length.
"""

from __future__ import annotations

from typing import ClassVar

from foxglove.messages import Event, KeyValuePair, Log, LogLevel

from gcs.record.derived.drawing import channel, stamp
from gcs.record.derived.gate_json import request_text
from gcs.record.topics import Deriver, Out
from gcs.report import DecisionItem, LogEvent, RecordItem

MOST_OPEN = 1000
"""Requests that may be under way; beyond it the oldest ends without an event."""

_LEVELS = {
    1: LogLevel.Debug,
    2: LogLevel.Info,
    3: LogLevel.Warning,
    4: LogLevel.Error,
    5: LogLevel.Fatal,
}


class Words(Deriver):
    """Lines as they are said, events when they have ended."""

    takes: ClassVar = frozenset({LogEvent, DecisionItem})

    def __init__(self) -> None:
        self._log = channel("/log", Log.get_schema())
        self._events = channel("/events", Event.get_schema())
        self._open: dict[tuple[int, int], tuple[int, str]] = {}

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        match item:
            case LogEvent(_, level, node, text):
                line = Log(
                    timestamp=stamp(now_ns),
                    level=_LEVELS.get(level, LogLevel.Unknown),
                    name=node,
                    message=text,
                )
                return [Out(self._log, line.encode())]
            case DecisionItem():
                return self._decision(item, now_ns)
            case _:
                return []

    def _decision(self, item: DecisionItem, now_ns: int) -> list[Out]:
        key = item.vehicle, item.request_id
        if item.phase == "verdict" and item.outcome == "accepted":
            self._open[key] = now_ns, request_text(item)
            if len(self._open) > MOST_OPEN:
                del self._open[next(iter(self._open))]
            return []
        start_ns, request = self._open.pop(key, (now_ns, request_text(item)))
        told = {
            "request": request,
            "outcome": item.outcome,
            "code": item.code,
            "reason": item.sentence,
            "vehicle": str(item.vehicle),
            "source": item.source,
        }
        event = Event(
            start_time=stamp(start_ns),
            end_time=stamp(now_ns),
            metadata=[KeyValuePair(key=name, value=value) for name, value in told.items() if value],
        )
        return [Out(self._events, event.encode())]
