"""Signatures (MAVLink guide, "Message Signing") against pymavlink's, which is the oracle."""

from __future__ import annotations

import hashlib

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import all as upstream

from gcs.wire.codec import FrameWriter
from gcs.wire.frame import SIGNED, Frame, split
from gcs.wire.messages import Heartbeat, Statustext
from gcs.wire.signing import (
    AHEAD_MAX_TICKS,
    EPOCH_NS,
    GOOD,
    LATE_MAX_TICKS,
    SENT_MAX,
    STREAMS_MAX,
    TIMESTAMP_MAX,
    Bad,
    BadKeyError,
    Checker,
    Reason,
    SecretKey,
    Signer,
    SigningClock,
    UnsignableError,
    strip,
    timestamp_of,
)

S = 1_000_000_000
KEY = SecretKey(bytes(range(32)))
OTHER = SecretKey(bytes(32 * [7]))
NOW_NS = EPOCH_NS + 1_000_000 * S
NOW = 100_000 * 1_000_000  # the same in ticks of 10 us
BEAT = Heartbeat(custom_mode=0, type=6, autopilot=8, base_mode=0, system_status=4)


class Peer:
    """A program of pymavlink's with the key, or without one."""

    def __init__(
        self, key: SecretKey | None = KEY, link_id: int = 3, timestamp: int = NOW, sysid: int = 1
    ) -> None:
        self.mav = upstream.MAVLink(None, srcSystem=sysid, srcComponent=1)
        self.mav.robust_parsing = True
        if key is not None:
            self.mav.signing.secret_key = key.secret
            self.mav.signing.link_id = link_id
            self.mav.signing.timestamp = timestamp
            self.mav.signing.sign_outgoing = True
            self.mav.signing.allow_unsigned_callback = None

    def says(self, *, mavlink1: bool = False) -> bytes:
        beat = upstream.MAVLink_heartbeat_message(2, 12, 81, 0, 4, 3)
        self.mav.seq = (self.mav.seq + 1) & 0xFF
        return bytes(beat.pack(self.mav, force_mavlink1=mavlink1))

    def radio(self) -> bytes:
        return bytes(upstream.MAVLink_radio_status_message(1, 2, 3, 4, 5, 6, 7).pack(self.mav))

    def takes(self, data: bytes) -> bool:
        """Whether pymavlink, which checks as the guide has it, takes the frame."""
        return [m.get_type() != "BAD_DATA" for m in self.mav.parse_buffer(data) or []] == [True]


def frame(raw: bytes) -> Frame:
    (only,) = split(raw)
    assert isinstance(only, Frame)
    return only


def reason(checker: Checker, raw: bytes, now_ns: int = NOW_NS) -> Reason | None:
    verdict = checker.check(frame(raw), now_ns)
    return verdict.reason if isinstance(verdict, Bad) else None


# ---------------------------------------------------------------------------- what we sign


def test_pymavlink_takes_what_we_sign_and_reads_our_link_id_and_time() -> None:
    raw = Signer(KEY, 200).sign(FrameWriter(255, 191).write(BEAT), NOW_NS)
    (message,) = Peer().mav.parse_buffer(raw)
    assert (message.get_type(), message.get_srcSystem(), message.get_signed()) == (
        "HEARTBEAT",
        255,
        True,
    )
    assert message.get_link_id() == 200
    assert int.from_bytes(raw[-12:-6], "little") == NOW


def test_the_same_frame_with_the_same_key_and_time_is_the_same_to_the_byte() -> None:
    peer = Peer(link_id=9, timestamp=NOW - 1, sysid=7)
    writer = FrameWriter(7, 1)
    writer.seq = 1
    raw = peer.says()
    ours = writer.write(
        Heartbeat(custom_mode=0, type=2, autopilot=12, base_mode=81, system_status=4)
    )
    # pymavlink counts on from its timestamp before it signs, or after: only the time may differ
    ticks = int.from_bytes(raw[-12:-6], "little")
    assert Signer(KEY, 9).sign(ours, EPOCH_NS + ticks * 10_000) == raw


