"""The zero-decode scheme: viewers decode what was sent, and the frame comes back whole."""

from __future__ import annotations

import math
import random
import re
import struct
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mcap.reader import make_reader
from mcap_ros1.decoder import DecoderFactory
from pymavlink.dialects.v20 import all as dialect

from gcs.record import ros1
from gcs.report import Direction, FrameItem
from gcs.wire.blanking import SETUP_SIGNING, without_key
from gcs.wire.dialect import MESSAGES, TYPE_CODES, MessageDef
from gcs.wire.frame import msgid_in
from tests.each import each
from tests.sample_files import elsewhere
from tests.unit.record.flights import frame_v1, frame_v2, record


def some_payload(definition: MessageDef, seed: int) -> bytes:
    """A full-length payload whose strings are text and whose floats are finite."""
    rng = random.Random(seed)
    parts = []
    for field in definition.fields:
        for _ in range(max(1, field.array_length)):
            if field.type == "char":
                parts.append(struct.pack("<c", rng.choice(b"abcXYZ_19").to_bytes(1, "little")))
            elif field.type in ("float", "double"):
                parts.append(struct.pack("<" + TYPE_CODES[field.type], rng.randint(-900, 900) / 8))
            else:
                parts.append(rng.randbytes(struct.calcsize("<" + TYPE_CODES[field.type])))
    payload = b"".join(parts)
    return payload[:-1] + bytes([payload[-1] | 1])


def encoded(raw: bytes, link: int, direction: int) -> bytes:
    """The message of a frame of any kind, as the recorder makes it."""
    return ros1.codec(ros1.full_length(msgid_in(raw))).encode(raw, link, direction)


def plain(value: Any) -> Any:
    """Numbers and lists as they are, text in any guise as bytes without padding."""
    if isinstance(value, str):
        return value.encode().rstrip(b"\0")
    if isinstance(value, bytes | bytearray):
        return bytes(value)
    if isinstance(value, list | tuple):
        return [plain(inner) for inner in value]
    return value


def same(ours: Any, theirs: Any) -> bool:
    if isinstance(ours, bytes) and isinstance(theirs, list):
        return list(ours) == theirs
    if isinstance(ours, int) and isinstance(theirs, bytes):  # a single char
        return bytes([ours]) == theirs
    return bool(ours == theirs)


