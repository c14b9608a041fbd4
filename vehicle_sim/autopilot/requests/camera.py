"""Pictures: the camera, what takes them, and what is told of each."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.interface import ImageCaptured, Result
from vehicle_sim.autopilot.parameters.parameters import Quantity


@dataclass(frozen=True, slots=True)
class Shot:
    """A picture that was just finished; `index` counts from 0 since boot."""

    index: int


class Camera:
    """It needs time: one exposure after another, each told when it is over.

    `update` with the simulated time; at most one picture is in the making.
    """

    __slots__ = ("_interval_ns", "_left", "_next_ns", "_ready_ns", "images")

    def __init__(self) -> None:
        self.images = 0
        self._ready_ns: int | None = None
        self._left = 0
        self._next_ns = 0
        self._interval_ns = 0

    @property
    def exposing(self) -> bool:
        return self._ready_ns is not None

    @property
    def busy(self) -> bool:
        """A picture, or a series of them, is under way."""
        return self._ready_ns is not None or self._left != 0

    def capture(self, interval_s: float, count: int, now_ns: int) -> None:
        """`count` pictures (0 = until `stop`), the start of one `interval_s` after the last."""
        self._left = count if count > 0 else -1
        self._interval_ns = int(interval_s * 1e9)
        self._next_ns = now_ns

    def stop(self) -> None:
        """No further picture; one in the making is finished."""
        self._left = 0

    def update(self, now_ns: int, exposure_s: float) -> Shot | None:
        """The picture that is ready now, if one is."""
        shot = None
        if self._ready_ns is not None and now_ns >= self._ready_ns:
            self._ready_ns = None
            shot = Shot(self.images)
            self.images += 1
        if self._ready_ns is None and self._left != 0 and now_ns >= self._next_ns:
            self._ready_ns = now_ns + int(exposure_s * 1e9)
            self._next_ns = now_ns + self._interval_ns
            if self._left > 0:
                self._left -= 1
        return shot


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
