"""The gate's decisions for tables and programs: /gate/decision, /gate/requests, /gate/fence.

/gate/requests holds the whole table in every message, the newest request first: a viewer shows the
last message of a topic, and so has the whole list after any seek.
"""

from __future__ import annotations

from math import isfinite
from typing import ClassVar

import msgspec

from gcs.record.derived.json_topic import JsonTopic, encode
from gcs.record.fence_topic import FENCE_TOPIC, Fence, written
from gcs.record.topics import INPUT_TOPIC, Deriver, Grid, Out
from gcs.report import DecisionItem, FenceItem, InputItem, RecordItem

REQUESTS_HZ = 4.0
MOST_ROWS = 100
"""Of the table; an older request is on /gate/decision only."""

NOTHING_TO_SAY = "Complete"
"""The sentence of an ending that needs none: the table has a column for that."""

DECIMALS = 3
DECIMALS_OF_DEGREES = 7


class RequestRow(msgspec.Struct, frozen=True):
    """One request: when it was asked (seconds of the record), the verdict, the ending, and why.

    Every row has every key: a viewer's table has the columns of the first row.
    """

    at_s: float
    request: str
    verdict: str
    ending: str
    reason: str
    vehicle: int
    source: str


class Requests(msgspec.Struct, frozen=True):
    """The table of requests, the newest first."""

    rows: list[RequestRow]


NOTHING_ASKED = RequestRow(0.0, "nothing yet", "", "", "", 0, "")
"""A viewer shows an error for a table without rows."""


class GateJson(Deriver):
    """Decisions and the fence as they come, inputs as they came, the table at most at 4 Hz."""

    takes: ClassVar = frozenset({DecisionItem, FenceItem, InputItem})

    def __init__(self) -> None:
        self._decision = JsonTopic("/gate/decision", "gate.Decision", DecisionItem)
        self._requests = JsonTopic("/gate/requests", "gate.Requests", Requests)
        self._fence = JsonTopic(FENCE_TOPIC, "gate.Fence", Fence)
        self._input = JsonTopic(INPUT_TOPIC, "session.Input", InputItem)
        self._rows: dict[tuple[int, int], RequestRow] = {}
        self._grid = Grid(REQUESTS_HZ)
        self._untold = False
        self._start_ns = 0

    def start(self, now_ns: int) -> list[Out]:
        self._start_ns = now_ns
        return [self._table()]

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        match item:
            case InputItem():
                return [Out(self._input.channel, encode(item))]
            case FenceItem():
                return [self._fence.out(written(item), latch="fence")]
            case DecisionItem():
                self._enter(item, now_ns)
                outs = [self._decision.out(_rounded(item))]
                return outs + self._table_if_due(now_ns)
            case _:
                return []

    def tick(self, now_ns: int) -> list[Out]:
        return self._table_if_due(now_ns) if self._untold else []

    def close(self, now_ns: int) -> list[Out]:
        return [self._table()] if self._untold else []

    def _enter(self, item: DecisionItem, now_ns: int) -> None:
        key = item.vehicle, item.request_id
        said = "" if item.sentence == NOTHING_TO_SAY else item.sentence
        reason = ": ".join(part for part in (item.code, said) if part)
        if item.phase == "verdict":
            at_s = round((now_ns - self._start_ns) / 1e9, 1)
            row = RequestRow(
                at_s, request_text(item), item.outcome, "", reason, item.vehicle, item.source
            )
        elif key in self._rows:
            row = msgspec.structs.replace(self._rows[key], ending=item.outcome, reason=reason)
        else:
            return
        self._rows[key] = row
        if len(self._rows) > MOST_ROWS:
            del self._rows[next(iter(self._rows))]
        self._untold = True

    def _table_if_due(self, now_ns: int) -> list[Out]:
        return [self._table()] if self._grid.due(now_ns) else []

    def _table(self) -> Out:
        self._untold = False
        rows = list(self._rows.values())[::-1] or [NOTHING_ASKED]
        return self._requests.out(Requests(rows), latch="requests")


def request_text(item: DecisionItem) -> str:
    """What was asked, as it is typed: `goto 3 0 2`, `mission start`."""
    words = [item.word.replace("_", " ")]
    if item.goal is not None:
        words += [f"{round(metres, 2):g}" for metres in item.goal.enu]
    return " ".join(words)


def _rounded(item: DecisionItem) -> DecisionItem:
    """With numbers that a person can read; the decision itself was made on the exact ones."""
    numbers = {name: _round(name, value) for name, value in item.numbers.items()}
    return msgspec.structs.replace(item, numbers=numbers)


def _round(name: str, value: float | None) -> float | None:
    if value is None or not isfinite(value):
        return value
    return round(value, DECIMALS_OF_DEGREES if name.endswith("_deg") else DECIMALS)
