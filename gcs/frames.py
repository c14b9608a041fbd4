"""The one place where the operator's frame meets MAVLink's.

The operator works in `map`: x = east, y = north, z = up (ENU, metres), labelled E N U
everywhere.  MAVLink's MAV_FRAME_LOCAL_NED is x = north, y = east, z = down.  Converting is
a swap of the first two axes and a change of sign; it is exact in IEEE-754, so a round trip
gives the same bits (acceptance test L18).
"""

from __future__ import annotations

import math
import struct

Vec3 = tuple[float, float, float]
"""Three metres (or metres per second) in the frame that the variable's name ends with."""


def ned_from_enu(v_enu: Vec3) -> Vec3:
    """East, north, up -> north, east, down.  Never yields -0.0."""
    east, north, up = v_enu
    return (north, east, 0.0 - up)


def enu_from_ned(v_ned: Vec3) -> Vec3:
    """North, east, down -> east, north, up.  Never yields -0.0."""
    north, east, down = v_ned
    return (east, north, 0.0 - down)


def as_on_the_wire(value: float) -> float:
    """Rounded to float32, as SET_POSITION_TARGET carries it: what is verified is what flies.

    Infinity where the number is larger than that can be.
    """
    try:
        rounded: float = struct.unpack("<f", struct.pack("<f", value))[0]
    except OverflowError:
        return math.inf
    return rounded


def finite_or_nan(triple: tuple[float | None, float | None, float | None]) -> Vec3:
    """JSON has no NaN: null stands for it, and the gate refuses it by name."""
    a, b, c = (math.nan if value is None else as_on_the_wire(value) for value in triple)
    return (a, b, c)


def heading_rad(yaw_deg: float) -> float:
    """Degrees of any number of turns -> -pi .. pi, as the wire carries it."""
    return as_on_the_wire(math.radians(math.remainder(yaw_deg, 360.0)))


def quat_from_euler(
    roll_rad: float, pitch_rad: float, yaw_rad: float
) -> tuple[float, float, float, float]:
    """ATTITUDE's angles (yaw-pitch-roll, NED <- FRD) as w, x, y, z.

    Diebel, "Representing Attitude" (2006), eq. 290 for the 1-2-3 sequence.
    """
    cr, sr = math.cos(roll_rad / 2), math.sin(roll_rad / 2)
    cp, sp = math.cos(pitch_rad / 2), math.sin(pitch_rad / 2)
    cy, sy = math.cos(yaw_rad / 2), math.sin(yaw_rad / 2)
    return (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )
