"""Whether a vehicle that was told to stop stands: its mode is seen to hold long before it does."""

from __future__ import annotations

import math

from gcs import ipc
from gcs.gate.states import State
from gcs.operator.text import event_text

STANDS_M_S = 0.3
"""Slower than this it stands, as far as its own position reports tell."""
STOPS = ("abort", "hold")


class Standstill:
    """Words each outcome, and tells of a stop when the vehicle stands."""

    def __init__(self) -> None:
        self.stopping = ""
        """The request whose hold mode was seen while the vehicle moved; empty once it stands."""

    def outcome(self, label: str, event: ipc.EndingEvent, seen: ipc.Snapshot | None) -> str:
        """The line of an outcome: of a stop, how fast the vehicle still is."""
        speed_m_s = _speed_m_s(seen)
        if event.word not in STOPS or event.ended != "complete" or speed_m_s <= STANDS_M_S:
            return event_text.outcome_line(label, event)
        self.stopping = label
        return f"{label}: complete: hold mode seen, still moving at {speed_m_s:.1f} m/s"

    def news(self, seen: ipc.Snapshot) -> str:
        """That it stands, once; empty where there is no news."""
        if seen.state != State.HOLDING.name:
            self.stopping = ""  # somebody has asked for something else meanwhile
        if not self.stopping or _speed_m_s(seen) > STANDS_M_S:
            return ""
        label, self.stopping = self.stopping, ""
        return f"{label}: the vehicle stands"


def _speed_m_s(seen: ipc.Snapshot | None) -> float:
    return math.hypot(*seen.v_enu) if seen is not None and seen.v_enu is not None else 0.0
