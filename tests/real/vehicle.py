"""A real vehicle flown without the gate: its truth, its estimate, setpoints to its own loops."""

import time
from collections.abc import Callable
from typing import Any

from tests.real.autopilots import ONBOARD_PORT, PX4, Kind
from tests.real.link import Link
from tests.real.truth import MESSAGES, Sample, Vector

STATION = 255  # its system id
SETPOINTS_HZ = 20.0
POSITION_ONLY = 0b110111111000
VELOCITY_ONLY = 0b110111000111


class Vehicle(Link):
    """In one thread: what is due is sent between what comes."""

    def __init__(self, kind: Kind) -> None:
        super().__init__(kind, ONBOARD_PORT, STATION)
        self.estimate: Sample | None = None
        self.version = ""
        self._setpoint: Callable[[], None] = lambda: None
        self._next_s = 0.0
        self._next_beat_s = 0.0

    # -- the link -----------------------------------------------------------------------------

    def pump(self, seconds: float = 0.01) -> None:
        """Takes what has come, waiting so long for the first, and sends what is due."""
        message = self.mavlink.recv_match(blocking=True, timeout=seconds)
        self._send_what_is_due()
        while message is not None:
            self.take(message)
            self._send_what_is_due()
            message = self.mavlink.recv_msg()

    def _send_what_is_due(self) -> None:
        now = time.monotonic()
        if now >= self._next_s:
            self._next_s = max(now, self._next_s + 1.0 / SETPOINTS_HZ)
            self._setpoint()
        if now >= self._next_beat_s:
            self._next_beat_s = now + 1.0
            self.mavlink.mav.heartbeat_send(6, 8, 0, 0, 4)

    def take(self, message: Any) -> None:
        super().take(message)
        match message.get_type():
            case "LOCAL_POSITION_NED":
                self.estimate = Sample(
                    message.time_boot_ms / 1e3,
                    (message.y, message.x, -message.z),
                    (message.vy, message.vx, -message.vz),
                )
            case "AUTOPILOT_VERSION":
                number = message.flight_sw_version
                self.version = f"{number >> 24}.{number >> 16 & 255}.{number >> 8 & 255}"

    def until(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Pumps until it is so, or so many seconds of the vehicle's clock have passed."""
        wall, start = time.monotonic(), self.truth.clock_s
        while not condition():
            self.pump()
            if self.truth.clock_s - start > seconds or time.monotonic() - wall > 3 * seconds:
                return False
        return True

    def pass_time(self, seconds: float) -> None:
        self.until(lambda: False, seconds)

    # -- what it is told ----------------------------------------------------------------------

    def to_position(self, position_enu: Vector) -> None:
        east, north, up = position_enu
        self._stream(POSITION_ONLY, (north, east, -up), (0, 0, 0))

    def to_velocity(self, velocity_enu: Vector) -> None:
        east, north, up = velocity_enu
        self._stream(VELOCITY_ONLY, (0, 0, 0), (north, east, -up))

    def _stream(self, mask: int, position_ned: Vector, velocity_ned: Vector) -> None:
        def send() -> None:
            self.mavlink.mav.set_position_target_local_ned_send(
                0, 1, 1, 1, mask, *position_ned, *velocity_ned, 0, 0, 0, 0, 0
            )

        self._setpoint = send
        send()

    def hold(self) -> None:
        """Told to stop in its own hold mode, as the gate tells it to; the stream ends with it."""
        self._setpoint = lambda: None
        self.mode(self.kind.hold_custom_mode)

    def guide(self) -> None:
        """Takes it into the mode that follows setpoints, where it is."""
        assert self.estimate is not None
        self.to_position(self.estimate.position_enu)
        self.pass_time(0.5)
        for _ in range(20):
            self.mode(self.kind.guided_custom_mode)
            if self.until(lambda: self.custom_mode == self.kind.guided_custom_mode, 1.5):
                return
        raise SystemExit(f"{self.kind.name}: the mode is {self.custom_mode}: {self.texts[-5:]}")

    def take_off(self, up_m: float) -> None:
        """From power on: asks for its messages, waits for its position, arms, climbs."""
        self.mavlink.wait_heartbeat(timeout=60)
        for number, hertz in ((32, 50.0), (30, 10.0), *((n, 50.0) for n in MESSAGES.values())):
            self.command(511, number, 1e6 / hertz)
            self.pass_time(0.05)
        self.command(512, 148)
        if not self.until(lambda: self.estimate is not None and bool(self.truth.samples), 120):
            raise SystemExit(f"{self.kind.name}: no position, or no truth: {self.texts[-5:]}")
        begun = time.monotonic()
        while not self.armed:
            if time.monotonic() - begun > 120:
                raise SystemExit(f"{self.kind.name}: does not arm: {self.texts[-5:]}")
            if self.custom_mode != self.kind.guided_custom_mode:
                assert self.estimate is not None
                self.to_position(self.estimate.position_enu)
                self.mode(self.kind.guided_custom_mode)
            self.command(400, 1.0)
            self.until(lambda: self.armed, 2.0)
        if self.kind is not PX4:
            self._setpoint = lambda: None
            self.command(22, 0, 0, 0, 0, 0, 0, up_m)
            self.until(lambda: self.up_m > up_m - 1.0, 60.0)
        self.to_position((0.0, 0.0, up_m))
        self.until(lambda: self.up_m > up_m - 1.0, 90.0)
        self.pass_time(4.0)

    @property
    def up_m(self) -> float:
        return self.now.position_enu[2]
