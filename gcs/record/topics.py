"""What derived topics are made of: a message for a channel, and how often one may be sent."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from gcs.mcap_file.writer import Channel
from gcs.report import RecordItem

INPUT_TOPIC = "/session/input"
"""Where the inputs of a session are, all but the frames and bytes that links received."""


@dataclass(frozen=True, slots=True)
class Out:
    """One message to record.

    `latch` names what this message is the last word on: the next part of a record begins with
    the latest message of every latch of every topic.  "" = it is not repeated.
    """

    channel: Channel
    message: bytes
    latch: str = ""


class Deriver:
    """Makes messages for viewers of what the session reports; `now_ns` becomes their log_time.

    `takes` are the kinds of items that `handle` is given.
    """

    takes: ClassVar[frozenset[type[RecordItem]]] = frozenset()

    def start(self, now_ns: int) -> list[Out]:
        """What is written before everything else: a viewer opens a record at its start."""
        return []

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        """What follows from one item."""
        return []

    def tick(self, now_ns: int) -> list[Out]:
        """What is due by the clock alone: a state is repeated about once a second."""
        return []

    def close(self, now_ns: int) -> list[Out]:
        """What is written at the end: a viewer's state bar stops at its last message."""
        return []


class Grid:
    """At most one message a period.

    Due times lie on a grid rather than one period after the last message, so that a 30 Hz input
    under a 25 Hz limit comes out at 25 Hz and not at 15.
    """

    __slots__ = ("_next_ns", "_period_ns")

    def __init__(self, hz: float) -> None:
        self._period_ns = round(1e9 / hz)
        self._next_ns: int | None = None

    def due(self, now_ns: int) -> bool:
        """Whether a message may go now; asking and being told yes counts as sending."""
        if self._next_ns is not None and now_ns < self._next_ns:
            return False
        behind = self._next_ns is None or now_ns - self._next_ns >= self._period_ns
        self._next_ns = (now_ns if behind else self._next_ns or now_ns) + self._period_ns
        return True
