"""Whether a GPS with a fix is poor: few satellites, a bad constellation, a wide accuracy."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from gcs.gate.condition import Condition
from gcs.gate.inputs import ConditionChanged
from gcs.gate.policy.policy import GpsLimits
from gcs.session.work import ToGate
from gcs.wire.ids import GpsFix
from gcs.wire.messages import GpsRawInt

UNKNOWN_SATELLITES: Final = 255
UNKNOWN_HDOP: Final = 0xFFFF
REPORTS_THAT_COUNT: Final = 2
"""In a row, for worse as for better: one alone may be a spike."""


class GpsQuality:
    """Of one vehicle's receiver."""

    def __init__(self, limits: GpsLimits) -> None:
        self._limits = limits
        self._is_poor = False
        self._others_in_a_row = 0
        """Reports that say otherwise than what is told."""

    def gps_raw(self, message: GpsRawInt) -> Iterator[ToGate]:
        """GPS_RAW_INT.  What is not known is not bad; without a fix there is nothing to judge."""
        why = self._poor(message) if message.fix_type >= GpsFix.FIX_TYPE_3D_FIX else []
        self._others_in_a_row = self._others_in_a_row + 1 if bool(why) is not self._is_poor else 0
        if self._others_in_a_row >= REPORTS_THAT_COUNT:
            self._is_poor, self._others_in_a_row = bool(why), 0
            yield ToGate(ConditionChanged(Condition.GPS_POOR, self._is_poor, ", ".join(why)))

    def _poor(self, message: GpsRawInt) -> list[str]:
        limits, satellites = self._limits, message.satellites_visible
        why = []
        if satellites < limits.min_satellites and satellites != UNKNOWN_SATELLITES:
            why.append(f"{satellites} satellites, {limits.min_satellites} are wanted")
        if message.eph not in (0, UNKNOWN_HDOP) and message.eph / 100.0 > limits.max_hdop:
            why.append(f"HDOP {message.eph / 100.0:.1f}, {limits.max_hdop:g} is allowed")
        accuracy_m = message.h_acc / 1e3
        if accuracy_m > limits.max_accuracy_h_m:
            why.append(f"accurate to {accuracy_m:.0f} m, {limits.max_accuracy_h_m:g} m is allowed")
        return why
