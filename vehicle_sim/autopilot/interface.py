"""The line between the services (MAVLink without I/O) and the vehicle that they serve.

`services/` and `world.py` know a vehicle only through `Vehicle`; `autopilot/autopilot.py`
implements it over `model/`.  Everything is SI, the local frame is NED with its origin at the
EKF origin, body axes are forward-right-down, quaternions are w, x, y, z and rotate body to NED.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Protocol, TypeAlias

Vec3 = tuple[float, float, float]
Quat = tuple[float, float, float, float]


class Result(IntEnum):
    """MAV_RESULT, with its numbers."""

    ACCEPTED = 0
    TEMPORARILY_REJECTED = 1
    DENIED = 2
    UNSUPPORTED = 3
    FAILED = 4
    IN_PROGRESS = 5
    CANCELLED = 6
    COMMAND_LONG_ONLY = 7
    COMMAND_INT_ONLY = 8
    UNSUPPORTED_MAV_FRAME = 9


class Landed(IntEnum):
    """MAV_LANDED_STATE, with its numbers."""

    UNDEFINED = 0
    ON_GROUND = 1
    IN_AIR = 2
    TAKEOFF = 3
    LANDING = 4


@dataclass(frozen=True, slots=True)
class Estimate:
    """What the estimator reports; never the truth."""

    time_ns: int
    pos_ned: Vec3
    v_ned: Vec3
    q_ned_from_frd: Quat
    rates_frd: Vec3  # rad/s
    accel_frd: Vec3  # m/s^2, specific force
    lat_deg: float
    lon_deg: float
    alt_amsl_m: float
    alt_rel_m: float  # above home
    heading_rad: float  # 0..2 pi, from north
    gps_ok: bool


@dataclass(frozen=True, slots=True)
class Power:
    voltage_v: float
    current_a: float
    consumed_mah: float
    remaining_pct: int


@dataclass(frozen=True, slots=True)
class Target:
    """What the position controller flies to now, for POSITION_TARGET_LOCAL_NED."""

    pos_ned: Vec3 | None
    v_ned: Vec3 | None
    yaw_rad: float | None


@dataclass(frozen=True, slots=True)
class Geodetic:
    lat_deg: float
    lon_deg: float
    alt_amsl_m: float


@dataclass(frozen=True, slots=True)
class Setpoint:
    """A client's setpoint in local NED; None = ignored by the type_mask.

    Body and offset frames, GLOBAL_INT and masks are resolved by the service before this line.
    """

    pos_ned: Vec3 | None = None
    v_ned: Vec3 | None = None
    a_ned: Vec3 | None = None
    yaw_rad: float | None = None
    yaw_rate_rad_s: float | None = None


@dataclass(frozen=True, slots=True)
class AttitudeSetpoint:
    """SET_ATTITUDE_TARGET: thrust 0..1; None = ignored."""

    q_ned_from_frd: Quat | None
    rates_frd: Vec3 | None
    thrust: float


@dataclass(frozen=True, slots=True)
class PlanItem:
    """A mission item as it came over the wire, before it is given a meaning."""

    seq: int
    frame: int
    command: int
    p1: float
    p2: float
    p3: float
    p4: float
    x: int  # 1e-7 degrees, or 1e-4 metres in local frames
    y: int
    z: float
    autocontinue: int


# ------------------------------------------------------------- events, drained with `events()`


@dataclass(frozen=True, slots=True)
class StatusText:
    severity: int  # MAV_SEVERITY
    text: str


@dataclass(frozen=True, slots=True)
class ImageCaptured:
    index: int
    time_ns: int
    geodetic: Geodetic
    alt_rel_m: float
    q_ned_from_frd: Quat


@dataclass(frozen=True, slots=True)
class MissionReached:
    seq: int


@dataclass(frozen=True, slots=True)
class HomeChanged:
    pass


@dataclass(frozen=True, slots=True)
class CommandDone:
    """The final result of a command that was answered IN_PROGRESS."""

    command: int
    result: Result


VehicleEvent: TypeAlias = StatusText | ImageCaptured | MissionReached | HomeChanged | CommandDone


class Vehicle(Protocol):
    """One vehicle: body and brain.  Pure; time moves only by `step`."""

    @property
    def dt_ns(self) -> int: ...
    @property
    def time_ns(self) -> int:
        """Simulated time since boot."""
        ...

    def step(self) -> None:
        """Advance everything by `dt_ns`."""
        ...

    def events(self) -> list[VehicleEvent]:
        """What happened since the last call, in order."""
        ...

    # state -----------------------------------------------------------------------------
    @property
    def estimate(self) -> Estimate: ...
    @property
    def power(self) -> Power: ...
    @property
    def target(self) -> Target: ...
    @property
    def armed(self) -> bool: ...
    @property
    def landed(self) -> Landed: ...
    @property
    def custom_mode(self) -> int:
        """HEARTBEAT.custom_mode of the personality."""
        ...

    @property
    def base_mode(self) -> int: ...
    @property
    def system_status(self) -> int:
        """MAV_STATE."""
        ...

    @property
    def origin(self) -> Geodetic | None:
        """EKF origin, None before the first fix."""
        ...

    @property
    def home(self) -> Geodetic | None: ...
    @property
    def home_pos_ned(self) -> Vec3 | None: ...
    @property
    def armable(self) -> bool: ...
    @property
    def motor_outputs(self) -> tuple[float, float, float, float]:
        """0..1, for SERVO_OUTPUT_RAW."""
        ...

    @property
    def mission_current(self) -> int: ...
    @property
    def mission_state(self) -> int:
        """MISSION_STATE."""
        ...

    @property
    def capturing(self) -> bool: ...
    @property
    def images_captured(self) -> int: ...

    # requests: each answers at once; effects are seen in the state above ---------------
    def arm(self, force: bool) -> Result: ...
    def disarm(self, force: bool) -> Result: ...
    def set_mode(self, base_mode: int, custom_mode: int) -> Result: ...
    def set_mode_kind(self, kind: str) -> Result:
        """By meaning: "hold", "return", "land", "guided", "mission", "brake"."""
        ...

    def take_off(self, up_above_home_m: float | None) -> Result:
        """None = the personality's default height (MIS_TAKEOFF_ALT)."""
        ...

    def land(self) -> Result: ...
    def return_home(self) -> Result: ...
    def reposition(
        self, pos_ned: Vec3 | None, yaw_rad: float | None, speed_m_s: float | None
    ) -> Result: ...
    def pause(self) -> Result: ...
    def resume(self) -> Result: ...
    def change_speed(self, speed_m_s: float) -> Result: ...
    def change_altitude(self, up_above_home_m: float) -> Result: ...
    def condition_yaw(
        self, yaw_rad: float, relative: bool, rate_rad_s: float, direction: int
    ) -> Result: ...
    def set_home(self, where: Geodetic | None) -> Result:
        """None = the present position."""
        ...

    def set_setpoint(self, setpoint: Setpoint) -> None: ...
    def set_attitude(self, setpoint: AttitudeSetpoint) -> None: ...
    def capture_image(self, interval_s: float, count: int) -> Result: ...
    def stop_capture(self) -> Result: ...
    def mission_start(self, first: int, last: int) -> Result: ...
    def mission_set_current(self, seq: int) -> Result: ...
    def check_plan(self, items: tuple[PlanItem, ...]) -> tuple[int, str] | None:
        """(seq, why) of the first item that cannot be flown, None when all can."""
        ...

    def load_plan(self, items: tuple[PlanItem, ...]) -> None:
        """Swap the mission; only after `check_plan` answered None."""
        ...

    @property
    def plan(self) -> tuple[PlanItem, ...]: ...
    def terminate(self) -> Result: ...
    def reboot(self) -> Result: ...
    def gcs_heard(self, wall_ns: int) -> None:
        """A ground station's heartbeat came; the other side's time-outs run on wall time."""
        ...

    def wall(self, wall_ns: int) -> None:
        """The present wall time, for those time-outs; called before `step`."""
        ...
