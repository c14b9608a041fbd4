"""Frames made anew, with another number or as MAVLink 1: pymavlink reads the same message."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v10 import all as v10
from pymavlink.dialects.v20 import all as v20

from gcs.wire.frame import Frame, split
from gcs.wire.rewrite import as_mavlink1, seq_of, source_of, with_seq

KEY = bytes(range(32))


def packed(message: Any, *, version: int = 2, seq: int = 7, signed: bool = False) -> bytes:
    mav = v20.MAVLink(None, srcSystem=3, srcComponent=4)
    mav.seq = seq
    if signed:
        mav.signing.secret_key = KEY
        mav.signing.sign_outgoing = True
    return bytes(message.pack(mav, force_mavlink1=version == 1))


def attitude() -> Any:
    return v20.MAVLink_attitude_message(1000, 0.25, -0.5, 1.0, 0.0, 0.0, 0.0)


def battery() -> Any:
    """With fields that MAVLink 2 added."""
    volts = [12000] + [65535] * 9
    return v20.MAVLink_battery_status_message(
        0, 1, 1, 2000, volts, 500, 10, 20, 90, 3600, 1, [0, 0, 0, 7], 1, 5
    )


def protocol_of(message: Any) -> dict[str, Any]:
    return {name: getattr(message, name) for name in message.get_fieldnames()}


@given(st.integers(0, 255), st.sampled_from((1, 2)), st.booleans())
def test_another_number_and_nothing_else(seq: int, version: int, signed: bool) -> None:
    raw = packed(attitude(), version=version, signed=signed and version == 2)
    made = with_seq(raw, seq)
    (read,) = v20.MAVLink(None).parse_buffer(made)
    assert (read.get_seq(), read.get_srcSystem(), read.get_srcComponent()) == (seq, 3, 4)
    assert protocol_of(read) == protocol_of(attitude())
    assert not read.get_signed()
    assert made[0] == raw[0]
    assert (seq_of(made), source_of(made)) == (seq, bytes((3, 4)))


@given(st.integers(0, 255), st.integers(0, 255), st.binary(min_size=1, max_size=60))
def test_a_message_that_the_dialect_lacks_has_a_right_checksum_as_well(
    seq: int, crc_extra: int, payload: bytes
) -> None:
    """Whoever knows the message knows its CRC extra."""

    def frame(number: int) -> bytes:
        body = bytes((len(payload), 0, 0, number, 3, 4, 0x50, 0xC3, 0)) + payload
        crc = v20.x25crc(body)
        crc.accumulate(bytes((crc_extra,)))
        return b"\xfd" + body + int(crc.crc).to_bytes(2, "little")

    assert with_seq(frame(7), seq) == frame(seq)


@pytest.mark.parametrize("message", [attitude(), battery()], ids=lambda m: m.get_type())
def test_mavlink_1_has_the_fields_that_it_knows(message: Any) -> None:
    """Read by a parser that knows MAVLink 1 alone."""
    made = as_mavlink1(packed(message, signed=True))
    assert made is not None
    (read,) = v10.MAVLink(None).parse_buffer(made)
    assert (read.get_seq(), read.get_srcSystem(), read.get_srcComponent()) == (7, 3, 4)
    wanted = protocol_of(message)
    assert protocol_of(read) == {name: wanted[name] for name in read.get_fieldnames()}
    (frame,) = split(made)
    assert isinstance(frame, Frame)


def test_what_mavlink_1_cannot_say() -> None:
    event = v20.MAVLink_open_drone_id_location_message(0, 0, bytes(20), *[0] * 15, 0)
    assert as_mavlink1(packed(event)) is None
    already = packed(attitude(), version=1)
    assert as_mavlink1(already) == already
