"""DO_JUMP and DO_JUMP_TAG: where the mission goes on, and how often."""

from __future__ import annotations

from vehicle_sim.autopilot.interface import PlanItem
from vehicle_sim.autopilot.mission.plan import Cmd

JUMPS = frozenset({Cmd.JUMP, Cmd.DO_JUMP_TAG})


class Jumps:
    """Counts the repetitions of each jump (param 2; less than 0 = for ever)."""

    __slots__ = ("_done",)

    def __init__(self) -> None:
        self._done: dict[int, int] = {}

    def forget(self) -> None:
        """None has been made yet."""
        self._done.clear()

    def leads_to(self, item: PlanItem, items: tuple[PlanItem, ...]) -> int | None:
        """Index of the item that it leads to; None = it has been repeated often enough.

        What leads to no item (PX4 stores such jumps; a tag that no JUMP_TAG has) leads beyond the
        last one: the mission ends.
        """
        done = self._done.get(item.seq, 0)
        if 0 <= item.p2 <= done:
            return None
        self._done[item.seq] = done + 1
        if item.command == Cmd.DO_JUMP_TAG:
            tags = (i for i, each in enumerate(items) if _tagged(each, item.p1))
            return next(tags, len(items))
        return int(item.p1) if 0 <= item.p1 < len(items) else len(items)


def _tagged(item: PlanItem, tag: float) -> bool:
    return item.command == Cmd.JUMP_TAG and item.p1 == tag
