"""A reference that moves the way the vehicle can: limited in speed and acceleration.

The controller follows the reference; goals only pull at it.  So a step of the goal is a smooth
flight, without a wound-up position error, and a brake is a goal at the stopping point.

What is asked for directly (PX4's OFFBOARD) is not shaped: the reference is where the vehicle is,
at the velocity that the position loop asks for or that was asked for, within the limits of speed.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from math import sqrt
from typing import Final

from vehicle_sim.control_loops.flight import ACCELERATE, AT_VELOCITY, TO, Flight
from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.numerics.vectors import Vec3

QUICK_M_S3: Final = 30.0
"""The jerk of a vehicle that its autopilot does not limit: it is in the lag of its attitude."""
_LEAD_FREE = 0.175  # of the lead at which the reference waits: up to here it does not
_FORGET_P = 1.0  # 1/s
_UNWIND_SHARE = 0.7  # of the jerk takes the acceleration back as the velocity comes near
_BRAKE_REACT_S = 0.6  # by memory: MissionBlock::calculate_breaking_stop, 0.6 of the jerk over it


class Law(Enum):
    """How a reference comes up to a velocity and down to a goal."""

    STEADY = "of this vehicle, for what no autopilot shapes"
    PX4 = "with room to reverse the acceleration at the jerk (`speed_by_jerk`)"
    COPTER = "acceleration = jerk / acceleration of what is missing; the braking is fed forward"


@dataclass(frozen=True, slots=True)
class MotionLimits:
    """Speeds [m/s], horizontal and vertical acceleration [m/s^2], and jerk; all positive."""

    speed_m_s: float
    climb_m_s: float
    descend_m_s: float
    accel_m_s2: float
    accel_vertical_m_s2: float  # downwards; upwards too where `accel_up_m_s2` is not given
    accel_up_m_s2: float | None = None
    jerk_m_s3: float = QUICK_M_S3
    law: Law = Law.STEADY

    @property
    def lift_m_s2(self) -> float:
        up_m_s2 = self.accel_up_m_s2
        return self.accel_vertical_m_s2 if up_m_s2 is None else up_m_s2


def slowed(v_ned: Vec3, limits: MotionLimits, top_m_s: float) -> Vec3:
    """The velocity of a moving goal, as fast as the vehicle can ever go after it."""
    n, e, d = v_ned
    flat = sqrt(n * n + e * e)
    scale = top_m_s / flat if flat > top_m_s else 1.0
    return (n * scale, e * scale, min(limits.descend_m_s, max(-limits.climb_m_s, d)))


def approach_speed(distance_m: float, accel_m_s2: float, approach_p: float) -> float:
    """The speed at `distance_m` from a goal from which one can still stop there.

    sqrt(2 a d) far away, proportional to the distance near by, and smooth where they meet.
    """
    near = accel_m_s2 / (approach_p * approach_p)
    return (
        approach_p * distance_m
        if distance_m <= near
        else sqrt(2.0 * accel_m_s2 * (distance_m - 0.5 * near))
    )


def approach_fall(speed_m_s: float, accel_m_s2: float, approach_p: float) -> float:
    """How much slower `approach_speed` is a metre nearer, where it is `speed_m_s` [1/s]."""
    near = approach_p * speed_m_s <= accel_m_s2
    return approach_p if near else accel_m_s2 / speed_m_s


def speed_by_jerk(distance_m: float, accel_m_s2: float, jerk_m_s3: float) -> float:
    """PX4's speed at `distance_m` from a goal (`computeMaxSpeedFromDistance`, by memory): one that
    it can still brake after the acceleration has been reversed at that jerk."""
    half = 2.0 * accel_m_s2 * accel_m_s2 / jerk_m_s3
    more = 2.0 * accel_m_s2 * distance_m
    # Not the root less `half`: for a small distance that is zero, and a leg would wait for ever.
    return more / (sqrt(half * half + more) + half)


def stopping_point(f: Flight, est: Estimated, limits: MotionLimits) -> Vec3:
    """Where the reference stands still if it brakes from now on [m, NED]."""
    vn, ve, vd = f.ref_vel_n, f.ref_vel_e, f.ref_vel_d
    if f.direct:
        vn, ve, vd = est.vel_n, est.vel_e, est.vel_d
    flat = sqrt(vn * vn + ve * ve)
    if f.brakes_by_jerk:
        brake = limits.accel_vertical_m_s2 if vd > 0.0 else limits.lift_m_s2
        lead = flat / (2.0 * limits.accel_m_s2) + _BRAKE_REACT_S
        lead_d = abs(vd) / (2.0 * brake) + _BRAKE_REACT_S
        return (f.ref_n + vn * lead, f.ref_e + ve * lead, f.ref_d + vd * lead_d)
    lead = flat / (2.0 * f.brake_share * limits.accel_m_s2) + 0.5 / f.approach_p
    brake = limits.lift_m_s2 if vd > 0.0 else limits.accel_vertical_m_s2
    lead_d = abs(vd) / (2.0 * f.brake_share * brake) + 0.5 / f.approach_p_d
    return (f.ref_n + vn * lead, f.ref_e + ve * lead, f.ref_d + vd * lead_d)


def move_goal(f: Flight, dt_s: float) -> None:
    """A goal that moves: along a line, or round a centre.

    The turn is a Cayley map, which keeps the radius exactly; its angle is wrong by t^3 / 12.
    """
    t = 0.5 * f.turn_rad_s * dt_s
    whole = 1.0 / (1.0 + t * t)
    c = (1.0 - t * t) * whole
    s = 2.0 * t * whole
    n = f.goal_n - f.centre_n
    e = f.goal_e - f.centre_e
    turns = f.turn_rad_s != 0.0
    moves = f.horizontal == TO
    out_n = c * n - s * e
    out_e = s * n + c * e
    vel_n = -f.turn_rad_s * out_e if turns else f.goal_vel_n
    vel_e = f.turn_rad_s * out_n if turns else f.goal_vel_e
    f.goal_n = f.centre_n + out_n if turns else f.goal_n + (vel_n * dt_s if moves else 0.0)
    f.goal_e = f.centre_e + out_e if turns else f.goal_e + (vel_e * dt_s if moves else 0.0)
    f.goal_d += f.goal_vel_d * dt_s if f.vertical == TO else 0.0
    f.goal_vel_n = vel_n
    f.goal_vel_e = vel_e


def move_reference(f: Flight, est: Estimated, dt_s: float) -> None:
    """Move the reference on by `dt_s`, pulled by the demand."""
    to_flat = f.horizontal == TO
    to_down = f.vertical == TO
    free_flat = f.horizontal >= ACCELERATE
    free_down = f.vertical >= ACCELERATE
    # After a jump of the estimate the reference begins anew where the vehicle is said to be.
    direct = f.direct
    anew = f.resets != est.resets or direct
    f.resets = est.resets
    ref_n = est.pos_n if anew else f.ref_n
    ref_e = est.pos_e if anew else f.ref_e
    ref_d = est.pos_d if anew or f.height_free else f.ref_d

    # Towards a goal: as fast as one can still stop there.
    dn = f.goal_n - ref_n
    de = f.goal_e - ref_e
    dd = f.goal_d - ref_d
    flat = sqrt(dn * dn + de * de)
    drop = dd if dd >= 0.0 else -dd
    vn = f.ref_vel_n
    ve = f.ref_vel_e
    vd = f.ref_vel_d
    top = f.speed_m_s
    accel = f.accel_m_s2
    accel_d = f.accel_vertical_m_s2
    accel_up = f.accel_up_m_s2
    jerk = f.jerk_m_s3
    slow = f.brakes_by_jerk
    speed = (
        f.kp_pos_xy * flat
        if direct
        else speed_by_jerk(flat, accel, jerk)
        if slow
        else approach_speed(flat, f.brake_share * accel, f.approach_p)
    )
    # With the braking fed forward: less by what the plan slows down while that is taken up.
    ahead = f.brakes_ahead
    nears = ((vn - f.goal_vel_n) * dn + (ve - f.goal_vel_e) * de) / flat if flat > 0.0 else 0.0
    fall = approach_fall(speed, f.brake_share * accel, f.approach_p)
    led = speed - fall * nears / f.sharpness if ahead and nears > 0.0 else speed
    led = top if led > top else -top if led < -top else led
    speed = top if speed > top else speed
    brake = f.brake_share * (accel_up if dd > 0.0 else accel_d)
    rise = (
        f.kp_pos_z * drop
        if direct
        else speed_by_jerk(drop, accel_d if dd > 0.0 else accel_up, jerk)
        if slow
        else approach_speed(drop, brake, f.approach_p_d)
    )
    cap = f.descend_m_s if dd > 0.0 else f.climb_m_s
    nears = vd - f.goal_vel_d if dd > 0.0 else f.goal_vel_d - vd
    fall = approach_fall(rise, brake, f.approach_p_d)
    led_d = rise - fall * nears / f.sharpness_d if ahead and nears > 0.0 else rise
    led_d = cap if led_d > cap else -cap if led_d < -cap else led_d
    rise = cap if rise > cap else rise
    # On a line the faster of the horizontal and the vertical motion waits for the slower.
    line = f.straight and to_flat and to_down and flat > 0.0 and drop > 0.0
    flat_waits = line and flat * rise < drop * speed
    down_waits = line and not flat_waits
    led = flat * rise / drop if flat_waits else led
    led_d = drop * speed / flat if down_waits else led_d
    scale = led / flat if flat > 0.0 else 0.0

    # At a velocity: the one that is asked for, within the limits.
    ask_n = f.goal_vel_n
    ask_e = f.goal_vel_e
    ask_d = f.goal_vel_d
    ask = sqrt(ask_n * ask_n + ask_e * ask_e)
    bound = top / ask if ask > top else 1.0
    fall = f.descend_m_s
    climb = -f.climb_m_s
    ask_bound = fall if ask_d > fall else climb if ask_d < climb else ask_d

    want_n = ask_n + dn * scale if to_flat else ask_n * bound
    want_e = ask_e + de * scale if to_flat else ask_e * bound
    want_d = ask_d + (led_d if dd > 0.0 else -led_d) if to_down else ask_bound

    # The acceleration that takes it up; round a centre, with what bends the path.
    turns = f.turn_rad_s != 0.0
    bend = f.turn_rad_s * f.turn_rad_s
    sharp = f.sharpness
    an = sharp * (want_n - vn) - bend * (f.goal_n - f.centre_n)
    ae = sharp * (want_e - ve) - bend * (f.goal_e - f.centre_e)
    ad = f.sharpness_d * (want_d - vd)
    # No more than can be taken back, at the jerk, by the time the velocity is there.
    unwind = 2.0 * _UNWIND_SHARE / sharp * jerk
    size = sqrt(an * an + ae * ae)
    most = sqrt(unwind * size) if size > unwind and not turns else size
    most = accel if most > accel else most
    scale = most / size if size > most else 1.0
    an = 0.0 if free_flat else an * scale
    ae = 0.0 if free_flat else ae * scale
    unwind = 2.0 * _UNWIND_SHARE / f.sharpness_d * jerk
    ad = sqrt(unwind * ad) if ad > unwind else -sqrt(-unwind * ad) if -ad > unwind else ad
    ad = 0.0 if free_down else accel_d if ad > accel_d else -accel_up if ad < -accel_up else ad
    jn = an - f.ref_acc_n
    je = ae - f.ref_acc_e
    jd = ad - f.ref_acc_d
    size = sqrt(jn * jn + je * je + jd * jd)
    most = jerk * dt_s
    scale = most / size if size > most else 1.0
    an = 0.0 if free_flat else f.ref_acc_n + jn * scale
    ae = 0.0 if free_flat else f.ref_acc_e + je * scale
    ad = 0.0 if free_down else f.ref_acc_d + jd * scale

    # Time waits for a vehicle that is left behind: 1 when it follows, towards 0 when not.  For one
    # that is ahead it must go on: the vehicle would come to rest there, and wait for the reference.
    ln = ref_n - est.pos_n
    le = ref_e - est.pos_e
    ld = ref_d - est.pos_d
    lead = sqrt((0.0 if free_flat else ln * ln + le * le) + (0.0 if free_down else ld * ld))
    behind = (0.0 if free_flat else ln * vn + le * ve) + (0.0 if free_down else ld * vd)
    rest = (f.lead_max_m - lead) / (f.lead_max_m * (1.0 - _LEAD_FREE))
    rest = 1.0 if rest > 1.0 or behind < 0.0 else 0.0 if rest < 0.0 else rest
    half = 0.5 * rest * dt_s
    new_n = vn + an * dt_s
    new_e = ve + ae * dt_s
    new_d = vd + ad * dt_s
    # A demanded velocity is no demand to catch up: what was left behind is forgotten on the way.
    lost = _FORGET_P * dt_s if f.horizontal == AT_VELOCITY and ask > 0.0 else 0.0
    # Where the motion is not controlled the reference goes along, ready to take over.
    free_flat = free_flat or direct
    free_down = free_down or direct
    f.ref_n = est.pos_n if free_flat else ref_n + (vn + new_n) * half - lost * ln
    f.ref_e = est.pos_e if free_flat else ref_e + (ve + new_e) * half - lost * le
    f.ref_d = est.pos_d if free_down else ref_d + (vd + new_d) * half
    f.ref_vel_n = want_n if direct else est.vel_n if free_flat else new_n
    f.ref_vel_e = want_e if direct else est.vel_e if free_flat else new_e
    f.ref_vel_d = want_d if direct else est.vel_d if free_down else new_d
    f.ref_acc_n = 0.0 if direct else an
    f.ref_acc_e = 0.0 if direct else ae
    f.ref_acc_d = 0.0 if direct else ad
