"""Flight control: writes demands, turns and starts into the `Flight` of one vehicle.

On the ground, armed, the motors idle and nothing is controlled.  A task that lifts off starts
the flight; the land detector ends it.
"""

from __future__ import annotations

from math import atan2, pi, remainder, sqrt
from typing import Final, assert_never

from vehicle_sim.autopilot.control.demands import (
    STILL,
    Demand,
    FlyAcceleration,
    FlyAtHeight,
    FlyAttitude,
    FlyCircle,
    FlyLean,
    FlyLevel,
    FlyTo,
    FlyVelocity,
    Situation,
)
from vehicle_sim.autopilot.interface import AttitudeSetpoint
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.control_loops.flight import (
    ACCELERATE,
    AT_VELOCITY,
    BY_ATTITUDE,
    BY_MOTION,
    BY_RATES,
    THRUST,
    TO,
    Flight,
)
from vehicle_sim.control_loops.trajectory import QUICK_M_S3, Law, MotionLimits
from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.numerics.vectors import Quat, Vec3

LAND_S: Final[dict[Personality, float]] = {"px4": 1.0, "ardupilot": 0.6}
"""How long the land detector must feel the ground: LNDMC_TRIG_TIME, by memory; ArduCopter's 1 s
begins earlier than `guidance.feel_ground` can tell."""
_SHARPNESS: Final = 5.0  # 1/s: these three of `Flight`, where no autopilot's law says otherwise
_APPROACH_P: Final = 1.5  # 1/s
_BRAKE_SHARE: Final = 0.6


def heading_of(q_ned_from_frd: Quat) -> float:
    """Yaw of the body's forward axis, -pi .. pi from north."""
    w, x, y, z = q_ned_from_frd
    return atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def wrap_pi(angle_rad: float) -> float:
    """The same direction within -pi .. pi."""
    return remainder(angle_rad, 2.0 * pi)


class Heading:
    """The yaw setpoint: slews to a goal the shorter way, or the way that was asked for."""

    __slots__ = ("_flight", "_goal_rad", "max_rad_s")

    def __init__(self, flight: Flight) -> None:
        self._flight = flight
        self._goal_rad = 0.0
        self.max_rad_s = 1.0

    @property
    def yaw_rad(self) -> float:
        """The setpoint now, -pi .. pi from north."""
        return self._flight.yaw_rad

    @property
    def turning(self) -> bool:
        return self._flight.yaw_left_rad != 0.0

    def reset(self, yaw_rad: float) -> None:
        self._goal_rad = yaw_rad
        self._flight.yaw_rad = yaw_rad
        self._flight.yaw_left_rad = 0.0
        self._flight.yaw_spin_rad_s = 0.0

    def turn_to(self, yaw_rad: float) -> None:
        """The shorter way, at the vehicle's own turn rate."""
        if yaw_rad == self._goal_rad and self._flight.yaw_spin_rad_s == 0.0:
            return
        self.turn(yaw_rad, self.max_rad_s, 0)

    def point(self, yaw_rad: float) -> None:
        """At once: as fast as the attitude loop takes it there, as a setpoint from outside."""
        if yaw_rad != self._goal_rad or self._flight.yaw_spin_rad_s != 0.0:
            self.reset(wrap_pi(yaw_rad))
            self._goal_rad = yaw_rad

    def turn(self, yaw_rad: float, rate_rad_s: float, direction: int) -> None:
        """`direction` 1 clockwise, -1 counter-clockwise, 0 the shorter way."""
        f = self._flight
        left = wrap_pi(yaw_rad - f.yaw_rad)
        if direction > 0 and left < 0.0:
            left += 2.0 * pi
        elif direction < 0 and left > 0.0:
            left -= 2.0 * pi
        self._goal_rad = yaw_rad
        f.yaw_left_rad = left
        f.yaw_most_rad_s = rate_rad_s if 0.0 < rate_rad_s < self.max_rad_s else self.max_rad_s
        f.yaw_spin_rad_s = 0.0

    def turn_by_rate(self, rate_rad_s: float) -> None:
        """Go on turning at this rate; 0 ends such a turn, and leaves one to a goal alone."""
        f = self._flight
        if rate_rad_s == 0.0 and f.yaw_spin_rad_s == 0.0:
            return
        top = f.yaw_rate_max_rad_s
        f.yaw_spin_rad_s = top if rate_rad_s > top else max(rate_rad_s, -top)
        f.yaw_left_rad = 0.0
        self._goal_rad = f.yaw_rad