@pytest.mark.slow
def test_every_message_of_the_dialect_decodes_from_a_written_file(tmp_path: Path) -> None:
    payloads = {msgid: some_payload(known, seed=msgid) for msgid, known in MESSAGES.items()}
    frames = {msgid: frame_v2(msgid, payload) for msgid, payload in payloads.items()}
    frames[SETUP_SIGNING] = without_key(frames[SETUP_SIGNING])  # no record holds a key
    payloads[SETUP_SIGNING] = frames[SETUP_SIGNING][10:-2]
    items = [FrameItem(0, Direction.RECEIVED, raw) for raw in frames.values()]
    path = record(tmp_path, items)
    parser = dialect.MAVLink(None)
    decoded = fields = 0
    with open(path, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for schema, channel, message, ros_message in reader.iter_decoded_messages():
            msgid = ros_message.frame.msgid
            definition = MESSAGES[msgid]
            assert channel.topic == f"/mavlink/1/1/{definition.name}"
            assert schema is not None
            assert schema.name == f"mavlink/{definition.name}"
            assert ros1.rebuild(message.data) == frames[msgid]
            decoded += 1
            known = dialect.mavlink_map.get(msgid)
            if known is None:
                continue  # from the supplement: there is no oracle for it
            shorter = payloads[msgid][: known.unpacker.size]  # where the supplement is longer
            oracle = parser.decode(bytearray(frame_v2(msgid, shorter)))
            for field in definition.fields:
                if field.name not in known.fieldnames:
                    continue
                ours = plain(getattr(ros_message, ros1.field_name(field.name)))
                theirs = plain(getattr(oracle, field.name))
                assert same(ours, theirs), f"{definition.name}.{field.name}"
                fields += 1
    assert decoded == len(MESSAGES)
    assert fields >= 2730


def test_the_frame_header_is_decoded_beside_the_payload(tmp_path: Path) -> None:
    raw = frame_v2(0, b"\1\2\3\4\5\6\7\10\11", seq=42, source=(7, 9), signed=True)
    path = record(tmp_path, [FrameItem(3, Direction.REFUSED, raw)])
    with open(path, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        ((_, channel, _, message),) = reader.iter_decoded_messages()
    head = message.frame
    assert channel.topic == "/mavlink/7/9/HEARTBEAT"
    assert (head.link, head.direction, head.magic, head.len) == (3, head.REFUSED, head.MAVLINK_2, 9)
    assert (head.incompat_flags, head.seq, head.sysid, head.compid) == (1, 42, 7, 9)
    assert message.tail == raw[-15:]


def test_payload_fields_called_like_ours_get_an_underscore() -> None:
    lines = ros1.schema_text(MESSAGES[75]).splitlines()  # COMMAND_INT has a field `frame`
    assert lines[0] == "Frame frame"
    assert "uint8 frame_" in lines


@each("definition", MESSAGES.values(), said=lambda d: d.name)
def test_names_in_a_schema_are_legal_and_unique(definition: MessageDef) -> None:
    own = ros1.schema_text(definition).split("=" * 80)[0].splitlines()
    names = [re.split(r"[ =]+", line)[1] for line in own]
    assert len(names) == len(set(names))
    assert all(re.fullmatch(r"[A-Za-z]\w*", name) for name in names)


def test_constants_stand_before_their_field_and_fit_its_type() -> None:
    lines = ros1.schema_text(MESSAGES[245]).splitlines()  # EXTENDED_SYS_STATE
    at = lines.index("uint8 landed_state")
    assert lines[at - 1] == "uint8 MAV_LANDED_STATE_LANDING=4"
    assert not any("ENUM_END" in line for line in lines)


@pytest.mark.slow
@given(
    msgid=st.one_of(st.sampled_from(sorted(MESSAGES)), st.integers(0, 2**24 - 1)),
    payload=st.binary(max_size=255),
    header=st.binary(min_size=5, max_size=5),
    signature=st.one_of(st.just(b""), st.binary(min_size=13, max_size=13)),
    checksum=st.binary(min_size=2, max_size=2),
    link=st.integers(0, 255),
    direction=st.sampled_from(Direction),
)
def test_any_mavlink_2_frame_is_rebuilt_byte_for_byte(
    msgid: int,
    payload: bytes,
    header: bytes,
    signature: bytes,
    checksum: bytes,
    link: int,
    direction: Direction,
) -> None:
    raw = b"".join(
        (b"\xfd", bytes([len(payload)]), header, msgid.to_bytes(3, "little"), payload, checksum)
    )
    raw += signature
    message = encoded(raw, link, direction)
    assert message[:2] == bytes((link, direction))
    assert len(message) == len(raw) + 7 + max(0, ros1.full_length(msgid) - len(payload))
    assert ros1.rebuild(message) == raw


@given(
    msgid=st.integers(0, 255),
    payload=st.binary(max_size=255),
    header=st.binary(min_size=3, max_size=3),
    checksum=st.binary(min_size=2, max_size=2),
)
def test_any_mavlink_1_frame_is_rebuilt_byte_for_byte(
    msgid: int, payload: bytes, header: bytes, checksum: bytes
) -> None:
    raw = b"\xfe" + bytes([len(payload)]) + header + bytes([msgid]) + payload + checksum
    assert ros1.rebuild(encoded(raw, 0, Direction.SENT)) == raw


def test_a_record_of_an_older_dialect_is_rebuilt_by_the_length_it_carries() -> None:
    raw = frame_v2(42, bytes(range(1, 19)))
    message = ros1.codec(6).encode(raw, 0, 0)  # when MISSION_CURRENT was 6 bytes long
    assert ros1.rebuild(message, payload_length=6) == raw


def test_every_channel_carries_the_length_its_payloads_have() -> None:
    for msgid in (*MESSAGES, 9_999_999):
        channel = ros1.frame_channel(1, 1, msgid)
        assert dict(channel.metadata) == {"payload_length": str(ros1.full_length(msgid))}


def test_an_unknown_message_keeps_its_bytes_in_the_tail(tmp_path: Path) -> None:
    raw = frame_v2(9_999_999, b"what is this")
    path = record(tmp_path, [FrameItem(0, Direction.RECEIVED, raw)])
    with open(path, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        ((_, channel, _, message),) = reader.iter_decoded_messages()
    assert channel.topic == "/mavlink/1/1/UNKNOWN_9999999"
    assert message.tail.startswith(b"what is this")


def test_both_versions_of_a_message_share_its_topic(tmp_path: Path) -> None:
    heartbeat = b"\1\2\3\4\5\6\7\10\11"
    raws = [frame_v1(0, heartbeat), frame_v2(0, heartbeat)]
    path = record(tmp_path, [FrameItem(0, Direction.RECEIVED, raw) for raw in raws])
    with open(path, "rb") as file:
        found = list(make_reader(file, decoder_factories=[DecoderFactory()]).iter_messages())
    assert [channel.topic for _, channel, _ in found] == ["/mavlink/1/1/HEARTBEAT"] * 2
    assert [ros1.rebuild(message.data) for _, _, message in found] == raws


def test_a_log_of_every_message_in_both_versions_is_rebuilt_byte_for_byte() -> None:
    payloads = {msgid: some_payload(known, seed=msgid) for msgid, known in MESSAGES.items()}
    raws = [
        *(frame_v2(msgid, payload) for msgid, payload in payloads.items()),
        *(frame_v2(msgid, payload, signed=True) for msgid, payload in payloads.items()),
        *(
            frame_v1(msgid, payload[: MESSAGES[msgid].min_len])
            for msgid, payload in payloads.items()
            if msgid <= 255
        ),
    ]
    log = b"".join(number.to_bytes(8, "big") + raw for number, raw in enumerate(raws))
    assert frames_of_tlog(log) == raws
    assert all(ros1.rebuild(encoded(raw, 0, 0)) == raw for raw in raws)


@pytest.mark.parametrize("name", ["quad_2015.tlog", "arducopter_sitl.tlog"])
def test_real_flights_are_rebuilt_byte_for_byte(name: str) -> None:
    frames = frames_of_tlog(elsewhere("logs", name).read_bytes())
    assert len(frames) > 3000
    assert all(ros1.rebuild(encoded(raw, 0, 0)) == raw for raw in frames)


def frames_of_tlog(data: bytes) -> list[bytes]:
    """Everything that looks like a frame eight bytes before the next one; damage is skipped."""
    frames = []
    at = 8
    while at + 12 < len(data):
        length = data[at + 1] + (12 + 13 * (data[at + 2] & 1) if data[at] == 0xFD else 8)
        follower = data[at + length + 8 : at + length + 9]
        if data[at] in (0xFD, 0xFE) and follower in (b"\xfd", b"\xfe", b""):
            frames.append(data[at : at + length])
            at += length + 8
        else:
            at += 1
    return frames


def test_infinity_and_nan_go_through_untouched() -> None:
    raw = frame_v2(32, struct.pack("<I6f", 1, math.nan, math.inf, -math.inf, 0.0, -0.0, 1.0))
    assert ros1.rebuild(encoded(raw, 0, 0)) == raw
