"""Where a jump of a mission leads.

DO_JUMP names an item by its do_jump_id, DO_JUMP_TAG one by the number that a JUMP_TAG has.  An
ArduCopter looks for the tag as it flies, and takes the first item that has it (from memory).
"""

from __future__ import annotations

from gcs.plan.model import Item, Plan
from gcs.wire.ids import Cmd


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
