"""An airframe as the kernels see it: numbers only, the same for all vehicles of a world."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import Final

from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.plant.airframe import Airframe, AirframeError

_MARGIN_M: Final = 1e-3
_TURN_MAX_RAD: Final = 0.25


@dataclass(frozen=True, slots=True)
class Plant:
    """Constants of the physics and of the control loops, for steps of `dt_s`.

    Those of the TOML have its names.  `couple_*` are the factors of Euler's equations, such as
    (Iyy - Izz) / Ixx; `rate_max_rad_s` is the fastest turning that steps of `dt_s` can follow,
    about twice what a gyroscope measures.  `motor_keep` is how much of its speed a motor keeps
    over a step.  The ground is the plane down = `plane_d_m`; above `near_ground_d_m` no foot can
    reach it.
    """

    dt_s: float
    mass_kg: float
    inertia_xx_kg_m2: float
    inertia_yy_kg_m2: float
    inertia_zz_kg_m2: float
    couple_x: float
    couple_y: float
    couple_z: float
    rate_max_rad_s: float
    drag_n_per_m2_s2: float
    arm_forward_m: float
    arm_right_m: float
    arm_squared_m2: float
    thrust_max_n: float
    torque_per_thrust_m: float
    rotor_drag_n_s_per_m: float
    inflow_n_s_per_m: float
    motor_time_constant_s: float
    motor_keep: float
    motor_gain: float
    idle: float
    foot_forward_m: float
    foot_right_m: float
    foot_down_m: float
    top_up_m: float
    stiffness_n_per_m: float
    damping_n_s_per_m: float
    friction: float
    plane_d_m: float
    near_ground_d_m: float
    cells: float
    capacity_mah: float
    resistance_ohm: float
    idle_current_a: float
    motor_current_max_a: float


def plant_of(airframe: Airframe, dt_s: float) -> Plant:
    """What `airframe` means for steps of `dt_s`.  Raises AirframeError where they are too long.

    Local height is measured at the centre of mass, as an estimator does, and is 0 at rest on the
    ground: so the plane lies as deep as the feet, less what the springs give under the weight.
    """
    body, motors, gear, pack = airframe.body, airframe.motors, airframe.gear, airframe.battery
    ixx, iyy, izz = body.inertia_xx_kg_m2, body.inertia_yy_kg_m2, body.inertia_zz_kg_m2
    tau = motors.time_constant_s
    # The bilinear form of exp(-dt/tau): arithmetic only, the same on every machine.
    keep = (2.0 * tau - dt_s) / (2.0 * tau + dt_s)
    x, y, z = gear.foot_forward_m, gear.foot_right_m, gear.height_m
    tallest = z if z > gear.top_m else gear.top_m
    reach_m = sqrt(x * x + y * y + tallest * tallest)
    _check_steps(airframe, dt_s, reach_m)
    plane_d_m = z - body.mass_kg * GRAVITY_M_S2 / (4.0 * gear.stiffness_n_per_m)
    return Plant(
        dt_s=dt_s,
        mass_kg=body.mass_kg,
        inertia_xx_kg_m2=ixx,
        inertia_yy_kg_m2=iyy,
        inertia_zz_kg_m2=izz,
        couple_x=(iyy - izz) / ixx,
        couple_y=(izz - ixx) / iyy,
        couple_z=(ixx - iyy) / izz,
        rate_max_rad_s=_TURN_MAX_RAD / dt_s,
        drag_n_per_m2_s2=body.drag_n_per_m2_s2,
        arm_forward_m=motors.arm_forward_m,
        arm_right_m=motors.arm_right_m,
        arm_squared_m2=motors.arm_forward_m * motors.arm_forward_m
        + motors.arm_right_m * motors.arm_right_m,
        thrust_max_n=motors.thrust_max_n,
        torque_per_thrust_m=motors.torque_per_thrust_m,
        rotor_drag_n_s_per_m=motors.rotor_drag_n_s_per_m,
        inflow_n_s_per_m=motors.inflow_n_s_per_m,
        motor_time_constant_s=tau,
        motor_keep=keep,
        motor_gain=1.0 - keep,
        idle=motors.idle,
        foot_forward_m=x,
        foot_right_m=y,
        foot_down_m=z,
        top_up_m=gear.top_m,
        stiffness_n_per_m=gear.stiffness_n_per_m,
        damping_n_s_per_m=gear.damping_n_s_per_m,
        friction=gear.friction,
        plane_d_m=plane_d_m,
        near_ground_d_m=plane_d_m - reach_m - _MARGIN_M,
        cells=pack.cells,
        capacity_mah=pack.capacity_mah,
        resistance_ohm=pack.resistance_ohm,
        idle_current_a=pack.idle_current_a,
        motor_current_max_a=pack.motor_current_max_a,
    )


def _check_steps(airframe: Airframe, dt_s: float, reach_m: float) -> None:
    """Explicit steps follow a motor slower than them and a foot that is neither stiff nor loose:
    a spring-damper of w^2 and c (per mass) is stable for w^2 dt / 2 < c < 2 / dt."""
    body, gear = airframe.body, airframe.gear
    where = f"{airframe.name}: steps of {1e3 * dt_s:g} ms"
    if airframe.motors.time_constant_s < dt_s:
        raise AirframeError(
            f"{where} are too long for [motors] time_constant_s = "
            f"{airframe.motors.time_constant_s:g}; it must be {dt_s:g} or more"
        )
    lightest = 1.0 / body.mass_kg + reach_m * reach_m / min(
        body.inertia_xx_kg_m2, body.inertia_yy_kg_m2, body.inertia_zz_kg_m2
    )
    low, high = gear.stiffness_n_per_m * dt_s / 2.0, 0.5 / (lightest * dt_s)
    if not low < gear.damping_n_s_per_m < high:
        raise AirframeError(
            f"{where} cannot follow [gear] damping_n_s_per_m = {gear.damping_n_s_per_m:g}; with "
            f"this stiffness, mass and inertia it must be between {low:.3g} and {high:.3g}"
        )
