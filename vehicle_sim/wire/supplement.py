"""What upstream MAVLink has and pymavlink's dialect lacks, as far as this vehicle needs it.

Facts of mavlink `common` as of 2026-08: messages that are new, and known ones that have grown
extensions.  Fields are in wire order; types as in MAVLink's XML.
"""

from __future__ import annotations

from typing import Final, NamedTuple


class MessageField(NamedTuple):
    name: str
    kind: str  # MAVLink's C type
    length: int  # array length, 0 for a scalar
    extension: bool = False


class Layout(NamedTuple):
    """One message of the dialect."""

    number: int
    name: str
    crc_extra: int
    fields: tuple[MessageField, ...]


NEW: Final = (
    Layout(
        290,
        "ESC_INFO",
        251,
        (
            MessageField("time_usec", "uint64_t", 0),
            MessageField("error_count", "uint32_t", 4),
            MessageField("counter", "uint16_t", 0),
            MessageField("failure_flags", "uint16_t", 4),
            MessageField("temperature", "int16_t", 4),
            MessageField("index", "uint8_t", 0),
            MessageField("count", "uint8_t", 0),
            MessageField("connection_type", "uint8_t", 0),
            MessageField("info", "uint8_t", 0),
        ),
    ),
    Layout(
        291,
        "ESC_STATUS",
        10,
        (
            MessageField("time_usec", "uint64_t", 0),
            MessageField("rpm", "int32_t", 4),
            MessageField("voltage", "float", 4),
            MessageField("current", "float", 4),
            MessageField("index", "uint8_t", 0),
        ),
    ),
    Layout(
        300,
        "PROTOCOL_VERSION",
        217,
        (
            MessageField("version", "uint16_t", 0),
            MessageField("min_version", "uint16_t", 0),
            MessageField("max_version", "uint16_t", 0),
            MessageField("spec_version_hash", "uint8_t", 8),
            MessageField("library_version_hash", "uint8_t", 8),
        ),
    ),
    Layout(
        397,
        "COMPONENT_METADATA",
        182,
        (
            MessageField("time_boot_ms", "uint32_t", 0),
            MessageField("file_crc", "uint32_t", 0),
            MessageField("uri", "char", 100),
        ),
    ),
    Layout(
        410,
        "EVENT",
        160,
        (
            MessageField("id", "uint32_t", 0),
            MessageField("event_time_boot_ms", "uint32_t", 0),
            MessageField("sequence", "uint16_t", 0),
            MessageField("destination_component", "uint8_t", 0),
            MessageField("destination_system", "uint8_t", 0),
            MessageField("log_levels", "uint8_t", 0),
            MessageField("arguments", "uint8_t", 40),
        ),
    ),
    Layout(
        411,
        "CURRENT_EVENT_SEQUENCE",
        106,
        (
            MessageField("sequence", "uint16_t", 0),
            MessageField("flags", "uint8_t", 0),
        ),
    ),
    Layout(
        412,
        "REQUEST_EVENT",
        33,
        (
            MessageField("first_sequence", "uint16_t", 0),
            MessageField("last_sequence", "uint16_t", 0),
            MessageField("target_system", "uint8_t", 0),
            MessageField("target_component", "uint8_t", 0),
        ),
    ),
    Layout(
        413,
        "RESPONSE_EVENT_ERROR",
        77,
        (
            MessageField("sequence", "uint16_t", 0),
            MessageField("sequence_oldest_available", "uint16_t", 0),
            MessageField("target_system", "uint8_t", 0),
            MessageField("target_component", "uint8_t", 0),
            MessageField("reason", "uint8_t", 0),
        ),
    ),
    Layout(
        512,
        "CONTROL_STATUS",
        21,
        (
            MessageField("flags", "uint8_t", 0),
            MessageField("gcs_main", "uint8_t", 0),
            MessageField("gcs_secondary", "uint8_t", 10),
        ),
    ),
)

COMMANDS: Final = {"MAV_CMD_REQUEST_OPERATOR_CONTROL": 32100}
"""Of development.xml, as CONTROL_STATUS: work in progress."""

GROWN: Final[dict[str, tuple[MessageField, ...]]] = {
    "MISSION_CURRENT": (
        MessageField("mission_id", "uint32_t", 0, True),
        MessageField("fence_id", "uint32_t", 0, True),
        MessageField("rally_points_id", "uint32_t", 0, True),
    ),
    "MISSION_COUNT": (MessageField("opaque_id", "uint32_t", 0, True),),
    "MISSION_ACK": (MessageField("opaque_id", "uint32_t", 0, True),),
    "TIMESYNC": (
        MessageField("target_system", "uint8_t", 0, True),
        MessageField("target_component", "uint8_t", 0, True),
    ),
    "SET_ATTITUDE_TARGET": (MessageField("thrust_body", "float", 3, True),),
    "AVAILABLE_MODES": (MessageField("seq", "uint8_t", 0, True),),
}
