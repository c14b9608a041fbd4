"""Writing frames, and what is refused at encoding."""

from __future__ import annotations

import math

import msgspec
import pytest

from gcs.wire.codec import EncodeError, FrameWriter, decode, encode
from gcs.wire.frame import Frame, split
from gcs.wire.ids import MsgId
from gcs.wire.messages import (
    GpsGlobalOrigin,
    Heartbeat,
    HomePosition,
    LocalPositionNed,
    Message,
    MissionCount,
    MissionCurrent,
    MissionItemReached,
    ParamValue,
    Statustext,
)

POSITION = LocalPositionNed(time_boot_ms=1, x=1.0, y=2.0, z=-3.0, vx=0.0, vy=0.0, vz=0.0)
BEAT = Heartbeat(custom_mode=0, type=6, autopilot=8, base_mode=0, system_status=4)


def only(raw: bytes) -> Frame:
    (frame,) = split(raw)
    assert isinstance(frame, Frame)
    return frame


def test_each_writer_counts_its_own_frames_and_wraps() -> None:
    one, other = FrameWriter(255, 190), FrameWriter(255, 190)
    assert [only(one.write(BEAT)).seq for _ in range(258)] == [*range(256), 0, 1]
    assert only(other.write(BEAT)).seq == 0


def test_a_message_that_does_not_encode_uses_up_no_number() -> None:
    writer = FrameWriter(255, 190)
    with pytest.raises(EncodeError):
        writer.write(MissionItemReached(seq=-1))
    assert only(writer.write(BEAT)).seq == 0


def test_trailing_zeros_are_cut_but_for_the_first_byte() -> None:
    assert len(only(FrameWriter(1, 1).write(MissionItemReached(seq=0))).payload) == 1
    count = MissionCount(count=0, target_system=1, target_component=1)
    assert only(FrameWriter(1, 1).write(count)).payload == b"\0\0\x01\x01"


def test_a_known_frame_has_these_bytes() -> None:
    raw = FrameWriter(255, 190).write(BEAT)
    assert raw[:-2].hex() == "fd09000000ffbe000000" + "000000000608000403"


@pytest.mark.parametrize(
    ("message", "blamed"),
    [
        (MissionItemReached(seq=65_536), "MISSION_ITEM_REACHED: seq = 65536"),
        (
            GpsGlobalOrigin(latitude=0, longitude=2**31, altitude=0),
            "GPS_GLOBAL_ORIGIN: longitude = 2147483648",
        ),
        (Statustext(severity=6, text="x" * 51), "STATUSTEXT.text: .* longer than 50"),
    ],
)
def test_a_value_that_does_not_fit_is_named(
    message: MissionItemReached | GpsGlobalOrigin | Statustext, blamed: str
) -> None:
    with pytest.raises(EncodeError, match=blamed):
        encode(message)


def test_an_array_of_the_wrong_length_is_named() -> None:
    zeros = decode(only(FrameWriter(1, 1).write_payload(MsgId.HOME_POSITION, bytes(60))))
    assert isinstance(zeros, HomePosition)
    with pytest.raises(EncodeError, match=r"HOME_POSITION\.q: 3 elements instead of 4"):
        encode(msgspec.structs.replace(zeros, q=(1.0, 0.0, 0.0)))


def test_a_number_too_large_for_float32_is_named() -> None:
    told = ParamValue(param_value=1e39, param_count=1, param_index=0, param_id="P", param_type=9)
    with pytest.raises(EncodeError, match="PARAM_VALUE: param_value = 1e"):
        encode(told)


def test_text_ends_at_its_nul_and_may_fill_its_field() -> None:
    full = ParamValue(
        param_value=0.0, param_count=1, param_index=0, param_id="SIXTEEN_LETTERS_", param_type=9
    )
    assert decode(only(FrameWriter(1, 1).write(full))) == full
    raw = FrameWriter(1, 1).write(Statustext(severity=6, text="left\0right"))
    assert decode(only(raw)) == Statustext(severity=6, text="left")


def test_bytes_that_are_no_text_do_not_raise() -> None:
    payload = b"\x06" + b"\xff\xc3\x28" + bytes(50)
    decoded = decode(only(FrameWriter(1, 1).write_payload(MsgId.STATUSTEXT, payload)))
    assert isinstance(decoded, Statustext)
    assert decoded.text.startswith("\N{REPLACEMENT CHARACTER}")


def test_not_a_number_travels() -> None:
    sent = msgspec.structs.replace(POSITION, x=math.nan)
    decoded = decode(only(FrameWriter(1, 1).write(sent)))
    assert isinstance(decoded, LocalPositionNed)
    assert math.isnan(decoded.x)
    assert decoded.y == sent.y


def test_a_message_without_a_class_is_not_decoded() -> None:
    raw = FrameWriter(1, 1).write_payload(MsgId.POSITION_TARGET_LOCAL_NED, bytes(51))
    assert decode(only(raw)) is None


def test_messages_of_different_kinds_are_never_equal() -> None:
    reached: Message = MissionItemReached(seq=3)
    current: Message = MissionCurrent(seq=3)
    assert reached != current
    assert reached == MissionItemReached(seq=3)


def test_what_a_terminal_would_obey_is_no_part_of_a_text() -> None:
    """Escape sequences of C0 and C1, line ends, and what turns the direction of writing."""
    said = "\x1b[2J\u009b31m a\nb\r\u202ec\u2066\x07d\x7f\ttab"
    raw = FrameWriter(1, 1).write(Statustext(severity=6, text=said))
    decoded = decode(only(raw))
    assert isinstance(decoded, Statustext)
    bad = "\N{REPLACEMENT CHARACTER}"
    assert decoded.text == f"{bad}[2J{bad}31m a b {bad}c{bad}{bad}d{bad}\ttab"
    assert said.encode() in raw
