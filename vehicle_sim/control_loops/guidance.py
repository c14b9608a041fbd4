"""Guidance at 50 Hz: goal, reference, heading, position and velocity loops, land detector.

It flies by the estimate, and leaves an attitude and a collective for the inner loops.  Velocity
2.5 /s, position 1 /s: slow enough to see the attitude loop as immediate.
"""

from __future__ import annotations

from math import pi, sqrt

from vehicle_sim.control_loops.believed import Believed
from vehicle_sim.control_loops.flight import ACCELERATE, BY_MOTION, THRUST, Flight
from vehicle_sim.control_loops.trajectory import move_goal, move_reference
from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.numerics.angles import sincos
from vehicle_sim.numerics.gravity import GRAVITY_M_S2

_INTEGRAL_TILT = 0.7  # of the steepest tilt, for each axis
_UNWIND = 2.0
_LIFT_MIN_M_S2 = 0.3 * GRAVITY_M_S2
_THRUST_LOW = 0.23  # of hover: below it the motors lose their authority over the attitude
_THRUST_HIGH = 0.95  # of full: the rest is for the attitude
_LOAD_MIN = 0.4
_LOAD_ROOM = 0.95  # of the thrust that there is: so much may carry the weight at the most
# ArduCopter's for MOT_THST_HOVER (AP_MOTORS_THST_HOVER_TC and Copter::update_throttle_hover), by
# memory: much slower than the integrator that it relieves.
_LEARN_S = 10.0
_LEARN_SPEED_M_S = 0.6
_ALOFT_M = 0.5  # above where it stood: the ground carries nothing any more
_UPRIGHT_MIN = 0.5  # cosine of the tilt up to which the collective makes up for it
_EASE_P = 1.5  # 1/s: a turn slows down before its goal, at last to _EASE_RAD_S
_EASE_RAD_S = 0.1
_LAND_SPEED_M_S = 0.3
_LAND_THRUST = 0.7  # of hover, where a height at or below the ground is asked for
# Where neither that nor a descent is asked for: a vehicle 40 % lighter than
# believed hovers on 0.6 of the believed weight, above its reference, until that is learnt.
_LAND_THRUST_UNASKED = 0.4
_LAND_ASKED_M_S = 0.1
_LAND_LAG_M = 0.2
_LAND_LAG_M_S = 0.2


def guide(f: Flight, est: Estimated, believed: Believed, dt_s: float) -> None:
    """All of it, once."""
    move_goal(f, dt_s)
    move_reference(f, est, dt_s)
    turn(f, dt_s)
    follow(f, est, believed, dt_s)
    feel_ground(f, est, believed, dt_s)


def turn(f: Flight, dt_s: float) -> None:
    """The heading setpoint goes on: to its goal, slower towards the end, or for ever."""
    left = f.yaw_left_rad
    size = left if left >= 0.0 else -left
    most = _EASE_P * size + _EASE_RAD_S
    most = f.yaw_most_rad_s if most > f.yaw_most_rad_s else most
    there = size <= most * dt_s
    rate = left / dt_s if there else most if left > 0.0 else -most
    spin = f.yaw_spin_rad_s
    rate = spin if spin != 0.0 else rate
    yaw = f.yaw_rad + rate * dt_s
    f.yaw_left_rad = 0.0 if there or spin != 0.0 else left - rate * dt_s
    f.yaw_rad = yaw - 2.0 * pi if yaw > pi else yaw + 2.0 * pi if yaw < -pi else yaw
    f.yaw_rate_rad_s = rate


