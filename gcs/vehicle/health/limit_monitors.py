"""What the policy's limits say of the vehicle's battery, link, GPS and own fence, as conditions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from gcs.gate.condition import Condition
from gcs.gate.policy.policy import GpsLimits, Policy
from gcs.protocol.sequence import SequenceTracker
from gcs.session.speedup_waits import Times
from gcs.session.work import GateInput, condition
from gcs.vehicle.health.battery import Batteries
from gcs.vehicle.health.link_quality import LinkQuality
from gcs.wire import messages as m
from gcs.wire.ids import FenceBreach, GpsFix
from gcs.wire.messages import GpsRawInt

UNKNOWN_SATELLITES: Final = 255
UNKNOWN_HDOP: Final = 0xFFFF
REPORTS_THAT_COUNT: Final = 2
"""In a row, for worse as for better: one alone may be a spike."""

WATCH_MESSAGES: Final = frozenset(
    {m.SysStatus, m.BatteryStatus, m.GpsRawInt, m.FenceStatus, m.RadioStatus}
)
"""What this interprets."""

BREACH_WORDS: Final = {
    FenceBreach.NONE: "of a kind that it does not tell",
    FenceBreach.MINALT: "below its floor",
    FenceBreach.MAXALT: "above its ceiling",
    FenceBreach.BOUNDARY: "outside its boundary",
}


class GpsQuality:
    """Whether a GPS with a fix is poor: few satellites, a bad constellation, a wide accuracy."""

    def __init__(self, limits: GpsLimits) -> None:
        self._limits = limits
        self._is_poor = False
        self._others_in_a_row = 0
        """Reports that say otherwise than what is told."""

    def gps_raw(self, message: GpsRawInt) -> Iterator[GateInput]:
        """GPS_RAW_INT.  What is not known is not bad; without a fix there is nothing to judge."""
        why = self._poor(message) if message.fix_type >= GpsFix.FIX_TYPE_3D_FIX else []
        self._others_in_a_row = self._others_in_a_row + 1 if bool(why) is not self._is_poor else 0
        if self._others_in_a_row >= REPORTS_THAT_COUNT:
            self._is_poor, self._others_in_a_row = bool(why), 0
            yield condition(Condition.GPS_POOR, self._is_poor, ", ".join(why))

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


class Watch:
    """Of one vehicle."""

    def __init__(self, policy: Policy, times: Times) -> None:
        self._batteries = Batteries(policy.battery)
        self._link = LinkQuality(policy.link, times)
        self._gps = GpsQuality(policy.gps)

    def heard(self, message: m.Message, now_ns: int) -> Iterator[GateInput]:
        """A message of the vehicle's autopilot."""
        match message:
            case m.SysStatus():
                yield from self._batteries.system_status(message, now_ns)
            case m.BatteryStatus():
                yield from self._batteries.battery_status(message, now_ns)
            case m.GpsRawInt():
                yield from self._gps.gps_raw(message)
            case m.FenceStatus():
                yield _own_fence(message)
            case _:
                pass

    def radio(self, message: m.RadioStatus, now_ns: int) -> Iterator[GateInput]:
        """RADIO_STATUS, which a radio sends in its own name."""
        return self._link.radio(message, now_ns)

    def second(self, losses: SequenceTracker, now_ns: int) -> Iterator[GateInput]:
        """Once a second."""
        return self._link.second(losses.received, losses.lost, now_ns)


def _own_fence(message: m.FenceStatus) -> GateInput:
    """FENCE_STATUS: ArduPilot's, which acts on it by itself (FENCE_ACTION)."""
    kinds = frozenset(int(kind) for kind in FenceBreach)
    kind = FenceBreach(message.breach_type) if message.breach_type in kinds else FenceBreach.NONE
    text = f"the vehicle breaches its own fence: it is {BREACH_WORDS[kind]}"
    breached = bool(message.breach_status)
    return condition(Condition.VEHICLE_FENCE_BREACHED, breached, text)
