"""The one place where a SET_POSITION_TARGET or SET_ATTITUDE_TARGET is made; it needs the gate's
permit (invariant 1)."""

from __future__ import annotations

import math
from typing import Final

from gcs.frames import Vec3
from gcs.gate.permit import Permit
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import AttitudeMask, MavFrame, TypeMask
from gcs.wire.messages import SetAttitudeTarget, SetPositionTargetLocalNed

POSITION: Final = TypeMask.X_IGNORE | TypeMask.Y_IGNORE | TypeMask.Z_IGNORE
VELOCITY: Final = TypeMask.VX_IGNORE | TypeMask.VY_IGNORE | TypeMask.VZ_IGNORE
ACCELERATION: Final = TypeMask.AX_IGNORE | TypeMask.AY_IGNORE | TypeMask.AZ_IGNORE

BODY_RATES: Final = (
    AttitudeMask.BODY_ROLL_RATE_IGNORE
    | AttitudeMask.BODY_PITCH_RATE_IGNORE
    | AttitudeMask.BODY_YAW_RATE_IGNORE
)

NOTHING: Final[Vec3] = (0.0, 0.0, 0.0)


def type_mask(permit: Permit) -> int:
    """Set bits mean "ignore".  Whole vectors only: ArduCopter ignores one of which it is to ignore
    an axis.  A position alone is 3576, with a yaw 2552; a velocity alone is 3527."""
    mask = 0
    for given, ignore in (
        (permit.pos_ned, POSITION),
        (permit.v_ned, VELOCITY),
        (permit.a_ned, ACCELERATION),
        (permit.yaw_rad, TypeMask.YAW_IGNORE),
        (permit.yaw_rate_rad_s, TypeMask.YAW_RATE_IGNORE),
    ):
        mask |= ignore if given is None else 0
    return mask


def setpoint(
    telemetry: Telemetry, permit: Permit, start_ns: int, now_ns: int
) -> SetPositionTargetLocalNed:
    """SET_POSITION_TARGET_LOCAL_NED with what the permit has of position, velocity, acceleration,
    yaw and yaw rate.

    `start_ns` is when the session began: `time_boot_ms` counts from there.  Raises
    PermissionError for a permit of another moment, with nothing to fly, or with a number that is
    not finite.
    """
    x, y, z = permit.pos_ned or NOTHING
    vx, vy, vz = permit.v_ned or NOTHING
    afx, afy, afz = permit.a_ned or NOTHING
    yaw, yaw_rate = permit.yaw_rad or 0.0, permit.yaw_rate_rad_s or 0.0
    moves = (permit.pos_ned, permit.v_ned, permit.a_ned) != (None, None, None)
    numbers = (x, y, z, vx, vy, vz, afx, afy, afz, yaw, yaw_rate)
    if not moves or permit.issued_ns != now_ns or not all(map(math.isfinite, numbers)):
        raise PermissionError("a setpoint needs a permit of this very moment, with finite numbers")
    return SetPositionTargetLocalNed(
        time_boot_ms=(now_ns - start_ns) // 1_000_000 & 0xFFFFFFFF,
        x=x,
        y=y,
        z=z,
        vx=vx,
        vy=vy,
        vz=vz,
        afx=afx,
        afy=afy,
        afz=afz,
        yaw=yaw,
        yaw_rate=yaw_rate,
        type_mask=type_mask(permit),
        target_system=telemetry.sysid,
        target_component=telemetry.compid,
        coordinate_frame=MavFrame.LOCAL_NED,
    )


def attitude_target(
    telemetry: Telemetry, permit: Permit, start_ns: int, now_ns: int
) -> SetAttitudeTarget:
    """SET_ATTITUDE_TARGET with the permit's attitude, thrust and yaw rate.

    PX4 takes a yaw rate beside an attitude where the rates of roll and pitch are ignored;
    ArduCopter takes all three or none, and stops at any other mask (both from memory).  Raises
    PermissionError as `setpoint` does.
    """
    attitude, rate_rad_s = permit.attitude, permit.yaw_rate_rad_s
    moves = (permit.pos_ned, permit.v_ned, permit.a_ned, permit.yaw_rad) != (None,) * 4
    if attitude is None or moves or permit.issued_ns != now_ns:
        raise PermissionError("an attitude needs a permit of this very moment, for it alone")
    if not all(map(math.isfinite, (*attitude.numbers, rate_rad_s or 0.0))):
        raise PermissionError("an attitude needs finite numbers")
    px4 = telemetry.autopilot.mode_in_two_parts
    with_rate = BODY_RATES & ~AttitudeMask.BODY_YAW_RATE_IGNORE if px4 else 0
    return SetAttitudeTarget(
        time_boot_ms=(now_ns - start_ns) // 1_000_000 & 0xFFFFFFFF,
        q=attitude.q_ned_from_frd,
        body_roll_rate=0.0,
        body_pitch_rate=0.0,
        body_yaw_rate=rate_rad_s or 0.0,
        thrust=attitude.thrust,
        target_system=telemetry.sysid,
        target_component=telemetry.compid,
        type_mask=BODY_RATES if rate_rad_s is None else with_rate,
    )
