"""Sticks and switches.

They act when they come: a gesture arms, a moved stick takes over, a switch changes the mode.
"""

from __future__ import annotations

from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.manual.stick_gestures import Gesture, Gestures
from vehicle_sim.autopilot.manual.sticks import Radio
from vehicle_sim.autopilot.modes import Behaviour, by_number
from vehicle_sim.autopilot.requests.arming import ArmingRequests
from vehicle_sim.autopilot.requests.mode_changes import ModeChanges
from vehicle_sim.autopilot.transitions import Transitions

_AUTO_BIT, _OFFBOARD_BIT = 1, 2  # COM_RC_OVERRIDE


class ManualInput:
    """What a pilot asks by hand."""

    def __init__(
        self,
        state: FlightState,
        radio: Radio,
        arming: ArmingRequests,
        mode_changes: ModeChanges,
        transitions: Transitions,
    ) -> None:
        self._state = state
        self._radio = radio
        self._arming = arming
        self._mode_changes = mode_changes
        self._transitions = transitions
        self._gestures = Gestures(state.parameters)

    def restart(self) -> None:
        """As after power-up."""
        self._gestures.forget()

    @property
    def channels_us(self) -> tuple[int, ...]:
        return self._radio.channels_us(self._state.sense().wall_ns)

    @property
    def sticks(self) -> tuple[float, float, float, float] | None:
        now = self._radio.sticks(self._state.sense().wall_ns)
        return None if now is None else (now.roll, now.pitch, now.yaw, now.throttle)

    def joystick(self, forward: int, right: int, up: int, clockwise: int, wall_ns: int) -> None:
        self._radio.joystick(forward, right, up, clockwise, wall_ns)
        self._apply_sticks(wall_ns)

    def override_channels(self, channels_us: tuple[int, ...], wall_ns: int) -> None:
        self._radio.override(channels_us, wall_ns)
        self._apply_sticks(wall_ns)

    def _apply_sticks(self, wall_ns: int) -> None:
        state = self._state
        if state.rules.mode_switch:
            number = self._gestures.mode(self._radio, wall_ns)
            mode = None if number is None else by_number(state.personality, number)
            if mode is not None and mode is not state.mode:
                self._mode_changes.change_mode(mode)
        hand = self._radio.sticks(wall_ns)
        if hand is None:
            return
        match self._gestures.seen(hand, wall_ns):
            case Gesture.ARM if state.mode.law is not None and not state.armed:
                self._arming.arm(False)
            case Gesture.DISARM if state.armed and not state.control.flying:
                self._arming.disarm(False)
            case _:
                pass
        if state.rules.sticks_take_over and self._gestures.takes_over(hand):
            self._take_over()
        if state.armed:
            state.request_decision()

    def _take_over(self) -> None:
        """PX4's COM_RC_OVERRIDE: a moved stick ends an automatic flight."""
        state = self._state
        if not state.control.flying or state.mode.law is not None:
            return
        guided = state.mode.behaviour is Behaviour.GUIDED
        bit = _OFFBOARD_BIT if guided else _AUTO_BIT
        allowed = int(state.parameters.get("COM_RC_OVERRIDE")) & bit
        if allowed and state.mode.behaviour is not Behaviour.ORBIT:
            state.say(6, "Pilot took over using sticks")
            self._transitions.enter_kind("position" if state.position_ok else "altitude")
