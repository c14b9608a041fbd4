"""Whether the link to the vehicle is poor: frames that are lost, and what radios tell.

A radio tells its own signal and noise, and those at the other end, in RADIO_STATUS.  SiK radios
count both in steps of 1/1.9 dB (their firmware's documentation, from memory).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from gcs.gate.condition import Condition
from gcs.gate.policy.policy import LinkLimits
from gcs.session.speedup_waits import Times
from gcs.session.work import GateInput, condition
from gcs.wire.messages import RadioStatus

STEPS_PER_DB: Final = 1.9
UNKNOWN: Final = 255
FEWEST: Final = 20
"""Frames of a window that a share can be told of."""
RADIO_SILENT_NS: Final = 5_000_000_000
"""A radio that has told nothing for so long is not known any more."""
RECOVERED: Final = 0.5
"""Loss is over at this part of the limit: one that wavers about it would come and go."""
RECOVERED_DB: Final = 2.0


class LinkQuality:
    """Of all links to one vehicle together."""

    def __init__(self, limits: LinkLimits, times: Times) -> None:
        self._limits = limits
        self._window_ns = times.real_ns(round(limits.window_s * 1e9))
        self._silent_ns = times.real_ns(RADIO_SILENT_NS)
        self._began: tuple[int, int, int] | None = None
        """When the window began, and how many frames had come and were lost then."""
        self._loses = False
        self._lost_pct = 0.0
        self._margin_db: float | None = None
        self._margin_ns = 0
        self._is_faint = False

    def second(self, received: int, lost: int, now_ns: int) -> Iterator[GateInput]:
        """Once a second, with the number of frames that have come and were lost so far."""
        if now_ns - self._margin_ns > self._silent_ns:
            self._margin_db, self._is_faint = None, False
        if self._began is None:
            self._began = now_ns, received, lost
        began_ns, received_before, lost_before = self._began
        if now_ns - began_ns >= self._window_ns:
            self._began = now_ns, received, lost
            # A late frame takes its loss back, perhaps that of the window before.
            gone = max(0, lost - lost_before)
            total = gone + received - received_before
            if total >= FEWEST:
                self._lost_pct = 100.0 * gone / total
                limit_pct = self._limits.max_lost_pct * (RECOVERED if self._loses else 1.0)
                self._loses = self._lost_pct > limit_pct
        yield self._told()

    def radio(self, message: RadioStatus, now_ns: int) -> Iterator[GateInput]:
        """RADIO_STATUS."""
        ends = ((message.rssi, message.noise), (message.remrssi, message.remnoise))
        margins = [(s - n) / STEPS_PER_DB for s, n in ends if UNKNOWN not in (s, n) and s > 0]
        if not margins:
            return
        self._margin_db, self._margin_ns = min(margins), now_ns
        least_db = self._limits.min_radio_margin_db + (RECOVERED_DB if self._is_faint else 0.0)
        self._is_faint = self._margin_db < least_db
        yield self._told()

    def _told(self) -> GateInput:
        why = []
        if self._loses:
            why.append(f"{self._lost_pct:.0f} % of the vehicle's frames are lost")
        if self._is_faint and self._margin_db is not None:
            why.append(f"the radio's signal is {self._margin_db:.0f} dB above its noise")
        return condition(Condition.LINK_POOR, bool(why), "; ".join(why))
