"""A sample of a setpoint stream in the operators' words, and in their frame."""

from __future__ import annotations

import math

from gcs import ipc
from gcs.bridge.translate.meaning import Sample
from gcs.frames import Vec3, enu_from_ned
from gcs.gate.attitude import roll_pitch_yaw


def stream_of(sample: Sample) -> ipc.Stream:
    """The same in east, north, up and degrees."""
    if sample.attitude is not None:
        roll, pitch, yaw = map(math.degrees, roll_pitch_yaw(sample.attitude.q_ned_from_frd))
        return ipc.Stream(
            roll_deg=roll,
            pitch_deg=pitch,
            yaw_deg=yaw,
            yaw_rate_deg_s=_degrees(sample.yaw_rate_rad_s),
            thrust=sample.attitude.thrust,
        )
    return ipc.Stream(
        pos_enu=_enu(sample.pos_ned),
        v_enu=_enu(sample.v_ned),
        a_enu=_enu(sample.a_ned),
        yaw_deg=_degrees(sample.yaw_rad),
        yaw_rate_deg_s=_degrees(sample.yaw_rate_rad_s),
    )


def _enu(triple_ned: Vec3 | None) -> ipc.Maybe3 | None:
    """East, north, up; an axis that was left out (NaN) is None."""
    if triple_ned is None:
        return None
    east, north, up = (None if math.isnan(x) else x for x in enu_from_ned(triple_ned))
    return (east, north, up)


def _degrees(angle_rad: float | None) -> float | None:
    return None if angle_rad is None else math.degrees(angle_rad)
