"""What a client is told that sends more than it may.

The shell counts what it drops of each client unread, and the log has that once a second.  The
client itself reads it as a STATUSTEXT in a vehicle's name: within a second of the first that was
dropped, and while it goes on at most once in `TOLD_NS`, each time with all since the last text.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from gcs.bridge.conversation.answers import texts
from gcs.gate.effects import Level
from gcs.wire.messages import Statustext

TOLD_NS: Final = 5_000_000_000
TEXT_ID: Final = 1
"""Joins the pieces, where a large number makes the text longer than one."""


@dataclass(slots=True)
class DroppedMessages:
    """Datagrams of one client that were dropped."""

    count: int = 0
    """Since it came."""
    _told: int = 0
    _told_ns: int | None = None

    def due_text(self, rate_hz: float, now_ns: int) -> Sequence[Statustext]:
        """What it is to be told now; `rate_hz` is what it may send."""
        new = self.count - self._told
        if not new or (self._told_ns is not None and now_ns - self._told_ns < TOLD_NS):
            return ()
        self._told, self._told_ns = self.count, now_ns
        text = f"gate: {new} dropped: more than {rate_hz:g} messages/s"
        return texts(Level.WARNING, text, TEXT_ID)
