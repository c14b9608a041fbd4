"""What upstream MAVLink has and pymavlink's dialect lacks, as far as this vehicle needs it.

Facts of mavlink `common` as of 2026-08: messages that are new, and known ones that have grown
extensions.  Fields are in wire order; types as in MAVLink's XML.
"""

from __future__ import annotations

from typing import Final, NamedTuple


class Field(NamedTuple):
    name: str
    kind: str  # MAVLink's C type
    length: int  # array length, 0 for a scalar
    extension: bool = False


class Layout(NamedTuple):
    """One message of the dialect."""

    number: int
    name: str
    crc_extra: int
    fields: tuple[Field, ...]


NEW: Final = (
    Layout(
        300,
        "PROTOCOL_VERSION",
        217,
        (
            Field("version", "uint16_t", 0),
            Field("min_version", "uint16_t", 0),
            Field("max_version", "uint16_t", 0),
            Field("spec_version_hash", "uint8_t", 8),
            Field("library_version_hash", "uint8_t", 8),
        ),
    ),
    Layout(
        397,
        "COMPONENT_METADATA",
        182,
        (
            Field("time_boot_ms", "uint32_t", 0),
            Field("file_crc", "uint32_t", 0),
            Field("uri", "char", 100),
        ),
    ),
)

GROWN: Final[dict[str, tuple[Field, ...]]] = {
    "MISSION_CURRENT": (
        Field("mission_id", "uint32_t", 0, True),
        Field("fence_id", "uint32_t", 0, True),
        Field("rally_points_id", "uint32_t", 0, True),
    ),
    "MISSION_COUNT": (Field("opaque_id", "uint32_t", 0, True),),
    "MISSION_ACK": (Field("opaque_id", "uint32_t", 0, True),),
    "TIMESYNC": (
        Field("target_system", "uint8_t", 0, True),
        Field("target_component", "uint8_t", 0, True),
    ),
    "SET_ATTITUDE_TARGET": (Field("thrust_body", "float", 3, True),),
    "AVAILABLE_MODES": (Field("seq", "uint8_t", 0, True),),
}
