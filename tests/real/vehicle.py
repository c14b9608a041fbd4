"""A real vehicle flown without the gate: its truth, its estimate, and setpoints to its own loops.

Truth is what the simulation integrates, never what the vehicle believes: HIL_STATE_QUATERNION of
PX4's SIH, SIM_STATE of ArduCopter's SITL.  Positions are east, north, up of where it stood first, in
metres; times are the vehicle's own, since boot.
"""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from pymavlink import mavutil

from tests.real.autopilots import PX4, Kind

Vector = tuple[float, float, float]
RADIUS_M = 6_378_137.0
SETPOINTS_HZ = 20.0
POSITION_ONLY = 0b110111111000
VELOCITY_ONLY = 0b110111000111
TRUTH = {"HIL_STATE_QUATERNION": 115, "SIM_STATE": 108}


@dataclass(frozen=True)
class Sample:
    at_s: float
    position_enu: Vector
    velocity_enu: Vector
    tilt_deg: float

    @property
    def speed_m_s(self) -> float:
        return math.hypot(*self.velocity_enu)


class Truth:
    """Takes the messages that tell the truth; `samples` are all that came."""

    def __init__(self) -> None:
        self.samples: list[Sample] = []
        self.origin: tuple[float, float, float] | None = None
        self.clock_s = 0.0

    def take(self, message: Any) -> None:
        match message.get_type():
            case "LOCAL_POSITION_NED" | "ATTITUDE":
                self.clock_s = message.time_boot_ms / 1e3
                return
            case "HIL_STATE_QUATERNION":
                w, x, y, z = message.attitude_quaternion
                tilt = math.acos(max(-1.0, min(1.0, 1.0 - 2.0 * (x * x + y * y))))
                velocity = (message.vy / 100.0, message.vx / 100.0, -message.vz / 100.0)
                lat, lon, alt = message.lat / 1e7, message.lon / 1e7, message.alt / 1e3
                at_s = self.clock_s
            case "SIM_STATE":
                tilt = math.acos(math.cos(message.roll) * math.cos(message.pitch))
                velocity = (message.ve, message.vn, -message.vd)
                lat, lon, alt = message.lat_int / 1e7, message.lon_int / 1e7, message.alt
                at_s = self.clock_s
            case _:
                return
        if self.origin is None:
            self.origin = (lat, lon, alt)
        lat0, lon0, alt0 = self.origin
        east = math.radians(lon - lon0) * RADIUS_M * math.cos(math.radians(lat0))
        north = math.radians(lat - lat0) * RADIUS_M
        self.samples.append(
            Sample(at_s, (east, north, alt - alt0), velocity, math.degrees(tilt))
        )


class Vehicle:
    def __init__(self, kind: Kind, url: str) -> None:
        self.kind = kind
        self.sysid = 1
        self.link: Any = mavutil.mavlink_connection(url, source_system=255)
        self.truth = Truth()
        self.estimate: Sample | None = None
        self.armed = False
        self.custom_mode = -1
        self.version = ""
        self.texts: list[str] = []
        self._setpoint: Callable[[], None] = lambda: None
        self._next_s = 0.0
        self._next_beat_s = 0.0

    # -- the link -----------------------------------------------------------------------------

    def pump(self, seconds: float = 0.01) -> None:
        """Takes what has come, waiting so long for the first; sends setpoint and heartbeat when due."""
        message = self.link.recv_match(blocking=True, timeout=seconds)
        self._send_what_is_due()
        while message is not None:
            self._take(message)
            self._send_what_is_due()
            message = self.link.recv_msg()

    def _send_what_is_due(self) -> None:
        now = time.monotonic()
        if now >= self._next_s:
            self._next_s = max(now, self._next_s + 1.0 / SETPOINTS_HZ)
            self._setpoint()
        if now >= self._next_beat_s:
            self._next_beat_s = now + 1.0
            self.link.mav.heartbeat_send(6, 8, 0, 0, 4)

    def _take(self, message: Any) -> None:
        self.truth.take(message)
        match message.get_type():
            case "HEARTBEAT" if message.get_srcComponent() == 1:
                self.armed = bool(message.base_mode & 128)
                self.custom_mode = message.custom_mode
            case "LOCAL_POSITION_NED":
                self.estimate = Sample(
                    message.time_boot_ms / 1e3,
                    (message.y, message.x, -message.z),
                    (message.vy, message.vx, -message.vz),
                    0.0,
                )
            case "AUTOPILOT_VERSION":
                number = message.flight_sw_version
                self.version = f"{number >> 24}.{number >> 16 & 255}.{number >> 8 & 255}"
            case "STATUSTEXT":
                self.texts.append(message.text)

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

    def ask(self, command: int, *params: float) -> None:
        self.link.mav.command_long_send(self.sysid, 1, command, 0, *params, *[0.0] * (7 - len(params)))

    # -- what it is told ----------------------------------------------------------------------

    def to_position(self, position_enu: Vector) -> None:
        east, north, up = position_enu
        self._stream(POSITION_ONLY, (north, east, -up), (0, 0, 0))

    def to_velocity(self, velocity_enu: Vector) -> None:
        east, north, up = velocity_enu
        self._stream(VELOCITY_ONLY, (0, 0, 0), (north, east, -up))

    def _stream(self, mask: int, position_ned: Vector, velocity_ned: Vector) -> None:
        def send() -> None:
            self.link.mav.set_position_target_local_ned_send(
                0, self.sysid, 1, 1, mask, *position_ned, *velocity_ned, 0, 0, 0, 0, 0
            )

        self._setpoint = send
        send()

    def mode(self, custom_mode: int) -> None:
        if self.kind is PX4:
            self.ask(176, 1.0, custom_mode >> 16 & 255, custom_mode >> 24)
        else:
            self.ask(176, 1.0, custom_mode)

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
        self.link.wait_heartbeat(timeout=60)
        for number, hertz in ((32, 50.0), (30, 10.0), *((n, 50.0) for n in TRUTH.values())):
            self.ask(511, number, 1e6 / hertz)
            self.pass_time(0.05)
        self.ask(512, 148)
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
            self.ask(400, 1.0)
            self.until(lambda: self.armed, 2.0)
        if self.kind is not PX4:
            self._setpoint = lambda: None
            self.ask(22, 0, 0, 0, 0, 0, 0, up_m)
            self.until(lambda: self.up_m > up_m - 1.0, 60.0)
        self.to_position((0.0, 0.0, up_m))
        self.until(lambda: self.up_m > up_m - 1.0, 90.0)
        self.pass_time(4.0)

    # -- what it does -------------------------------------------------------------------------

    @property
    def now(self) -> Sample:
        return self.truth.samples[-1]

    @property
    def up_m(self) -> float:
        return self.now.position_enu[2]