def test_another_key_or_one_bit_less_is_not_taken_by_pymavlink() -> None:
    raw = FrameWriter(255, 191).write(BEAT)
    assert not Peer(OTHER).takes(Signer(KEY, 0).sign(raw, NOW_NS))
    signed = bytearray(Signer(KEY, 0).sign(raw, NOW_NS))
    signed[-1] ^= 1
    assert not Peer().takes(bytes(signed))


@given(text=st.text(alphabet="abc\0", max_size=50), seq=st.integers(0, 255))
def test_signing_and_stripping_give_the_frame_back_whatever_is_in_it(text: str, seq: int) -> None:
    writer = FrameWriter(255, 191)
    writer.seq = seq
    raw = writer.write(Statustext(severity=6, text=text))
    signed = Signer(KEY, 1).sign(raw, NOW_NS)
    assert signed[2] == SIGNED
    assert Peer().takes(signed)
    assert strip(signed) == raw


@given(payload=st.binary(min_size=1, max_size=255), msgid=st.integers(0, (1 << 24) - 1))
def test_the_checksum_is_mended_for_messages_that_no_dialect_of_ours_has(
    payload: bytes, msgid: int
) -> None:
    """With a CRC extra of 77, which we do not know: a forwarded frame has to stay right."""
    from fastcrc import crc16

    def body(flags: int) -> bytes:
        return bytes((len(payload), flags, 0, 5, 1, 1)) + msgid.to_bytes(3, "little") + payload

    def whole(flags: int) -> bytes:
        crc = int(crc16.mcrf4xx(body(flags) + b"\x4d"))
        return b"\xfd" + body(flags) + crc.to_bytes(2, "little")

    signed = Signer(KEY, 0).sign(whole(0), NOW_NS)
    assert signed[:-13] == whole(SIGNED)
    assert strip(signed) == whole(0)


def test_what_is_forwarded_is_signed_anew_in_place_of_its_own_signature() -> None:
    raw = Peer(OTHER).says()
    ours = Signer(KEY, 200).sign(raw, NOW_NS)
    assert len(ours) == len(raw)
    assert Peer().takes(ours)


def test_a_frame_of_mavlink_1_becomes_one_of_mavlink_2_because_only_that_has_signatures() -> None:
    raw = Peer(None).says(mavlink1=True)
    assert raw[0] == 0xFE
    (message,) = Peer().mav.parse_buffer(Signer(KEY, 0).sign(raw, NOW_NS))
    assert (message.get_type(), message.base_mode, message.get_signed()) == ("HEARTBEAT", 81, True)
    assert strip(raw) == raw
    unknown = b"\xfe\x01\x00\x01\x01\xff\x00\x00\x00"
    with pytest.raises(UnsignableError, match="message 255"):
        Signer(KEY, 0).sign(unknown, NOW_NS)


@given(st.lists(st.integers(-70 * S, 70 * S), max_size=40))
def test_timestamps_rise_whatever_the_wall_clock_does(steps: list[int]) -> None:
    signers = [Signer(KEY, link_id, clock) for clock in [SigningClock()] for link_id in (1, 2)]
    now_ns, last = NOW_NS, 0
    for number, step in enumerate(steps):
        now_ns += step
        raw = signers[number % 2].sign(FrameWriter(255, 191).write(BEAT), now_ns)
        timestamp = int.from_bytes(raw[-12:-6], "little")
        assert timestamp > last
        assert timestamp >= timestamp_of(now_ns)
        last = timestamp


def test_a_station_that_begins_anew_with_a_clock_behind_goes_on_where_the_vehicle_is() -> None:
    clock = SigningClock()
    signer, checker = Signer(KEY, 1, clock), Checker(KEY, clock)
    vehicle = Peer(timestamp=NOW)
    behind_ns = NOW_NS - 3600 * S
    assert reason(checker, vehicle.says(), behind_ns) is None
    assert vehicle.takes(signer.sign(FrameWriter(255, 191).write(BEAT), behind_ns))


