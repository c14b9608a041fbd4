"""What the autopilot believes of the airframe: as the data sheets say, whatever really flies."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_sim.plant.airframe import Airframe
from vehicle_sim.plant.battery import FULL_CELL_V


@dataclass(frozen=True, slots=True)
class Believed:
    """Constants of the control loops and of all that decides, for steps of `dt_s`.

    Those of the TOML have its names.  The physics has its own (`plant/constants.py`): payload, a
    weak battery or a wrong thrust curve change the plant, and nothing here.  `full_v` is the
    voltage of the full battery.
    """

    dt_s: float
    mass_kg: float
    inertia_xx_kg_m2: float
    inertia_yy_kg_m2: float
    inertia_zz_kg_m2: float
    drag_n_per_m2_s2: float
    arm_forward_m: float
    arm_right_m: float
    thrust_max_n: float
    torque_per_thrust_m: float
    rotor_drag_n_s_per_m: float
    motor_time_constant_s: float
    idle: float
    cells: float
    full_v: float
    resistance_ohm: float


def believed_of(airframe: Airframe, dt_s: float) -> Believed:
    """What the data sheets of `airframe` say, for steps of `dt_s`."""
    body, motors, pack = airframe.body, airframe.motors, airframe.battery
    return Believed(
        dt_s=dt_s,
        mass_kg=body.mass_kg,
        inertia_xx_kg_m2=body.inertia_xx_kg_m2,
        inertia_yy_kg_m2=body.inertia_yy_kg_m2,
        inertia_zz_kg_m2=body.inertia_zz_kg_m2,
        drag_n_per_m2_s2=body.drag_n_per_m2_s2,
        arm_forward_m=motors.arm_forward_m,
        arm_right_m=motors.arm_right_m,
        thrust_max_n=motors.thrust_max_n,
        torque_per_thrust_m=motors.torque_per_thrust_m,
        rotor_drag_n_s_per_m=motors.rotor_drag_n_s_per_m,
        motor_time_constant_s=motors.time_constant_s,
        idle=motors.idle,
        cells=pack.cells,
        full_v=pack.cells * FULL_CELL_V,
        resistance_ohm=pack.resistance_ohm,
    )
