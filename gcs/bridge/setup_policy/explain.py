"""What a policy makes of a parameter or a command, in words: `gcs bridge --explain NAME`.

Nothing is said twice: the lines are what the guard itself answers by that policy.
"""

from __future__ import annotations

from collections.abc import Iterator

from gcs.bridge.catalog.row import Kind, Row
from gcs.bridge.catalog.tables import command_rows
from gcs.bridge.setup_policy.commands import ROWS
from gcs.bridge.setup_policy.free_parameters import free_group_of
from gcs.bridge.setup_policy.mission_items import refused_item
from gcs.bridge.setup_policy.names import kinds_by_name
from gcs.bridge.setup_policy.parameters import ParameterGuard
from gcs.bridge.setup_policy.safety_parameters import BY_AUTOPILOT, NAME, group_of
from gcs.gate.policy.policy import BridgeRules
from gcs.plan.commands import KINDS
from gcs.protocol.autopilot import ARDUPILOT, PX4


def policy_explanation(row: Row, rules: BridgeRules) -> str:
    """What the policy says of a message or command: by its name, by a key, and in a mission."""
    return "\n".join(_by_policy(row, rules))


def _by_policy(row: Row, rules: BridgeRules) -> Iterator[str]:
    named = kinds_by_name(rules).get(row.name)
    if named is Kind.DENIED:
        yield "  policy: denied by its name (`extra_denied` of [bridge])"
    elif named is not None:
        yield "  policy: forwarded by its name (`extra_harmless` of [bridge])"
    number = next((n for n, each in command_rows().items() if each is row), None)
    if number is None:
        return
    guarded = ROWS.get(number)
    if named is None and guarded is not None:
        if guarded.key is None:
            yield "  policy: no key of [bridge] lets it through"
        else:
            yield f'  policy: `{guarded.key}` of [bridge] is "{getattr(rules, guarded.key)}"'
    refusal = refused_item(number, rules, kinds_by_name(rules))
    if refusal is not None:
        yield f"  in a client's mission: refused {refusal.code}: {refusal.sentence}"
    elif number in KINDS:
        yield "  in a client's mission: carried; the verifier judges the whole mission"
    else:
        yield "  in a client's mission: refused, as it is none that is verified here"


def parameter_explanation(name: str, rules: BridgeRules) -> str | None:
    """Some lines for a person; None where no table has a parameter that is called so."""
    name = name.strip().upper()
    if not NAME.fullmatch(name):
        return None
    knows = [who for who in BY_AUTOPILOT if group_of(who, name) or free_group_of(who, name)]
    if not knows:
        return None
    stands_on_it = any(group_of(who, name) is not None for who in knows)
    what = "that safety stands on" if stands_on_it else "that safety does not stand on"
    lines = [f"{name}, a parameter {what}"]
    encodings = {each.name: each.param_encoding for each in (PX4, ARDUPILOT)}
    for who in knows:
        why_not = ParameterGuard(rules, who, encodings[who]).why_refused(name)
        group = group_of(who, name) or free_group_of(who, name)
        if why_not is not None:
            lines.append(f"  {who}, from a client: not written: {why_not}")
        else:
            lines.append(f"  {who}, from a client: written")
        if group is not None and group.why not in (why_not or ""):
            lines.append(f"    why: {group.why}")
    lines += [
        f'  policy: `parameters` of [bridge] is "{rules.parameters}"; single ones are named by',
        "    `parameters_allowed` and `parameters_guarded`",
    ]
    return "\n".join(lines)
