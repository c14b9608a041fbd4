"""What the guard does with a parameter or a command, in words: `gcs bridge --explain NAME`."""

from __future__ import annotations

from gcs.bridge.guard.commands import ROWS
from gcs.bridge.guard.free_parameters import free_group_of
from gcs.bridge.guard.safety_parameters import BY_AUTOPILOT, NAME, group_of
from gcs.gate.policy.parse import DEFAULT


def key_explanation(command: str) -> str:
    """Which key of the policy decides on a command that configures; empty for any other name."""
    row = next((row for row in ROWS.values() if row.name == command), None)
    if row is None:
        return ""
    if row.key is None:
        return "  policy: no key of [bridge] lets it through"
    return f'  policy: `{row.key}` of [bridge], "{getattr(DEFAULT.bridge, row.key)}" by default'


def parameter_explanation(name: str) -> str | None:
    """Some lines for a person; None where no table has a parameter that is called so."""
    name = name.strip().upper()
    if not NAME.fullmatch(name):
        return None
    guarded = {autopilot: group_of(autopilot, name) for autopilot in BY_AUTOPILOT}
    whys = [f"  {who}: {group.why}" for who, group in guarded.items() if group is not None]
    if whys:
        head = f"{name}, a parameter that safety stands on"
        rule = "  from a client: not written, unless `parameters_allowed` of [bridge] names it"
        return "\n".join((head, rule, *whys))
    free = {autopilot: free_group_of(autopilot, name) for autopilot in BY_AUTOPILOT}
    whys = [f"  {who}: {group.why}" for who, group in free.items() if group is not None]
    if not whys:
        return None
    head = f"{name}, a parameter that a client may write"
    rule = "  from a client: forwarded, unless `parameters_guarded` of [bridge] names it"
    return "\n".join((head, rule, *whys))
