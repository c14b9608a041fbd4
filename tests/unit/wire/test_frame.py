"""From bytes to frames: nothing good is swallowed, nothing bad is believed, nothing is lost."""

from __future__ import annotations

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pymavlink.dialects.v20 import all as pymavlink_dialect

from gcs.wire.codec import FrameWriter, decode
from gcs.wire.dialect import MESSAGES, MESSAGES_BY_NAME
from gcs.wire.frame import (
    MAX_DATAGRAM,
    MAX_FRAME,
    Frame,
    Garbage,
    Item,
    Reason,
    StreamSplitter,
    split,
)
from gcs.wire.messages import LocalPositionNed, MissionItemReached, Statustext
from tests.shares import examples

POSITION = LocalPositionNed(time_boot_ms=1234, x=1.0, y=2.0, z=-3.0, vx=0.5, vy=0.25, vz=0.125)
UNKNOWN_ID = 59_999


def position(seq: int = 0, mavlink1: bool = False) -> bytes:
    """POSITION in a frame: in MAVLink 1 as pymavlink writes it, we write MAVLink 2 only."""
    if mavlink1:
        return position_mavlink1(seq)
    writer = FrameWriter(1, 1)
    writer.seq = seq
    return writer.write(POSITION)


def position_mavlink1(seq: int) -> bytes:
    sender = pymavlink_dialect.MAVLink(None, srcSystem=1, srcComponent=1)
    sender.seq = seq
    twin = pymavlink_dialect.MAVLink_local_position_ned_message(*msgspec.structs.astuple(POSITION))
    return bytes(twin.pack(sender, force_mavlink1=True))


def unknown(payload: bytes = b"hello") -> bytes:
    """A frame of a message that the dialect lacks: nobody here can tell its checksum."""
    header = bytes((0xFD, len(payload), 0, 0, 5, 1, 1)) + UNKNOWN_ID.to_bytes(3, "little")
    return header + payload + b"\x12\x34"


def frames(items: list[Item]) -> list[Frame]:
    return [item for item in items if isinstance(item, Frame)]


def garbage(items: list[Item]) -> list[Garbage]:
    return [item for item in items if isinstance(item, Garbage)]


def rejoined(items: list[Item]) -> bytes:
    return b"".join(item.raw for item in items)


assert UNKNOWN_ID not in MESSAGES


@pytest.mark.parametrize("mavlink1", [False, True], ids=["mavlink2", "mavlink1"])
def test_one_frame_is_taken_apart(mavlink1: bool) -> None:
    raw = position(seq=7, mavlink1=mavlink1)
    (frame,) = frames(split(raw))
    assert frame.raw == raw
    assert (frame.seq, frame.sysid, frame.compid, frame.msgid) == (7, 1, 1, 32)
    assert frame.known
    assert frame.signature == b""
    assert frame.name == "LOCAL_POSITION_NED"
    assert decode(frame) == POSITION


def test_a_signed_frame_keeps_its_signature() -> None:
    sender = pymavlink_dialect.MAVLink(None, srcSystem=1, srcComponent=1)
    sender.signing.secret_key = bytes(32)
    sender.signing.sign_outgoing = True
    raw = bytes(pymavlink_dialect.MAVLink_mission_item_reached_message(seq=3).pack(sender))
    (frame,) = frames(split(raw))
    assert frame.signature == raw[-13:]
    assert decode(frame) == MissionItemReached(seq=3)


def test_several_frames_in_one_datagram_come_in_order() -> None:
    data = position(1) + position(2, mavlink1=True) + position(3)
    assert [frame.seq for frame in frames(split(data))] == [1, 2, 3]
    assert rejoined(split(data)) == data


def test_zeros_that_were_cut_come_back_and_bytes_from_the_future_stay() -> None:
    writer = FrameWriter(1, 1)
    short = writer.write(Statustext(severity=6, text="Hi"))
    (frame,) = frames(split(short))
    assert frame.payload == b"\x06Hi"
    assert decode(frame) == Statustext(severity=6, text="Hi")
    (longer,) = frames(split(writer.write_payload(46, b"\x03\x00" + b"more")))
    assert longer.payload == b"\x03\x00more"
    assert decode(longer) == MissionItemReached(seq=3)


@pytest.mark.parametrize("stray", [b"\xfd", b"\xfe", b"\xfd\x09\x00", b"\xfe\x00", b"\xfd" * 40])
def test_a_stray_magic_swallows_nothing(stray: bytes) -> None:
    data = stray + position(1) + position(2)
    items = split(data)
    assert [frame.seq for frame in frames(items)] == [1, 2]
    assert rejoined(items) == data
    assert garbage(items)[0].raw == stray


def test_a_stray_header_of_an_unknown_message_swallows_nothing() -> None:
    stray = unknown(bytes(60))[:12]
    items = split(stray + position(1) + position(2))
    assert [frame.seq for frame in frames(items)] == [1, 2]


