"""What commands a client's mission may carry: those that the client could send by themselves.

An autopilot does the commands of a mission as it flies it, so each is judged by its row in the
tables (`catalog/`) and by the policy.  What flies, waits or jumps, and what means something in a
mission only, is the mission verifier's to judge.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from gcs.bridge.catalog.command_items import ONLY_IN_PLANS
from gcs.bridge.catalog.row import Kind, Row
from gcs.bridge.catalog.tables import command_rows
from gcs.bridge.setup_policy.commands import ROWS, choice_of
from gcs.bridge.setup_policy.names import DENIED_BY_NAME, kinds_by_name
from gcs.bridge.setup_policy.verdict import not_allowed, on_ground_only
from gcs.gate.policy.policy import BridgeRules
from gcs.gate.refusal import Code, Refusal
from gcs.plan import commands
from gcs.plan.wire import WireItem


def refused_items(
    items: Sequence[WireItem], first_seq: int, rules: BridgeRules
) -> tuple[Refusal, ...]:
    """A refusal for each item that may not be carried, which names it.

    `first_seq` is the first item that is flown, which findings count as item 1.
    """
    by_name = kinds_by_name(rules)
    found = ((item, refused_item(item.command, rules, by_name)) for item in items[first_seq:])
    return tuple(
        Refusal(why.code, f"{_label(item, first_seq)}: {why.sentence}")
        for item, why in found
        if why is not None
    )


def refused_item(command: int, rules: BridgeRules, by_name: Mapping[str, Kind]) -> Refusal | None:
    """Why a mission may not carry this command; None where it may, and where the verifier judges.

    `by_name` is what the policy says of single names.  What the dialect lacks is no item that is
    verified here, which the verifier says.
    """
    row = command_rows().get(command)
    if row is None:
        return None
    match by_name.get(row.name):
        case Kind.DENIED:
            return DENIED_BY_NAME
        case None:
            return _by_row(command, row, rules)
        case _:
            return None


def _by_row(command: int, row: Row, rules: BridgeRules) -> Refusal | None:
    if row.kind is Kind.CONFIGURATION:
        return _set_up(command, rules)
    verified = command in ONLY_IN_PLANS or commands.KINDS.get(command) is commands.Kind.JUMP
    if row.kind is Kind.DENIED and not verified:
        return Refusal(Code.POLICY, row.why)
    return None


def _set_up(command: int, rules: BridgeRules) -> Refusal | None:
    """As the guard judges the command of a vehicle in the air, where missions are flown."""
    key, what = ROWS[command].key, ROWS[command].what
    if key is None:
        return Refusal(Code.POLICY, f"{what} is never allowed to a client")
    match choice_of(key, rules):
        case "forward":
            return None
        case "on_ground":
            return Refusal(Code.POLICY, on_ground_only(what, key))
        case _:
            return Refusal(Code.POLICY, not_allowed(what, key))


def _label(item: WireItem, first_seq: int) -> str:
    return f"item {item.seq - first_seq + 1} ({command_rows()[item.command].name})"
