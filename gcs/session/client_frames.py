"""How frames leave on one client's link: counted on without a gap, and in a MAVLink version that
the client reads.

A receiver takes a gap in the sequence numbers of a component for lost frames (pymavlink, and
QGroundControl from memory, modulo 256).  What the bridge answers in a vehicle's name stands between
the vehicle's own frames; so from the first answer on, these are given numbers that count on over
it.  A frame that was lost before the bridge still leaves its gap.  Until then nothing is altered.

A client that speaks MAVLink 1 only, and goes on so while it is sent MAVLink 2, cannot read that:
then it is sent MAVLink 1, as far as that can say it.  Not before: many begin with version 1 and go
over with the first frame of version 2 that they hear, and pymavlink stays with what it heard first.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from typing import Final

from gcs.wire.rewrite import as_mavlink1, is_mavlink1, seq_of, source_of, with_seq

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

    def passed(self, raws: Sequence[bytes], now_ns: int) -> Sequence[bytes]:
        """Frames of others, as they are to leave."""
        self._batches.append(raws)
        old = self._reads_v1_alone(now_ns)
        if not old and not self._shift:
            return raws
        return list(self._altered(raws, old=old))

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

    def _altered(self, raws: Sequence[bytes], *, old: bool) -> Iterable[bytes]:
        for raw in raws:
            source = source_of(raw)
            shift = self._shift.get(source)
            made = as_mavlink1(raw) if old else raw
            if shift is None:
                if old:
                    shift = self._shift[source] = _Shift(seq_of(raw) - 1)
                else:
                    yield raw
                    continue
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

    __slots__ = ("_by", "_last")

    def __init__(self, last: int) -> None:
        self._by = 0
        self._last = last

    def inserted(self) -> int:
        """The number of a frame that stands between its own."""
        self._by += 1
        self._last = (self._last + 1) & 0xFF
        return self._last

    def left_out(self) -> None:
        """One of its own frames is not sent on."""
        self._by -= 1

    def passed(self, seq: int) -> int:
        """The number of one of its own frames, that had `seq`."""
        self._last = (seq + self._by) & 0xFF
        return self._last
