"""The one place where a SET_POSITION_TARGET is made; it needs the gate's permit (invariant 1)."""

from __future__ import annotations

import math

from gcs.gate.permit import Permit
from gcs.session.telemetry import Telemetry
from gcs.wire.ids import MavFrame, TypeMask
from gcs.wire.messages import SetPositionTargetLocalNed

POSITION_ONLY = (
    TypeMask.VX_IGNORE
    | TypeMask.VY_IGNORE
    | TypeMask.VZ_IGNORE
    | TypeMask.AX_IGNORE
    | TypeMask.AY_IGNORE
    | TypeMask.AZ_IGNORE
    | TypeMask.YAW_IGNORE
    | TypeMask.YAW_RATE_IGNORE
)
"""3576: set bits mean "ignore"; heading is left to the autopilot."""
POSITION_AND_YAW = POSITION_ONLY & ~TypeMask.YAW_IGNORE
"""2552."""


def setpoint(
    telemetry: Telemetry, permit: Permit, start_ns: int, now_ns: int
) -> SetPositionTargetLocalNed:
    """SET_POSITION_TARGET_LOCAL_NED with the permit's position and, if it has one, yaw.

    `start_ns` is when the session began: `time_boot_ms` counts from there.  Raises
    PermissionError for a permit of another moment or without a finite position.
    """
    pos_ned, yaw_rad = permit.pos_ned, permit.yaw_rad
    if pos_ned is None or permit.issued_ns != now_ns or not all(map(math.isfinite, pos_ned)):
        raise PermissionError("a setpoint needs a permit of this very moment, with a position")
    return SetPositionTargetLocalNed(
        time_boot_ms=(now_ns - start_ns) // 1_000_000 & 0xFFFFFFFF,
        x=pos_ned[0],
        y=pos_ned[1],
        z=pos_ned[2],
        vx=0.0,
        vy=0.0,
        vz=0.0,
        afx=0.0,
        afy=0.0,
        afz=0.0,
        yaw=0.0 if yaw_rad is None else yaw_rad,
        yaw_rate=0.0,
        type_mask=POSITION_ONLY if yaw_rad is None else POSITION_AND_YAW,
        target_system=telemetry.sysid,
        target_component=telemetry.compid,
        coordinate_frame=MavFrame.LOCAL_NED,
    )
