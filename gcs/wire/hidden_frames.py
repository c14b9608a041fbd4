"""Frames inside frames: what a receiver of a byte stream would take that has lost its place.

A parser that lost a byte looks for the next magic byte, which may stand in a payload: whoever
writes payloads could so send a frame that was never judged.  `hides_frame` finds one inside a
frame; `Separator` puts a byte before a frame that would complete one begun earlier (between frames
a parser skips what is no magic byte).

A hidden frame counts where its checksum is right for its message, or, of a message that the dialect
lacks, for any; also where it becomes right by the loss of one more byte of it, as bytes are lost
where this matters at all.  With a signed link none of this is needed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from gcs.wire.crc import CRC_EXTRA, mcrf4xx
from gcs.wire.frame import (
    CHECKSUM_SIZE,
    HEADER_V1,
    HEADER_V2,
    MAGIC_V1,
    MAGIC_V2,
    MAX_FRAME,
    SIGNATURE_SIZE,
    SIGNED,
)

MOST_HEADS: Final = 8
"""Heads of known messages in one frame; random bytes of the greatest payload have 0.8 of them."""
_MAGIC: Final = re.compile(b"[\xfd\xfe]")
_BETWEEN: Final = tuple(
    bytes((byte,)) * count for count in (1, 2, 3, 4) for byte in range(MAGIC_V2)
)
"""What may stand between two frames: of these, a hidden frame ends rightly in one at the most."""


def _table() -> list[int]:
    """What a byte makes of an empty CRC-16/MCRF4XX (polynomial 0x8408, reflected)."""
    made = []
    for byte in range(256):
        crc = byte
        for _ in range(8):
            crc = crc >> 1 ^ 0x8408 if crc & 1 else crc >> 1
        made.append(crc)
    return made


_TABLE: Final = _table()
_BY_HIGH: Final = {crc >> 8: low for low, crc in enumerate(_TABLE)}
"""Undoes `_TABLE`: the high bytes of its entries are all different."""
_ANY_SEED: Final = frozenset(_TABLE)


def hides_frame(raw: bytes) -> bool:
    """Whether a whole frame can be read in `raw`, a frame, past its first byte: as it is, or with
    one byte of `raw` lost.  More heads than `MOST_HEADS` are taken for one."""
    heads = 0
    for start in _MAGIC.finditer(raw, 1):
        at = start.start()
        heads += _is_known_head(raw, at)
        if heads > MOST_HEADS or any(good for _, good in _ends(raw, at, 0)):
            return True
    # Of the frame itself, another that ends in it is made by the loss of its length or flags alone.
    return any(_good_without(raw, 0, lost, 0)[1] for lost in (1, 2))


class Separator:
    """Keeps the frames that leave on one link so far apart that none completes a hidden one."""

    __slots__ = ("_begun", "_tail")

    def __init__(self) -> None:
        self._tail = b""
        """The last bytes that left, from the first head that is not complete."""
        self._begun: list[int] = []
        """Where in `_tail` such heads are."""

    def apart(self, raw: bytes, *, foreign: bool) -> bytes:
        """`raw` as it is to leave, nearly always as it is.  `foreign`: a client has written it, so
        that the loss of a byte may be meant to make another message of it."""
        if not self._begun and not foreign and _MAGIC.search(raw, 1) is None:
            return raw
        first = cut = len(self._tail)
        data = self._tail + raw
        if self._completes(data, cut):
            between = next(b for b in _BETWEEN if not self._completes(self._tail + b + raw, cut))
            first += len(between)
            raw = between + raw
            data = self._tail + raw
        begun = [*self._begun, *([first] if foreign else [])]
        begun += [start.start() for start in _MAGIC.finditer(data, first + 1)]
        oldest = len(data) - MAX_FRAME - 1
        kept = [at for at in begun if at >= oldest and _reaches_past(data, at)]
        self._tail = data[kept[0] :] if kept else b""
        self._begun = [at - kept[0] for at in kept]
        return raw

    def _completes(self, data: bytes, cut: int) -> bool:
        """Whether a hidden frame that begins before `cut` ends behind it."""
        return any(good for at in self._begun for _, good in _ends(data, at, cut))


def _reaches_past(data: bytes, at: int) -> bool:
    ends = [end for end, _ in _header_losses(data, at, len(data))]
    end, _ = _whole(data, at, len(data))
    return max(end + 1, *ends) > len(data)


def _is_known_head(data: bytes, at: int) -> bool:
    head = _head(data, at)
    return head is not None and head[2] in CRC_EXTRA


def _ends(data: bytes, at: int, cut: int) -> Iterator[tuple[int, bool]]:
    """Of the frames that begin at `at`, as it is or with one byte lost: where each ends in `data`,
    and whether it is a good one that ends behind `cut`."""
    end, good = _whole(data, at, cut)
    yield end, good
    if cut < end + 1 <= len(data):
        yield end + 1, _good_without_one(data, at)
    yield from _header_losses(data, at, cut)


def _header_losses(data: bytes, at: int, cut: int) -> Iterator[tuple[int, bool]]:
    # Two magic bytes alike: without one it is the frame that begins a byte later, which is looked
    # at by itself, or is the next one that leaves.
    first = 2 if data[at : at + 1] == data[at + 1 : at + 2] else 1
    for lost in range(first, HEADER_V1 if data[at] == MAGIC_V1 else HEADER_V2):
        yield _good_without(data, at, lost, cut)


def _good_without(data: bytes, at: int, lost: int, cut: int) -> tuple[int, bool]:
    """As `_whole`, with the byte `lost` of the header lost; of known messages alone."""
    left = data[at : at + lost] + data[at + lost + 1 : at + MAX_FRAME + 1]
    end, good = _whole(left, 0, max(0, cut - at - 1))
    return at + end + 1, good and _is_known_head(left, 0)


def _head(data: bytes, at: int) -> tuple[int, int, int, int] | None:
    """Where payload and frame end, message id, and where the payload begins; None where `data`
    ends before that can be said, or no frame can begin so."""
    if data[at] == MAGIC_V1:
        if at + HEADER_V1 > len(data):
            return None
        start = at + HEADER_V1
        stop = start + data[at + 1]
        return stop, stop + CHECKSUM_SIZE, data[at + 5], start
    if at + HEADER_V2 > len(data) or data[at + 2] & ~SIGNED:
        return None
    start = at + HEADER_V2
    stop = start + data[at + 1]
    end = stop + CHECKSUM_SIZE + (SIGNATURE_SIZE if data[at + 2] else 0)
    return stop, end, int.from_bytes(data[at + 7 : start], "little"), start


def _whole(data: bytes, at: int, cut: int) -> tuple[int, bool]:
    """Where the frame that begins at `at` ends (beyond `data` where that cannot be said yet, 0
    where no frame can begin so), and whether it is a good one that ends behind `cut`."""
    head = _head(data, at)
    if head is None:
        flags = data[at + 2 : at + 3]
        no_frame = data[at] != MAGIC_V1 and flags and flags[0] & ~SIGNED
        return (0 if no_frame else len(data) + 1), False
    stop, end, msgid, _ = head
    if not cut < end <= len(data):
        return end, False
    body, checksum = data[at + 1 : stop], data[stop] | data[stop + 1] << 8
    seed = CRC_EXTRA.get(msgid)
    if seed is not None:
        return end, mcrf4xx(body + seed) == checksum
    return end, (checksum ^ mcrf4xx(body) >> 8) in _ANY_SEED


def _good_without_one(data: bytes, at: int) -> bool:
    """Whether the frame that begins at `at` is a good one with one byte behind its header lost.

    Forwards from its first byte, and backwards from the checksum that it then ends in: where both
    meet but for one byte.
    """
    head = _head(data, at)
    if head is None or head[2] not in CRC_EXTRA:
        return False
    stop, _, msgid, start = head
    seed = CRC_EXTRA[msgid]
    whole = mcrf4xx(data[at + 1 : stop] + seed)
    # Its checksum lost one of its own two bytes.
    low, high, behind = data[stop : stop + 3]
    if whole in (high | behind << 8, low | behind << 8):
        return True
    state = mcrf4xx(data[at + 1 : start])
    forwards = [state]
    for byte in data[start : stop - 1]:
        state = state >> 8 ^ _TABLE[(state ^ byte) & 0xFF]
        forwards.append(state)
    wanted = _before(high | behind << 8, seed[0])
    for lost in range(stop - 1, start - 1, -1):
        wanted = _before(wanted, data[lost + 1])
        if wanted == forwards[lost - start]:
            return True
    return False


def _before(crc: int, byte: int) -> int:
    """The checksum that `byte` made `crc` of."""
    low = _BY_HIGH[crc >> 8]
    return (crc ^ _TABLE[low]) << 8 & 0xFF00 | low ^ byte
