"""How frames leave on one client's link: counted on without a gap, and in a MAVLink version that
the client reads.

A receiver takes a gap in the sequence numbers of a component for lost frames (pymavlink, and
QGroundControl from memory, modulo 256).  What the bridge answers in a vehicle's name stands between
the vehicle's own frames; so from the first answer on, these are given numbers that count on over
it; and so over what is left out for a client that asked for fewer of a message.  A frame that was
lost before the bridge still leaves its gap.  Until then nothing is altered.

A client that speaks MAVLink 1 only, and goes on so while it is sent MAVLink 2, cannot read that:
then it is sent MAVLink 1, as far as that can say it.  Not before: many begin with version 1 and go
over with the first frame of version 2 that they hear, and pymavlink stays with what it heard first.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from typing import Final

from gcs.wire.frame import MAGIC_V2
from gcs.wire.rewrite import (
    SEQ_V2,
    as_mavlink1,
    crc_change,
    is_mavlink1,
    seq_of,
    source_of,
    with_seq,
)

UPGRADES_NS: Final = 3_000_000_000
"""How long a client is sent MAVLink 2 that has spoken version 1 only."""
BATCHES_KEPT: Final = 16
"""What was sent on last, to find a component's latest number in when it is first answered for."""


class ClientFrames:
    """One client's link."""

    __slots__ = ("_batches", "_shift", "_since_ns", "_speaks_v1", "_speaks_v2")

    def __init__(self) -> None:
        self._batches: deque[Sequence[bytes]] = deque(maxlen=BATCHES_KEPT)
        self._shift: dict[bytes, _Shift] = {}
        self._speaks_v1 = self._speaks_v2 = False
        self._since_ns: int | None = None
        """When the first frame was sent to it."""

    def spoke(self, raw: bytes) -> None:
        """A good frame of the client."""
        if is_mavlink1(raw):
            self._speaks_v1 = True
        else:
            self._speaks_v2 = True

    def passed(
        self, raws: Sequence[bytes], now_ns: int, left_out: Sequence[bytes] = ()
    ) -> Sequence[bytes]:
        """Frames of others, as they are to leave; of those that are left out the client is to see
        no gap."""
        self.keep(raws)
        if self._reads_v1_alone(now_ns):
            return list(self._as_mavlink1(raws, left_out))
        return self._numbered_on(raws, left_out) if self._shift or left_out else raws

    def keep(self, raws: Sequence[bytes]) -> None:
        """These leave as they are, in this order."""
        self._batches.append(raws)

    def alters(self, now_ns: int) -> bool:
        """Whether frames of others leave as anything but what they are."""
        return self._reads_v1_alone(now_ns) or bool(self._shift)

    def joined(self, raws: Sequence[bytes], now_ns: int) -> bytes:
        """The same as `passed`, one behind the other.

        They are altered where they stand, which for each of them costs half of a new frame.
        """
        if self._reads_v1_alone(now_ns):
            return b"".join(self.passed(raws, now_ns))
        shift_of = self._shift.get
        made = bytearray(b"".join(raws))
        end = 0
        for raw in raws:
            at, end = end, end + len(raw)
            if raw[0] != MAGIC_V2 or raw[2]:  # of MAVLink 1, or signed
                return b"".join(self.passed(raws, now_ns))
            shift = shift_of(raw[5:7])
            if shift is None:
                continue
            seq = raw[SEQ_V2]
            made[at + SEQ_V2] = shift.last = (seq + shift.by) & 0xFF
            change = crc_change(raw[1], seq ^ shift.last)
            made[end - 2] ^= change & 0xFF
            made[end - 1] ^= change >> 8
        self.keep(raws)
        return bytes(made)

    def _reads_v1_alone(self, now_ns: int) -> bool:
        """As far as it has shown by now, when it is sent something."""
        if self._since_ns is None:
            self._since_ns = now_ns
        late = now_ns - self._since_ns >= UPGRADES_NS
        return late and self._speaks_v1 and not self._speaks_v2

    def answer(self, raw: bytes, now_ns: int) -> bytes | None:
        """A frame of the bridge's in the name of a component; None where the client's version of
        MAVLink cannot say it."""
        made = as_mavlink1(raw) if self._reads_v1_alone(now_ns) else raw
        if made is None:
            return None
        source = source_of(raw)
        shift = self._shift.get(source)
        if shift is None:
            shift = self._shift[source] = _Shift(self._latest(source))
        return with_seq(made, shift.inserted())

    def _numbered_on(self, raws: Sequence[bytes], left_out: Sequence[bytes]) -> Sequence[bytes]:
        """Those of components that were answered for, or of which a frame was left out; the others
        are as they were."""
        made: list[bytes] = []
        for raw in raws:
            if raw in left_out:
                self._shift_of(raw).left_out()
                continue
            shift = self._shift.get(source_of(raw))
            made.append(raw if shift is None else with_seq(raw, shift.passed(seq_of(raw))))
        return made

    def _shift_of(self, raw: bytes) -> _Shift:
        """Of the frame's component, begun with this frame if need be."""
        return self._shift.setdefault(source_of(raw), _Shift(seq_of(raw) - 1))

    def _as_mavlink1(self, raws: Iterable[bytes], left_out: Sequence[bytes]) -> Iterable[bytes]:
        for raw in raws:
            shift = self._shift_of(raw)
            made = None if raw in left_out else as_mavlink1(raw)
            if made is None:
                shift.left_out()
            else:
                yield with_seq(made, shift.passed(seq_of(raw)))

    def _latest(self, source: bytes) -> int:
        """The number of the component's last frame that was sent on; -1 where there is none."""
        for batch in reversed(self._batches):
            for raw in reversed(batch):
                if source_of(raw) == source:
                    return seq_of(raw)
        return -1


class _Shift:
    """The numbers of one component on one link."""

    __slots__ = ("by", "last")

    def __init__(self, last: int) -> None:
        self.by = 0
        self.last = last

    def inserted(self) -> int:
        """The number of a frame that stands between its own."""
        self.by += 1
        self.last = (self.last + 1) & 0xFF
        return self.last

    def left_out(self) -> None:
        """One of its own frames is not sent on."""
        self.by -= 1

    def passed(self, seq: int) -> int:
        """The number of one of its own frames, that had `seq`."""
        self.last = (seq + self.by) & 0xFF
        return self.last
