"""A plan has three parts, any of which may be missing: a mission, a fence, rally points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from gcs.plan.model import Fence, Plan
from gcs.wire.ids import MissionType

WORDS = {
    MissionType.MISSION: "mission",
    MissionType.FENCE: "fence",
    MissionType.RALLY: "rally points",
}


def held(plan: Plan) -> tuple[str, ...]:
    """What it holds, such as: 7 items, a fence of 3 zones, 2 rally points."""
    counts = len(plan.items), len(plan.fence.zones), len(plan.rally)
    names = ("item", "zone", "rally point")
    texts = [
        f"{count} {name}{'s'[: count != 1]}" for count, name in zip(counts, names, strict=True)
    ]
    texts[1] = f"a fence of {texts[1]}"
    return tuple(text for text, count in zip(texts, counts, strict=True) if count)


def are(parts: Sequence[str]) -> str:
    """What is `held`, with its verb."""
    one = len(parts) == 1 and parts[0].startswith(("1 ", "a "))
    return f"{', '.join(parts)} {'is' if one else 'are'}"


def apart(kind: MissionType, plan: Plan) -> tuple[Plan, Plan]:
    """The fence or the rally points of a plan alone, and the plan without them."""
    if kind is MissionType.FENCE:
        return replace(plan, items=(), rally=()), replace(plan, fence=Fence())
    return replace(plan, items=(), fence=Fence()), replace(plan, rally=())
