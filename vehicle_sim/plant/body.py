"""The state of one quadrotor's body: motion, motors, battery and the air around it."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_sim.numerics.gravity import GRAVITY_M_S2


@dataclass(slots=True)
class Body:
    """A block (see `kernel.py`); the truth, which only the physics writes.

    `pos` [m] and `vel` [m/s] in local NED; `q` rotates FRD to NED; `rate` [rad/s] in FRD; `sf`
    [m/s^2, NED] is the specific force of the last step, what an ideal accelerometer feels.
    `s1 .. s4` are the motors' speeds (0..1 of full speed), `health_*` what is left of each motor's
    thrust (1 = sound, 0 = dead).  `touching` says that a foot is on the ground; `grip_*` [m, NED]
    is how far friction is stretched under each foot.

    The air, all in m/s, NED: `wind` is the steady wind that is wanted, `flow` what it has come to
    (it follows within some `wind_rise_s`), `gust` the turbulence, `air` the sum that blows.
    """

    pos_n: float = 0.0
    pos_e: float = 0.0
    pos_d: float = 0.0
    vel_n: float = 0.0
    vel_e: float = 0.0
    vel_d: float = 0.0
    qw: float = 1.0
    qx: float = 0.0
    qy: float = 0.0
    qz: float = 0.0
    rate_x: float = 0.0
    rate_y: float = 0.0
    rate_z: float = 0.0
    sf_n: float = 0.0
    sf_e: float = 0.0
    sf_d: float = -GRAVITY_M_S2
    s1: float = 0.0
    s2: float = 0.0
    s3: float = 0.0
    s4: float = 0.0
    health_1: float = 1.0
    health_2: float = 1.0
    health_3: float = 1.0
    health_4: float = 1.0
    # In what the plant differs from its data sheets, as faults make it.
    payload_kg: float = 0.0  # carried at the centre, without an inertia of its own
    mass_off_x: float = 0.0  # of the centre of mass from the rotors' centre, FRD, metres
    mass_off_y: float = 0.0
    inertia_scale: float = 1.0
    thrust_scale: float = 1.0
    resistance_scale: float = 1.0
    capacity_scale: float = 1.0
    touching: bool = False
    grip_n1: float = 0.0
    grip_e1: float = 0.0
    grip_n2: float = 0.0
    grip_e2: float = 0.0
    grip_n3: float = 0.0
    grip_e3: float = 0.0
    grip_n4: float = 0.0
    grip_e4: float = 0.0
    consumed_mah: float = 0.0
    current_a: float = 0.0
    voltage_v: float = 0.0
    strength: float = 1.0  # voltage over the full battery's
    remaining: float = 1.0  # charge left, 0..1
    cells_lost: float = 0.0
    wind_n: float = 0.0
    wind_e: float = 0.0
    wind_d: float = 0.0
    wind_rise_s: float = 1.0
    flow_n: float = 0.0
    flow_e: float = 0.0
    flow_d: float = 0.0
    gust_n: float = 0.0
    gust_e: float = 0.0
    gust_d: float = 0.0
    gust_m_s: float = 0.0  # standard deviation of the horizontal turbulence, 0 = smooth air
    gust_key: int = 0
    air_n: float = 0.0
    air_e: float = 0.0
    air_d: float = 0.0
