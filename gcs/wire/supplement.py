"""What MAVLink's common dialect had in August 2026 and pymavlink 2.4.50 lacks, kept by hand.

One paragraph a message: `id NAME crc_extra: type[array] field, ... | extension fields`, in wire
order.  pymavlink has eight of them in a shorter version; `dialect.py` takes the longer one.
Delete this file once pymavlink has them all.
"""

from __future__ import annotations

import re
from typing import NamedTuple


class SupplementField(NamedTuple):
    name: str
    type: str
    array_length: int
    extension: bool


class SupplementMessage(NamedTuple):
    msgid: int
    name: str
    crc_extra: int
    fields: tuple[SupplementField, ...]


RESULTS = {
    6: "MAV_RESULT_CANCELLED",
    9: "MAV_RESULT_COMMAND_UNSUPPORTED_MAV_FRAME",
    10: "MAV_RESULT_NOT_IN_CONTROL",
}
"""MAV_RESULT entries that pymavlink lacks."""

COMMANDS = {32100: "MAV_CMD_REQUEST_OPERATOR_CONTROL"}
"""MAV_CMD entries that pymavlink lacks."""

DEVELOPMENT = frozenset({512})
"""Messages of these that are in MAVLink's development.xml, where work goes on: the message and the
command of operator control."""


ENTRIES = {"MAV_RESULT": RESULTS, "MAV_CMD": COMMANDS}
"""By the enum's name."""


def messages() -> tuple[SupplementMessage, ...]:
    """`_MESSAGES`, parsed."""
    return tuple(_message(paragraph) for paragraph in re.split(r"\n(?=\d)", _MESSAGES.strip()))


def _message(paragraph: str) -> SupplementMessage:
    head, _, body = " ".join(paragraph.split()).partition(": ")
    msgid, name, crc_extra = head.split()
    base, _, extensions = body.partition(" | ")
    fields = [_field(text, extension=False) for text in base.split(", ")]
    fields += [_field(text, extension=True) for text in extensions.split(", ") if text]
    return SupplementMessage(int(msgid), name, int(crc_extra), tuple(fields))


def _field(text: str, extension: bool) -> SupplementField:
    type_, name = text.split()
    type_, _, length = type_.partition("[")
    return SupplementField(name, type_, int(length.rstrip("]") or 0), extension)


