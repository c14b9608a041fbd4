"""Who is there, how it is, what it says.

One named tuple a message, fields in wire order, values as MAVLink has them (units and frames are
the dialect's).  `char[n]` and `uint8_t[n]` are `bytes`, shorter ones are padded with zeros.
"""

from __future__ import annotations

from typing import NamedTuple


class Heartbeat(NamedTuple):
    custom_mode: int
    type: int
    autopilot: int
    base_mode: int
    system_status: int
    mavlink_version: int


class SysStatus(NamedTuple):
    onboard_control_sensors_present: int
    onboard_control_sensors_enabled: int
    onboard_control_sensors_health: int
    load: int
    voltage_battery: int
    current_battery: int
    drop_rate_comm: int
    errors_comm: int
    errors_count1: int
    errors_count2: int
    errors_count3: int
    errors_count4: int
    battery_remaining: int
    onboard_control_sensors_present_extended: int = 0
    onboard_control_sensors_enabled_extended: int = 0
    onboard_control_sensors_health_extended: int = 0


class SystemTime(NamedTuple):
    time_unix_usec: int
    time_boot_ms: int


class Ping(NamedTuple):
    time_usec: int
    seq: int
    target_system: int
    target_component: int


class SetMode(NamedTuple):
    custom_mode: int
    target_system: int
    base_mode: int


class RequestDataStream(NamedTuple):
    req_message_rate: int
    target_system: int
    target_component: int
    req_stream_id: int
    start_stop: int


class Timesync(NamedTuple):
    tc1: int
    ts1: int
    target_system: int = 0
    target_component: int = 0


class AutopilotVersion(NamedTuple):
    capabilities: int
    uid: int
    flight_sw_version: int
    middleware_sw_version: int
    os_sw_version: int
    board_version: int
    vendor_id: int
    product_id: int
    flight_custom_version: bytes
    middleware_custom_version: bytes
    os_custom_version: bytes
    uid2: bytes = b""


class MessageInterval(NamedTuple):
    interval_us: int
    message_id: int


class ExtendedSysState(NamedTuple):
    vtol_state: int
    landed_state: int


class Statustext(NamedTuple):
    severity: int
    text: bytes
    id: int = 0
    chunk_seq: int = 0


class ProtocolVersion(NamedTuple):
    version: int
    min_version: int
    max_version: int
    spec_version_hash: bytes
    library_version_hash: bytes


class AvailableModes(NamedTuple):
    custom_mode: int
    properties: int
    number_modes: int
    mode_index: int
    standard_mode: int
    mode_name: bytes
    seq: int = 0


class CurrentMode(NamedTuple):
    custom_mode: int
    intended_custom_mode: int
    standard_mode: int
