"""Writing frames, and what is refused at encoding."""

from __future__ import annotations

import math

import pytest

from gcs.wire.codec import (
    EncodeError,
    FrameWriter,
    decode,
    decode_fields,
    encode,
    encode_fields,
)
from gcs.wire.frame import Frame, split
from gcs.wire.ids import MsgId
from gcs.wire.messages import (
    GpsGlobalOrigin,
    Heartbeat,
    HomePosition,
    Message,
    MissionCount,
    MissionCurrent,
    MissionItemReached,
    ParamValue,
    Statustext,
)

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
    raw = FrameWriter(255, 190, mavlink1=True).write(BEAT)
    assert raw[:-2].hex() == "fe0900ffbe00" + "000000000608000403"


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
    fields = decode_fields(only(FrameWriter(1, 1).write_payload(MsgId.HOME_POSITION, bytes(60))))
    assert fields is not None
    home = HomePosition(**{**fields, "q": (1.0, 0.0, 0.0)})  # type: ignore[arg-type]  # wrong on purpose
    with pytest.raises(EncodeError, match=r"HOME_POSITION\.q: 3 elements instead of 4"):
        encode(home)


def test_a_number_too_large_for_float32_is_named() -> None:
    with pytest.raises(EncodeError, match="param_value = 1e"):
        encode_fields(MsgId.PARAM_SET, {"param_value": 1e39})


def test_text_ends_at_its_nul_and_may_fill_its_field() -> None:
    full = ParamValue(
        param_value=0.0, param_count=1, param_index=0, param_id="SIXTEEN_LETTERS_", param_type=9
    )
    assert decode(only(FrameWriter(1, 1).write(full))) == full
    raw = encode_fields(MsgId.STATUSTEXT, {"severity": 6, "text": "left\0right"})
    decoded = decode(only(FrameWriter(1, 1).write_payload(MsgId.STATUSTEXT, raw)))
    assert decoded == Statustext(severity=6, text="left")


def test_bytes_that_are_no_text_do_not_raise() -> None:
    payload = b"\x06" + b"\xff\xc3\x28" + bytes(50)
    decoded = decode(only(FrameWriter(1, 1).write_payload(MsgId.STATUSTEXT, payload)))
    assert isinstance(decoded, Statustext)
    assert decoded.text.startswith("\N{REPLACEMENT CHARACTER}")


def test_not_a_number_travels() -> None:
    payload = encode_fields(MsgId.COMMAND_LONG, {"param4": math.nan, "command": 22})
    fields = decode_fields(only(FrameWriter(1, 1).write_payload(MsgId.COMMAND_LONG, payload)))
    assert fields is not None
    assert math.isnan(float(fields["param4"]))  # type: ignore[arg-type]  # a scalar field
    assert fields["command"] == 22


def test_what_the_dialect_lacks_is_refused() -> None:
    with pytest.raises(EncodeError, match="no message 59999"):
        encode_fields(59_999, {})
    with pytest.raises(EncodeError, match="HEARTBEAT has no field mood"):
        encode_fields(MsgId.HEARTBEAT, {"mood": 1})


def test_messages_of_different_kinds_are_never_equal() -> None:
    reached: Message = MissionItemReached(seq=3)
    current: Message = MissionCurrent(seq=3)
    assert reached != current
    assert reached == MissionItemReached(seq=3)
