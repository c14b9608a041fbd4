"""The line between the services (MAVLink without I/O) and the vehicle that they serve.

`services/` and `simulation/` know a vehicle only through `Vehicle`; `autopilot/autopilot.py`
implements it over `engine/`.  Everything is SI, the local frame is NED with its origin at the
EKF origin, body axes are forward-right-down, quaternions are w, x, y, z and rotate body to NED.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum, IntEnum
from typing import Final, NamedTuple, Protocol, TypeAlias

from vehicle_sim.autopilot.boot import BootStage
from vehicle_sim.estimation.estimator import Health
from vehicle_sim.numerics.vectors import Quat, Vec3
from vehicle_sim.plant.faults import Fault

GPS_HDOP: Final = 0.8
"""What the receiver says of its satellites' geometry, once it has a fix."""


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
    NOT_IN_CONTROL = 10


class SpeedType(IntEnum):
    """SPEED_TYPE, with its numbers."""

    AIR = 0
    GROUND = 1
    CLIMB = 2
    DESCENT = 3


class Landed(IntEnum):
    """MAV_LANDED_STATE, with its numbers."""

    UNDEFINED = 0
    ON_GROUND = 1
    IN_AIR = 2
    TAKEOFF = 3
    LANDING = 4


class Estimate(NamedTuple):
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


class GpsFix(NamedTuple):
    """What the receiver last said by itself: late, noisy, and not the estimate."""

    fix_type: int  # GPS_FIX_TYPE
    satellites: int
    lat_deg: float
    lon_deg: float
    alt_amsl_m: float
    v_ned: Vec3
    eph_m: float  # standard deviations, infinite without a fix
    epv_m: float


class Readings(NamedTuple):
    """What the other sensors last said, biases and noise included."""

    gyro_frd: Vec3  # rad/s
    accel_frd: Vec3  # m/s^2, specific force
    mag_frd: Vec3  # gauss
    pressure_alt_amsl_m: float
    gps: GpsFix


@dataclass(frozen=True, slots=True)
class Power:
    voltage_v: float
    current_a: float
    consumed_mah: float
    remaining_pct: int


class Target(NamedTuple):
    """What the position controller flies to now, for POSITION_TARGET_LOCAL_NED."""

    pos_ned: Vec3 | None
    v_ned: Vec3 | None
    yaw_rad: float | None


class Geodetic(NamedTuple):
    lat_deg: float
    lon_deg: float
    alt_amsl_m: float


@dataclass(frozen=True, slots=True)
class Setpoint:
    """A client's setpoint in local NED; None = ignored by the type_mask, NaN = only this axis.

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


class AttitudeGoal(NamedTuple):
    """What the attitude controller flies to now: attitude, body rates [rad/s], thrust 0..1."""

    q_ned_from_frd: Quat
    rates_frd: Vec3
    thrust: float


@dataclass(frozen=True, slots=True)
class Orbiting:
    """A circle that is flown; a positive radius [m] is clockwise seen from above."""

    centre_ned: Vec3
    radius_m: float


@dataclass(frozen=True, slots=True)
class OrbitRequest:
    """DO_ORBIT; None = as it is.  A positive radius [m] is clockwise, speed in m/s."""

    radius_m: float | None
    speed_m_s: float | None
    nose: int | None  # ORBIT_YAW_BEHAVIOUR
    centre_ne: tuple[float, float] | None
    down_m: float | None


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


class Flaw(Enum):
    """What is wrong with an item of a fence or of rally points; each has its MISSION_ACK."""

    COMMAND = "command"
    FRAME = "frame"
    PARAM1 = "param1"
    PLACE = "place"
    WHOLE = "whole"  # sound by itself, but not together with the others


@dataclass(frozen=True, slots=True)
class Refusal:
    """The item that a fence or rally points are refused for, and why."""

    seq: int
    flaw: Flaw
    why: str


@dataclass(frozen=True, slots=True)
class FenceState:
    """For SYS_STATUS and FENCE_STATUS; `breach_type` is a FENCE_BREACH, the time simulated."""

    present: bool
    enabled: bool
    breached: bool
    count: int
    breach_type: int
    breach_ns: int


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


@dataclass(frozen=True, slots=True)
class CommandSent:
    """A command that the vehicle itself sends, with its first parameter; `system` 0 = to all."""

    command: int
    p1: float
    system: int = 0


VehicleEvent: TypeAlias = (
    StatusText | ImageCaptured | MissionReached | HomeChanged | CommandDone | CommandSent
)


@dataclass(frozen=True, slots=True)
class Truth:
    """What really is, whatever is reported: NED from the vehicle's own start, rates in rad/s."""

    time_s: float  # simulated
    pos_ned: Vec3
    v_ned: Vec3
    q_ned_from_frd: Quat
    rates_frd: Vec3
    lat_deg: float
    lon_deg: float
    alt_amsl_m: float
    armed: bool
    mode: str
    landed: bool
    battery: float  # charge left, 0..1


