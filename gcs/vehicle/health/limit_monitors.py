"""What the policy's limits say of the vehicle's battery, link, GPS and own fence, as conditions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from gcs.gate.condition import Condition
from gcs.gate.inputs import ConditionChanged
from gcs.gate.policy.policy import Policy
from gcs.protocol.sequence import SequenceTracker
from gcs.session.speedup_waits import Times
from gcs.session.work import ToGate
from gcs.vehicle.health.battery import Batteries
from gcs.vehicle.health.gps_quality import GpsQuality
from gcs.vehicle.health.link_quality import LinkQuality
from gcs.wire import messages as m
from gcs.wire.ids import FenceBreach

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


class Watch:
    """Of one vehicle."""

    def __init__(self, policy: Policy, times: Times) -> None:
        self._batteries = Batteries(policy.battery)
        self._link = LinkQuality(policy.link, times)
        self._gps = GpsQuality(policy.gps)

    def heard(self, message: m.Message, now_ns: int) -> Iterator[ToGate]:
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

    def radio(self, message: m.RadioStatus, now_ns: int) -> Iterator[ToGate]:
        """RADIO_STATUS, which a radio sends in its own name."""
        return self._link.radio(message, now_ns)

    def second(self, losses: SequenceTracker, now_ns: int) -> Iterator[ToGate]:
        """Once a second."""
        return self._link.second(losses.received, losses.lost, now_ns)


def _own_fence(message: m.FenceStatus) -> ToGate:
    """FENCE_STATUS: ArduPilot's, which acts on it by itself (FENCE_ACTION)."""
    kinds = frozenset(int(kind) for kind in FenceBreach)
    kind = FenceBreach(message.breach_type) if message.breach_type in kinds else FenceBreach.NONE
    text = f"the vehicle breaches its own fence: it is {BREACH_WORDS[kind]}"
    breached = bool(message.breach_status)
    return ToGate(ConditionChanged(Condition.VEHICLE_FENCE_BREACHED, breached, text))
