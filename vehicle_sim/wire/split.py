"""Bytes -> frames, for datagrams (each decoded alone) and for streams (TCP)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from fastcrc.crc16 import mcrf4xx

from vehicle_sim.wire.codec import SIGNED, STX1, STX2, MavlinkFrame
from vehicle_sim.wire.layouts import CRC_EXTRAS

_STARTS: Final = (STX1, STX2)
_KNOWN_FLAGS: Final = SIGNED
SIGNATURE_BYTES: Final = 13


@dataclass(slots=True)
class Counters:
    """What came in on one channel, and what was wrong with it.

    `frames` had a right checksum; under a key the last three are frames that were refused after it.
    """

    frames: int = 0
    garbage_bytes: int = 0
    bad_crc: int = 0
    truncated: int = 0
    unknown: int = 0
    incompatible: int = 0
    unsigned: int = 0
    bad_signature: int = 0
    replayed: int = 0

    @property
    def bad(self) -> int:
        """Frames that were refused; a message that is merely not known is none of them."""
        return (
            self.bad_crc
            + self.truncated
            + self.incompatible
            + self.unsigned
            + self.bad_signature
            + self.replayed
        )


_EXTRA: Final = {number: bytes((extra,)) for number, extra in CRC_EXTRAS.items()}


def frame_size(data: bytes, at: int) -> int | None:
    """Whole length of the frame that starts at `at`, None if its header is not complete."""
    left = len(data) - at
    if data[at] == STX1:
        return 8 + data[at + 1] if left >= 2 else None
    if left < 3:
        return None
    return 12 + data[at + 1] + (SIGNATURE_BYTES if data[at + 2] & SIGNED else 0)


def _start(data: bytes, at: int) -> int:
    """Index of the next start byte from `at` on, the length of `data` if there is none."""
    found = [index for mark in _STARTS if (index := data.find(mark, at)) >= 0]
    return min(found, default=len(data))


def split(data: bytes, counters: Counters) -> list[MavlinkFrame]:
    """The good frames of one datagram, in order; all else is counted, nothing raises.

    After a bad frame the search goes on one byte behind its start, so that a stray start byte
    cannot swallow the good frame behind it.
    """
    frames: list[MavlinkFrame] = []
    at = 0
    end = len(data)
    while at < end:
        mark = data[at]
        if mark != STX2 and mark != STX1:
            start = _start(data, at)
            counters.garbage_bytes += start - at
            at = start
            continue
        size = frame_size(data, at)
        if size is None or at + size > end:
            counters.truncated += 1
            at += 1
            continue
        read = _frame2 if mark == STX2 else _frame1
        frame = read(data, at, size, counters)
        if frame is None:
            at += 1
            continue
        frames.append(frame)
        counters.frames += 1
        at += size
    return frames


def _frame2(data: bytes, at: int, size: int, counters: Counters) -> MavlinkFrame | None:
    length, flags, _, sequence, system, component = data[at + 1 : at + 7]
    if flags & ~_KNOWN_FLAGS:
        counters.incompatible += 1
        return None
    number = int.from_bytes(data[at + 7 : at + 10], "little")
    extra = _EXTRA.get(number)
    if extra is None:
        counters.unknown += 1
        return None
    tail = at + 10 + length
    if mcrf4xx(data[at + 1 : tail] + extra) != data[tail] | data[tail + 1] << 8:
        counters.bad_crc += 1
        return None
    payload, raw = data[at + 10 : tail], data[at : at + size]
    return MavlinkFrame(2, sequence, system, component, number, payload, bool(flags & SIGNED), raw)


def _frame1(data: bytes, at: int, size: int, counters: Counters) -> MavlinkFrame | None:
    length, sequence, system, component, number = data[at + 1 : at + 6]
    extra = _EXTRA.get(number)
    if extra is None:
        counters.unknown += 1
        return None
    tail = at + 6 + length
    if mcrf4xx(data[at + 1 : tail] + extra) != data[tail] | data[tail + 1] << 8:
        counters.bad_crc += 1
        return None
    payload, raw = data[at + 6 : tail], data[at : at + size]
    return MavlinkFrame(1, sequence, system, component, number, payload, False, raw)


class Reassembler:
    """Cuts a byte stream at frame boundaries, so that a piece can be split like a datagram."""

    def __init__(self) -> None:
        self._held = b""

    def feed(self, data: bytes) -> bytes:
        """Everything up to the last frame that is still incomplete, which is held back."""
        data = self._held + data
        at = _start(data, 0)
        while at < len(data):
            size = frame_size(data, at)
            if size is None or at + size > len(data):
                self._held = data[at:]
                return data[:at]
            at = _start(data, at + size)
        self._held = b""
        return data
