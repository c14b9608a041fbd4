"""Pictures: what takes them, and what is told of each."""

from __future__ import annotations

from math import isfinite

from vehicle_sim.autopilot.camera import Camera
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.interface import ImageCaptured, Result
from vehicle_sim.autopilot.parameters.parameters import Quantity


class CameraRequests:
    """`fitted`: whether the vehicle has a camera at all."""

    def __init__(self, state: FlightState, fitted: bool) -> None:
        self._state = state
        self._fitted = fitted
        self.camera = Camera()

    def capture_image(self, interval_s: float, count: int) -> Result:
        if count < 0 or not isfinite(interval_s) or interval_s < 0.0:
            return Result.DENIED
        if self.camera.busy:
            return Result.TEMPORARILY_REJECTED
        self.take_pictures(interval_s, count)
        return Result.ACCEPTED

    def stop_capture(self) -> Result:
        self.stop_pictures()
        return Result.ACCEPTED

    def take_pictures(self, interval_s: float, count: int) -> None:
        if self._fitted:
            self.camera.capture(interval_s, count, self._state.time_ns)

    def stop_pictures(self) -> None:
        self.camera.stop()

    def photograph(self) -> None:
        """Take the picture that is due, if one is."""
        state = self._state
        shot = self.camera.update(state.time_ns, state.parameters.si(Quantity.EXPOSURE_S))
        if shot is None:
            return
        pos = state.sense().pos_ned
        home_d = state.home_ned[2] if state.home_ned is not None else 0.0
        state.emit(
            ImageCaptured(
                shot.index,
                state.time_ns,
                state.projection.to_geodetic(pos),
                home_d - pos[2],
                state.attitude,
            )
        )
