"""SET_POSITION_TARGET_LOCAL_NED and _GLOBAL_INT: setpoints in every frame and mask.

Each autopilot's own rules, PX4 1.14 (`mavlink_receiver.cpp`) and ArduCopter 4.5 to 4.7
(`GCS_Mavlink.cpp`): which frames it takes, and which of position, velocity and acceleration
together.  What it would not fly is refused here, in words; the vehicle itself says nothing, or
stops.  Both refuse the force bit only where an acceleration is given: QGroundControl sets it
otherwise (from memory: type_mask 0xFFF8 for a change of height on ArduPilot).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Final

from gcs.bridge.translate.meaning import Meaning, Reject, Sample, Seen, Words
from gcs.bridge.translate.places import DEGREES_PER_UNIT, datum_of, place_of, rotated
from gcs.bridge.translate.says import go_to, refuse, unsupported
from gcs.frames import Vec3, as_on_the_wire
from gcs.gate.refusal import Code, Refusal
from gcs.wire.ids import MavFrame, TypeMask
from gcs.wire.messages import SetPositionTargetGlobalInt, SetPositionTargetLocalNed

_POSITION: Final = TypeMask.X_IGNORE | TypeMask.Y_IGNORE | TypeMask.Z_IGNORE
_VELOCITY: Final = TypeMask.VX_IGNORE | TypeMask.VY_IGNORE | TypeMask.VZ_IGNORE
_ACCELERATION: Final = TypeMask.AX_IGNORE | TypeMask.AY_IGNORE | TypeMask.AZ_IGNORE

_BODY: Final = frozenset({MavFrame.BODY_NED, MavFrame.BODY_OFFSET_NED})
"""Turned with the vehicle's heading; level, whatever its tilt."""
_FROM_HERE: Final = _BODY | {MavFrame.LOCAL_OFFSET_NED}
"""A position in them counts from where the vehicle is (ArduPilot)."""
_FRAMES_PX4: Final = frozenset({MavFrame.LOCAL_NED, MavFrame.BODY_NED})
_FRAMES_ARDUPILOT: Final = _FROM_HERE | {MavFrame.LOCAL_NED}
_GLOBAL_PX4: Final = frozenset({MavFrame.GLOBAL_INT, MavFrame.GLOBAL_RELATIVE_ALT_INT})


class _Given(Enum):
    """Which of the three axes of a triple the mask leaves in."""

    NONE = 0
    SOME = 1
    ALL = 2


@dataclass(frozen=True, slots=True)
class _Target:
    """What is given, after the mask; the frame's axes, not yet turned or moved."""

    position: Vec3 | None
    velocity: Vec3 | None
    acceleration: Vec3 | None
    yaw_rad: float | None
    yaw_rate_rad_s: float | None


def local_target(message: SetPositionTargetLocalNed, seen: Seen) -> Meaning:
    """Metres in a local frame."""
    px4, frame = seen.autopilot.mode_in_two_parts, message.coordinate_frame
    if frame not in (_FRAMES_PX4 if px4 else _FRAMES_ARDUPILOT):
        return unsupported(f"{seen.autopilot.name} takes no local setpoint in frame {frame}")
    target = _after_mask(message, (message.x, message.y, message.z), px4)
    if isinstance(target, Reject):
        return target
    heading_rad = 0.0
    if frame in _BODY:
        if seen.yaw_rad is None:
            return refuse(Code.NO_POSITION, "where the vehicle's nose points is not known")
        heading_rad = seen.yaw_rad
    position = target.position
    if position is not None:
        if px4 and frame in _BODY:
            return unsupported("px4 takes no position in the body frame")
        if frame in _FROM_HERE:
            if seen.pos_ned is None:
                return refuse(Code.NO_POSITION, "where the vehicle is now is not known")
            position = _sum(seen.pos_ned, rotated(position, heading_rad))
    yaw_rad = target.yaw_rad
    if yaw_rad is not None and frame in _BODY and not px4:
        yaw_rad = math.remainder(yaw_rad + heading_rad, math.tau)
    return _flown(
        _Target(
            position,
            target.velocity and rotated(target.velocity, heading_rad),
            target.acceleration and rotated(target.acceleration, heading_rad),
            yaw_rad,
            target.yaw_rate_rad_s,
        ),
        seen,
    )


