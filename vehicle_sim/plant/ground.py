"""The ground: a plane that four feet stand on, as springs, dampers and friction."""

from __future__ import annotations

from math import sqrt
from typing import TypeAlias

from vehicle_sim.plant.body import Body
from vehicle_sim.plant.constants import Plant

Push: TypeAlias = tuple[float, float, float, float, float, float]
"""Force north, east, down [N] and torque about body x, y, z [N m]."""


def stand(body: Body, plant: Plant) -> Push:
    """What the ground does to `body` in this step.

    Feet are numbered and placed as the motors are: 1 (+,+), 2 (-,-), 3 (+,-), 4 (-,+).  A foot at
    (+-x, +-y, z) is the sum of three columns of the rotation matrix, and so is its velocity:
    v + R (w x foot).  The sums are paired, so that mirrored feet give exactly mirrored pushes.
    """
    qw = body.qw
    qx = body.qx
    qy = body.qy
    qz = body.qz
    r11 = 1.0 - 2.0 * (qy * qy + qz * qz)
    r12 = 2.0 * (qx * qy - qw * qz)
    r13 = 2.0 * (qx * qz + qw * qy)
    r21 = 2.0 * (qx * qy + qw * qz)
    r22 = 1.0 - 2.0 * (qx * qx + qz * qz)
    r23 = 2.0 * (qy * qz - qw * qx)
    r31 = 2.0 * (qx * qz - qw * qy)
    r32 = 2.0 * (qy * qz + qw * qx)
    r33 = 1.0 - 2.0 * (qx * qx + qy * qy)
    x = plant.foot_forward_m
    y = plant.foot_right_m
    # Turned over, it lies on its propellers.
    z = plant.foot_down_m if r33 > 0.0 else -plant.top_up_m
    p = body.rate_x
    q = body.rate_y
    r = body.rate_z
    # What the foot's place along body x, y and z adds to its velocity.
    x_n = x * (r12 * r - r13 * q)
    x_e = x * (r22 * r - r23 * q)
    x_d = x * (r32 * r - r33 * q)
    y_n = y * (r13 * p - r11 * r)
    y_e = y * (r23 * p - r21 * r)
    y_d = y * (r33 * p - r31 * r)
    v_n = body.vel_n + z * (r11 * q - r12 * p)
    v_e = body.vel_e + z * (r21 * q - r22 * p)
    v_d = body.vel_d + z * (r31 * q - r32 * p)
    depth = body.pos_d + z * r33 - plant.plane_d_m
    fore = x * r31
    side = y * r32
    depth_1 = depth + fore + side
    depth_2 = depth - fore - side
    depth_3 = depth + fore - side
    depth_4 = depth - fore + side
    n1, e1, d1, body.grip_n1, body.grip_e1 = _foot(
        depth_1,
        v_n + x_n + y_n,
        v_e + x_e + y_e,
        v_d + x_d + y_d,
        body.grip_n1,
        body.grip_e1,
        plant,
    )
    n2, e2, d2, body.grip_n2, body.grip_e2 = _foot(
        depth_2,
        v_n - x_n - y_n,
        v_e - x_e - y_e,
        v_d - x_d - y_d,
        body.grip_n2,
        body.grip_e2,
        plant,
    )
    n3, e3, d3, body.grip_n3, body.grip_e3 = _foot(
        depth_3,
        v_n + x_n - y_n,
        v_e + x_e - y_e,
        v_d + x_d - y_d,
        body.grip_n3,
        body.grip_e3,
        plant,
    )
    n4, e4, d4, body.grip_n4, body.grip_e4 = _foot(
        depth_4,
        v_n - x_n + y_n,
        v_e - x_e + y_e,
        v_d - x_d + y_d,
        body.grip_n4,
        body.grip_e4,
        plant,
    )
    body.touching = depth_1 > 0.0 or depth_2 > 0.0 or depth_3 > 0.0 or depth_4 > 0.0

    front_n = n1 + n3
    front_e = e1 + e3
    front_d = d1 + d3
    rear_n = n2 + n4
    rear_e = e2 + e4
    rear_d = d2 + d4
    lever_n = front_n - rear_n
    lever_e = front_e - rear_e
    lever_d = front_d - rear_d
    sway_n = (n1 + n4) - (n2 + n3)
    sway_e = (e1 + e4) - (e2 + e3)
    sway_d = (d1 + d4) - (d2 + d3)
    sum_n = front_n + rear_n
    sum_e = front_e + rear_e
    sum_d = front_d + rear_d
    # To the body frame (R transposed), then foot x force.
    sum_x = r11 * sum_n + r21 * sum_e + r31 * sum_d
    sum_y = r12 * sum_n + r22 * sum_e + r32 * sum_d
    return (
        sum_n,
        sum_e,
        sum_d,
        y * (r13 * sway_n + r23 * sway_e + r33 * sway_d) - z * sum_y,
        z * sum_x - x * (r13 * lever_n + r23 * lever_e + r33 * lever_d),
        x * (r12 * lever_n + r22 * lever_e + r32 * lever_d)
        - y * (r11 * sway_n + r21 * sway_e + r31 * sway_d),
    )


def _foot(
    depth: float,
    v_n: float,
    v_e: float,
    v_d: float,
    grip_n: float,
    grip_e: float,
    plant: Plant,
) -> tuple[float, float, float, float, float]:
    """Force on one foot [N, NED], and how far its friction is stretched now [m].

    Upwards a spring and a damper that cannot pull.  Sideways a spring and a damper that slip
    where Coulomb's law gives way (Cundall and Strack, Geotechnique 29, 1979): so a vehicle stands
    where it stands, also in a wind, and slides with mu N.
    """
    stiffness = plant.stiffness_n_per_m
    damping = plant.damping_n_s_per_m
    load = stiffness * depth + damping * v_d
    loaded = depth > 0.0 and load > 0.0
    load = load if loaded else 0.0
    dt_s = plant.dt_s
    grip_n = grip_n + v_n * dt_s
    grip_e = grip_e + v_e * dt_s
    pull_n = stiffness * grip_n + damping * v_n
    pull_e = stiffness * grip_e + damping * v_e
    pull = sqrt(pull_n * pull_n + pull_e * pull_e)
    hold = plant.friction * load
    slips = pull > hold
    part = hold / (pull if slips else 1.0) if slips else 1.0
    return (
        -pull_n * part if loaded else 0.0,
        -pull_e * part if loaded else 0.0,
        -load,
        grip_n * part if loaded else 0.0,
        grip_e * part if loaded else 0.0,
    )
