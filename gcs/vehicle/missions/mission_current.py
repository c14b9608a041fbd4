"""What a vehicle tells of its mission (MISSION_CURRENT), beside the one that was verified.

It tells how many items there are, and newer firmware a number of the mission (`mission_id`).  The
recorded PX4 1.14 and ArduCopter 4.7 give none.  A PX4 1.14 tells the item that it is at and nothing
else, and without a mission not even that: it is asked how many items there are
(MISSION_REQUEST_LIST).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from gcs.session.speedup_waits import Times
from gcs.vehicle.missions.plans import OnBoard
from gcs.wire.ids import MissionState
from gcs.wire.messages import MissionCurrent

NO_ITEMS: Final = (0, 0xFFFF)
"""MISSION_CURRENT.total without a mission: 0 of an ArduPilot, which tells NO_MISSION with it."""
NEWS_NS: Final = 1_500_000_000
"""How long a MISSION_CURRENT may still be about the mission before: it comes once a second."""


@dataclass(slots=True)
class _Refused:
    """A mission that was read and does not clear."""

    items: int
    why: str
    number: int | None = None
    """The number that the vehicle gives it (0: none), once it has told of as many items since."""


class MissionTold:
    """Of one vehicle; it is asked about the verified mission that is known to be on board."""

    def __init__(self, times: Times) -> None:
        self._times = times
        self._told: MissionCurrent | None = None
        self._counted = False
        """What it has told is the number that it was asked for."""
        self._first_item = 0
        """The number of the first item after home, where home is one."""
        self._verified_id = 0
        self._verified_ns: int | None = None
        """The number that it gives the mission that was verified, and since when there is one."""
        self._seen = False
        """Whether it has told of that mission since."""
        self._refused: _Refused | None = None

    def forget(self) -> None:
        """The vehicle restarted or was away."""
        self._told = self._refused = None
        self._counted = False

    def changed(self) -> None:
        """It has taken a mission, or cleared it: another number may be right."""
        self._refused = None
        if self._counted:
            self._told, self._counted = None, False

    def refused(self, items: int, why: str) -> None:
        """The mission on board, of so many items that the vehicle counts, was read and does not
        clear."""
        self._refused = _Refused(items, why)

    def forget_refused(self) -> None:
        """Another mission is on board, or may be."""
        self._refused = None

    def learn_anew(self) -> None:
        """Another mission was verified, or none is on board."""
        self._verified_id, self._verified_ns, self._seen = 0, None, False

    def heard(
        self, told: MissionCurrent, known: OnBoard | None, first_item: int, now_ns: int
    ) -> None:
        """Keep it, and the number of the verified mission, once it is told after that was brought
        on board.  `first_item`: of those that the vehicle counts.

        Without items and a state it tells of neither (common.xml: 0 is "not supported"), but that
        there is a mission: a PX4 1.14 sends none else."""
        if told.total == 0 and told.mission_state == MissionState.UNKNOWN:
            if self._counted and self._told is not None and not self._told.total:
                self._told = None
            return
        self._told, self._first_item, self._counted = told, first_item, False
        self._look_at_refused(told)
        if known is None:
            self.learn_anew()
        elif self._verified_ns is None:
            self._verified_ns = now_ns
        elif now_ns - self._verified_ns >= self._times.real_ns(NEWS_NS):
            self._verified_id = self._verified_id or told.mission_id
            self._seen |= told.total == self._countable(known)

    def counted(self, count: int, first_item: int = 0) -> None:
        """MISSION_COUNT, of a vehicle whose MISSION_CURRENT has told no number."""
        if self._told is None or self._counted:
            items = max(0, count - first_item)
            self._told, self._counted = MissionCurrent(seq=0, total=items), True
            self._first_item = first_item

    @property
    def known(self) -> bool:
        """Whether it has told what is on board."""
        return self._told is not None

    def _look_at_refused(self, told: MissionCurrent) -> None:
        """Is it still the mission that was refused?"""
        refused = self._refused
        if refused is None:
            return
        if refused.number is None:
            if told.total == refused.items:
                refused.number = told.mission_id
        elif (told.total, told.mission_id) != (refused.items, refused.number):
            self._refused = None

    def unverified(self, known: OnBoard | None) -> str:
        """What is wrong with the mission on board: that it was not verified, or is another one.
        Empty where it was verified, or where there is none."""
        told = self._told
        if told is None:
            return "it has not told whether a mission is on board"
        if told.total in NO_ITEMS:
            return ""
        if known is None:
            which = f"the mission on board ({told.total} items)"
            if self._refused is not None and self._refused.items == told.total:
                return f"{which} did not clear when it was read: {self._refused.why}"
            return f"{which} was not verified: upload or clear it"
        if told.total != self._countable(known):
            which = f"{told.total} items, {self._countable(known)} were verified"
            return f"another mission is on board than was verified ({which})"
        if self._verified_id and told.mission_id != self._verified_id:
            return "another mission of as many items is on board than was verified"
        return ""

    def does_not_clear(self, known: OnBoard | None) -> bool:
        """Whether the mission on board is one that was read and does not clear."""
        told, refused = self._told, self._refused
        return bool(told and refused and known is None and refused.items == told.total)

    def replaced(self, known: OnBoard | None) -> str:
        """That what is on board is not what it has told of before; empty where it is."""
        if not self._seen or self._told is None:
            return ""
        if self._told.total in NO_ITEMS:
            return "no mission is on board any more"
        return self.unverified(known)

    def _countable(self, known: OnBoard) -> int:
        """Items as MISSION_CURRENT.total counts them: ArduPilot leaves out home (recorded: 6 of the
        7 of its MISSION_COUNT)."""
        return len(known.sent) - self._first_item
