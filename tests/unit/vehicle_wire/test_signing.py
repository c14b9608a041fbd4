"""Message signing (MAVLink guide, "Message Signing") against pymavlink's, which is the oracle."""

from __future__ import annotations

import hashlib

import pytest
from pymavlink.dialects.v20 import all as upstream

from vehicle_sim.wire.codec import BY_TYPE, SIGNED, MavlinkFrame, encode
from vehicle_sim.wire.messages import Heartbeat, SetupSigning, Timesync
from vehicle_sim.wire.signing import (
    EPOCH_UNIX_NS,
    TIMESTAMP_MAX,
    Signing,
    SigningKey,
    SigningKeyError,
    Verdict,
    parse_key,
    timestamp_of,
)
from vehicle_sim.wire.split import Counters, split

S = 1_000_000_000
KEY = SigningKey(bytes(range(32)))
OTHER = SigningKey(bytes(32 * [7]))
NOW_NS = EPOCH_UNIX_NS + 1_000_000 * S
NOW = 100_000 * 1_000_000  # the same in ticks of 10 us
MINUTE = 60 * 100_000


class Ground:
    """A ground station of pymavlink's, with the key."""

    def __init__(self, key: SigningKey = KEY, link_id: int = 3, timestamp: int = NOW) -> None:
        self.mav = upstream.MAVLink(None, srcSystem=255, srcComponent=190)
        self.mav.signing.secret_key = key.secret
        self.mav.signing.link_id = link_id
        self.mav.signing.timestamp = timestamp
        self.mav.signing.sign_outgoing = True
        self.mav.robust_parsing = True

    def says(self) -> bytes:
        beat = upstream.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)
        return bytes(beat.pack(self.mav))


def frame(data: bytes) -> MavlinkFrame:
    (only,) = split(data, Counters())
    return only


def sealed(signing: Signing, unix_ns: int, sequence: int = 0, link_id: int = 1) -> bytes:
    codec = BY_TYPE[Heartbeat]
    payload = codec.payload(Heartbeat(0, 2, 12, 81, 3, 3))
    return signing.seal(codec.frame(payload, sequence, 1, 1, SIGNED), link_id, unix_ns)


def test_what_pymavlink_signs_is_good() -> None:
    signing, ground = Signing(KEY), Ground()
    for _ in range(5):
        assert signing.judge(frame(ground.says()), NOW_NS) is Verdict.GOOD


def test_pymavlink_takes_what_we_sign() -> None:
    signing, ground = Signing(KEY), Ground()
    for sequence in range(5):
        (read,) = ground.mav.parse_buffer(sealed(signing, NOW_NS, sequence))
        assert read.get_type() == "HEARTBEAT"
        assert read.get_signed()
    assert list(ground.mav.signing.stream_timestamps) == [(1, 1, 1)]
    assert ground.mav.signing.stream_timestamps[1, 1, 1] == NOW + 4


def test_pymavlink_refuses_our_frames_under_another_key() -> None:
    told = Ground().mav.parse_buffer(sealed(Signing(OTHER), NOW_NS))
    assert [each.get_type() for each in told] == ["BAD_DATA"]


def test_any_changed_byte_makes_the_signature_bad() -> None:
    """Whoever changes a byte can mend the checksum, but not the signature."""
    good = Ground().says()
    for at in range(1, len(good)):
        changed = bytearray(good)
        changed[at] ^= 0x20
        taken = MavlinkFrame(2, 0, 255, 190, 0, b"", True, bytes(changed))
        assert Signing(KEY).judge(taken, NOW_NS) is Verdict.BAD_SIGNATURE, at
    assert Signing(KEY).judge(frame(good), NOW_NS) is Verdict.GOOD


def test_a_frame_of_another_key_is_bad() -> None:
    assert Signing(KEY).judge(frame(Ground(OTHER).says()), NOW_NS) is Verdict.BAD_SIGNATURE


def test_an_unsigned_frame_is_not_taken_in_either_version_but_for_the_radios_own() -> None:
    signing = Signing(KEY)
    beat = upstream.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)
    plain = upstream.MAVLink(None, srcSystem=255, srcComponent=190)
    for mavlink1 in (False, True):
        data = bytes(beat.pack(plain, force_mavlink1=mavlink1))
        assert signing.judge(frame(data), NOW_NS) is Verdict.UNSIGNED
    radio = upstream.MAVLink_radio_status_message(200, 190, 90, 40, 40, 0, 0)
    assert signing.judge(frame(bytes(radio.pack(plain))), NOW_NS) is Verdict.GOOD


def test_without_a_key_everything_is_good() -> None:
    signing = Signing()
    assert not signing.on
    assert signing.judge(frame(encode(Timesync(0, 1), 0, 255, 190)), NOW_NS) is Verdict.GOOD
    assert signing.judge(frame(Ground(OTHER).says()), NOW_NS) is Verdict.GOOD


def test_a_replayed_frame_is_refused_and_an_older_one_too() -> None:
    signing, ground = Signing(KEY), Ground()
    first, second, third = ground.says(), ground.says(), ground.says()
    assert signing.judge(frame(second), NOW_NS) is Verdict.GOOD
    assert signing.judge(frame(second), NOW_NS) is Verdict.REPLAYED
    assert signing.judge(frame(first), NOW_NS) is Verdict.REPLAYED
    assert signing.judge(frame(third), NOW_NS) is Verdict.GOOD


