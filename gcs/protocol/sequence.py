"""How many frames were lost, from the gaps in each sender's sequence numbers."""

from __future__ import annotations

from dataclasses import dataclass

REORDERED = 128
"""A step this large over the ring of 256 is a frame that came late, not a huge gap."""


_RING = bytes(range(256)) * 3
"""Sequence numbers as they follow each other, for runs of at most 512."""


@dataclass(slots=True)
class SequenceCount:
    """One sender's tally."""

    last_seq: int
    last_number: int
    received: int = 1
    lost: int = 0
    resume: bool = False


class SequenceTracker:
    """Per (sysid, compid).  A frame that comes late takes its loss back; a duplicate is no loss."""

    def __init__(self) -> None:
        self.senders: dict[tuple[int, int], SequenceCount] = {}

    @property
    def received(self) -> int:
        return sum(count.received for count in self.senders.values())

    @property
    def lost(self) -> int:
        return sum(count.lost for count in self.senders.values())

    def restart(self, sysid: int, compid: int) -> None:
        """The sender was away and may have begun anew: its next frame follows its last one."""
        count = self.senders.get((sysid, compid))
        if count is not None:
            count.resume = True

    def number(self, sysid: int, compid: int, seq: int) -> int:
        """`seq` of a frame that is not counted yet, without the wrap at 256: greater is newer."""
        count = self.senders.get((sysid, compid))
        if count is None:
            return seq
        if count.resume:
            return count.last_number + 1
        step = (seq - count.last_seq) & 0xFF
        return count.last_number + (step if step < REORDERED else step - 256)

    def in_turn(self, sender: tuple[int, int], seq: int) -> int | None:
        """Count a frame that is the next one of its sender, and give its number as `number` does;
        None, and nothing is counted, where it is any other."""
        count = self.senders.get(sender)
        if count is None or count.resume or seq != (count.last_seq + 1) & 0xFF:
            return None
        count.received += 1
        count.last_seq = seq
        count.last_number += 1
        return count.last_number

    def all_in_turn(self, sender: tuple[int, int], seqs: bytes) -> bool:
        """The same for frames in a row; False, and nothing is counted, where one is any other."""
        count = self.senders.get(sender)
        if count is None or count.resume or not _RING.startswith(seqs, (count.last_seq + 1) & 0xFF):
            return False
        count.received += len(seqs)
        count.last_seq = seqs[-1]
        count.last_number += len(seqs)
        return True

    def late(self, sysid: int, compid: int, seq: int) -> bool:
        """Whether `seq` was sent before a frame that has come, unless the sender began anew."""
        count = self.senders.get((sysid, compid))
        return count is not None and self.number(sysid, compid, seq) < count.last_number

    def seen(self, sysid: int, compid: int, seq: int) -> int:
        """Count a frame; how many were lost just before it (negative: one that was lost came)."""
        count = self.senders.get((sysid, compid))
        if count is None:
            self.senders[sysid, compid] = SequenceCount(seq, seq)
            return 0
        count.received += 1
        if count.resume:
            count.resume = False
            count.last_seq, count.last_number = seq, count.last_number + 1
            return 0
        step = (seq - count.last_seq) & 0xFF
        if step == 0:
            return 0
        if step >= REORDERED:
            found = min(1, count.lost)
            count.lost -= found
            return -found
        count.last_seq = seq
        count.last_number += step
        count.lost += step - 1
        return step - 1
