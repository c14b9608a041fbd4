"""Manual input: what a joystick and overridden radio channels make of four sticks.

PX4 has two sources, the joystick (MANUAL_CONTROL) and the radio (RC_CHANNELS_OVERRIDE through
RC_MAP_*), and COM_RC_IN_MODE chooses between them.  ArduCopter has channels only: a joystick
overrides those of RCMAP_*, and an override lasts RC_OVERRIDE_TIME.  Both measure the other side,
so both run on wall time.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from vehicle_sim.autopilot.parameters.parameters import Parameters

CHANNELS = 18
_S_NS = 1_000_000_000
_FIRST_EXTENSION = 8  # channels 9 .. 18 came later: 0 leaves them alone
_IGNORE_US = 65535
_RELEASE_EXTENSION_US = 65534
_AXIS_MAX = 1000
_LOWEST_US, _MIDDLE_US, _HIGHEST_US = 1000, 1500, 2000
_ANGLE_DEAD_US = 20.0  # ArduCopter's RCx_DZ of roll, pitch and yaw
_THROTTLE_DEAD_US = 30.0


@dataclass(frozen=True, slots=True)
class Sticks:
    """Roll right, pitch forward, yaw clockwise -1..1; throttle 0..1."""

    roll: float
    pitch: float
    yaw: float
    throttle: float

    @property
    def climb(self) -> float:
        """The throttle stick from its middle: -1 down .. 1 up."""
        return 2.0 * self.throttle - 1.0


CENTRED = Sticks(0.0, 0.0, 0.0, 0.5)
_AT_REST = Sticks(0.0, 0.0, 0.0, 0.0)  # those of SITL's receiver: the throttle at its bottom


class _Source(Enum):
    JOYSTICK = "joystick"
    RADIO = "radio"


_SOURCES: dict[int, tuple[_Source, ...]] = {
    0: (_Source.RADIO,),
    1: (_Source.JOYSTICK,),
    2: (_Source.RADIO, _Source.JOYSTICK),
    3: (_Source.RADIO, _Source.JOYSTICK),
    4: (),
}
"""COM_RC_IN_MODE; 3 keeps to the source that was heard first."""
_KEEP_FIRST = 3


class Radio:
    """What was heard of the sticks, by whom and when."""

    __slots__ = ("_channels_us", "_first", "_heard_ns", "_joystick", "_joystick_ns", "_last",
                 "_parameters", "deaf")  # fmt: skip

    def __init__(self, parameters: Parameters) -> None:
        """`deaf`: nothing that is sent is heard."""
        self._parameters = parameters
        self.deaf = False
        self.forget()

    def forget(self) -> None:
        """As after power-up."""
        self._channels_us = [0] * CHANNELS
        self._heard_ns: list[int | None] = [None] * CHANNELS
        self._joystick: Sticks | None = None
        self._joystick_ns = 0
        self._first: _Source | None = None
        self._last: Sticks | None = None

    # ---------------------------------------------------------------------------- hearing

    def joystick(self, forward: int, right: int, up: int, clockwise: int, wall_ns: int) -> None:
        """MANUAL_CONTROL's x, y, z and r: -1000..1000, z 0..1000; beyond that an axis is not there.

        A negative z is the bottom of the stick.
        """
        if self.deaf:
            return
        pitch, roll, yaw = (_axis(value) for value in (forward, right, clockwise))
        throttle = max(0, up) / _AXIS_MAX if up <= _AXIS_MAX else 0.0
        if not self._parameters.rules.joystick_overrides_channels:
            self._joystick = Sticks(roll, pitch, yaw, throttle)
            self._joystick_ns = wall_ns
            self._settle(_Source.JOYSTICK)
        else:
            levels = {
                "RCMAP_ROLL": 500.0 * roll,
                # A channel's pitch stick pulled back (nose up) is high.
                "RCMAP_PITCH": -500.0 * pitch,
                "RCMAP_YAW": 500.0 * yaw,
                "RCMAP_THROTTLE": 1000.0 * throttle - 500.0,
            }
            for name, level_us in levels.items():
                self._put(self._number(name), round(_MIDDLE_US + level_us), wall_ns)
        self._remember(wall_ns)

    def override(self, channels_us: tuple[int, ...], wall_ns: int) -> None:
        """RC_CHANNELS_OVERRIDE's channels 1 .. 18 [us].

        65535 leaves a channel alone, 0 (from channel 9 on 65534) gives it back.
        """
        if self.deaf:
            return
        for number, value_us in enumerate(channels_us[:CHANNELS], start=1):
            extension = number > _FIRST_EXTENSION
            if value_us == _IGNORE_US or (extension and value_us == 0):
                continue
            self._put(number, 0 if value_us == _RELEASE_EXTENSION_US else value_us, wall_ns)
        if self._radio(wall_ns) is not None:
            self._settle(_Source.RADIO)
        elif all(heard is None for heard in self._heard_ns) and self._joystick is None:
            # Given back on purpose: that is no loss.
            self._last = None
        self._remember(wall_ns)

    def _put(self, number: int, value_us: int, wall_ns: int) -> None:
        self._channels_us[number - 1] = value_us
        self._heard_ns[number - 1] = wall_ns if value_us else None

    def _settle(self, source: _Source) -> None:
        if self._first is None:
            self._first = source

    def _remember(self, wall_ns: int) -> None:
        now = self.sticks(wall_ns)
        if now is not None:
            self._last = now

    # ------------------------------------------------------------------------- being asked

    @property
    def heard(self) -> bool:
        """Sticks were heard, and not given back."""
        return self._last is not None

    @property
    def last(self) -> Sticks | None:
        """The newest sticks, however old; None if there were never any."""
        return self._last

    def lost(self, wall_ns: int) -> bool:
        """There were sticks, and now there are none: a matter for a failsafe."""
        if self._last is None:
            return False
        grace = self._parameters.rules.receiver_grace
        if grace is None:
            return self.sticks(wall_ns) is None
        if self._has_receiver:
            return False
        # As recorded: with no receiver nothing new comes to be read after the last override.
        grace_ns = int(self._parameters.get(grace) * _S_NS)
        newest_ns = max((at_ns for at_ns in self._heard_ns if at_ns is not None), default=None)
        return newest_ns is None or wall_ns - newest_ns >= grace_ns

    @property
    def _has_receiver(self) -> bool:
        """SITL's own, whose sticks are in use where no override is, once there was one."""
        silent = self._parameters.rules.receiver_silent
        return silent is not None and self._parameters.get(silent) == 0.0 and not self.deaf

    def sticks(self, wall_ns: int) -> Sticks | None:
        """The sticks in use, None when there are none now."""
        if self._parameters.rules.joystick_overrides_channels:
            own = _AT_REST if self._last is not None and self._has_receiver else None
            return self._radio(wall_ns) or own
        mode = int(self._parameters.get("COM_RC_IN_MODE"))
        for source in _SOURCES[mode]:
            if mode == _KEEP_FIRST and source is not self._first:
                continue
            now = self._radio(wall_ns) if source is _Source.RADIO else self._fresh(wall_ns)
            if now is not None:
                return now
        return None

    def channel_us(self, number: int, wall_ns: int) -> int:
        """One channel, 1 .. 18; 0 = nothing comes."""
        heard_ns = self._heard_ns[number - 1]
        if heard_ns is None:
            return 0
        lasts_ns = self._lasts_ns
        gone = lasts_ns is not None and wall_ns - heard_ns >= lasts_ns
        return 0 if gone else self._channels_us[number - 1]

    def channels_us(self, wall_ns: int) -> tuple[int, ...]:
        """All 18, for RC_CHANNELS."""
        return tuple(self.channel_us(number, wall_ns) for number in range(1, CHANNELS + 1))

    @property
    def _lasts_ns(self) -> int | None:
        """How long a channel's value lasts; None = for ever."""
        lasts_s = self._parameters.get(self._parameters.rules.channel_lasts)
        return None if lasts_s < 0.0 else int(lasts_s * _S_NS)

    def _fresh(self, wall_ns: int) -> Sticks | None:
        """The joystick."""
        limit_ns = int(self._parameters.get("COM_RC_LOSS_T") * _S_NS)
        return self._joystick if wall_ns - self._joystick_ns < limit_ns else None

    def _radio(self, wall_ns: int) -> Sticks | None:
        """The sticks on the mapped channels; a channel without a value is a centred stick."""
        names = ("ROLL", "PITCH", "YAW", "THROTTLE")
        prefix = self._parameters.rules.channel_map
        numbers = [self._number(prefix + name) for name in names]
        roll, pitch, yaw, throttle = (
            self.channel_us(number, wall_ns) if number else 0 for number in numbers
        )
        if not (roll or pitch or yaw or throttle):
            return None
        return Sticks(_stick(roll), -_stick(pitch), _stick(yaw), _throttle(throttle))

    def _number(self, name: str) -> int:
        return int(self._parameters.get(name))


def _axis(value: int) -> float:
    return value / _AXIS_MAX if abs(value) <= _AXIS_MAX else 0.0


def _stick(value_us: int) -> float:
    """A channel as a stick, -1..1; 0 = no such channel."""
    if value_us == 0:
        return 0.0
    off_us = float(min(max(value_us, _LOWEST_US), _HIGHEST_US) - _MIDDLE_US)
    size = (abs(off_us) - _ANGLE_DEAD_US) / (500.0 - _ANGLE_DEAD_US)
    if size <= 0.0:
        return 0.0
    return size if off_us > 0.0 else -size


def _throttle(value_us: int) -> float:
    if value_us == 0:
        return 0.0
    up_us = min(max(value_us, _LOWEST_US), _HIGHEST_US) - _LOWEST_US - _THROTTLE_DEAD_US
    # The dead zone lies at the bottom; the middle of the stick stays its middle.
    if up_us < 500.0 - _THROTTLE_DEAD_US:
        return max(0.0, 0.5 * up_us / (500.0 - _THROTTLE_DEAD_US))
    return 0.5 + 0.5 * (up_us + _THROTTLE_DEAD_US - 500.0) / 500.0
