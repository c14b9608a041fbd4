"""What a task asks of the pilot, and what it is told of the flight."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, TypeAlias

from vehicle_sim.autopilot.interface import AttitudeSetpoint, Landed, Target
from vehicle_sim.control_loops.trajectory import MotionLimits
from vehicle_sim.numerics.vectors import Vec3

STILL: Vec3 = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class FlyTo:
    """To a goal [m, NED] that itself moves at `v_ned`; along a line where `straight`.

    `since_ns`: when the goal was at `pos_ned`, for one that moves.  `direct`: as a step for the
    position loop, within the limits of speed but not of acceleration.  `height_free`: vertically at
    the velocity towards it, without a height that is to be caught up with.
    """

    pos_ned: Vec3
    limits: MotionLimits
    v_ned: Vec3 = STILL
    straight: bool = True
    since_ns: int = 0
    direct: bool = False
    height_free: bool = False


@dataclass(frozen=True, slots=True)
class FlyVelocity:
    """At a velocity.

    `anew`: horizontally from the vehicle's own motion, without an acceleration, as ArduCopter
    begins where its position controller is initialised.  All that the vehicle leans for then is
    taken for what it needs to hold a speed, and unlearnt as the speed changes.
    """

    v_ned: Vec3
    limits: MotionLimits
    direct: bool = False
    anew: bool = False


@dataclass(frozen=True, slots=True)
class FlyAtHeight:
    """At a velocity over the ground [m/s], and to or at a height."""

    v_n: float
    v_e: float
    down_m: float
    limits: MotionLimits
    direct: bool = False


@dataclass(frozen=True, slots=True)
class FlyCircle:
    """Round a centre at its height, from where the vehicle is; `turn_rad_s` > 0 = clockwise.

    The same centre again, with another radius or speed, goes on from where it is.
    """

    centre_ned: Vec3
    radius_m: float
    turn_rad_s: float
    limits: MotionLimits


@dataclass(frozen=True, slots=True)
class FlyAcceleration:
    a_ned: Vec3


@dataclass(frozen=True, slots=True)
class FlyLevel:
    """Level, at this height; horizontally free."""

    down_m: float
    limits: MotionLimits


@dataclass(frozen=True, slots=True)
class FlyLean:
    """Leaning by hand: accelerate horizontally [m/s^2] without feedback, the nose as it turns.

    Vertically one of three: at the height `down_m`, at the velocity `v_d`, or with `thrust` as a
    part of full throttle.
    """

    a_n: float
    a_e: float
    limits: MotionLimits
    down_m: float | None = None
    v_d: float | None = None
    thrust: float = 0.0


@dataclass(frozen=True, slots=True)
class FlyAttitude:
    """An attitude or body rates from outside.

    `thrust_is_climb`: 0.5 keeps the height and the rest is climb rate (ArduCopter's GUIDED);
    otherwise thrust is a part of full throttle.
    """

    setpoint: AttitudeSetpoint
    thrust_is_climb: bool
    limits: MotionLimits


Demand: TypeAlias = (
    FlyTo
    | FlyVelocity
    | FlyAtHeight
    | FlyCircle
    | FlyAcceleration
    | FlyLevel
    | FlyLean
    | FlyAttitude
)


class Situation:
    """The flight as the estimator and the pilot see it, rewritten for every decision.

    `stop_ned` is where the vehicle comes to rest if it brakes now.  `limits` are those of the
    vehicle's own flights.  `flying` = off the ground, by the land detector.
    """

    __slots__ = (
        "flying",
        "heading_rad",
        "home_ned",
        "limits",
        "pos_ned",
        "stop_ned",
        "time_ns",
        "v_ned",
        "wall_ns",
    )

    def __init__(self, limits: MotionLimits) -> None:
        self.time_ns = 0
        self.wall_ns = 0
        self.pos_ned: Vec3 = STILL
        self.v_ned: Vec3 = STILL
        self.stop_ned: Vec3 = STILL
        self.home_ned: Vec3 = STILL
        self.heading_rad = 0.0
        self.limits = limits
        self.flying = False


class Turner(Protocol):
    """Where a task sets the heading; without a word it stays as it is."""

    def turn_to(self, yaw_rad: float) -> None: ...
    def point(self, yaw_rad: float) -> None: ...
    def turn_by_rate(self, rate_rad_s: float) -> None: ...


class Task(Protocol):
    """What a mode flies.

    `begin` when it is entered; while armed `update` at 10 Hz, and at once when something came.
    """

    @property
    def landed_word(self) -> Landed:
        """What EXTENDED_SYS_STATE says while flying: IN_AIR, TAKEOFF or LANDING."""
        ...

    @property
    def done(self) -> bool:
        """Nothing left to do but to stay."""
        ...

    @property
    def target(self) -> Target:
        """What is flown to, for POSITION_TARGET_LOCAL_NED."""
        ...

    def lifts_off(self, s: Situation) -> bool:
        """Whether it takes the vehicle off the ground now."""
        ...

    def begin(self, s: Situation, turner: Turner) -> None: ...
    def update(self, s: Situation, turner: Turner) -> Demand: ...