def follow(f: Flight, est: Estimated, believed: Believed, dt_s: float) -> None:
    """Position and velocity loops, then the attitude and the collective that they need."""
    err_n = f.ref_vel_n + f.kp_pos_xy * (f.ref_n - est.pos_n) - est.vel_n
    err_e = f.ref_vel_e + f.kp_pos_xy * (f.ref_e - est.pos_e) - est.vel_e
    err_d = f.ref_vel_d + f.kp_pos_z * (f.ref_d - est.pos_d) - est.vel_d
    # Where the motion is not controlled the reference is the estimate, and nothing is learnt.
    mass = believed.mass_kg
    load = f.load
    full = 4.0 * believed.thrust_max_n
    low = _THRUST_LOW * GRAVITY_M_S2 * mass * load
    high = _THRUST_HIGH * full
    # Vertically up to what the thrust can give, and no further while it gives all or nothing.
    asked = f.collective_n
    upright = 1.0 - 2.0 * (est.qx * est.qx + est.qy * est.qy)
    spent = (asked >= high and err_d < 0.0) or (asked <= low and err_d > 0.0)
    spent = spent or upright < _UPRIGHT_MIN
    int_d = f.int_d + (0.0 if spent else f.ki_vel_z * dt_s * err_d)
    most = GRAVITY_M_S2 - low / (mass * load)
    int_d = most if int_d > most else int_d
    most = GRAVITY_M_S2 - high / (mass * load)
    int_d = most if int_d < most else int_d
    as_asked = f.horizontal >= ACCELERATE
    a_n = f.acc_n if as_asked else f.ref_acc_n + f.kp_vel_xy * err_n + f.int_n
    a_e = f.acc_e if as_asked else f.ref_acc_e + f.kp_vel_xy * err_e + f.int_e
    a_d = f.ref_acc_d + f.kp_vel_z * err_d + int_d
    a_d = f.acc_d if f.vertical >= ACCELERATE else a_d

    lift = GRAVITY_M_S2 - a_d
    lift = _LIFT_MIN_M_S2 if lift < _LIFT_MIN_M_S2 else lift
    flat = sqrt(a_n * a_n + a_e * a_e)
    most = f.tilt_max * lift
    steep = flat > most
    scale = most / flat if steep else 1.0
    # What the tilt does not give is taken from the integrators, as PX4 does (PositionControl.cpp,
    # by memory; Rundqwist, Anti-reset windup for PID controllers, 1990).
    back = 0.0 if as_asked or f.kp_vel_xy == 0.0 else _UNWIND * (1.0 - scale) / f.kp_vel_xy
    gain = f.ki_vel_xy * dt_s
    int_n = f.int_n + gain * (err_n - back * a_n)
    int_e = f.int_e + gain * (err_e - back * a_e)
    most = _INTEGRAL_TILT * f.tilt_max * GRAVITY_M_S2
    f.int_n = most if int_n > most else -most if int_n < -most else int_n
    f.int_e = most if int_e > most else -most if int_e < -most else int_e
    a_n = a_n * scale
    a_e = a_e * scale
    size = sqrt(a_n * a_n + a_e * a_e + lift * lift)
    # Shortest turn from (0, 0, -1) to the thrust direction, after the turn by the heading.
    w = 1.0 + lift / size
    x = a_e / size
    y = -a_n / size
    scale = 1.0 / sqrt(w * w + x * x + y * y)
    w = w * scale
    x = x * scale
    y = y * scale
    s, c = sincos(0.5 * f.yaw_rad)
    by_motion = f.attitude == BY_MOTION
    f.sp_w = w * c if by_motion else f.sp_w
    f.sp_x = x * c + y * s if by_motion else f.sp_x
    f.sp_y = y * c - x * s if by_motion else f.sp_y
    f.sp_z = w * s if by_motion else f.sp_z

    # An attitude from outside costs height unless the collective makes up for its tilt.
    upright = _UPRIGHT_MIN if upright < _UPRIGHT_MIN else upright
    # What carries it is learnt: believed weight and thrust may both be wrong.  It is what the
    # vertical integrator has come to in a hover, and the integrator gives it back at once, so that
    # the collective does not jump.
    floor_d = f.floor_d if f.flying else est.pos_d
    f.floor_d = floor_d
    aloft = f.flying and floor_d - est.pos_d > _ALOFT_M and f.ref_d - est.pos_d < _LAND_LAG_M
    slow = _LEARN_SPEED_M_S
    steady = est.vel_d < slow and est.vel_d > -slow
    steady = steady and f.ref_vel_d < slow and f.ref_vel_d > -slow and f.vertical < ACCELERATE
    weight = GRAVITY_M_S2 * mass
    new = load - dt_s / _LEARN_S * load * int_d / GRAVITY_M_S2
    most = _LOAD_ROOM * high / weight
    new = most if new > most else _LOAD_MIN if new < _LOAD_MIN else new
    new = new if aloft and steady else load
    f.load = new
    f.int_d = GRAVITY_M_S2 - load / new * (GRAVITY_M_S2 - int_d)
    wanted = mass * load * (size if by_motion else lift / upright)
    wanted = f.thrust * full if f.vertical == THRUST else wanted
    f.collective_n = low if wanted < low else high if wanted > high else wanted


def feel_ground(f: Flight, est: Estimated, believed: Believed, dt_s: float) -> None:
    """Land detector: how long the vehicle wants to descend, does not, and hardly carries itself.

    A horizontal velocity that no fix holds any more is no evidence against the ground.
    """
    slow = _LAND_SPEED_M_S
    still_d = est.vel_d < slow and est.vel_d > -slow
    still_n = est.vel_n < slow and est.vel_n > -slow
    still_e = est.vel_e < slow and est.vel_e > -slow
    still = still_d and ((still_n and still_e) or not est.gps_used)
    by_velocity = f.direct or f.height_free
    sinking = f.ref_vel_d > _LAND_LAG_M_S if by_velocity else f.ref_d - est.pos_d > _LAND_LAG_M
    share = _LAND_THRUST if f.ref_d > f.floor_d else _LAND_THRUST_UNASKED
    share = f.land_share if f.ref_vel_d > _LAND_ASKED_M_S else share
    light = f.collective_n < share * GRAVITY_M_S2 * believed.mass_kg * f.load
    f.still_s = f.still_s + dt_s if sinking and still and light and f.flying else 0.0
