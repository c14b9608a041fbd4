"""The whole body of a quadrotor: motors, drag, ground and battery around a rigid body."""

from __future__ import annotations

from math import sqrt

from vehicle_sim.numerics.kernel import anywhere
from vehicle_sim.plant.battery import BATTERY_EVERY, drain, settle
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.constants import Plant
from vehicle_sim.plant.ground import stand
from vehicle_sim.plant.motors import spin
from vehicle_sim.plant.rigid_body import move
from vehicle_sim.plant.wind import WIND_EVERY, blow


def begin(body: Body, gust_key: int, plant: Plant) -> None:
    """Make a fresh block a vehicle on the ground: battery full, wind as it is wanted."""
    body.gust_key = gust_key
    body.current_a = plant.idle_current_a
    settle(body, plant)
    body.flow_n = body.wind_n
    body.flow_e = body.wind_e
    body.flow_d = body.wind_d
    body.air_n = body.wind_n
    body.air_e = body.wind_e
    body.air_d = body.wind_d


def advance(body: Body, u1: float, u2: float, u3: float, u4: float, plant: Plant, k: int) -> None:
    """Step number `k`, of `plant.dt_s`, with the motors commanded to `u` (0..1 of what the
    battery can turn).  The ground is the plane down = 0, where the feet stand.

    Where the centre of mass is not that of the rotors, thrust and ground turn the body: the part of
    both along body z is what weighs, the rest is left out, and so is what moves the sensors.

    Drag is quadratic for the body and linear in the plane of the rotors, whose thrust leans back
    against the flow (Faessler et al., IEEE RA-L 3(2), 2018); both are against the air.
    """
    if k % WIND_EVERY == 0:
        blow(body, plant, k)
    qw = body.qw
    qx = body.qx
    qy = body.qy
    qz = body.qz
    # The image of body z in NED: the third column of R(q).  Thrust acts against it.
    z_n = 2.0 * (qx * qz + qw * qy)
    z_e = 2.0 * (qy * qz - qw * qx)
    z_d = 1.0 - 2.0 * (qx * qx + qy * qy)
    air_n = body.vel_n - body.air_n
    air_e = body.vel_e - body.air_e
    air_d = body.vel_d - body.air_d
    sink = air_n * z_n + air_e * z_e + air_d * z_d
    thrust, torque_x, torque_y, torque_z = spin(body, u1, u2, u3, u4, sink, plant)

    rotors = plant.rotor_drag_n_s_per_m * ((body.s1 + body.s3) + (body.s2 + body.s4))
    drag = rotors + plant.drag_n_per_m2_s2 * sqrt(air_n * air_n + air_e * air_e + air_d * air_d)
    # Along body z the rotors' drag is no drag: it is taken back with the thrust.
    lift = thrust - rotors * sink
    force_n = -lift * z_n - drag * air_n
    force_e = -lift * z_e - drag * air_e
    force_d = -lift * z_d - drag * air_d
    torque_z = torque_z - rotors * plant.arm_squared_m2 * body.rate_z
    off_x = body.mass_off_x
    off_y = body.mass_off_y
    torque_x = torque_x + off_y * thrust
    torque_y = torque_y - off_x * thrust

    if anywhere(body.pos_d > plant.near_ground_d_m or body.touching):
        push_n, push_e, push_d, push_x, push_y, push_z = stand(body, plant)
        press = push_n * z_n + push_e * z_e + push_d * z_d
        push_x = push_x - off_y * press
        push_y = push_y + off_x * press
        # Who does not touch gets the very bytes that it gets alone: x + 0.0 is not always x.
        touching = body.touching
        force_n = force_n + push_n if touching else force_n
        force_e = force_e + push_e if touching else force_e
        force_d = force_d + push_d if touching else force_d
        torque_x = torque_x + push_x if touching else torque_x
        torque_y = torque_y + push_y if touching else torque_y
        torque_z = torque_z + push_z if touching else torque_z
    move(body, force_n, force_e, force_d, torque_x, torque_y, torque_z, plant)

    if k % BATTERY_EVERY == 0:
        drain(body, plant)
