"""What is kept of a SETUP_SIGNING: all but the key."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from gcs.wire.blanking import (
    datagram_without_keys,
    may_hold_key,
    without_key,
    without_keys,
)
from gcs.wire.codec import FrameWriter, decode
from gcs.wire.frame import Frame, split
from gcs.wire.messages import Heartbeat, SetupSigning
from gcs.wire.signing import SecretKey, Signer

keys = st.binary(min_size=32, max_size=32)
BEAT = Heartbeat(custom_mode=0, type=6, autopilot=8, base_mode=0, system_status=4)
NOW_NS = 1_700_000_000_000_000_000


def setup(key: bytes, *, signed: bool = False) -> bytes:
    message = SetupSigning(
        initial_timestamp=77, target_system=1, target_component=1, secret_key=tuple(key)
    )
    raw = FrameWriter(255, 191).write(message)
    return Signer(SecretKey(bytes(32)), 1).sign(raw, NOW_NS) if signed else raw


@given(key=keys, signed=st.booleans())
def test_the_frame_stays_a_good_one_of_the_same_length(key: bytes, signed: bool) -> None:
    raw = setup(key, signed=signed)
    kept = without_key(raw)
    assert len(kept) == len(raw)
    (frame,) = split(kept)
    assert isinstance(frame, Frame)
    message = decode(frame)
    assert isinstance(message, SetupSigning)
    assert message.secret_key == (0,) * 32
    assert (message.initial_timestamp, message.target_system) == (77, 1)
    assert without_key(kept) == kept


@given(key=keys)
def test_of_a_damaged_one_the_key_is_kept_out_too(key: bytes) -> None:
    raw = setup(key)
    broken = raw[:-1] + bytes([raw[-1] ^ 1])
    kept = without_keys(broken)
    zeros = bytes(min(32, len(raw) - 20))  # MAVLink 2 cuts a key's last zeros
    assert kept[: 20 + len(zeros)] == broken[:20] + zeros
    assert without_keys(kept) == kept


HEADER = b"\xfd\x2a\x00\x00\x00\xff\xbf\x00\x01\x00"
"""Of a SETUP_SIGNING."""


@given(before=st.binary(max_size=22), signed=st.booleans())
def test_a_key_that_looks_like_a_header_blanks_nothing_but_itself(
    before: bytes, signed: bool
) -> None:
    key = (before + HEADER + bytes(range(1, 33)))[:32]
    raw = setup(key, signed=signed)
    kept = without_key(raw)
    end = 10 + raw[1]
    assert kept[:20] + kept[end + 2 :] == raw[:20] + raw[end + 2 :]
    assert set(kept[20:end]) <= {0}
    assert isinstance(split(kept)[0], Frame)


@given(
    st.lists(
        st.one_of(st.binary(max_size=60), st.just(HEADER), st.sampled_from(range(256)).map(bytes)),
        max_size=8,
    ).map(b"".join)
)
def test_what_is_recorded_stays_as_it_is_when_it_is_recorded_again(noise: bytes) -> None:
    kept = without_keys(noise)
    assert len(kept) == len(noise)
    assert without_keys(kept) == kept
    assert may_hold_key(kept) == may_hold_key(noise)
    whole = datagram_without_keys(noise)
    assert len(whole) == len(noise)


def test_a_time_stamp_that_makes_a_header_with_the_zeros_of_a_key_is_none() -> None:
    """fd ... 01 before the key, and zeros after it: the first 20 bytes are no key's place."""
    noise = HEADER + b"\x00\xfd\x00\x00\x00\x00\x00\x00\x00\x01" + bytes([7] * 60)
    kept = without_keys(noise)
    assert kept == noise[:20] + bytes(32) + noise[52:]
    assert without_keys(kept) == kept


def test_other_frames_stay_as_they_are() -> None:
    raw = FrameWriter(255, 191).write(BEAT)
    assert without_key(raw) is raw