class Stepper(Protocol):
    """Moves the bodies of one vehicle or of many."""

    def step(self) -> None:
        """All of them, by one `dt_ns`."""
        ...


class Vehicle(Protocol):
    """One vehicle: body and brain.  Pure; time moves only by the steps of its engine."""

    @property
    def dt_ns(self) -> int: ...
    @property
    def time_ns(self) -> int:
        """Simulated time since boot."""
        ...

    @property
    def engine(self) -> Stepper:
        """Vehicles of a fleet share one; who steps it then calls `live` where it is due."""
        ...

    @property
    def due_step(self) -> int:
        """Number of the step, counted from 1, after which `live` has something to do next."""
        ...

    def live(self) -> None:
        """After a step of the engine: decide, if a decision is due."""
        ...

    def step(self) -> None:
        """For a vehicle that has its engine for itself: step it, then `live`."""
        ...

    def events(self) -> list[VehicleEvent]:
        """What happened since the last call, in order."""
        ...

    # state -----------------------------------------------------------------------------
    @property
    def estimate(self) -> Estimate: ...
    @property
    def health(self) -> Health:
        """The estimate judged: what is good enough to fly by."""
        ...

    @property
    def boot_stage(self) -> BootStage:
        """How far it has started up."""
        ...

    @property
    def readings(self) -> Readings: ...
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
    def mav_type(self) -> int:
        """HEARTBEAT's MAV_TYPE."""
        ...

    @property
    def motor_outputs(self) -> tuple[float, float, float, float]:
        """0..1, for SERVO_OUTPUT_RAW."""
        ...

    @property
    def servos_us(self) -> tuple[int, ...]:
        """What was set on the 16 servo outputs [us]; 0 = nothing."""
        ...

    @property
    def relays(self) -> tuple[int, int]:
        """Masks of the relays that are there, and of those that are on."""
        ...

    @property
    def wind_ned(self) -> Vec3 | None:
        """Where the air goes [m/s], as far as it can be felt; None = not known yet."""
        ...

    @property
    def vibration_m_s2(self) -> Vec3:
        """Root mean square of what shakes the accelerometer, FRD."""
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

    @property
    def attitude_goal(self) -> AttitudeGoal | None:
        """None while nothing is controlled."""
        ...

    @property
    def orbiting(self) -> Orbiting | None: ...
    @property
    def channels_us(self) -> tuple[int, ...]:
        """The 18 radio channels [us], 0 = nothing comes on it."""
        ...

    @property
    def sticks(self) -> tuple[float, float, float, float] | None:
        """Roll, pitch forward and yaw -1..1, throttle 0..1, as they are flown; None = no sticks."""
        ...

    # requests: each answers at once; effects are seen in the state above ---------------
    def arm(self, force: bool) -> Result:
        """IN_PROGRESS: nothing is answered until a `CommandDone`."""
        ...

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
        self,
        pos_ned: Vec3 | None,
        yaw_rad: float | None,
        speed_m_s: float | None,
        changes_mode: bool = True,
    ) -> Result:
        """`changes_mode`: also from another mode than the one that flies there."""
        ...

    def pause(self) -> Result: ...
    def resume(self) -> Result: ...
    def change_speed(self, kind: SpeedType, speed_m_s: float | None) -> Result:
        """None: back to the default."""
        ...

    def change_altitude(self, up_above_home_m: float) -> Result: ...
    def condition_yaw(
        self, yaw_rad: float, relative: bool, rate_rad_s: float, direction: int
    ) -> Result: ...
    def orbit(self, asked: OrbitRequest) -> Result:
        """PX4's Orbit mode; ArduCopter has none."""
        ...

    def look_at(self, where_ned: Vec3 | None) -> Result:
        """A region of interest for the nose; None = no more."""
        ...

    def joystick(self, forward: int, right: int, up: int, clockwise: int, wall_ns: int) -> None:
        """MANUAL_CONTROL's x, y, z and r."""
        ...

    def override_channels(self, channels_us: tuple[int, ...], wall_ns: int) -> None:
        """RC_CHANNELS_OVERRIDE's 18 channels, as they came."""
        ...

    def hear_leader(
        self, system: int, where: Geodetic, v_ned: Vec3, heading_rad: float | None, wall_ns: int
    ) -> None:
        """Where one to follow says that it is; `system` 0 = it did not say who."""
        ...

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
    def check_fence(self, items: tuple[PlanItem, ...]) -> Refusal | None:
        """The first item that would not be taken, None when all would."""
        ...

    def load_fence(self, items: tuple[PlanItem, ...]) -> None:
        """Swap the fence; only after `check_fence` answered None."""
        ...

    def check_rally(self, items: tuple[PlanItem, ...]) -> Refusal | None: ...
    def load_rally(self, items: tuple[PlanItem, ...]) -> None: ...
    @property
    def fence_state(self) -> FenceState: ...
    def enable_fence(self, choice: int) -> Result:
        """DO_FENCE_ENABLE's parameter 1: 0 off, 1 on, 2 the floor off."""
        ...

    def check_arming(self) -> Result:
        """RUN_PREARM_CHECKS: says by STATUSTEXT all that is against arming."""
        ...

    def terminate(self, on: bool) -> Result:
        """Motors off, or (px4) that state ended."""
        ...

    def set_servo(self, servo: float, pulse_us: float) -> Result:
        """DO_SET_SERVO: an output, counted from 1; FAILED where a motor has it."""
        ...

    def repeat_servo(
        self, servo: float, pulse_us: float, count: float, period_s: float
    ) -> Result: ...
    def set_relay(self, relay: float, state: float) -> Result:
        """DO_SET_RELAY, counted from 0: 1 = on, 0 = off."""
        ...

    def repeat_relay(self, relay: float, count: float, period_s: float) -> Result: ...
    def calibrate(self, parameters: tuple[float, ...]) -> Result | None:
        """PREFLIGHT_CALIBRATION's seven parameters.  None: PX4 answers nothing; IN_PROGRESS: the
        answer comes as `CommandDone`."""
        ...

    def calibration_position(self, position: float) -> Result:
        """ACCELCAL_VEHICLE_POS: how the vehicle lies, as the station says."""
        ...

    def calibrate_compass_by_yaw(self) -> Result:
        """FIXED_MAG_CAL_YAW."""
        ...

    def log_download(self, running: bool) -> None:
        """Somebody downloads a flight log now: ArduCopter does not arm meanwhile."""
        ...

    def test_motor(self, seconds: float) -> Result:
        """DO_MOTOR_TEST."""
        ...

    def command_acked(self, command: int, result: int, param1: int, param2: int) -> None:
        """An answer to a command that the vehicle itself sent."""
        ...

    def reboot(self) -> Result: ...
    def reset_parameters(self) -> None:
        """All to their defaults: at once (px4), or with the next reboot (ardupilot)."""
        ...

    @property
    def takes_failures(self) -> bool:
        """Whether INJECT_FAILURE is allowed (px4: SYS_FAILURE_EN)."""
        ...

    @property
    def faults(self) -> Sequence[Fault]:
        """Those that it has now, of whomever."""
        ...

    def inject(self, fault: Fault) -> None:
        """Something goes wrong, or is put right again."""
        ...

    @property
    def truth(self) -> Truth: ...
    @property
    def clock_ns(self) -> int:
        """What its messages tell as time since boot: starts anew with it, jumps by faults."""
        ...

    def gcs_heard(self, wall_ns: int) -> None:
        """A ground station's heartbeat came; the other side's time-outs run on wall time."""
        ...

    def wall(self, wall_ns: int) -> None:
        """The present wall time, for those time-outs; called before `live`."""
        ...
