"""What is kept of a SETUP_SIGNING: all but the key."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from gcs.wire.blanking import blanked, without_key
from gcs.wire.codec import FrameWriter, decode
from gcs.wire.frame import Frame, StreamSplitter, split
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
def test_bytes_that_are_no_frame_do_not_become_one(key: bytes) -> None:
    raw = setup(key)
    broken = bytearray(raw)
    broken[-1] ^= 1
    kept = blanked(bytes(broken), mend=False)
    zeros = bytes(min(32, len(raw) - 22))  # MAVLink 2 cuts a key's last zeros
    assert kept == bytes(broken[:20]) + zeros + kept[20 + len(zeros) :]
    assert not any(isinstance(item, Frame) for item in split(kept))


@given(key=keys, cut=st.integers(1, 60), signed=st.booleans())
def test_a_stream_that_was_cut_anywhere_gives_the_same_frame_without_its_key(
    key: bytes, cut: int, signed: bool
) -> None:
    """What is recorded of a read that ends within the frame goes on with what is recorded next."""
    raw = setup(key, signed=signed)
    splitter = StreamSplitter()
    splitter.feed(raw[:cut])
    rest = blanked(splitter.rest, mend=True)
    assert without_key(raw).startswith(rest) or cut >= len(raw)


def test_other_frames_stay_as_they_are() -> None:
    raw = FrameWriter(255, 191).write(BEAT)
    assert without_key(raw) is raw
