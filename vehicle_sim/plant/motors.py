"""Four motors with propellers: command -> speed (first-order lag) -> thrust and torque."""

from __future__ import annotations

from vehicle_sim.plant.body import Body
from vehicle_sim.plant.constants import Plant


def spin(
    body: Body, u1: float, u2: float, u3: float, u4: float, sink: float, plant: Plant
) -> tuple[float, float, float, float]:
    """One step towards the commands `u` (0..1 of what the battery can turn).

    `sink` [m/s] is the body's speed downwards, along its z axis, through the air.  Returns thrust
    [N, upwards in the body] and torque [N m] about body x, y, z.  Positions in FRD: 1 (+,+) ccw,
    2 (-,-) ccw, 3 (+,-) cw, 4 (-,+) cw.

    A propeller at speed `s` that sinks with v through the air lifts `thrust_max s^2 + inflow s v`:
    climbing costs thrust, and turning is damped, as one side climbs and the other sinks (blade
    element theory for small v: Leishman, Principles of Helicopter Aerodynamics, 3.4).  Its
    reaction torque about the yaw axis is `torque_per_thrust` times the thrust, to the right
    (clockwise from above) for the propellers that turn to the left.

    `health` scales what a propeller lifts, as if it were broken; a dead motor gets no current.
    `thrust_scale` does so for all four: other propellers than those of the data sheet.
    """
    keep = plant.motor_keep
    gain = plant.motor_gain * body.strength
    health_1 = body.health_1
    health_2 = body.health_2
    health_3 = body.health_3
    health_4 = body.health_4
    s1 = keep * body.s1 + gain * (u1 if health_1 > 0.0 else 0.0)
    s2 = keep * body.s2 + gain * (u2 if health_2 > 0.0 else 0.0)
    s3 = keep * body.s3 + gain * (u3 if health_3 > 0.0 else 0.0)
    s4 = keep * body.s4 + gain * (u4 if health_4 > 0.0 else 0.0)
    body.s1 = s1
    body.s2 = s2
    body.s3 = s3
    body.s4 = s4
    scale = body.thrust_scale
    top = scale * plant.thrust_max_n
    inflow = scale * plant.inflow_n_s_per_m
    roll = body.rate_x * plant.arm_right_m
    pitch = body.rate_y * plant.arm_forward_m
    sink_right = sink + roll
    sink_left = sink - roll
    t1 = health_1 * s1 * (top * s1 + inflow * (sink_right - pitch))
    t2 = health_2 * s2 * (top * s2 + inflow * (sink_left + pitch))
    t3 = health_3 * s3 * (top * s3 + inflow * (sink_left - pitch))
    t4 = health_4 * s4 * (top * s4 + inflow * (sink_right + pitch))
    # Each pair is symmetric, so a mirrored command gives an exactly mirrored torque.
    right = t1 + t4
    left = t2 + t3
    front = t1 + t3
    rear = t2 + t4
    return (
        left + right,
        (left - right) * plant.arm_right_m,
        (front - rear) * plant.arm_forward_m,
        ((t1 + t2) - (t3 + t4)) * plant.torque_per_thrust_m,
    )
