"""The camera.

One named tuple a message, fields in wire order, values as MAVLink has them (units and frames are
the dialect's).  `char[n]` and `uint8_t[n]` are `bytes`, shorter ones are padded with zeros.
"""

from __future__ import annotations

from typing import NamedTuple


class CameraFeedback(NamedTuple):
    time_usec: int
    lat: int
    lng: int
    alt_msl: float
    alt_rel: float
    roll: float
    pitch: float
    yaw: float
    foc_len: float
    img_idx: int
    target_system: int
    cam_idx: int
    flags: int
    completed_captures: int = 0


class CameraInformation(NamedTuple):
    time_boot_ms: int
    firmware_version: int
    focal_length: float
    sensor_size_h: float
    sensor_size_v: float
    flags: int
    resolution_h: int
    resolution_v: int
    cam_definition_version: int
    vendor_name: bytes
    model_name: bytes
    lens_id: int
    cam_definition_uri: bytes
    gimbal_device_id: int = 0
    camera_device_id: int = 0


class CameraSettings(NamedTuple):
    time_boot_ms: int
    mode_id: int
    zoom_level: float = 0.0
    focus_level: float = 0.0
    camera_device_id: int = 0


class StorageInformation(NamedTuple):
    time_boot_ms: int
    total_capacity: float
    used_capacity: float
    available_capacity: float
    read_speed: float
    write_speed: float
    storage_id: int
    storage_count: int
    status: int
    type: int = 0
    name: bytes = b""
    storage_usage: int = 0


class CameraCaptureStatus(NamedTuple):
    time_boot_ms: int
    image_interval: float
    recording_time_ms: int
    available_capacity: float
    image_status: int
    video_status: int
    image_count: int = 0
    camera_device_id: int = 0


class CameraImageCaptured(NamedTuple):
    time_utc: int
    time_boot_ms: int
    lat: int
    lon: int
    alt: int
    relative_alt: int
    q: tuple[float, ...]
    image_index: int
    camera_id: int
    capture_result: int
    file_url: bytes
