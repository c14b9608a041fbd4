"""The truth of a vehicle: for tests, for whoever injects faults, for the simulator's own ground.

The only way to a body other than through its sensors.  Nothing that decides may call `motion_of`.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Final

from vehicle_sim.engine.step import Blocks
from vehicle_sim.numerics.vectors import Quat, Vec3
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.faults import ModelFault


@dataclass(frozen=True, slots=True)
class Motion:
    """How the body really moves: metres, m/s in local NED, rad/s in FRD, charge 0..1."""

    pos_ned: Vec3
    v_ned: Vec3
    q_ned_from_frd: Quat
    rates_frd: Vec3
    touching: bool
    charge: float


def motion_of(blocks: Blocks) -> Motion:
    """The state of the body now."""
    b = blocks.body
    return Motion(
        pos_ned=(b.pos_n, b.pos_e, b.pos_d),
        v_ned=(b.vel_n, b.vel_e, b.vel_d),
        q_ned_from_frd=(b.qw, b.qx, b.qy, b.qz),
        rates_frd=(b.rate_x, b.rate_y, b.rate_z),
        touching=b.touching,
        charge=b.remaining,
    )


def inject(fault: ModelFault, blocks: Blocks) -> None:
    """Make the fault true."""
    fault.inject(blocks.body, blocks.sensed)


def put_home(blocks: Blocks) -> None:
    """What stands is set down on its home ground, at rest; what is in the air is left alone.

    Its battery, its faults and the wind stay.
    """
    body = blocks.body
    if not body.touching:
        return
    fresh = Body()
    for name in _AT_REST:
        setattr(body, name, getattr(fresh, name))


_AT_REST: Final = tuple(
    field.name
    for field in fields(Body)
    if field.name.startswith(("pos_", "vel_", "q", "rate_", "sf_", "grip_"))
    or field.name in ("s1", "s2", "s3", "s4", "touching")
)
