"""What the guard does with a parameter, in words: `gcs bridge --explain NAME`."""

from __future__ import annotations

from gcs.bridge.guard.free_parameters import free_group_of
from gcs.bridge.guard.safety_parameters import BY_AUTOPILOT, NAME, group_of


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
