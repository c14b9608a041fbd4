"""What of a plan a format cannot keep, in words: one finding a kind of loss, with the items."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from gcs.plan import commands
from gcs.plan.errors import Finding, Level
from gcs.plan.model import Item, Plan

_SHOWN = 5


@dataclass(frozen=True, slots=True)
class Written:
    """A file's bytes, and what of the plan is not in them."""

    data: bytes
    lost: tuple[Finding, ...] = ()


class Losses:
    """Losses of one writer; those of items of one kind are told together.

    A WARNING is what changes the flight, a NOTE what does not.
    """

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._of_plan: list[Finding] = []
        self._of_items: dict[tuple[Level, str, str], list[int]] = {}

    def of_item(self, index: int, what: str, level: Level = Level.WARNING) -> None:
        name = commands.name(self._plan.items[index].command)
        self._of_items.setdefault((level, name, what), []).append(index)

    def of_plan(self, item: str, what: str, level: Level = Level.WARNING, where: str = "") -> None:
        self._of_plan.append(Finding(level, where, item, what))

    def heights_of_zones(self) -> None:
        for zone in self._plan.fence.zones:
            if zone.floor_above_home_m is not None or zone.ceiling_above_home_m is not None:
                what = "its floor and ceiling are not kept by this format"
                self.of_plan(f"fence zone {zone.name}", what, where=zone.where)

    def settings(self, *, home: bool, firmware: bool, speeds: bool = True) -> None:
        """What belongs to the whole plan and is not kept; a False is kept."""
        plan = self._plan
        if home and plan.home is not None:
            self.of_plan("home", "is not kept by this format", Level.NOTE)
        if firmware and plan.firmware is not None:
            what = f"that it was written for {plan.firmware} is not kept by this format"
            self.of_plan("firmware", what, Level.NOTE)
        if speeds and (plan.cruise_speed_m_s is not None or plan.hover_speed_m_s is not None):
            self.of_plan("speeds", "are not kept by this format", Level.NOTE)

    def fence_and_rally(self) -> None:
        """All of them."""
        count = len(self._plan.fence.zones)
        if count or self._plan.fence.breach_return is not None:
            self.of_plan("fence", f"its {count} zones are not kept by this format")
        if self._plan.rally:
            self.of_plan("rally points", f"{len(self._plan.rally)} are not kept by this format")

    def numbering(self) -> None:
        if any(item.do_jump_id != i for i, item in enumerate(self._plan.items, start=1)):
            self.of_plan("doJumpId", "items are numbered in their order", Level.NOTE)

    def found(self) -> tuple[Finding, ...]:
        return (*self._of_plan, *self._items())

    def _items(self) -> Iterator[Finding]:
        for (level, name, what), indexes in self._of_items.items():
            numbers = ", ".join(str(index + 1) for index in indexes[:_SHOWN])
            more = f" and {len(indexes) - _SHOWN} more" if len(indexes) > _SHOWN else ""
            word = "item" if len(indexes) == 1 else "items"
            where = self._plan.items[indexes[0]].where
            told = f"{what} ({word} {numbers}{more})"
            yield Finding(level, where, name, told, index=indexes[0])


def parameters_told(item: Item) -> str:
    """Which parameters of a waypoint say something: `wait of 2 s, heading`; empty for none."""
    hold_s, accept_m, pass_m, yaw_deg = item.params
    said = [
        (hold_s, f"wait of {hold_s:g} s"),
        (accept_m, "acceptance radius"),
        (pass_m, "passing distance"),
    ]
    told = [text for value, text in said if value and not math.isnan(value)]
    return ", ".join([*told, *([] if math.isnan(yaw_deg) else ["heading"])])
