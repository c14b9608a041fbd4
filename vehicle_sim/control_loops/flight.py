"""What one vehicle is asked to fly, and how far its controllers have come with it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

# How the horizontal and the vertical motion are demanded.
TO: Final = 0.0  # a goal, which may move
AT_VELOCITY: Final = 1.0
ACCELERATE: Final = 2.0  # as it is, without feedback
THRUST: Final = 3.0  # vertical only: a part of full throttle

# Where the attitude comes from.
BY_MOTION: Final = 0.0  # whatever the demanded motion needs
BY_ATTITUDE: Final = 1.0  # `sp_*`, from outside
BY_RATES: Final = 2.0  # `rate_sp_*`, from outside


@dataclass(slots=True)
class Flight:
    """A block (see `numerics/kernel.py`); guidance and control write it, decisions its demands.

    Metres, m/s, m/s^2 in local NED; radians; `rate_*` in rad/s, FRD; collective in newtons.
    """

    # Demand: what the decisions ask for.
    flying: bool = False  # else all motors turn at `idle`, uncontrolled
    idle: float = 0.0  # 0..1 of full speed
    horizontal: float = TO
    vertical: float = TO
    attitude: float = BY_MOTION
    straight: bool = False  # horizontal and vertical motion arrive together
    height_free: bool = False  # a vertical velocity is flown, without a height to catch up with
    direct: bool = False  # the loops fly what is asked as it is, without a reference that shapes it
    goal_n: float = 0.0
    goal_e: float = 0.0
    goal_d: float = 0.0
    goal_vel_n: float = 0.0  # of the goal, or the velocity itself (AT_VELOCITY)
    goal_vel_e: float = 0.0
    goal_vel_d: float = 0.0
    turn_rad_s: float = 0.0  # the goal goes round the centre, positive = clockwise from above
    centre_n: float = 0.0
    centre_e: float = 0.0
    acc_n: float = 0.0
    acc_e: float = 0.0
    acc_d: float = 0.0
    thrust: float = 0.0  # 0..1
    rate_sp_x: float = 0.0
    rate_sp_y: float = 0.0
    rate_sp_z: float = 0.0
    # Limits, set with each demand.
    speed_m_s: float = 5.0
    climb_m_s: float = 3.0
    descend_m_s: float = 1.0
    accel_m_s2: float = 3.0
    accel_vertical_m_s2: float = 3.0  # downwards
    accel_up_m_s2: float = 3.0
    # Heading: the setpoint, what is left of a turn, and how fast it may go.
    yaw_rad: float = 0.0
    yaw_left_rad: float = 0.0
    yaw_most_rad_s: float = 1.0
    yaw_spin_rad_s: float = 0.0  # a turn without an end
    yaw_rate_rad_s: float = 0.0  # of the setpoint now, fed forward
    # Reference: the motion that is flown now (see `trajectory.py`).
    ref_n: float = 0.0
    ref_e: float = 0.0
    ref_d: float = 0.0
    ref_vel_n: float = 0.0
    ref_vel_e: float = 0.0
    ref_vel_d: float = 0.0
    ref_acc_n: float = 0.0
    ref_acc_e: float = 0.0
    ref_acc_d: float = 0.0
    resets: int = 0  # of the estimate that the reference has gone along with
    # Cascade: integrators, attitude setpoint (FRD to NED) and collective.
    int_n: float = 0.0
    int_e: float = 0.0
    int_d: float = 0.0
    sp_w: float = 1.0
    sp_x: float = 0.0
    sp_y: float = 0.0
    sp_z: float = 0.0
    collective_n: float = 0.0
    load: float = 1.0  # learnt: newtons asked for a newton of the believed weight, in hover
    floor_d: float = 0.0  # where it stood last
    int_roll_n: float = 0.0  # of the rate loops, in each motor's share of thrust
    int_pitch_n: float = 0.0
    int_yaw_n: float = 0.0
    rate_slow_x: float = 0.0  # behind the filter of the D-term
    rate_slow_y: float = 0.0
    still_s: float = 0.0  # how long the land detector has believed in ground
    strength_inv: float = 1.0  # full battery voltage over the measured one
    u1: float = 0.0  # motor commands, 0..1
    u2: float = 0.0
    u3: float = 0.0
    u4: float = 0.0
    # Gains and bounds, from the airframe (`cascade.tune`) and from parameters.
    kp_pos_xy: float = 1.0
    kp_pos_z: float = 1.0
    kp_vel_xy: float = 2.5
    kp_vel_z: float = 2.5
    ki_vel_xy: float = 0.6
    ki_vel_z: float = 0.3
    kp_roll: float = 9.0
    kp_pitch: float = 9.0
    kp_yaw: float = 2.0
    kp_rate_roll: float = 22.0
    kp_rate_pitch: float = 22.0
    kp_rate_yaw: float = 6.0
    # Integral over proportional gain, 1/s: PX4's MC_ROLLRATE_I over MC_ROLLRATE_P.
    ki_rate_roll: float = 1.33
    ki_rate_pitch: float = 1.33
    ki_rate_yaw: float = 0.3
    kd_rate_roll: float = 0.005  # derivative over proportional gain, s
    kd_rate_pitch: float = 0.005
    roll_rate_max_rad_s: float = 3.8
    pitch_rate_max_rad_s: float = 3.8
    yaw_rate_max_rad_s: float = 1.6
    land_share: float = 0.7  # of hover: with less in a descent it may stand on the ground
    tilt_max: float = 0.7  # tangent
    jerk_m_s3: float = 30.0
    # Of the reference (see `trajectory.Law`), 1/s, horizontally and vertically: near the goal the
    # speed is `approach_p` of the distance, the acceleration `sharpness` of the missing velocity.
    approach_p: float = 1.5
    approach_p_d: float = 1.5
    sharpness: float = 5.0
    sharpness_d: float = 5.0
    brake_share: float = 0.6  # of the acceleration is planned for braking, the rest is for the lag
    brakes_by_jerk: bool = False  # plans a stop with that jerk, as PX4's own flights do
    brakes_ahead: bool = False  # feeds the planned braking forward, as ArduCopter's own flights do
    lead_max_m: float = 4.0  # so far ahead of the vehicle the reference stands and waits