def test_each_link_id_is_a_stream_with_a_time_of_its_own() -> None:
    signing = Signing(KEY)
    quick, slow = Ground(link_id=1, timestamp=NOW + 1000), Ground(link_id=2, timestamp=NOW)
    assert signing.judge(frame(quick.says()), NOW_NS) is Verdict.GOOD
    assert signing.judge(frame(slow.says()), NOW_NS) is Verdict.GOOD


def test_a_forged_frame_does_not_move_its_stream() -> None:
    """Else anybody could lock a ground station out with a time in the future."""
    signing, ground = Signing(KEY), Ground()
    forged = Ground(OTHER, timestamp=NOW + MINUTE)
    assert signing.judge(frame(forged.says()), NOW_NS) is Verdict.BAD_SIGNATURE
    assert signing.judge(frame(ground.says()), NOW_NS) is Verdict.GOOD


@pytest.mark.parametrize(
    ("behind", "verdict"), [(MINUTE, Verdict.GOOD), (MINUTE + 1, Verdict.REPLAYED)]
)
def test_a_new_stream_may_be_a_minute_behind(behind: int, verdict: Verdict) -> None:
    late = frame(Ground(timestamp=NOW - behind).says())
    assert Signing(KEY).judge(late, NOW_NS) is verdict


def test_a_new_stream_is_measured_by_the_latest_time_heard() -> None:
    signing = Signing(KEY)
    ahead = Ground(link_id=1, timestamp=NOW + 3 * MINUTE)
    assert signing.judge(frame(ahead.says()), NOW_NS) is Verdict.GOOD
    assert signing.judge(frame(Ground(link_id=2).says()), NOW_NS) is Verdict.REPLAYED


def test_our_time_rises_with_every_frame_even_if_the_clock_does_not() -> None:
    signing = Signing(KEY)
    clocks = (NOW_NS, NOW_NS, NOW_NS - 5 * S, NOW_NS + S, 0)
    frames = [sealed(signing, unix_ns) for unix_ns in clocks]
    stamps = [int.from_bytes(each[-12:-6], "little") for each in frames]
    assert stamps == [NOW, NOW + 1, NOW + 2, NOW + 100_000, NOW + 100_001]
    assert [each[-13] for each in frames] == [1] * 5


def test_our_time_follows_a_ground_station_that_is_ahead() -> None:
    signing = Signing(KEY)
    signing.judge(frame(Ground(timestamp=NOW + MINUTE).says()), NOW_NS)
    assert int.from_bytes(sealed(signing, NOW_NS)[-12:-6], "little") == NOW + MINUTE + 1


def test_the_end_of_time_is_no_error() -> None:
    signing = Signing(KEY)
    signing.setup(KEY, 1 << 63)
    assert int.from_bytes(sealed(signing, NOW_NS)[-12:-6], "little") == TIMESTAMP_MAX
    assert timestamp_of(0) == 0


def test_a_key_that_comes_back_lets_no_old_frame_in() -> None:
    signing, ground = Signing(KEY), Ground()
    told = ground.says()
    assert signing.judge(frame(told), NOW_NS) is Verdict.GOOD
    signing.follow(SetupSigning(0, 1, 1, bytes(32)))
    signing.follow(SetupSigning(NOW, 1, 1, KEY.secret))
    assert signing.judge(frame(told), NOW_NS) is Verdict.REPLAYED


def test_setup_signing_sets_changes_and_ends_it() -> None:
    signing = Signing()
    signing.follow(SetupSigning(NOW, 1, 1, KEY.secret))
    assert signing.judge(frame(Ground().says()), NOW_NS) is Verdict.GOOD
    signing.follow(SetupSigning(NOW, 1, 1, OTHER.secret))
    assert signing.judge(frame(Ground().says()), NOW_NS) is Verdict.BAD_SIGNATURE
    later = Ground(OTHER, timestamp=NOW + 1)
    assert signing.judge(frame(later.says()), NOW_NS) is Verdict.GOOD
    signing.follow(SetupSigning(NOW, 1, 1, bytes(32)))
    assert signing.on, "a key of zeros with a time is a key"
    signing.follow(SetupSigning(0, 1, 1, bytes(32)))
    assert not signing.on


def test_a_key_is_raw_bytes_or_hex_or_a_passphrase() -> None:
    assert parse_key(KEY.secret) == KEY
    assert parse_key(KEY.secret.hex().encode()) == KEY
    assert parse_key(KEY.secret.hex().upper().encode() + b"\r\n") == KEY
    assert parse_key(b"correct horse\n").secret == hashlib.sha256(b"correct horse").digest()
    assert parse_key(b"x" * 64).secret == hashlib.sha256(b"x" * 64).digest()
    assert parse_key(b"\n" * 32).secret == b"\n" * 32
    for empty in (b"", b"\n"):
        with pytest.raises(SigningKeyError, match="empty"):
            parse_key(empty)
    with pytest.raises(SigningKeyError, match="32 bytes, not 5"):
        SigningKey(b"short")


def test_a_key_is_not_shown() -> None:
    assert "passphrase" not in repr(SigningKey(b"passphrase".ljust(32)))