def global_target(message: SetPositionTargetGlobalInt, seen: Seen) -> Meaning:
    """Latitude, longitude and a height; velocities are north, east, down."""
    px4, frame = seen.autopilot.mode_in_two_parts, message.coordinate_frame
    lat_deg, lon_deg = message.lat_int * DEGREES_PER_UNIT, message.lon_int * DEGREES_PER_UNIT
    target = _after_mask(message, (lat_deg, lon_deg, message.alt), px4)
    if isinstance(target, Reject) or target.position is None:
        return target if isinstance(target, Reject) else _flown(target, seen)
    datum = datum_of(frame)
    if isinstance(datum, Refusal):
        return Reject(datum)
    if px4 and frame not in _GLOBAL_PX4:
        return unsupported(f"px4 takes no global setpoint in frame {frame}, but in 5 and 6")
    place_ned = place_of(seen, *target.position, datum)
    if isinstance(place_ned, Refusal):
        return Reject(place_ned)
    moved = _Target(
        place_ned,
        target.velocity,
        target.acceleration,
        target.yaw_rad,
        target.yaw_rate_rad_s,
    )
    return _flown(moved, seen)


def _after_mask(
    message: SetPositionTargetLocalNed | SetPositionTargetGlobalInt, place: Vec3, px4: bool
) -> _Target | Reject:
    """What the mask leaves, if the autopilot flies such a combination."""
    mask = message.type_mask
    given = [_given(mask, bits) for bits in (_POSITION, _VELOCITY, _ACCELERATION)]
    if _Given.SOME in given:
        return unsupported(
            f"type_mask {mask} leaves out single axes: give all three of a position, a velocity "
            "or an acceleration, or none"
        )
    position, velocity, acceleration = (each is _Given.ALL for each in given)
    if acceleration and mask & TypeMask.FORCE_SET:
        return unsupported("a force instead of an acceleration is not flown by either autopilot")
    if not (position or velocity or acceleration):
        return unsupported(f"type_mask {mask} leaves nothing to fly to")
    if position and acceleration and not velocity and not px4:
        return unsupported("ArduCopter flies no position with an acceleration but no velocity")
    target = _Target(
        place if position else None,
        (message.vx, message.vy, message.vz) if velocity else None,
        (message.afx, message.afy, message.afz) if acceleration else None,
        None if mask & TypeMask.YAW_IGNORE else _turned(message.yaw, px4),
        None if mask & TypeMask.YAW_RATE_IGNORE else _turned(message.yaw_rate, px4),
    )
    if not _is_finite(target):
        return refuse(Code.NON_FINITE, "a setpoint with a number that is not finite")
    return target


def _turned(angle: float, px4: bool) -> float | None:
    """PX4 takes NaN as not given, as it writes it for what the mask leaves out."""
    return None if px4 and math.isnan(angle) else angle


def _given(mask: int, bits: int) -> _Given:
    if not mask & bits:
        return _Given.ALL
    return _Given.NONE if mask & bits == bits else _Given.SOME


def _is_finite(target: _Target) -> bool:
    triples = (target.position, target.velocity, target.acceleration)
    numbers = [number for triple in triples if triple is not None for number in triple]
    angles = [angle for angle in (target.yaw_rad, target.yaw_rate_rad_s) if angle is not None]
    return all(map(math.isfinite, numbers + angles))


def _flown(target: _Target, seen: Seen) -> Meaning:
    """A sample.  ArduPilot flies on to a position that it was sent once, so that is a go-to there,
    unless its sender turns out to be streaming."""
    sample = Sample(
        _rounded(target.position),
        _rounded(target.velocity),
        _rounded(target.acceleration),
        None if target.yaw_rad is None else as_on_the_wire(target.yaw_rad),
        target.yaw_rate_rad_s,
    )
    alone = target.velocity is None and target.acceleration is None
    if seen.autopilot.mode_in_two_parts or target.position is None or not alone:
        return sample
    once = go_to(seen, target.position, target.yaw_rad)
    return Words(once.asks, once.note, if_repeated=sample)


def _rounded(vector: Vec3 | None) -> Vec3 | None:
    """As the wire will carry it: what is verified is what flies."""
    if vector is None:
        return None
    return (as_on_the_wire(vector[0]), as_on_the_wire(vector[1]), as_on_the_wire(vector[2]))


def _sum(a: Vec3, b: Vec3) -> Vec3:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])