def test_time_ends_at_48_bits_and_begins_in_2015() -> None:
    assert timestamp_of(0) == timestamp_of(EPOCH_NS) == 0
    assert timestamp_of(EPOCH_NS + 10_000) == 1
    assert timestamp_of(EPOCH_NS + (TIMESTAMP_MAX + 5) * 10_000) == TIMESTAMP_MAX


# ------------------------------------------------------------------------------ what we check


def test_what_pymavlink_signs_is_good() -> None:
    checker, peer = Checker(KEY), Peer()
    assert [checker.check(frame(peer.says()), NOW_NS) for _ in range(5)] == [GOOD] * 5


def test_another_key_and_no_key_are_told_apart() -> None:
    checker = Checker(KEY)
    assert reason(checker, Peer(OTHER).says()) is Reason.WRONG_KEY
    assert reason(checker, Peer(None).says()) is Reason.UNSIGNED
    assert reason(checker, Peer(None).says(mavlink1=True)) is Reason.UNSIGNED


@given(data=st.data())
def test_no_bit_of_a_signed_frame_may_change(data: st.DataObject) -> None:
    raw = bytearray(Peer().says())
    bit = data.draw(st.integers(0, 8 * len(raw) - 1))
    raw[bit // 8] ^= 1 << bit % 8
    items = split(bytes(raw))
    taken = [i for i in items if isinstance(i, Frame) and Checker(KEY).check(i, NOW_NS) == GOOD]
    assert taken == []


@given(order=st.lists(st.integers(0, 9), min_size=1, max_size=60))
def test_of_what_was_sent_each_frame_is_taken_at_most_once_in_whatever_order(
    order: list[int],
) -> None:
    peer, checker = Peer(), Checker(KEY)
    sent = [peer.says() for _ in range(10)]
    newest = -1
    for number in order:
        expected = None if number > newest else Reason.REPLAYED
        assert reason(checker, sent[number]) is expected
        newest = max(newest, number)


def test_streams_have_times_of_their_own() -> None:
    checker = Checker(KEY)
    for link_id, sysid in ((0, 1), (1, 1), (0, 2)):
        raw = Peer(link_id=link_id, sysid=sysid).says()
        assert reason(checker, raw) is None
        assert reason(checker, raw) is Reason.REPLAYED


def test_what_was_signed_before_we_began_is_too_old_but_for_what_waits_in_a_socket() -> None:
    for early_ms, taken in ((0, True), (190, True), (210, False), (30_000, False)):
        checker = Checker(KEY, since_ns=NOW_NS)
        said = Peer(timestamp=timestamp_of(NOW_NS - early_ms * 1_000_000)).says()
        assert reason(checker, said) is (None if taken else Reason.TOO_OLD), early_ms


def test_a_new_stream_may_be_a_minute_behind_and_no_more() -> None:
    at_limit = NOW - LATE_MAX_TICKS
    assert reason(Checker(KEY), Peer(timestamp=at_limit).says()) is None
    assert reason(Checker(KEY), Peer(timestamp=at_limit - 2).says()) is Reason.TOO_OLD


def test_what_another_stream_has_told_of_the_time_counts_for_a_new_one() -> None:
    checker = Checker(KEY)
    ahead = Peer(timestamp=NOW + 3 * LATE_MAX_TICKS, sysid=1)
    assert reason(checker, ahead.says()) is None
    assert reason(checker, Peer(sysid=2).says()) is Reason.TOO_OLD


@pytest.mark.parametrize("known", [True, False])
def test_one_frame_that_is_far_ahead_moves_nothing(known: bool) -> None:
    clock = SigningClock()
    checker, peer = Checker(KEY, clock), Peer()
    if known:
        assert reason(checker, peer.says()) is None
    for timestamp in (NOW + AHEAD_MAX_TICKS + 100, TIMESTAMP_MAX - 3):
        assert reason(checker, Peer(timestamp=timestamp).says()) is Reason.AHEAD
    assert clock.now(NOW_NS) <= NOW + 10
    assert reason(checker, peer.says()) is None, "the stream goes on"


def test_a_stream_that_is_far_ahead_is_followed_from_its_second_frame() -> None:
    """A computer without a clock of its own, whose vehicle knows the time."""
    peer, checker = Peer(timestamp=NOW + 400 * AHEAD_MAX_TICKS), Checker(KEY)
    assert [reason(checker, peer.says()) for _ in range(3)] == [Reason.AHEAD, None, None]
    first = Peer(timestamp=NOW + 400 * AHEAD_MAX_TICKS).says()
    again = Checker(KEY)
    assert [reason(again, first) for _ in range(3)] == [Reason.AHEAD] * 3, "sent a second time"


def test_streams_are_bounded_and_those_that_are_known_go_on() -> None:
    checker, first = Checker(KEY), Peer(sysid=1)
    assert reason(checker, first.says()) is None
    for number in range(1, STREAMS_MAX):
        peer = Peer(link_id=number % 256, sysid=2 + number // 256)
        assert reason(checker, peer.says()) is None
    assert reason(checker, Peer(sysid=9).says()) is Reason.TOO_MANY
    assert reason(checker, first.says()) is None


def test_a_radio_has_no_key_but_may_not_speak_for_one_who_has() -> None:
    checker = Checker(KEY)
    assert reason(checker, Peer(None, sysid=51).radio()) is None
    assert reason(checker, Peer(None, sysid=1).radio()) is None
    assert reason(checker, Peer(sysid=1).says()) is None
    assert reason(checker, Peer(None, sysid=1).radio()) is Reason.UNSIGNED
    assert reason(checker, Peer(None, sysid=51).radio()) is None
    assert reason(checker, Peer(OTHER, sysid=51).radio()) is Reason.WRONG_KEY


def test_our_own_frames_that_come_back_are_replays() -> None:
    checker = Checker(KEY)
    checker.never(255, 191, 200)
    raw = Signer(KEY, 200).sign(FrameWriter(255, 191).write(BEAT), NOW_NS)
    assert reason(checker, raw) is Reason.REPLAYED


# ------------------------------------------------------------------------------------- keys


def test_a_key_is_not_shown_and_has_32_bytes() -> None:
    assert "secret" not in repr(KEY)
    assert KEY.secret.hex()[:8] not in repr(KEY)
    with pytest.raises(BadKeyError, match="31"):
        SecretKey(bytes(31))


def test_the_fingerprint_tells_keys_apart_and_is_no_part_of_the_key() -> None:
    assert KEY.fingerprint != OTHER.fingerprint
    digest = hashlib.sha256(KEY.secret).hexdigest()
    assert KEY.fingerprint.replace(":", "") not in KEY.secret.hex() + digest


# --------------------------------------------------------------- what comes back of what we sent


def test_what_we_sign_in_anothers_name_is_a_replay_when_it_comes_back() -> None:
    clock = SigningClock()
    signer, checker = Signer(KEY, 201, clock), Checker(KEY, clock)
    raw = signer.sign(FrameWriter(1, 1).write(BEAT), NOW_NS)
    checker.sent(raw)
    assert reason(checker, raw) is Reason.REPLAYED
    assert reason(checker, Peer(link_id=3, timestamp=NOW + 5).says()) is None, "its own stream"


def test_another_sender_that_has_our_link_id_is_taken_with_what_is_newer() -> None:
    clock = SigningClock()
    signer, checker = Signer(KEY, 201, clock), Checker(KEY, clock)
    checker.sent(signer.sign(FrameWriter(1, 1).write(BEAT), NOW_NS))
    assert reason(checker, Peer(link_id=201, timestamp=NOW + 100_000).says()) is None


def test_of_our_streams_the_newest_are_remembered() -> None:
    clock = SigningClock()
    signer, checker = Signer(KEY, 201, clock), Checker(KEY, clock)
    raws = [
        signer.sign(FrameWriter(number >> 8, number & 0xFF).write(BEAT), NOW_NS)
        for number in range(SENT_MAX + 1)
    ]
    for raw in raws:
        checker.sent(raw)
    assert reason(checker, raws[-1]) is Reason.REPLAYED
    assert reason(checker, raws[1]) is Reason.REPLAYED
    assert reason(checker, raws[0]) is None
