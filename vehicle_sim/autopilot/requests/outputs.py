"""Servos and relays: what may be asked of them, by command or by mission item (ArduPilot)."""

from __future__ import annotations

from typing import Final

from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.interface import PlanItem, Result
from vehicle_sim.autopilot.mission.plan import Cmd

_PULSE_MOST_US: Final = 0xFFFF
_PERIOD_MOST_S: Final = 1e6
_COUNT_MOST: Final = 10_000


class OutputRequests:
    """Answered at once; `FAILED` where there is no such output, or a motor has it."""

    def __init__(self, state: FlightState) -> None:
        self._state = state

    def set_servo(self, servo: float, pulse_us: float) -> Result:
        if not (_whole(servo) and 0.0 <= pulse_us <= _PULSE_MOST_US):
            return Result.FAILED
        return self._servo(int(servo), self._state.outputs.set_servo(int(servo), int(pulse_us)))

    def repeat_servo(self, servo: float, pulse_us: float, count: float, period_s: float) -> Result:
        sound = _whole(servo) and 0.0 <= pulse_us <= _PULSE_MOST_US and _repeats(count, period_s)
        if not sound:
            return Result.FAILED
        outputs, now_ns = self._state.outputs, self._state.time_ns
        done = outputs.repeat_servo(int(servo), int(pulse_us), int(count), period_s, now_ns)
        return self._servo(int(servo), done)

    def set_relay(self, relay: float, state: float) -> Result:
        done = _whole(relay) and _whole(state)
        done = done and self._state.outputs.set_relay(int(relay), int(state))
        return Result.ACCEPTED if done else Result.FAILED

    def repeat_relay(self, relay: float, count: float, period_s: float) -> Result:
        if not (_whole(relay) and _repeats(count, period_s)):
            return Result.FAILED
        outputs, now_ns = self._state.outputs, self._state.time_ns
        done = outputs.repeat_relay(int(relay), int(count), period_s, now_ns)
        return Result.ACCEPTED if done else Result.FAILED

    def actuate(self, item: PlanItem) -> None:
        """What a mission item asks for; one that cannot be done is passed over."""
        match item.command:
            case Cmd.SET_SERVO:
                self.set_servo(item.p1, item.p2)
            case Cmd.REPEAT_SERVO:
                self.repeat_servo(item.p1, item.p2, item.p3, item.p4)
            case Cmd.SET_RELAY:
                self.set_relay(item.p1, item.p2)
            case Cmd.REPEAT_RELAY:
                self.repeat_relay(item.p1, item.p2, item.p3)
            case _:
                pass

    def _servo(self, servo: int, done: bool) -> Result:
        if self._state.outputs.in_use(servo):
            text = f"ServoRelayEvent: Channel {servo} is already in use"  # from memory
            self._state.say(6, text)
        return Result.ACCEPTED if done else Result.FAILED


def _whole(value: float) -> bool:
    return abs(value) <= _PULSE_MOST_US and value == int(value)


def _repeats(count: float, period_s: float) -> bool:
    return 0.0 <= count <= _COUNT_MOST and 0.0 <= period_s <= _PERIOD_MOST_S
