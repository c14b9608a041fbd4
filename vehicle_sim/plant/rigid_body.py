"""A rigid body: six degrees of freedom, quaternion attitude, one step of Newton and Euler.

Only + - * / and sqrt in one written order, so that every IEEE-754 machine computes the same
bits.  Frames: local NED (north, east, down; metres) and body FRD (forward, right, down).
"""

from __future__ import annotations

from math import sqrt

from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.numerics.kernel import anywhere
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.constants import Plant

_MASS_LEAST = 0.25  # of the data sheet's: a negative payload takes no more away


def move(
    body: Body,
    force_n: float,
    force_e: float,
    force_d: float,
    torque_x: float,
    torque_y: float,
    torque_z: float,
    plant: Plant,
) -> None:
    """One step under `force` [N, NED, without gravity] and `torque` [N m, FRD].

    Velocity by Euler; position and attitude with the mean of the old and the new velocity, which
    is exact for constant acceleration and of second order otherwise.  Rates by Euler's equations
    for a diagonal inertia tensor, J w' = t - w x (J w) (Goldstein, Classical Mechanics, 5.39),
    with the gyroscopic term of half a step on: of second order, so that tumbling gains no energy
    worth the name.
    """
    dt_s = plant.dt_s
    half = 0.5 * dt_s
    mass = plant.mass_kg + body.payload_kg
    least = _MASS_LEAST * plant.mass_kg
    mass = mass if mass > least else least
    acc_n = force_n / mass
    acc_e = force_e / mass
    acc_d = force_d / mass
    body.sf_n = acc_n
    body.sf_e = acc_e
    body.sf_d = acc_d
    v_n = body.vel_n
    v_e = body.vel_e
    v_d = body.vel_d
    new_n = v_n + acc_n * dt_s
    new_e = v_e + acc_e * dt_s
    new_d = v_d + (acc_d + GRAVITY_M_S2) * dt_s
    body.pos_n += (v_n + new_n) * half
    body.pos_e += (v_e + new_e) * half
    body.pos_d += (v_d + new_d) * half
    body.vel_n = new_n
    body.vel_e = new_e
    body.vel_d = new_d

    x = body.rate_x
    y = body.rate_y
    z = body.rate_z
    couple_x = plant.couple_x
    couple_y = plant.couple_y
    couple_z = plant.couple_z
    scale = body.inertia_scale
    turn_x = torque_x / (plant.inertia_xx_kg_m2 * scale)
    turn_y = torque_y / (plant.inertia_yy_kg_m2 * scale)
    turn_z = torque_z / (plant.inertia_zz_kg_m2 * scale)
    mid_x = x + (turn_x + couple_x * y * z) * half
    mid_y = y + (turn_y + couple_y * z * x) * half
    mid_z = z + (turn_z + couple_z * x * y) * half
    new_x = x + (turn_x + couple_x * mid_y * mid_z) * dt_s
    new_y = y + (turn_y + couple_y * mid_z * mid_x) * dt_s
    new_z = z + (turn_z + couple_z * mid_x * mid_y) * dt_s
    most = plant.rate_max_rad_s
    size = new_x * new_x + new_y * new_y + new_z * new_z
    fast = size > most * most
    if anywhere(fast):
        # A racer with a motor gone gets there: the air would stop it, and the steps must not burst.
        part = most / sqrt(size if fast else 1.0)
        new_x = new_x * part if fast else new_x
        new_y = new_y * part if fast else new_y
        new_z = new_z * part if fast else new_z
    body.rate_x = new_x
    body.rate_y = new_y
    body.rate_z = new_z

    # q' = q (1, theta / 2), normalised: the turn of a Cayley map, wrong by theta^3 / 12.
    quarter = 0.5 * half
    x = (x + new_x) * quarter
    y = (y + new_y) * quarter
    z = (z + new_z) * quarter
    qw = body.qw
    qx = body.qx
    qy = body.qy
    qz = body.qz
    w1 = qw - qx * x - qy * y - qz * z
    x1 = qx + qw * x + qy * z - qz * y
    y1 = qy + qw * y + qz * x - qx * z
    z1 = qz + qw * z + qx * y - qy * x
    scale = 1.0 / sqrt(w1 * w1 + x1 * x1 + y1 * y1 + z1 * z1)
    body.qw = w1 * scale
    body.qx = x1 * scale
    body.qy = y1 * scale
    body.qz = z1 * scale