_MESSAGES = """
8 LINK_NODE_STATUS 117: uint64 timestamp, uint32 tx_rate, uint32 rx_rate, uint32 messages_sent,
    uint32 messages_received, uint32 messages_lost, uint16 rx_parse_err, uint16 tx_overflows,
    uint16 rx_overflows, uint8 tx_buf, uint8 rx_buf
42 MISSION_CURRENT 28: uint16 seq | uint16 total, uint8 mission_state, uint8 mission_mode,
    uint32 mission_id, uint32 fence_id, uint32 rally_points_id
44 MISSION_COUNT 221: uint16 count, uint8 target_system, uint8 target_component | uint8
    mission_type, uint32 opaque_id
47 MISSION_ACK 153: uint8 target_system, uint8 target_component, uint8 type | uint8
    mission_type, uint32 opaque_id
80 COMMAND_CANCEL 14: uint16 command, uint8 target_system, uint8 target_component
82 SET_ATTITUDE_TARGET 49: uint32 time_boot_ms, float[4] q, float body_roll_rate, float
    body_pitch_rate, float body_yaw_rate, float thrust, uint8 target_system, uint8
    target_component, uint8 type_mask | float[3] thrust_body
111 TIMESYNC 34: int64 tc1, int64 ts1 | uint8 target_system, uint8 target_component
126 SERIAL_CONTROL 220: uint32 baudrate, uint16 timeout, uint8 device, uint8 flags, uint8 count,
    uint8[70] data | uint8 target_system, uint8 target_component
290 ESC_INFO 251: uint64 time_usec, uint32[4] error_count, uint16 counter, uint16[4]
    failure_flags, int16[4] temperature, uint8 index, uint8 count, uint8 connection_type, uint8
    info
291 ESC_STATUS 10: uint64 time_usec, int32[4] rpm, float[4] voltage, float[4] current, uint8
    index
299 WIFI_CONFIG_AP 19: char[32] ssid, char[64] password | int8 mode, int8 response
300 PROTOCOL_VERSION 217: uint16 version, uint16 min_version, uint16 max_version, uint8[8]
    spec_version_hash, uint8[8] library_version_hash
334 CELLULAR_STATUS 72: uint16 mcc, uint16 mnc, uint16 lac, uint8 status, uint8 failure_reason,
    uint8 type, uint8 quality | uint8 id, uint32 link_tx_rate, uint32 link_rx_rate, char[9]
    cell_tower_id, uint8 band_number, float band_frequency, uint32 channel_number, float
    rx_level, float tx_level, float rx_quality, float sinr
336 CELLULAR_CONFIG 245: uint8 enable_lte, uint8 enable_pin, char[16] pin, char[16] new_pin,
    char[32] apn, char[16] puk, uint8 roaming, uint8 response
361 FIGURE_EIGHT_EXECUTION_STATUS 93: uint64 time_usec, float major_radius, float minor_radius,
    float orientation, int32 x, int32 y, float z, uint8 frame
371 FUEL_STATUS 10: float maximum_fuel, float consumed_fuel, float remaining_fuel, float
    flow_rate, float temperature, uint32 fuel_type, uint8 id, uint8 percent_remaining
372 BATTERY_INFO 26: float discharge_minimum_voltage, float charging_minimum_voltage, float
    resting_minimum_voltage, float charging_maximum_voltage, float charging_maximum_current,
    float nominal_voltage, float discharge_maximum_current, float
    discharge_maximum_burst_current, float design_capacity, float full_charge_capacity, uint16
    cycle_count, uint16 weight, uint8 id, uint8 battery_function, uint8 type, uint8
    state_of_health, uint8 cells_in_series, char[9] manufacture_date, char[32] serial_number,
    char[50] name
380 TIME_ESTIMATE_TO_TARGET 232: int32 safe_return, int32 land, int32 mission_next_item, int32
    mission_end, int32 commanded_action
395 COMPONENT_INFORMATION 0: uint32 time_boot_ms, uint32 general_metadata_file_crc, uint32
    peripherals_metadata_file_crc, char[100] general_metadata_uri, char[100]
    peripherals_metadata_uri
396 COMPONENT_INFORMATION_BASIC 50: uint64 capabilities, uint32 time_boot_ms, uint32
    time_manufacture_s, char[32] vendor_name, char[32] model_name, char[24] software_version,
    char[24] hardware_version, char[32] serial_number
397 COMPONENT_METADATA 182: uint32 time_boot_ms, uint32 file_crc, char[100] uri
400 PLAY_TUNE_V2 110: uint32 format, uint8 target_system, uint8 target_component, char[248] tune
401 SUPPORTED_TUNES 183: uint32 format, uint8 target_system, uint8 target_component
410 EVENT 160: uint32 id, uint32 event_time_boot_ms, uint16 sequence, uint8
    destination_component, uint8 destination_system, uint8 log_levels, uint8[40] arguments
411 CURRENT_EVENT_SEQUENCE 106: uint16 sequence, uint8 flags
412 REQUEST_EVENT 33: uint16 first_sequence, uint16 last_sequence, uint8 target_system, uint8
    target_component
413 RESPONSE_EVENT_ERROR 77: uint16 sequence, uint16 sequence_oldest_available, uint8
    target_system, uint8 target_component, uint8 reason
435 AVAILABLE_MODES 134: uint32 custom_mode, uint32 properties, uint8 number_modes, uint8
    mode_index, uint8 standard_mode, char[35] mode_name | uint8 seq
440 ILLUMINATOR_STATUS 66: uint32 uptime_ms, uint32 error_status, float brightness, float
    strobe_period, float strobe_duty_cycle, float temp_c, float min_strobe_period, float
    max_strobe_period, uint8 enable, uint8 mode_bitmask, uint8 mode
512 CONTROL_STATUS 21: uint8 flags, uint8 gcs_main, uint8[10] gcs_secondary
"""
