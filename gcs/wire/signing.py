"""MAVLink 2 signatures: signs frames, and judges the signatures of frames that came in.

A signed frame ends in 13 bytes: link id, timestamp (48 bits), signature (48 bits of a SHA-256 over
the key, the frame up to and with its checksum, link id and timestamp).  A timestamp counts 10 us
since 2015-01-01 UTC, and rises from frame to frame in each stream, which is (system, component,
link id): so nothing that was recorded can be sent a second time.  After the MAVLink guide,
"Message Signing".  Pure: the time is passed in as ns since the Unix epoch.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from hashlib import sha256
from hmac import compare_digest
from typing import Final, Protocol, TypeAlias

from gcs.wire.crc import CRC_EXTRA, mcrf4xx
from gcs.wire.frame import (
    CHECKSUM_SIZE,
    HEADER_V1,
    HEADER_V2,
    MAGIC_V1,
    MAGIC_V2,
    SIGNATURE_SIZE,
    SIGNED,
    Frame,
)

KEY_BYTES: Final = 32
EPOCH_NS: Final = 1_420_070_400 * 1_000_000_000
"""2015-01-01 UTC, in ns since the Unix epoch."""
TICK_NS: Final = 10_000
TIMESTAMP_MAX: Final = (1 << 48) - 1
LATE_MAX_TICKS: Final = 60 * 100_000
"""A stream that is new must not be further behind: one minute (MAVLink guide)."""
AHEAD_MAX_TICKS: Final = 24 * 3600 * 100_000
"""What one frame may move the clock on by: one day.  Farther ahead nothing is taken before a second
frame of the same stream follows on the first one: a single one, made or signed wrongly, would else
block all that is signed after it until the station is begun anew."""
FOLLOWS_TICKS: Final = 60 * 100_000
"""So soon it must follow: within a minute by its own time stamps."""
STREAMS_MAX: Final = 1024
"""Streams that are remembered; only frames that were signed with the key make one."""
SENT_MAX: Final = 4096
"""Streams of our own that are remembered; of more, the first one is forgotten."""
UNSIGNED_ALLOWED: Final = frozenset({109, 166})
"""RADIO_STATUS and RADIO: the radio on the way puts them in, and has no key."""

_SIGNATURE: Final = 6
_TIMESTAMP: Final = slice(-SIGNATURE_SIZE + 1, -_SIGNATURE)
_FLAGS: Final = 2
"""Where a frame has its `incompat_flags`."""


class BadKeyError(ValueError):
    """Bytes that are no key."""


class UnsignableError(ValueError):
    """A MAVLink 1 frame of a message that the dialect lacks: it has no form in MAVLink 2."""


class Key(Protocol):
    """What signs.  A fresh session that an audit makes has one that knows no secret."""

    def signature(self, stamped: bytes) -> bytes:
        """The 6 bytes behind a frame with its link id and timestamp."""

    def has_signed(self, stamped: bytes, signature: bytes) -> bool:
        """Whether `signature` is the one of this key."""


@dataclass(frozen=True, slots=True)
class SecretKey:
    """32 bytes, which are never shown."""

    secret: bytes = field(repr=False)

    def __post_init__(self) -> None:
        if len(self.secret) != KEY_BYTES:
            raise BadKeyError(f"a signing key has {KEY_BYTES} bytes, not {len(self.secret)}")

    @property
    def fingerprint(self) -> str:
        """Tells keys apart, and nothing about them: `1a2b:3c4d:5e6f:7a8b`."""
        digest = sha256(b"mavgate signing key fingerprint" + self.secret).hexdigest()
        return ":".join(digest[at : at + 4] for at in range(0, 16, 4))

    def signature(self, stamped: bytes) -> bytes:
        return sha256(self.secret + stamped).digest()[:_SIGNATURE]

    def has_signed(self, stamped: bytes, signature: bytes) -> bool:
        return compare_digest(self.signature(stamped), signature)


class Reason(StrEnum):
    """Why a frame is not taken."""

    UNSIGNED = "unsigned"
    WRONG_KEY = "wrong key"
    REPLAYED = "replayed"
    TOO_OLD = "too old"
    """The first frame of a stream, and more than a minute behind, or from before we began."""
    TOO_MANY = "too many streams"
    AHEAD = "too far ahead"
    """More than a day ahead of what we know, and the first such frame of its stream."""


@dataclass(frozen=True, slots=True)
class Good:
    """To be taken."""


@dataclass(frozen=True, slots=True)
class Bad:
    """To be ignored."""

    reason: Reason


Verdict: TypeAlias = Good | Bad
GOOD: Final = Good()
_BAD: Final = {reason: Bad(reason) for reason in Reason}


WAITING_NS: Final = 200_000_000
"""What a socket holds when we begin may be so old: no station ends and begins anew that fast."""


def timestamp_of(unix_ns: int) -> int:
    """In units of 10 us since 2015; 0 before."""
    return min(max(0, unix_ns - EPOCH_NS) // TICK_NS, TIMESTAMP_MAX)


class SigningClock:
    """The timestamps of all that is signed with one key.

    They never go back: where the wall clock was set back, or a station begins anew with a clock
    that is behind, the frames of the other side, which are ahead, move this one on.
    """

    __slots__ = ("latest",)

    def __init__(self) -> None:
        self.latest = 0
        """The newest timestamp that was sent or heard."""

    def next(self, unix_ns: int) -> int:
        """For a frame that is to be signed: later than all before."""
        self.latest = min(max(self.latest + 1, timestamp_of(unix_ns)), TIMESTAMP_MAX)
        return self.latest

    def now(self, unix_ns: int) -> int:
        return max(self.latest, timestamp_of(unix_ns))

    def heard(self, timestamp: int) -> None:
        """A frame that was rightly signed had this one."""
        if timestamp > self.latest:
            self.latest = timestamp


class Signer:
    """Signs what leaves on one link."""

    __slots__ = ("_clock", "_key", "_link_id")

    def __init__(self, key: Key, link_id: int, clock: SigningClock | None = None) -> None:
        """`link_id`, 0 to 255, is our own: no other sender with the same system and component id
        may use it.  `clock` is shared by all that use the key."""
        self._key = key
        self._link_id = bytes((link_id,))
        self._clock = clock or SigningClock()

    def sign(self, raw: bytes, unix_ns: int) -> bytes:
        """The frame with our signature, in place of any that it has.

        A MAVLink 1 frame becomes one of MAVLink 2, which alone has signatures.  Raises
        UnsignableError.
        """
        if raw[0] == MAGIC_V1:
            raw = as_mavlink2(raw)
        frame = raw[:-SIGNATURE_SIZE] if raw[_FLAGS] & SIGNED else _with_flag_turned(raw)
        stamped = frame + self._link_id + self._clock.next(unix_ns).to_bytes(6, "little")
        return stamped + self._key.signature(stamped)


class Checker:
    """Judges the signatures of all that came in under one key."""

    __slots__ = ("_ahead", "_clock", "_key", "_sent", "_signers", "_since", "_streams")

    def __init__(self, key: Key, clock: SigningClock | None = None, since_ns: int = 0) -> None:
        """`clock`: as that of the key's `Signer`s.  `since_ns` is when we began (unix time): what
        was signed before may have been taken by who was here before us, and recorded by anybody."""
        self._key = key
        self._clock = clock or SigningClock()
        self._since = timestamp_of(max(0, since_ns - WAITING_NS))
        self._streams: dict[tuple[int, int, int], int] = {}
        self._ahead: dict[tuple[int, int, int], int] = {}
        """The time stamps of streams that began too far ahead."""
        self._signers: set[tuple[int, int]] = set()
        self._sent: dict[tuple[int, int, int], int] = {}

    def never(self, sysid: int, compid: int, link_id: int) -> None:
        """A stream that is ours to send: what comes back of it is a replay."""
        self._streams[sysid, compid, link_id] = TIMESTAMP_MAX

    def sent(self, raw: bytes) -> None:
        """We have signed this frame, in whatever name: what comes back of it is a replay."""
        stream = (raw[5], raw[6], raw[-SIGNATURE_SIZE])
        if stream not in self._sent and len(self._sent) >= SENT_MAX:
            del self._sent[next(iter(self._sent))]
        self._sent[stream] = int.from_bytes(raw[_TIMESTAMP], "little")

    def check(self, frame: Frame, unix_ns: int) -> Verdict:
        """Whether to take the frame; one that is taken moves its stream on.

        A radio's own messages are taken unsigned, unless a sender who signs is named in them.
        """
        if not frame.signature:
            source = (frame.sysid, frame.compid)
            if frame.msgid in UNSIGNED_ALLOWED and source not in self._signers:
                return GOOD
            return _BAD[Reason.UNSIGNED]
        raw = frame.raw
        if not self._key.has_signed(raw[:-_SIGNATURE], raw[-_SIGNATURE:]):
            return _BAD[Reason.WRONG_KEY]
        timestamp = int.from_bytes(raw[_TIMESTAMP], "little")
        stream = (frame.sysid, frame.compid, raw[-SIGNATURE_SIZE])
        if timestamp <= self._sent.get(stream, -1):
            return _BAD[Reason.REPLAYED]
        last = self._streams.get(stream)
        if last is not None and timestamp <= last:
            return _BAD[Reason.REPLAYED]
        if timestamp > self._clock.now(unix_ns) + AHEAD_MAX_TICKS and not self._follows(
            stream, timestamp
        ):
            return _BAD[Reason.AHEAD]
        if last is None:
            if timestamp < max(self._since, self._clock.now(unix_ns) - LATE_MAX_TICKS):
                return _BAD[Reason.TOO_OLD]
            if len(self._streams) >= STREAMS_MAX:
                return _BAD[Reason.TOO_MANY]
            self._signers.add(stream[:2])
        self._streams[stream] = timestamp
        self._clock.heard(timestamp)
        return GOOD

    def _follows(self, stream: tuple[int, int, int], timestamp: int) -> bool:
        """Whether a frame that is far ahead follows on the one before of its stream."""
        before = self._ahead.pop(stream, None)
        if before is not None and 0 < timestamp - before <= FOLLOWS_TICKS:
            return timestamp < TIMESTAMP_MAX - AHEAD_MAX_TICKS
        if len(self._ahead) < STREAMS_MAX:
            self._ahead[stream] = timestamp
        return False


def strip(raw: bytes) -> bytes:
    """The frame without its signature, for a link that has no key; one without stays as it is."""
    if raw[0] != MAGIC_V2 or not raw[_FLAGS] & SIGNED:
        return raw
    return _with_flag_turned(raw[:-SIGNATURE_SIZE])


def as_mavlink2(raw: bytes) -> bytes:
    """A MAVLink 1 frame as one of MAVLink 2, unsigned.  Raises UnsignableError."""
    msgid = raw[5]
    crc_extra = CRC_EXTRA.get(msgid)
    if crc_extra is None:
        raise UnsignableError(f"message {msgid} is not in the dialect")
    payload = raw[HEADER_V1:-CHECKSUM_SIZE]
    payload = payload.rstrip(b"\0") or payload[:1]
    body = bytes((len(payload), 0, 0, *raw[2:5], msgid, 0, 0)) + payload
    return b"\xfd" + body + mcrf4xx(body + crc_extra).to_bytes(2, "little")


def _with_flag_turned(frame: bytes) -> bytes:
    """A MAVLink 2 frame without a signature, but announcing one; or the other way round.

    The checksum is corrected without being counted anew, so this works for messages, too, that the
    dialect lacks: it is linear over the bits of frames of one length.
    """
    turned = bytearray(frame)
    low, high = _FLAG_IN_CHECKSUM[frame[1]]
    turned[_FLAGS] ^= SIGNED
    turned[-2] ^= low
    turned[-1] ^= high
    return bytes(turned)


def _flag_in_checksum(payload_length: int) -> bytes:
    """What the flag SIGNED changes in the checksum of a frame with a payload of that length."""
    rest = bytes(HEADER_V2 - 1 - _FLAGS + payload_length + 1)  # the checksum ends with CRC extra
    changed = mcrf4xx(b"\0" + bytes((SIGNED,)) + rest) ^ mcrf4xx(b"\0\0" + rest)
    return changed.to_bytes(CHECKSUM_SIZE, "little")


_FLAG_IN_CHECKSUM: Final = tuple(map(_flag_in_checksum, range(256)))
