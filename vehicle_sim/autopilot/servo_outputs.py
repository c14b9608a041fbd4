"""Servo outputs and relays that are set by commands and by mission items (ArduPilot's).

By ArduPilot's AP_ServoRelayEvents, from memory: an output that drives a motor is refused; one
servo or relay at a time can be repeated, to and fro.  There is one relay, as in the recorded
parameters (RELAY1_FUNCTION = 1, the others 0).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

OUTPUTS: Final = 16
_MOTORS: Final = 4  # SERVO1_FUNCTION .. SERVO4_FUNCTION
_RELAYS: Final = 1
_TRIM_US: Final = 1500  # SERVOn_TRIM
_ON: Final = 1


@dataclass(slots=True)
class _Repeated:
    """What is switched every half period; `left` switches, the last one back."""

    number: int
    pulse_us: int | None  # None = a relay
    left: int
    half_ns: int
    due_ns: int


class ServoOutputs:
    """Numbers of servos count from 1, of relays from 0, as on the wire."""

    def __init__(self) -> None:
        self.restart()

    def restart(self) -> None:
        """As after power-up: nothing was set, the relay is off."""
        self._pulses_us = [0] * OUTPUTS
        self._relays_on = 0
        self._repeated: _Repeated | None = None

    @property
    def pulses_us(self) -> tuple[int, ...]:
        """What the 16 outputs give [us]; 0 = nothing was set, or a motor's."""
        return tuple(self._pulses_us)

    @property
    def relays(self) -> tuple[int, int]:
        """Masks for RELAY_STATUS: those that are there, those that are on."""
        return (1 << _RELAYS) - 1, self._relays_on

    @staticmethod
    def in_use(servo: int) -> bool:
        """By a motor."""
        return 1 <= servo <= _MOTORS

    def set_servo(self, servo: int, pulse_us: int) -> bool:
        """Whether there is such an output that is free."""
        if not _MOTORS < servo <= OUTPUTS:
            return False
        self._pulses_us[servo - 1] = pulse_us
        self._end(servo, relay=False)
        return True

    def repeat_servo(
        self, servo: int, pulse_us: int, count: int, period_s: float, now_ns: int
    ) -> bool:
        """`count` times to the pulse and back to the middle."""
        if not _MOTORS < servo <= OUTPUTS:
            return False
        half_ns = int(0.5e9 * period_s)
        self._repeated = _Repeated(servo, pulse_us, 2 * count, half_ns, now_ns)
        self.update(now_ns)
        return True

    def set_relay(self, relay: int, state: int) -> bool:
        """1 = on, 0 = off, anything else = the other one."""
        if not 0 <= relay < _RELAYS:
            return False
        self._end(relay, relay=True)
        bit = 1 << relay
        if state not in (0, _ON):
            self._relays_on ^= bit
        else:
            self._relays_on = self._relays_on | bit if state == _ON else self._relays_on & ~bit
        return True

    def repeat_relay(self, relay: int, count: int, period_s: float, now_ns: int) -> bool:
        """`count` times to the other state and back."""
        if not 0 <= relay < _RELAYS:
            return False
        half_ns = int(0.5e9 * period_s)
        self._repeated = _Repeated(relay, None, 2 * count, half_ns, now_ns)
        self.update(now_ns)
        return True

    def update(self, now_ns: int) -> None:
        """Switch what is due."""
        repeated = self._repeated
        while repeated is not None and repeated.left > 0 and now_ns >= repeated.due_ns:
            if repeated.pulse_us is None:
                self._relays_on ^= 1 << repeated.number
            else:
                there = repeated.left % 2 == 0
                self._pulses_us[repeated.number - 1] = repeated.pulse_us if there else _TRIM_US
            repeated.left -= 1
            repeated.due_ns += repeated.half_ns
        if repeated is not None and repeated.left <= 0:
            self._repeated = None

    def _end(self, number: int, relay: bool) -> None:
        """What is set is no longer repeated."""
        repeated = self._repeated
        if repeated is not None and (repeated.pulse_us is None) is relay:
            self._repeated = None if repeated.number == number else repeated
