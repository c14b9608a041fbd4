"""What passes between the world and a vehicle's services."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

from vehicle_sim.wire.messages import Message


@dataclass(frozen=True, slots=True)
class Client:
    """Who sent a message: the channel that it came on, and the ids in its header."""

    channel: int
    system: int
    component: int


class Send(NamedTuple):
    """A message for one channel, or for every channel of the vehicle (None)."""

    channel: int | None
    message: Message


class Report(NamedTuple):
    """What is streamed on one channel after one step.  Channels with equal rates share the list."""

    channel: int
    messages: list[Message]


class Note(NamedTuple):
    """A line for the log; `level` is one of debug, info, warning, error, fatal."""

    level: str
    text: str


Effect: TypeAlias = Send | Report | Note