class FlightControl:
    """The demands of one vehicle, written into its loops."""

    __slots__ = ("_demand", "_land_s", "flight", "heading", "idle")

    def __init__(self, flight: Flight, idle: float, land_s: float = 1.0) -> None:
        """`idle`: speed (0..1) of an armed motor on the ground; `land_s`: see `LAND_S`."""
        self.flight = flight
        self.heading = Heading(flight)
        self.idle = idle
        self._land_s = land_s
        self._demand: Demand | None = None

    @property
    def flying(self) -> bool:
        return self.flight.flying

    def stop(self) -> None:
        """Motors off, at once, wherever the vehicle is."""
        self._ground(0.0)

    def rest(self) -> None:
        """Armed on the ground: motors idle."""
        self.flight.idle = self.idle

    def settle(self) -> None:
        """On the ground: stop controlling."""
        self._ground(self.idle)

    def _ground(self, idle: float) -> None:
        f = self.flight
        f.flying = False
        f.idle = f.u1 = f.u2 = f.u3 = f.u4 = idle
        f.collective_n = 0.0
        self._demand = None

    def lift_off(self, pos_ned: Vec3, heading_rad: float) -> None:
        """Begin to fly from where the vehicle stands; what was learnt before is forgotten."""
        f = self.flight
        f.flying = True
        f.still_s = 0.0
        f.int_n = f.int_e = f.int_d = 0.0
        f.int_roll_n = f.int_pitch_n = f.int_yaw_n = 0.0
        f.ref_n, f.ref_e, f.ref_d = pos_ned
        f.ref_vel_n = f.ref_vel_e = f.ref_vel_d = 0.0
        f.ref_acc_n = f.ref_acc_e = f.ref_acc_d = 0.0
        self._demand = None
        self.heading.reset(heading_rad)

    def touched_down(self) -> bool:
        """The land detector has struck."""
        return self.flight.still_s >= self._land_s

    # -------------------------------------------------------------------------- demands

    def fly(self, demand: Demand, s: Situation) -> None:
        """Take a demand.  The same one again changes nothing: its goal moves on by itself."""
        if isinstance(demand, FlyAttitude):
            self._let_go_of_heading(demand.setpoint, s)
        if demand == self._demand:
            return
        last = self._demand
        going_on = isinstance(last, FlyCircle) and isinstance(demand, FlyCircle)
        self._demand = demand
        f = self.flight
        leans = f.attitude != BY_RATES  # else the setpoint of the attitude is an old one
        f.attitude = BY_MOTION
        f.turn_rad_s = 0.0
        f.straight = f.height_free = False
        direct = isinstance(demand, (FlyTo, FlyVelocity, FlyAtHeight)) and demand.direct
        if f.direct and not direct:
            f.ref_vel_n, f.ref_vel_e, f.ref_vel_d = s.v_ned
        f.direct = direct
        match demand:
            case FlyTo():
                self._go(TO, TO, _now(demand, s.time_ns), demand.v_ned)
                f.straight = demand.straight
                f.height_free = demand.height_free
                self._limit(demand.limits)
                if demand.v_ned != STILL:
                    self._quicken()
            case FlyVelocity():
                if demand.anew and not (isinstance(last, FlyVelocity) and last.anew):
                    self._begin_anew(s, leans)
                self._go(AT_VELOCITY, AT_VELOCITY, s.pos_ned, demand.v_ned)
                self._limit(demand.limits)
            case FlyAtHeight():
                where = (s.pos_ned[0], s.pos_ned[1], demand.down_m)
                self._go(AT_VELOCITY, TO, where, (demand.v_n, demand.v_e, 0.0))
                self._limit(demand.limits)
            case FlyCircle():
                self._circle(demand, going_on)
                self._limit(demand.limits)
                self._quicken()
            case FlyAcceleration():
                f.horizontal = f.vertical = ACCELERATE
                f.acc_n, f.acc_e, f.acc_d = demand.a_ned
            case FlyLevel():
                self._go(ACCELERATE, TO, (0.0, 0.0, demand.down_m), STILL)
                f.acc_n = f.acc_e = 0.0
                self._limit(demand.limits)
            case FlyLean():
                self._lean(demand, s)
                self._limit(demand.limits)
            case FlyAttitude():
                self._fly_attitude(demand)
            case _:
                assert_never(demand)

    def _go(self, horizontal: float, vertical: float, goal_ned: Vec3, v_ned: Vec3) -> None:
        f = self.flight
        f.horizontal = horizontal
        f.vertical = vertical
        f.goal_n, f.goal_e, f.goal_d = goal_ned
        f.goal_vel_n, f.goal_vel_e, f.goal_vel_d = v_ned

    def _circle(self, demand: FlyCircle, going_on: bool) -> None:
        """The goal starts on the circle next to the vehicle, or to where it has come."""
        f = self.flight
        n, e = (f.goal_n, f.goal_e) if going_on else (f.ref_n, f.ref_e)
        centre_n, centre_e, centre_d = demand.centre_ned
        north, east = n - centre_n, e - centre_e
        size = sqrt(north * north + east * east)
        if size < 1e-3:
            north, east, size = 1.0, 0.0, 1.0
        out = demand.radius_m / size
        self._go(TO, TO, (centre_n + north * out, centre_e + east * out, centre_d), STILL)
        f.centre_n, f.centre_e = centre_n, centre_e
        f.turn_rad_s = demand.turn_rad_s

    def _lean(self, demand: FlyLean, s: Situation) -> None:
        f = self.flight
        if demand.down_m is not None:
            self._go(ACCELERATE, TO, (s.pos_ned[0], s.pos_ned[1], demand.down_m), STILL)
        elif demand.v_d is not None:
            self._go(ACCELERATE, AT_VELOCITY, s.pos_ned, (0.0, 0.0, demand.v_d))
        else:
            self._go(ACCELERATE, THRUST, s.pos_ned, STILL)
            f.thrust = demand.thrust
        f.acc_n, f.acc_e, f.acc_d = demand.a_n, demand.a_e, 0.0

    def _begin_anew(self, s: Situation, leans: bool) -> None:
        """Horizontally from where the vehicle is, as fast as it is: see `FlyVelocity`."""
        f = self.flight
        f.ref_n, f.ref_e, _ = s.pos_ned
        f.ref_vel_n, f.ref_vel_e, _ = s.v_ned
        f.ref_acc_n = f.ref_acc_e = 0.0
        if not leans:
            return
        w, x, y, z = f.sp_w, f.sp_x, f.sp_y, f.sp_z
        north, east = -2.0 * (x * z + w * y), -2.0 * (y * z - w * x)
        up, flat = 1.0 - 2.0 * (x * x + y * y), sqrt(north * north + east * east)
        scale = 1.0 / up if flat < f.tilt_max * up else f.tilt_max / max(flat, 1e-6)
        f.int_n, f.int_e = scale * GRAVITY_M_S2 * north, scale * GRAVITY_M_S2 * east

    def _limit(self, limits: MotionLimits) -> None:
        f = self.flight
        f.speed_m_s = limits.speed_m_s
        f.climb_m_s = limits.climb_m_s
        f.descend_m_s = limits.descend_m_s
        f.accel_m_s2 = limits.accel_m_s2
        f.accel_vertical_m_s2 = limits.accel_vertical_m_s2
        f.accel_up_m_s2 = limits.lift_m_s2
        f.jerk_m_s3 = limits.jerk_m_s3
        f.brakes_by_jerk = limits.law is Law.PX4
        if limits.law is Law.COPTER:
            f.sharpness = limits.jerk_m_s3 / limits.accel_m_s2
            f.sharpness_d = limits.jerk_m_s3 / limits.accel_vertical_m_s2
            f.approach_p, f.approach_p_d = f.sharpness, f.sharpness_d
            f.brakes_ahead = True
            f.brake_share = 1.0
        else:
            self._steady()

    def _quicken(self) -> None:
        """What moves the goal shapes the way."""
        self.flight.jerk_m_s3 = QUICK_M_S3
        self._steady()

    def _steady(self) -> None:
        f = self.flight
        f.sharpness = f.sharpness_d = _SHARPNESS
        f.approach_p = f.approach_p_d = _APPROACH_P
        f.brake_share = _BRAKE_SHARE
        f.brakes_ahead = False

    def _fly_attitude(self, demand: FlyAttitude) -> None:
        f = self.flight
        setpoint = demand.setpoint
        f.horizontal = ACCELERATE
        f.acc_n = f.acc_e = 0.0
        if demand.thrust_is_climb:
            part = 2.0 * setpoint.thrust - 1.0
            top = demand.limits.climb_m_s if part > 0.0 else demand.limits.descend_m_s
            f.vertical = AT_VELOCITY
            f.goal_vel_d = -part * top
            self._limit(demand.limits)
        else:
            f.vertical = THRUST
            f.thrust = setpoint.thrust
        if setpoint.q_ned_from_frd is not None:
            f.attitude = BY_ATTITUDE
            f.sp_w, f.sp_x, f.sp_y, f.sp_z = setpoint.q_ned_from_frd
        elif setpoint.rates_frd is not None:
            f.attitude = BY_RATES
            f.rate_sp_x, f.rate_sp_y, f.rate_sp_z = setpoint.rates_frd

    def _let_go_of_heading(self, setpoint: AttitudeSetpoint, s: Situation) -> None:
        """An attitude from outside has the heading in it; ours goes along, ready to take over."""
        if setpoint.q_ned_from_frd is not None:
            self.heading.reset(heading_of(setpoint.q_ned_from_frd))
        elif setpoint.rates_frd is not None:
            self.heading.reset(s.heading_rad)


def _now(demand: FlyTo, time_ns: int) -> Vec3:
    """Where the goal has come by now."""
    since_s = (time_ns - demand.since_ns) * 1e-9 if demand.since_ns else 0.0
    (n, e, d), (v_n, v_e, v_d) = demand.pos_ned, demand.v_ned
    return (n + v_n * since_s, e + v_e * since_s, d + v_d * since_s)
