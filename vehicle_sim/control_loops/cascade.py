"""The inner control loops: attitude -> rate -> motors, with every step of the physics.

Gains are a factor of two to three apart from loop to loop, so that each sees the next as
immediate.  The rate gain follows from the lag of the motors: with a lag of tau the rate loop is
of second order, and a gain of 0.55 / tau damps it at 0.67; the D-term, behind a filter of 30 Hz,
takes the damping up for a body whose inertia is less than believed.  The integrators take what
keeps on turning the body: a weak motor, a centre of mass that is not in the middle.
"""

from __future__ import annotations

from math import sqrt

from vehicle_sim.control_loops.believed import D_FILTER_S, Believed
from vehicle_sim.control_loops.flight import BY_RATES, Flight
from vehicle_sim.estimation.estimated import Estimated

_RATE_SHARE = 0.55  # of 1 / motor lag
_ATTITUDE_SHARE = 0.41  # of the rate gain
_ATTITUDE_P_MAX = 12.0
_TUMBLE_SQUARED = 7.0 * 7.0  # (400 deg/s)^2, where PX4's integrators take nothing up any more


def tune(flight: Flight, believed: Believed) -> None:
    """The gains of the attitude and rate loops that fit these motors."""
    rate = _RATE_SHARE / believed.motor_time_constant_s
    attitude = _ATTITUDE_SHARE * rate
    attitude = attitude if attitude < _ATTITUDE_P_MAX else _ATTITUDE_P_MAX
    flight.kp_rate_roll = flight.kp_rate_pitch = rate
    flight.kp_roll = flight.kp_pitch = attitude


def stabilise(f: Flight, est: Estimated, believed: Believed) -> None:
    """Attitude and rate loops and the mixer, by the estimate: leaves `u1 .. u4`."""
    # q_error = conj(q) q_setpoint; its vector part is half the turn that is missing.
    w = est.qw
    x = -est.qx
    y = -est.qy
    z = -est.qz
    a = f.sp_w
    b = f.sp_x
    c = f.sp_y
    d = f.sp_z
    # Of the two quaternions of one attitude the nearer: the turn is the shorter way.
    turn = 2.0 if w * a - x * b - y * c - z * d >= 0.0 else -2.0
    most = f.roll_rate_max_rad_s
    rate_x = turn * f.kp_roll * (w * b + x * a + y * d - z * c)
    rate_x = most if rate_x > most else -most if rate_x < -most else rate_x
    most = f.pitch_rate_max_rad_s
    rate_y = turn * f.kp_pitch * (w * c + y * a + z * b - x * d)
    rate_y = most if rate_y > most else -most if rate_y < -most else rate_y
    most = f.yaw_rate_max_rad_s
    rate_z = f.yaw_rate_rad_s + turn * f.kp_yaw * (w * d + z * a + x * c - y * b)
    rate_z = most if rate_z > most else -most if rate_z < -most else rate_z
    by_rates = f.attitude == BY_RATES
    rate_x = f.rate_sp_x if by_rates else rate_x
    rate_y = f.rate_sp_y if by_rates else rate_y
    rate_z = f.rate_sp_z if by_rates else rate_z

    # The torque that it takes, as each motor's share of thrust over its lever.
    is_x = est.rate_x
    is_y = est.rate_y
    err_x = rate_x - is_x
    err_y = rate_y - is_y
    err_z = rate_z - est.rate_z
    slow_x = f.rate_slow_x
    slow_y = f.rate_slow_y
    change_x = is_x - slow_x
    change_y = is_y - slow_y
    follow = believed.d_filter_part
    f.rate_slow_x = slow_x + follow * change_x
    f.rate_slow_y = slow_y + follow * change_y
    gain_x = f.kp_rate_roll * believed.roll_n_s2
    gain_y = f.kp_rate_pitch * believed.pitch_n_s2
    gain_z = f.kp_rate_yaw * believed.yaw_n_s2
    int_roll_n = f.int_roll_n
    int_pitch_n = f.int_pitch_n
    int_yaw_n = f.int_yaw_n
    roll = gain_x * (err_x - f.kd_rate_roll / D_FILTER_S * change_x) + int_roll_n
    pitch = gain_y * (err_y - f.kd_rate_pitch / D_FILTER_S * change_y) + int_pitch_n
    yaw = gain_z * err_z + int_yaw_n
    # Yaw has what roll and pitch leave of the lower motors, as PX4's mixer has it, and some always.
    each = 0.25 * f.collective_n
    cross = pitch - roll  # motors 1 and 2
    along = pitch + roll  # motors 3 and 4
    most_cross = cross if cross > 0.0 else -cross
    most_along = along if along > 0.0 else -along
    tilt = most_cross if most_cross > most_along else most_along
    most = believed.yaw_most_n
    room = each - tilt
    room = room if room < believed.hover_n else believed.hover_n
    most = most if most > room else room
    weak = yaw > most or yaw < -most
    yaw = most if yaw > most else -most if yaw < -most else yaw

    t1 = cross + yaw
    t2 = yaw - cross
    t3 = along - yaw
    t4 = -along - yaw
    # Tilt has priority over height: where a motor would saturate, the collective gives way.
    top = most_cross + yaw
    other = most_along - yaw
    top = top if top > other else other
    low = yaw - most_cross
    other = -yaw - most_along
    low = low if low < other else other
    full = believed.thrust_max_n
    flying = f.flying
    # Nothing is learnt in a tumble, nor while the motors cannot give what is asked, nor where the
    # ground may carry.
    tumbles = err_x * err_x + err_y * err_y + err_z * err_z > _TUMBLE_SQUARED
    learns = flying and top - low < full and f.still_s == 0.0 and not tumbles
    learn_s = believed.dt_s if learns else 0.0
    most = believed.integral_most_n
    kept = int_roll_n + f.ki_rate_roll * learn_s * gain_x * err_x
    f.int_roll_n = most if kept > most else -most if kept < -most else kept
    kept = int_pitch_n + f.ki_rate_pitch * learn_s * gain_y * err_y
    f.int_pitch_n = most if kept > most else -most if kept < -most else kept
    kept = int_yaw_n + (0.0 if weak else f.ki_rate_yaw * learn_s * gain_z * err_z)
    f.int_yaw_n = most if kept > most else -most if kept < -most else kept
    each = full - top if each + top > full else each
    each = -low if each + low < 0.0 else each
    # Thrust goes with the square of the speed; the battery's sag is made up for.
    scale = f.strength_inv
    t1 = (each + t1) / full
    t2 = (each + t2) / full
    t3 = (each + t3) / full
    t4 = (each + t4) / full
    u1 = sqrt(t1 if t1 > 0.0 else 0.0) * scale
    u2 = sqrt(t2 if t2 > 0.0 else 0.0) * scale
    u3 = sqrt(t3 if t3 > 0.0 else 0.0) * scale
    u4 = sqrt(t4 if t4 > 0.0 else 0.0) * scale
    idle = f.idle
    f.u1 = (1.0 if u1 > 1.0 else u1) if flying else idle
    f.u2 = (1.0 if u2 > 1.0 else u2) if flying else idle
    f.u3 = (1.0 if u3 > 1.0 else u3) if flying else idle
    f.u4 = (1.0 if u4 > 1.0 else u4) if flying else idle
