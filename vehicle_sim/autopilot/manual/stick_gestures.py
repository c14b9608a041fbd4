"""What a pilot says with the sticks beside flying: arm, disarm, take over, change the mode."""

from __future__ import annotations

from enum import Enum

from vehicle_sim.autopilot.manual.sticks import Radio, Sticks
from vehicle_sim.autopilot.parameters.parameters import Parameters

_HELD_NS = {"px4": 1_000_000_000, "ardupilot": 2_000_000_000}
_BOTTOM = {"px4": 0.1, "ardupilot": 0.01}  # of the throttle stick
_CORNER = 0.9
_STEPS_US = (1230, 1360, 1490, 1620, 1749)
_MODE_HELD_NS = 200_000_000


class Gesture(Enum):
    ARM = "arm"
    DISARM = "disarm"


class Gestures:
    """Watches the sticks as they come, on wall time."""

    __slots__ = ("_mode_since_ns", "_parameters", "_position", "_settled", "_since_ns", "_way")

    def __init__(self, parameters: Parameters) -> None:
        self._parameters = parameters
        self.forget()

    def forget(self) -> None:
        self._way: Gesture | None = None
        self._since_ns = 0
        self._position: int | None = None
        self._settled: int | None = None
        self._mode_since_ns = 0

    def seen(self, hand: Sticks, wall_ns: int) -> Gesture | None:
        """The throttle held down and the yaw in a corner, for long enough: told once.

        PX4 wants a second (MAN_ARM_GESTURE), ArduCopter two (ARMING_RUDDER).
        """
        way = self._corner(hand)
        if way is not self._way:
            self._way, self._since_ns = way, wall_ns
        if way is None or wall_ns - self._since_ns < _HELD_NS[self._parameters.personality]:
            return None
        # Not again before the stick has left its corner.
        self._since_ns = wall_ns + (1 << 60)
        return way

    def _corner(self, hand: Sticks) -> Gesture | None:
        rules, bottom = self._parameters.rules, _BOTTOM[self._parameters.personality]
        allowed = int(self._parameters.get(rules.arming_gesture))
        if not allowed or hand.throttle > bottom or abs(hand.yaw) < _CORNER:
            return None
        if hand.yaw > 0.0:
            return Gesture.ARM
        return Gesture.DISARM if allowed >= rules.gesture_disarms_from else None

    def takes_over(self, hand: Sticks) -> bool:
        """Moved farther than COM_RC_STICK_OV."""
        most = 0.01 * self._parameters.get("COM_RC_STICK_OV")
        return max(abs(hand.roll), abs(hand.pitch), abs(hand.yaw)) > most

    def mode(self, radio: Radio, wall_ns: int) -> int | None:
        """ArduCopter's mode channel: the number of a mode that was switched to just now."""
        channel = int(self._parameters.get("FLTMODE_CH"))
        value_us = radio.channel_us(channel, wall_ns) if channel else 0
        if value_us == 0:
            self._position = self._settled = None
            return None
        position = 1 + sum(value_us > step for step in _STEPS_US)
        if position != self._position:
            self._position, self._mode_since_ns = position, wall_ns
        if position == self._settled or wall_ns - self._mode_since_ns < _MODE_HELD_NS:
            return None
        self._settled = position
        return int(self._parameters.get(f"FLTMODE{position}"))
