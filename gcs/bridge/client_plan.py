"""A plan that a MAVLink client has sent."""

from __future__ import annotations

from dataclasses import dataclass

from gcs.plan.wire import WireItem
from gcs.wire.ids import MissionType


@dataclass(frozen=True, slots=True)
class ClientPlan:
    """A whole plan as a client sent it: seq 0 to the last one, none missing.

    `items` may hold anything that fits into the fields; nothing was judged yet.  On ArduPilot, item
    0 of a mission stands for home.
    """

    kind: MissionType
    items: tuple[WireItem, ...]
    source: str
    """Where it comes from, in place of a file's name in errors."""
