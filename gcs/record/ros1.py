"""The zero-decode scheme: a MAVLink frame becomes a ROS 1 message without being decoded.

Both a MAVLink payload and a ROS 1 message are packed little-endian structs.  A message here is

    Frame frame     link, direction, and the frame's own header
    ...             the payload in wire order, zero-extended to the dialect's full length
    uint8[] tail    payload bytes beyond what the dialect knows, checksum, signature

so a viewer decodes the bytes off the wire with the schema from `schema_text`, and `rebuild` gives
the original frame back, byte for byte.  A message of a kind that is not in the dialect has a full
length of 0: all of its payload is tail.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from struct import Struct
from typing import TypeAlias

from gcs.mcap_file.writer import Channel
from gcs.report import Direction
from gcs.wire.dialect import ENUMS, MESSAGES, FieldDef, MessageDef

MAGIC_V1 = 0xFE
MAGIC_V2 = 0xFD
FRAME_BYTES = 13
"""Length of `Frame` in a message."""

FRAME_TEXT = f"""uint8 link
uint8 RECEIVED={Direction.RECEIVED:d}
uint8 SENT={Direction.SENT:d}
uint8 REFUSED={Direction.REFUSED:d}
uint8 direction
uint8 MAVLINK_1={MAGIC_V1}
uint8 MAVLINK_2={MAGIC_V2}
uint8 magic
uint8 len
uint8 incompat_flags
uint8 compat_flags
uint8 seq
uint8 sysid
uint8 compid
uint32 msgid
"""

PAYLOAD_LENGTH_KEY = "payload_length"
"""Channel metadata: the full length that payloads were extended to when they were recorded."""

Encode: TypeAlias = Callable[[bytes, int, int], bytes]
"""(whole frame, link, direction) -> message."""

_TYPES = {"float": "float32", "double": "float64"}
_INTEGER_RANGES = {
    f"{sign}int{bits}": range(1 << bits) if sign else range(-1 << (bits - 1), 1 << (bits - 1))
    for sign in ("", "u")
    for bits in (8, 16, 32, 64)
}
_SEPARATOR = "=" * 80
_OWN_NAMES = ("frame", "tail")


# ------------------------------------------------------------------------------------ bytes


class Codec:
    """Between frames and messages of one full payload length."""

    __slots__ = ("_v1", "_v2", "pack_plain", "payload_length", "plain_end")

    def __init__(self, payload_length: int) -> None:
        self.payload_length = payload_length
        # `s` cuts what is too long and zero-extends what is too short.
        self._v1 = Struct(f"<BB2sxx4sxxx{payload_length}sI")
        self._v2 = Struct(f"<BB10sx{payload_length}sI")
        self.pack_plain = Struct(f"<BB10sx{payload_length}sI2s").pack
        """Of link, direction, frame, payload, 2 and checksum: the message of a plain frame."""
        self.plain_end = payload_length + 10
        """Where the payload of the longest such frame ends."""

    def encode(self, raw: bytes, link: int, direction: int) -> bytes:
        """The message of one whole frame, magic to signature; `direction` as in `Direction`."""
        known = raw[1]
        if raw[0] == MAGIC_V2 and known <= self.payload_length and len(raw) == known + 12:
            # Unsigned, and of the length that the dialect knows: nearly all frames.
            end = known + 10
            return self.pack_plain(link, direction, raw, raw[10:end], 2, raw[end:])
        if known > self.payload_length:
            known = self.payload_length
        if raw[0] == MAGIC_V2:
            end = 10 + known
            packed = self._v2.pack(link, direction, raw, raw[10:end], len(raw) - end)
        else:
            end = 6 + known
            packed = self._v1.pack(link, direction, raw, raw[2:6], raw[6:end], len(raw) - end)
        return packed + raw[end:]

    def rebuild(self, message: bytes) -> bytes:
        """The frame that `encode` was given."""
        magic, length = message[2:4]
        payload = message[FRAME_BYTES : FRAME_BYTES + min(length, self.payload_length)]
        tail = message[FRAME_BYTES + self.payload_length + 4 :]
        header = message[2:12] if magic == MAGIC_V2 else message[2:4] + message[6:10]
        return header + payload + tail


@cache
def codec(payload_length: int) -> Codec:
    return Codec(payload_length)


def source_of(raw: bytes) -> tuple[int, int]:
    """System and component id of a whole frame."""
    return (raw[5], raw[6]) if raw[0] == MAGIC_V2 else (raw[3], raw[4])


def full_length(msgid: int) -> int:
    """Payload length with every extension that the dialect knows; 0 for an unknown message."""
    definition = MESSAGES.get(msgid)
    return definition.max_len if definition is not None else 0


def rebuild(message: bytes, *, payload_length: int | None = None) -> bytes:
    """The frame that a recorded message came from.

    `payload_length` is the channel's metadata `payload_length`; without it the present dialect's
    length is taken, which is wrong for a record made with another one.
    """
    if payload_length is None:
        payload_length = full_length(int.from_bytes(message[9:13], "little"))
    return codec(payload_length).rebuild(message)


# ---------------------------------------------------------------------------------- schemas


def schema_text(definition: MessageDef | None) -> str:
    """The ros1msg definition of a message, dependencies appended; None = an unknown message."""
    lines = ["Frame frame"]
    taken: set[str] = set()
    for field in definition.fields if definition is not None else ():
        lines += _constants(field, taken)
        lines.append(_field_line(field))
    lines.append("uint8[] tail")
    return "\n".join([*lines, _SEPARATOR, "MSG: mavlink/Frame", FRAME_TEXT])


def frame_channel(sysid: int, compid: int, msgid: int) -> Channel:
    """The channel of one kind of message from one component."""
    definition = MESSAGES.get(msgid)
    name = definition.name if definition is not None else "UNKNOWN"
    leaf = name if definition is not None else f"UNKNOWN_{msgid}"
    return _channel(f"/mavlink/{sysid}/{compid}/{leaf}", name, definition)


def crowd_channel() -> Channel:
    """Where frames go once there are more kinds and components than a file has channels for."""
    return _channel("/mavlink/more", "UNKNOWN", None)


def garbage_channel(link: int) -> Channel:
    """Bytes of a link that were no frame, and why."""
    text = b"string reason\nuint8[] data\n"
    return Channel(f"/link/{link}/garbage", "ros1", "mavlink/Garbage", "ros1msg", text)


def encode_garbage(reason: str, raw: bytes) -> bytes:
    why = reason.encode()
    return b"%b%b%b%b" % (len(why).to_bytes(4, "little"), why, len(raw).to_bytes(4, "little"), raw)


def decode_garbage(message: bytes) -> tuple[str, bytes]:
    """Reason and bytes, as `encode_garbage` was given them."""
    at = 4 + int.from_bytes(message[:4], "little")
    return message[4:at].decode(errors="replace"), message[at + 4 :]


def field_name(name: str) -> str:
    """A payload field that is called like one of ours gets an underscore (COMMAND_INT.frame)."""
    return f"{name}_" if name in _OWN_NAMES else name


def _channel(topic: str, name: str, definition: MessageDef | None) -> Channel:
    length = definition.max_len if definition is not None else 0
    return Channel(
        topic,
        "ros1",
        f"mavlink/{name}",
        "ros1msg",
        schema_text(definition).encode(),
        ((PAYLOAD_LENGTH_KEY, str(length)),),
    )


def _field_line(field: FieldDef) -> str:
    array = f"[{field.array_length}]" if field.array_length else ""
    units = f"  # {field.units}" if field.units else ""
    return f"{_TYPES.get(field.type, field.type)}{array} {field_name(field.name)}{units}"


def _constants(field: FieldDef, taken: set[str]) -> list[str]:
    """The entries of the field's enum that fit its type.

    Viewers give a field the constants that stand directly before it.  A constant's name must be
    new to the message, so a second field of the same enum prefixes its own name.
    """
    values = _INTEGER_RANGES.get(field.type)
    enum = ENUMS.get(field.enum)
    if values is None or enum is None:
        return []
    lines = []
    for entry in enum.entries:
        if entry.value in values:
            name = entry.name
            if name in taken:
                name = f"{field.name.upper()}_{name}"
            taken.add(name)
            lines.append(f"{field.type} {name}={entry.value}")
    return lines
