"""How much charge a vehicle says is left: the least of its batteries.

SYS_STATUS tells it of the first battery, BATTERY_STATUS of each that drives motors.  What was told
some time ago counts no more, nor what a vehicle does not know any longer (-1 %).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

from gcs.vehicle.health.battery import FIRST, PROPULSION
from gcs.wire.messages import BatteryStatus, SysStatus

MOST_AGE_NS: Final = 15_000_000_000
"""Both messages come about once a second; over a slow radio every few."""


@dataclass(slots=True)
class Charge:
    """Of all batteries of one vehicle."""

    _told: dict[int, tuple[int, int]] = field(default_factory=dict)
    """Per cent and when, by the battery."""

    def system_status(self, message: SysStatus, now_ns: int) -> None:
        self._told[FIRST] = message.battery_remaining, now_ns

    def battery_status(self, message: BatteryStatus, now_ns: int) -> None:
        if message.battery_function in PROPULSION:
            self._told[message.id] = message.battery_remaining, now_ns

    def left_pct(self, now_ns: int) -> float | None:
        """None where nobody knows."""
        return min(
            (
                float(pct)
                for pct, told_ns in self._told.values()
                if pct >= 0 and now_ns - told_ns <= MOST_AGE_NS
            ),
            default=None,
        )
