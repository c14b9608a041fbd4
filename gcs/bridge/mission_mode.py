"""The mode of a mission that a client set on a vehicle that stands disarmed, and armings meanwhile.

A PX4 flies its mission as soon as it is armed in that mode.  The gate sets hold before it arms a
vehicle that shows another mode; so no arming goes out while that mode is under way and not shown,
and that mode is not forwarded while an arming may still come late.
"""

from __future__ import annotations

from typing import Final

from gcs.bridge.translate.chosen_before_arming import MISSION_MODE
from gcs.gate.refusal import Code, Refusal

SHOWN_NS: Final = 3_000_000_000
"""Three heartbeats: one that comes later and shows another mode was sent after the vehicle refused
this one, or never got it.  Heartbeats that did not come say nothing."""
LATE_NS: Final = 10_000_000_000
"""How long an arming that was not answered may still come (as `Memory.takeoff_until_ns`, twice the
policy's usual `control.timeout_s`).  A heartbeat that comes later shows whether it has."""
RECENT_NS: Final = 2_000_000_000
"""Two heartbeats.  The mode is forwarded only if one as young shows the vehicle disarmed."""
NOT_SHOWN: Final = Refusal(
    Code.BUSY, f"{MISSION_MODE} was set just now, and the vehicle does not show it yet"
)


class MissionMode:
    """Of one vehicle."""

    def __init__(self) -> None:
        self._sent_ns: int | None = None
        """Until a heartbeat tells whether the vehicle has it."""
        self._arm_ns: int | None = None
        self._heard_ns: int | None = None

    def sent(self, now_ns: int) -> None:
        """It was forwarded to the vehicle."""
        self._sent_ns = now_ns

    def may_be_sent(self, now_ns: int) -> bool:
        """The vehicle is not armed unseen, and no arming may come late: either would start the
        mission."""
        heard_ns = self._heard_ns
        return self._arm_ns is None and heard_ns is not None and now_ns - heard_ns <= RECENT_NS

    def may_have_come_late(self) -> bool:
        """Of a heartbeat that shows the vehicle armed, not by this station: may the mode have come
        after that?  No heartbeat has shown it on the vehicle while that was disarmed."""
        return self._arm_ns is None and self._sent_ns is not None

    def shown(self, mode_name: str, now_ns: int) -> None:
        """A heartbeat shows this mode."""
        self._heard_ns = now_ns
        if self._arm_ns is not None and now_ns - self._arm_ns >= LATE_NS:
            self._arm_ns = None
        sent_ns = self._sent_ns
        if mode_name == MISSION_MODE or (sent_ns is not None and now_ns - sent_ns >= SHOWN_NS):
            self._sent_ns = None

    def why_not_arm(self) -> Refusal | None:
        """Why nobody's arming can be judged now."""
        return None if self._sent_ns is None else NOT_SHOWN

    def arm_sent(self, now_ns: int) -> None:
        """An arming goes to the vehicle.  One that the gate refuses cannot come late."""
        self._arm_ns = now_ns

    @property
    def arm_may_come(self) -> bool:
        """An arming was sent to the vehicle, and may still take effect."""
        return self._arm_ns is not None

    def arm_ended(self) -> None:
        """The vehicle has refused it, or a heartbeat shows it armed."""
        self._arm_ns = None
