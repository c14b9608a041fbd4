"""MAVLink 2 message signing: one key, and who has used it when.

A signed frame ends in 13 bytes: link id, 48 bits of time in 10 us since 2015-01-01 GMT, and the
first 48 bits of SHA-256(key + frame up to and with its checksum + link id + time), as the MAVLink
guide has it ("Message Signing").  Pure: the time of the world comes in with each call, and the
key lives in memory only.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING, Final

from vehicle_sim.wire.codec import MavlinkFrame
from vehicle_sim.wire.messages import SetupSigning

if TYPE_CHECKING:
    from _hashlib import HASH

KEY_BYTES: Final = 32
EPOCH_UNIX_NS: Final = 1_420_070_400 * 1_000_000_000
TICK_NS: Final = 10_000
TIMESTAMP_MAX: Final = (1 << 48) - 1
NEW_STREAM_LATE_MAX: Final = 60 * 100_000
"""In ticks: how far a stream that was not heard before may be behind."""
STREAMS_MAX: Final = 256
RADIOS: Final = frozenset({109, 166})
"""RADIO_STATUS and RADIO come from the radio itself, which has no key (ArduPilot's list)."""
PX4_UNSIGNED: Final = frozenset({0, 109, 246, 247})
"""What PX4 1.17 takes unsigned on every link, USB too: HEARTBEAT, RADIO_STATUS, ADSB_VEHICLE and
COLLISION ("Unsigned Message Allowlist" of its page on message signing)."""

_SIGNATURE: Final = 6
_STAMP: Final = 7 + _SIGNATURE


class SigningKeyError(ValueError):
    """A text that is no key."""


@dataclass(frozen=True, slots=True)
class SigningKey:
    """32 bytes, never shown."""

    secret: bytes = field(repr=False)

    def __post_init__(self) -> None:
        if len(self.secret) != KEY_BYTES:
            raise SigningKeyError(f"a signing key has {KEY_BYTES} bytes, not {len(self.secret)}")


def _sha256(data: bytes) -> HASH:
    """Loaded with the first key: most vehicles have none."""
    from hashlib import sha256

    return sha256(data)


def parse_key(data: bytes) -> SigningKey:
    """What a key file holds: 32 raw bytes, 64 hexadecimal digits, or a passphrase.

    The key of a passphrase is its SHA-256, as MAVProxy and QGroundControl have it; a line end
    behind it is not part of it.  A passphrase of exactly 32 bytes needs that line end, for
    without it they are the key.  Raises SigningKeyError.
    """
    if len(data) == KEY_BYTES:
        return SigningKey(data)
    line = data.rstrip(b"\r\n")
    if not line:
        raise SigningKeyError("a signing key cannot be empty")
    if len(line) == 2 * KEY_BYTES:
        try:
            return SigningKey(bytes.fromhex(line.decode("ascii")))
        except ValueError:
            # As many characters, but a passphrase.
            pass
    return SigningKey(_sha256(line).digest())


class Verdict(Enum):
    """What to think of a frame; all but GOOD are to be ignored."""

    GOOD = "good"
    UNSIGNED = "unsigned"
    BAD_SIGNATURE = "bad signature"
    REPLAYED = "replayed"


def timestamp_of(unix_ns: int) -> int:
    """Ticks since 2015; 0 before."""
    return min(max(0, unix_ns - EPOCH_UNIX_NS) // TICK_NS, TIMESTAMP_MAX)


class Signing:
    """The key of one autopilot, the time it signs with, and the streams that it has heard.

    A stream is (system, component, link id).  One time serves all links, so that it rises on each.
    """

    def __init__(
        self, key: SigningKey | None = None, unsigned_allowed: frozenset[int] = RADIOS
    ) -> None:
        """`unsigned_allowed`: numbers of messages that are taken whatever their signature."""
        self._unsigned_allowed = unsigned_allowed
        self._key: SigningKey | None = None
        self._keyed: HASH | None = None
        self._timestamp = 0
        self._streams: dict[tuple[int, int, int], int] = {}
        self.setup(key, 0)

    @property
    def on(self) -> bool:
        """Whether there is a key: frames are signed, and only signed ones are taken."""
        return self._key is not None

    def setup(self, key: SigningKey | None, timestamp: int) -> None:
        """Another key, or none; `timestamp` is where signing goes on at the earliest.

        The streams stay: when a key comes back, its old frames must not.
        """
        self._key = key
        self._keyed = _sha256(key.secret) if key is not None else None
        self._timestamp = max(self._timestamp, min(timestamp, TIMESTAMP_MAX))

    def follow(self, asked: SetupSigning) -> None:
        """Carry out a SETUP_SIGNING: a key of all zeros with time 0 turns signing off."""
        off = not any(asked.secret_key) and asked.initial_timestamp == 0
        self.setup(None if off else SigningKey(asked.secret_key), asked.initial_timestamp)

    def judge(self, frame: MavlinkFrame, unix_ns: int) -> Verdict:
        """Whether a frame is to be taken; one that is taken moves its stream on."""
        if self._key is None:
            return Verdict.GOOD
        verdict = self._judge_signature(frame, unix_ns)
        # MAVLink's C library asks the autopilot also about frames whose signature is wrong.
        return Verdict.GOOD if frame.number in self._unsigned_allowed else verdict

    def _judge_signature(self, frame: MavlinkFrame, unix_ns: int) -> Verdict:
        if not frame.signed:
            return Verdict.UNSIGNED
        raw = frame.raw
        from hmac import compare_digest

        if not compare_digest(self._sign(raw[:-_SIGNATURE]), raw[-_SIGNATURE:]):
            return Verdict.BAD_SIGNATURE
        timestamp = int.from_bytes(raw[1 - _STAMP : -_SIGNATURE], "little")
        stream = (frame.system, frame.component, raw[-_STAMP])
        last = self._streams.get(stream)
        if last is None:
            now = max(self._timestamp, timestamp_of(unix_ns))
            if timestamp + NEW_STREAM_LATE_MAX < now or len(self._streams) >= STREAMS_MAX:
                return Verdict.REPLAYED
        elif timestamp <= last:
            return Verdict.REPLAYED
        self._streams[stream] = timestamp
        self._timestamp = max(self._timestamp, timestamp)
        return Verdict.GOOD

    def seal(self, frame: bytes, link_id: int, unix_ns: int) -> bytes:
        """A MAVLink 2 frame that announces a signature (`SIGNED`), with it."""
        self._timestamp = min(max(self._timestamp + 1, timestamp_of(unix_ns)), TIMESTAMP_MAX)
        stamped = frame + bytes((link_id,)) + self._timestamp.to_bytes(6, "little")
        return stamped + self._sign(stamped)

    def _sign(self, stamped: bytes) -> bytes:
        assert self._keyed is not None, "without a key nothing is signed"
        keyed = self._keyed.copy()
        keyed.update(stamped)
        return keyed.digest()[:_SIGNATURE]