def test_an_unknown_message_is_a_frame_whose_checksum_nobody_checked() -> None:
    items = split(position(1) + unknown() + unknown(b"again") + position(2))
    assert [frame.known for frame in frames(items)] == [True, False, False, True]
    assert not garbage(items)
    assert frames(items)[1].name == "UNKNOWN_59999"
    assert decode(frames(items)[1]) is None
    assert frames(items)[1].payload == b"hello"


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"Init ArduCopter V4.7\r\n", Reason.TEXT),
        (b"\x00\x01\x02", Reason.GARBAGE),
        (position()[:-1] + b"\x00", Reason.CRC),
        (position()[:-5], Reason.TRUNCATED),
        (b"\xfd", Reason.TRUNCATED),
        (b"\xfd\x09\x02" + position()[3:], Reason.INCOMPAT),
        (unknown() + b"x", Reason.CRC),
        (position() * 500, Reason.OVERSIZE),
    ],
)
def test_what_is_no_frame_is_told_why(data: bytes, reason: Reason) -> None:
    assert split(data) == [Garbage(data, reason)]


def test_an_empty_datagram_is_nothing() -> None:
    assert split(b"") == []


def test_leftovers_between_good_frames_are_one_piece_each() -> None:
    items = split(b"boot\n" + position(1) + b"\x00\x01" + position(2) + position(3)[:9])
    assert [item.reason for item in garbage(items)] == [
        Reason.TEXT,
        Reason.GARBAGE,
        Reason.TRUNCATED,
    ]
    assert [frame.seq for frame in frames(items)] == [1, 2]


# ------------------------------------------------------------------------------ streams


@pytest.mark.parametrize("step", [1, 2, 3, 7, 11, 1000])
def test_a_stream_in_pieces_gives_the_frames_of_the_whole(step: int) -> None:
    data = b"boot\n" + position(1) + b"\xfd" + position(2, mavlink1=True) + unknown() + position(3)
    splitter = StreamSplitter()
    items: list[Item] = []
    for start in range(0, len(data), step):
        items += splitter.feed(data[start : start + step])
    items += splitter.close()
    assert [(frame.seq, frame.known) for frame in frames(items)] == [
        (1, True),
        (2, True),
        (5, False),
        (3, True),
    ]
    assert rejoined(items) == data


def test_a_frame_leaves_the_stream_with_its_last_byte() -> None:
    splitter = StreamSplitter()
    raw = position(1)
    for byte in raw[:-1]:
        assert splitter.feed(bytes((byte,))) == []
    assert [frame.seq for frame in frames(splitter.feed(raw[-1:]))] == [1]
    assert splitter.waiting == 0


def test_a_stray_magic_in_a_stream_holds_nothing_up() -> None:
    splitter = StreamSplitter()
    items = splitter.feed(b"\xfd" + position(1))
    assert [frame.seq for frame in frames(items)] == [1]


# --------------------------------------------------------------------------- properties

PIECES = st.one_of(
    st.binary(max_size=40),
    st.builds(position, st.integers(0, 255), st.booleans()),
    st.builds(unknown, st.binary(max_size=20)),
    st.sampled_from([b"\xfd", b"\xfe", b"\xfd\xff\x01", b"hello\r\n"]),
)
MAGICLESS = st.binary(max_size=60).map(lambda b: b.replace(b"\xfd", b"").replace(b"\xfe", b""))


@pytest.mark.slow
@settings(max_examples=examples(300))
@given(st.lists(PIECES, max_size=8).map(b"".join))
def test_no_bytes_raise_and_none_are_lost(data: bytes) -> None:
    items = split(data)
    assert rejoined(items) == data
    for frame in frames(items):
        decode(frame)


@settings(max_examples=examples(300))
@given(st.lists(PIECES, max_size=8), st.lists(st.integers(1, 50), min_size=1))
def test_no_stream_raises_loses_bytes_or_grows(pieces: list[bytes], steps: list[int]) -> None:
    data = b"".join(pieces)
    splitter = StreamSplitter()
    items: list[Item] = []
    at = 0
    for step in steps * (len(data) // sum(steps) + 1):
        items += splitter.feed(data[at : at + step])
        assert splitter.waiting <= MAX_FRAME
        at += step
    items += splitter.close()
    assert rejoined(items) == data
    known = [frame.raw for frame in frames(items) if frame.known]
    assert known == [frame.raw for frame in frames(split(data)) if frame.known]


@settings(max_examples=examples(300))
@given(st.lists(st.tuples(st.booleans(), st.integers(0, 255), MAGICLESS), max_size=8))
def test_every_good_frame_is_found_after_garbage(parts: list[tuple[bool, int, bytes]]) -> None:
    data = b"".join(noise + position(seq, mavlink1) for mavlink1, seq, noise in parts)
    assert [frame.seq for frame in frames(split(data))] == [seq for _, seq, _ in parts]


@settings(max_examples=examples(300))
@given(st.integers(0, len(position()) - 1), st.integers(1, 255))
def test_a_damaged_byte_costs_one_frame_and_not_the_next(at: int, flip: int) -> None:
    damaged = bytearray(position(1))
    damaged[at] ^= flip
    found = frames(split(bytes(damaged) + position(2)))
    assert [frame.raw for frame in found if frame.known] == [position(2)]


def test_the_largest_datagram_of_magics_is_only_slow() -> None:
    (item,) = split(b"\xfd" * MAX_DATAGRAM)
    assert item == Garbage(b"\xfd" * MAX_DATAGRAM, Reason.INCOMPAT)


def test_a_payload_of_255_bytes_fits() -> None:
    definition = MESSAGES_BY_NAME["PLAY_TUNE_V2"]
    payload = bytes(range(1, definition.max_len + 1))
    (frame,) = frames(split(FrameWriter(1, 1).write_payload(definition.msgid, payload)))
    assert frame.payload == payload
