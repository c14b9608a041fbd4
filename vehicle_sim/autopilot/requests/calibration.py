"""PREFLIGHT_CALIBRATION and DO_MOTOR_TEST: who may start one, and when."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeAlias

from vehicle_sim.autopilot.calibration import copter_procedure, motor_test, px4_procedure
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import Personality

_LEVEL_OR_SIMPLE_ACCEL: Final = (2.0, 4.0)  # PREFLIGHT_CALIBRATION's parameter 5
_ACCEL_REST_NS: Final = 5_000_000_000
"""After one of these ArduCopter rejects the next: recorded 3.7 s after its end, and not 7.1 s."""


Calibrate: TypeAlias = Callable[[FlightState, tuple[float, ...]], Result | None]


class CalibrationRequests:
    """The calibration itself is the state's: it says what arming waits for."""

    def __init__(self, state: FlightState) -> None:
        self._state = state
        self._calibrate = _CALIBRATE[state.personality]

    def calibrate(self, parameters: tuple[float, ...]) -> Result | None:
        return self._calibrate(self._state, parameters)

    def calibration_position(self, position: float) -> Result:
        result, events = self._state.calibration.turned(position)
        for event in events:
            self._state.emit(event)
        return result

    def calibrate_compass_by_yaw(self) -> Result:
        if self._state.rules.calibrated_compass_needs_reboot:
            self._state.calibration.compass_done()
        return Result.ACCEPTED

    def test_motor(self, seconds: float) -> Result:
        state = self._state
        if state.armed:
            return Result.FAILED
        return state.calibration.begin(motor_test(seconds), state.time_ns)


def _calibrate_copter(state: FlightState, parameters: tuple[float, ...]) -> Result | None:
    if state.armed:
        state.say(5, "Disarm to allow calibration")
        return Result.FAILED
    accel = parameters[4] in _LEVEL_OR_SIMPLE_ACCEL
    if accel and state.time_ns < state.calibration.accel_again_ns:
        return Result.TEMPORARILY_REJECTED
    state.calibration.mind_radio(parameters[3])
    procedure = copter_procedure(parameters)
    if procedure is None:
        return Result.UNSUPPORTED
    if accel:
        ends_ns = state.time_ns + int(procedure.lasts_s * 1e9)
        state.calibration.accel_again_ns = ends_ns + _ACCEL_REST_NS
    return state.calibration.begin(procedure, state.time_ns)


def _calibrate_px4(state: FlightState, parameters: tuple[float, ...]) -> Result | None:
    if not any(parameters[:6]) and (state.calibration.busy or not any(parameters)):
        result, events = state.calibration.cancel_px4()
        for event in events:
            state.emit(event)
        return result
    if state.calibration.busy:
        # Two answer, the procedure (if it listens) and the commander; the first one is told.
        if not state.calibration.listens:
            return Result.TEMPORARILY_REJECTED
        state.say(2, "command denied during calibration: 241")
        return Result.DENIED
    if state.armed:
        return Result.TEMPORARILY_REJECTED
    procedure = px4_procedure(parameters)
    return None if procedure is None else state.calibration.begin(procedure, state.time_ns)


_CALIBRATE: Final[dict[Personality, Calibrate]] = {
    "px4": _calibrate_px4,
    "ardupilot": _calibrate_copter,
}
