"""What the autopilot believes of the airframe: as the data sheets say, whatever really flies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.plant.airframe import Airframe
from vehicle_sim.plant.battery import FULL_CELL_V

D_FILTER_S: Final = 0.0053
"""Of the rate loops' D-term: 30 Hz, as PX4's IMU_DGYRO_CUTOFF."""
# Of a motor's thrust in hover, for each axis: a motor at 0.4 takes 0.15 and a centre of mass 2 cm
# off its place 0.11; with more a vehicle that has lost a motor flies on, spinning, and bounces.
_INTEGRAL_SHARE: Final = 0.2
_YAW_SHARE: Final = 0.6  # of what hover can give: propellers turn a quadrotor weakly


@dataclass(frozen=True, slots=True)
class Believed:
    """Constants of the control loops and of all that decides, for steps of `dt_s`.

    Those of the TOML have its names.  The physics has its own (`plant/constants.py`): payload, a
    weak battery or a wrong thrust curve change the plant, and nothing here.  `full_v` is the
    voltage of the full battery.

    Of the four motors, each: `hover_n` is its thrust in hover, `roll_n_s2`, `pitch_n_s2` and
    `yaw_n_s2` the change of its thrust for an angular acceleration [N per rad/s^2]; for yaw it may
    always change by `yaw_most_n`, and by what an axis' integrator has learnt by
    `integral_most_n`.  `d_filter_part` is the D-term's filter's part of a new sample.
    """

    dt_s: float
    mass_kg: float
    drag_n_per_m2_s2: float
    roll_n_s2: float
    pitch_n_s2: float
    yaw_n_s2: float
    hover_n: float
    yaw_most_n: float
    integral_most_n: float
    d_filter_part: float
    thrust_max_n: float
    rotor_drag_n_s_per_m: float
    motor_time_constant_s: float
    idle: float
    cells: float
    full_v: float
    resistance_ohm: float


def believed_of(airframe: Airframe, dt_s: float) -> Believed:
    """What the data sheets of `airframe` say, for steps of `dt_s`."""
    body, motors, pack = airframe.body, airframe.motors, airframe.battery
    hover_n = 0.25 * GRAVITY_M_S2 * body.mass_kg
    return Believed(
        dt_s=dt_s,
        mass_kg=body.mass_kg,
        drag_n_per_m2_s2=body.drag_n_per_m2_s2,
        roll_n_s2=0.25 * body.inertia_xx_kg_m2 / motors.arm_right_m,
        pitch_n_s2=0.25 * body.inertia_yy_kg_m2 / motors.arm_forward_m,
        yaw_n_s2=0.25 * body.inertia_zz_kg_m2 / motors.torque_per_thrust_m,
        hover_n=hover_n,
        yaw_most_n=_YAW_SHARE * hover_n,
        integral_most_n=_INTEGRAL_SHARE * hover_n,
        d_filter_part=dt_s / (D_FILTER_S + dt_s),
        thrust_max_n=motors.thrust_max_n,
        rotor_drag_n_s_per_m=motors.rotor_drag_n_s_per_m,
        motor_time_constant_s=motors.time_constant_s,
        idle=motors.idle,
        cells=pack.cells,
        full_v=pack.cells * FULL_CELL_V,
        resistance_ohm=pack.resistance_ohm,
    )
