"""One MAVLink client: who it is, what it has sent, and what it has asked for."""

from __future__ import annotations

from dataclasses import dataclass, field

from gcs.bridge.dialogue import Dialogue

SPAN_NS = 2_000_000_000
"""Rates are of the last whole span of this length."""


@dataclass(slots=True)
class Rate:
    """How many a second."""

    hz: float = 0.0
    _count: int = 0
    _since_ns: int = 0

    def count(self, many: int, now_ns: int) -> None:
        self._count += many
        span_ns = now_ns - self._since_ns
        if span_ns >= SPAN_NS:
            self.hz = self._count * 1e9 / span_ns if self._since_ns else 0.0
            self._count, self._since_ns = 0, now_ns


@dataclass(slots=True)
class Client:
    """`link` is the link that it is reached on, `number` its number among the operators."""

    link: int
    number: int
    name: str
    dialogue: Dialogue = field(init=False)
    joined: bool = False
    heard_ns: int = 0
    received: Rate = field(default_factory=Rate)
    sent: Rate = field(default_factory=Rate)
    refused: int = 0
    dropped: int = 0

    def __post_init__(self) -> None:
        self.dialogue = Dialogue(self.number)
