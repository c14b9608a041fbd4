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
