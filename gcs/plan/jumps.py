"""Where a jump of a mission leads, and mistakes in DO_JUMP, JUMP_TAG and DO_JUMP_TAG items.

DO_JUMP names an item by its do_jump_id, DO_JUMP_TAG one by the number that a JUMP_TAG has.  An
ArduCopter looks for the tag as it flies, and takes the first item that has it (from memory).
"""

from __future__ import annotations

from collections.abc import Iterator

from gcs.plan.commands import FLOWN, KINDS, Kind, item_label
from gcs.plan.errors import Finding, Level
from gcs.plan.model import Item, Plan
from gcs.wire.ids import Cmd

_TAG_MAX = 65535
"""An ArduCopter keeps a tag in 16 bits: 70000 comes back as 4464, 1.6 as 1 (seen of one)."""


def jump_target(plan: Plan, jump: Item) -> int | None:
    """Into `plan.items`; None where no item is meant."""
    if jump.command == Cmd.DO_JUMP_TAG:
        return tagged(plan, jump.params[0])
    return plan.index_of(jump.params[0])


def tagged(plan: Plan, tag: float) -> int | None:
    """The first JUMP_TAG of that number."""
    for index, item in enumerate(plan.items):
        if item.command == Cmd.JUMP_TAG and item.params[0] == tag:
            return index
    return None


def lint_jumps(plan: Plan) -> Iterator[Finding]:
    """Jumps to items that are not there or to themselves, loops without a waypoint, loops without
    an end; tags that are none, or that two items have."""
    for index, item in enumerate(plan.items):
        if KINDS.get(item.command) is Kind.JUMP:
            yield from _lint_jump(plan, index, item)
        elif item.command == Cmd.JUMP_TAG:
            yield from _lint_tag(plan, index, item)


def _lint_tag(plan: Plan, index: int, item: Item) -> Iterator[Finding]:
    tag, label = item.params[0], item_label(index, item.command)
    first = tagged(plan, tag)
    if not (0 <= tag <= _TAG_MAX and tag == tag // 1):
        hint = f"a whole number from 0 to {_TAG_MAX}"
        yield Finding(Level.ERROR, item.where, label, f"its tag is {tag:g}", hint, index)
    elif first is not None and first != index:
        what = f"its tag {tag:g} is that of item {first + 1} too"
        yield Finding(Level.ERROR, item.where, label, what, "a tag names one item", index)


def _lint_jump(plan: Plan, index: int, item: Item) -> Iterator[Finding]:
    label = item_label(index, item.command)
    to, repeats = item.params[0], item.params[1]

    def finding(level: Level, what: str, hint: str = "") -> Finding:
        return Finding(level, item.where, label, what, hint, index)

    target = jump_target(plan, item)
    if target is None and item.command == Cmd.DO_JUMP_TAG:
        yield finding(Level.ERROR, f"jumps to tag {to:g}, which no JUMP_TAG has")
        return
    if target is None:
        ids = [other.do_jump_id for other in plan.items]
        before = "before the start" if to < min(ids) else "not there"
        yield finding(Level.ERROR, f"jumps to item {to:g}, which is {before}")
        return
    if target == index:
        yield finding(Level.ERROR, "jumps to itself")
        return
    if repeats != repeats or repeats < -1 or repeats != repeats // 1:
        hint = "-1 repeats for ever"
        yield finding(Level.ERROR, f"its repeat count is {repeats:g}", hint)
    elif repeats == 0:
        yield finding(Level.NOTE, "repeats 0 times, so it never jumps")
    elif repeats == -1 and target > index:
        yield finding(Level.WARNING, _leads_ahead(index, target))
    elif repeats == -1:
        what = "repeats for ever"
        behind = index + 1 < len(plan.items)
        yield finding(Level.WARNING, f"{what}; what follows is never flown" if behind else what)
    if target < index:
        passed = plan.items[target:index]
        if not any(KINDS.get(other.command) in FLOWN for other in passed):
            what = f"loops to item {target + 1} without a waypoint between them"
            yield finding(Level.ERROR, what)


def _leads_ahead(index: int, target: int) -> str:
    """What a jump does that is made every time and leads ahead: it repeats nothing."""
    if target == index + 1:
        return "goes on with the next item, as if it were not there"
    passed = f"items {index + 2} to {target} are" if target > index + 2 else f"item {target} is"
    return f"always goes on with item {target + 1}; {passed} only reached by another jump"
