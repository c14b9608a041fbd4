"""SET_POSITION_TARGET_*, SET_ATTITUDE_TARGET and guided mission items: masks and frames resolved.

These messages have no ack: what is refused leaves a note, and POSITION_TARGET_LOCAL_NED goes on
telling what is flown.  Frames by personality, as PX4 1.14 (`mavlink_receiver.cpp`) and ArduCopter
(`GCS_Mavlink.cpp`) take them.
"""

from __future__ import annotations

import math
from typing import Final

from vehicle_sim.autopilot.control.axes import every_axis_is_given, is_partial
from vehicle_sim.autopilot.geo import projection
from vehicle_sim.autopilot.interface import AttitudeSetpoint, Geodetic, Setpoint, Vehicle
from vehicle_sim.numerics.vectors import Vec3, euler_rad
from vehicle_sim.services.profile import Profile
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import ABSOLUTE, RELATIVE, AttitudeIgnore, MavFrame, PositionIgnore

FARTHEST: Final = 1e6
"""Metres, m/s or m/s^2 beyond which no setpoint means anything."""

_BODY: Final = frozenset({MavFrame.BODY_NED, MavFrame.BODY_OFFSET_NED})
_OFFSET: Final = frozenset({MavFrame.LOCAL_OFFSET_NED, MavFrame.BODY_NED, MavFrame.BODY_OFFSET_NED})
_FRAMES_PX4: Final = frozenset({MavFrame.LOCAL_NED, MavFrame.BODY_NED})
_FRAMES_ARDUPILOT: Final = _OFFSET | {MavFrame.LOCAL_NED}
_PLACES: Final = ABSOLUTE | RELATIVE
# As plain numbers: what a flag does with a number costs more than all that is done with the answer.
_POSITION: Final = int(PositionIgnore.POSITION)
_VELOCITY: Final = int(PositionIgnore.VELOCITY)
_ACCELERATION: Final = int(PositionIgnore.ACCELERATION)
_YAW: Final = int(PositionIgnore.YAW)
_YAW_RATE: Final = int(PositionIgnore.YAW_RATE)


class BadSetpointError(Exception):
    """A setpoint that cannot be flown; the message says why."""


def local_setpoint(
    vehicle: Vehicle, profile: Profile, asked: m.SetPositionTargetLocalNed
) -> Setpoint:
    """Raises BadSetpointError."""
    frame = asked.coordinate_frame
    if frame not in (_FRAMES_ARDUPILOT if profile.offset_frames else _FRAMES_PX4):
        raise BadSetpointError(f"frame {frame} is not supported")
    heading_rad = euler_rad(vehicle.estimate.q_ned_from_frd)[2] if frame in _BODY else 0.0
    place = _vector(asked.type_mask, _POSITION, (asked.x, asked.y, asked.z), profile)
    if place is not None:
        place = _rotated(place, heading_rad)
        if frame in _OFFSET:
            if not profile.offset_frames:
                raise BadSetpointError("a position in the body frame is not supported")
            here = vehicle.estimate.pos_ned
            place = (here[0] + place[0], here[1] + place[1], here[2] + place[2])
    return _setpoint(asked, place, heading_rad, profile)


def global_setpoint(
    vehicle: Vehicle, profile: Profile, asked: m.SetPositionTargetGlobalInt
) -> Setpoint:
    """Raises BadSetpointError."""
    if asked.coordinate_frame not in _PLACES:
        raise BadSetpointError(f"frame {asked.coordinate_frame} is not supported")
    raw = (asked.lat_int * 1e-7, asked.lon_int * 1e-7, asked.alt)
    given = _vector(asked.type_mask, _POSITION, raw, profile)
    place = None
    if given is not None:
        place = _global_place(vehicle, profile, given, asked.coordinate_frame in RELATIVE)
    return _setpoint(asked, place, 0.0, profile)


def _global_place(vehicle: Vehicle, profile: Profile, given: Vec3, relative: bool) -> Vec3:
    """With NaN where the mask leaves an axis out; latitude and longitude go together."""
    lat_deg, lon_deg, height_m = given
    flat, high = math.isfinite(lat_deg) and math.isfinite(lon_deg), math.isfinite(height_m)
    here = vehicle.estimate
    north, east, down = place_ned(
        vehicle,
        profile,
        lat_deg if flat else here.lat_deg,
        lon_deg if flat else here.lon_deg,
        height_m if high else 0.0,
        relative,
    )
    return (north if flat else math.nan, east if flat else math.nan, down if high else math.nan)


def place_ned(
    vehicle: Vehicle,
    profile: Profile,
    lat_deg: float,
    lon_deg: float,
    height_m: float,
    relative: bool,
) -> Vec3:
    """A place in local NED; `height_m` is above home if relative, else AMSL."""
    origin, home = vehicle.origin, vehicle.home
    if origin is None or home is None:
        raise BadSetpointError("there is no origin yet")
    if not (abs(lat_deg) <= 90.0 and abs(lon_deg) <= 180.0 and abs(height_m) <= FARTHEST):
        raise BadSetpointError(f"{lat_deg}, {lon_deg}, {height_m} is no place")
    alt_amsl_m = home.alt_amsl_m + height_m if relative else height_m
    return projection(profile.name, origin).to_local(Geodetic(lat_deg, lon_deg, alt_amsl_m))


