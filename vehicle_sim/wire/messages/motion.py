"""Where the vehicle is and where it is told to go.

One named tuple a message, fields in wire order, values as MAVLink has them (units and frames are
the dialect's).  `char[n]` and `uint8_t[n]` are `bytes`, shorter ones are padded with zeros.
"""

from __future__ import annotations

from typing import NamedTuple


class Attitude(NamedTuple):
    time_boot_ms: int
    roll: float
    pitch: float
    yaw: float
    rollspeed: float
    pitchspeed: float
    yawspeed: float


class AttitudeQuaternion(NamedTuple):
    time_boot_ms: int
    q1: float
    q2: float
    q3: float
    q4: float
    rollspeed: float
    pitchspeed: float
    yawspeed: float
    repr_offset_q: tuple[float, ...] = (0.0,) * 4


class LocalPositionNed(NamedTuple):
    time_boot_ms: int
    x: float
    y: float
    z: float
    vx: float
    vy: float
    vz: float


class GlobalPositionInt(NamedTuple):
    time_boot_ms: int
    lat: int
    lon: int
    alt: int
    relative_alt: int
    vx: int
    vy: int
    vz: int
    hdg: int


class GpsGlobalOrigin(NamedTuple):
    latitude: int
    longitude: int
    altitude: int
    time_usec: int = 0


class HomePosition(NamedTuple):
    latitude: int
    longitude: int
    altitude: int
    x: float
    y: float
    z: float
    q: tuple[float, ...]
    approach_x: float
    approach_y: float
    approach_z: float
    time_usec: int = 0


class VfrHud(NamedTuple):
    airspeed: float
    groundspeed: float
    alt: float
    climb: float
    heading: int
    throttle: int


class SetAttitudeTarget(NamedTuple):
    time_boot_ms: int
    q: tuple[float, ...]
    body_roll_rate: float
    body_pitch_rate: float
    body_yaw_rate: float
    thrust: float
    target_system: int
    target_component: int
    type_mask: int
    thrust_body: tuple[float, ...] = (0.0,) * 3


class SetPositionTargetLocalNed(NamedTuple):
    time_boot_ms: int
    x: float
    y: float
    z: float
    vx: float
    vy: float
    vz: float
    afx: float
    afy: float
    afz: float
    yaw: float
    yaw_rate: float
    type_mask: int
    target_system: int
    target_component: int
    coordinate_frame: int


class PositionTargetLocalNed(NamedTuple):
    time_boot_ms: int
    x: float
    y: float
    z: float
    vx: float
    vy: float
    vz: float
    afx: float
    afy: float
    afz: float
    yaw: float
    yaw_rate: float
    type_mask: int
    coordinate_frame: int


class SetPositionTargetGlobalInt(NamedTuple):
    time_boot_ms: int
    lat_int: int
    lon_int: int
    alt: float
    vx: float
    vy: float
    vz: float
    afx: float
    afy: float
    afz: float
    yaw: float
    yaw_rate: float
    type_mask: int
    target_system: int
    target_component: int
    coordinate_frame: int


class PositionTargetGlobalInt(NamedTuple):
    time_boot_ms: int
    lat_int: int
    lon_int: int
    alt: float
    vx: float
    vy: float
    vz: float
    afx: float
    afy: float
    afz: float
    yaw: float
    yaw_rate: float
    type_mask: int
    coordinate_frame: int


class AttitudeTarget(NamedTuple):
    time_boot_ms: int
    q: tuple[float, ...]
    body_roll_rate: float
    body_pitch_rate: float
    body_yaw_rate: float
    thrust: float
    type_mask: int


class FollowTarget(NamedTuple):
    timestamp: int
    custom_state: int
    lat: int
    lon: int
    alt: float
    vel: tuple[float, ...]
    acc: tuple[float, ...]
    attitude_q: tuple[float, ...]
    rates: tuple[float, ...]
    position_cov: tuple[float, ...]
    est_capabilities: int


class OrbitExecutionStatus(NamedTuple):
    time_usec: int
    radius: float
    x: int
    y: int
    z: float
    frame: int