def _setpoint(
    asked: m.SetPositionTargetLocalNed | m.SetPositionTargetGlobalInt,
    place_ned: Vec3 | None,
    heading_rad: float,
    profile: Profile,
) -> Setpoint:
    """Everything but the position, which is the same in both messages."""
    mask = asked.type_mask
    velocity = _vector(mask, _VELOCITY, (asked.vx, asked.vy, asked.vz), profile)
    thrust = _vector(mask, _ACCELERATION, (asked.afx, asked.afy, asked.afz), profile)
    yaw = _scalar(mask, _YAW, asked.yaw, profile)
    if yaw is not None and profile.offset_frames:
        yaw = math.remainder(yaw + heading_rad, 2.0 * math.pi)
    setpoint = Setpoint(
        pos_ned=place_ned,
        v_ned=_rotated(velocity, heading_rad) if velocity is not None else None,
        a_ned=_rotated(thrust, heading_rad) if thrust is not None else None,
        yaw_rad=yaw,
        yaw_rate_rad_s=_scalar(mask, _YAW_RATE, asked.yaw_rate, profile),
    )
    if setpoint.pos_ned is None and setpoint.v_ned is None and setpoint.a_ned is None:
        raise BadSetpointError(f"type_mask {mask} leaves nothing to fly to")
    if is_partial(setpoint) and not every_axis_is_given(setpoint):
        raise BadSetpointError(f"type_mask {mask} leaves an axis without position and velocity")
    return setpoint


def attitude_setpoint(asked: m.SetAttitudeTarget) -> AttitudeSetpoint:
    """Raises BadSetpointError."""
    mask = asked.type_mask
    if mask & AttitudeIgnore.THRUST:
        raise BadSetpointError("an attitude without thrust cannot be flown")
    if not 0.0 <= asked.thrust <= 1.0:
        raise BadSetpointError(f"thrust {asked.thrust} is not in 0..1")
    w, x, y, z = asked.q
    q = None
    if not mask & AttitudeIgnore.ATTITUDE:
        norm = math.sqrt(w * w + x * x + y * y + z * z)
        if not 0.5 < norm < 2.0:
            raise BadSetpointError(f"quaternion {asked.q} is no rotation")
        q = (w / norm, x / norm, y / norm, z / norm)
    rates = None
    if mask & AttitudeIgnore.RATES != AttitudeIgnore.RATES:
        given = (asked.body_roll_rate, asked.body_pitch_rate, asked.body_yaw_rate)
        used = [0.0 if mask & 1 << axis else rate for axis, rate in enumerate(given)]
        rates = (used[0], used[1], used[2])
        if not all(abs(rate) <= FARTHEST for rate in rates):
            raise BadSetpointError("a body rate is not finite")
    if q is None and rates is None:
        raise BadSetpointError(f"type_mask {mask} leaves nothing to fly")
    return AttitudeSetpoint(q, rates, asked.thrust)


def _vector(mask: int, ignore: int, value: Vec3, profile: Profile) -> Vec3 | None:
    ignored = mask & ignore
    if ignored == ignore or (ignored and profile.whole_masks):
        return None
    x, y, z = value
    if not ignored and abs(x) <= FARTHEST and abs(y) <= FARTHEST and abs(z) <= FARTHEST:
        return value
    lowest = ignore & -ignore
    used = [not ignored & lowest << axis for axis in range(3)]
    if not profile.whole_masks:
        used = [use and not math.isnan(part) for use, part in zip(used, value, strict=True)]
        if not any(used):
            return None
    if not all(abs(part) <= FARTHEST for part, use in zip(value, used, strict=True) if use):
        raise BadSetpointError(f"{value} is not finite, or beyond all measure")
    x, y, z = (part if use else math.nan for part, use in zip(value, used, strict=True))
    return (x, y, z)


def _scalar(mask: int, ignore: int, value: float, profile: Profile) -> float | None:
    """None where the mask leaves it out; to PX4, which has no other mask inside, NaN does too."""
    if mask & ignore or (math.isnan(value) and not profile.whole_masks):
        return None
    if not abs(value) <= FARTHEST:
        raise BadSetpointError(f"{value} is not finite, or beyond all measure")
    return value


def _rotated(vector: Vec3, heading_rad: float) -> Vec3:
    """From a frame that is turned by the heading around down, to NED."""
    if heading_rad == 0.0:
        return vector
    c, s = math.cos(heading_rad), math.sin(heading_rad)
    forward, right, down = vector
    return (c * forward - s * right, s * forward + c * right, down)
