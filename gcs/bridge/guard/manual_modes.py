"""Modes that sticks fly: the gate gives the vehicle up in them, so a client asks in vain."""

from __future__ import annotations

from collections.abc import Sequence

from gcs import ipc
from gcs.gate.policy.policy import BridgeRules
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import FlightMode
from gcs.protocol.autopilot import Autopilot, mode_named


def refused_mode(
    asks: Sequence[ipc.Ask], autopilot: Autopilot, rules: BridgeRules, *, stands_disarmed: bool
) -> Refusal | None:
    """Why what a client asks for leads to such a mode; None where it does not, where the policy
    names it in `manual_modes`, and while the vehicle is disarmed on the ground."""
    if stands_disarmed:
        return None
    for each in asks:
        mode = mode_named(autopilot, each.mode) if each.word == "mode" else None
        if mode is None or mode.meaning is not FlightMode.OTHER:
            continue
        allowed = (mode_named(autopilot, name) for name in rules.manual_modes)
        if mode not in tuple(allowed):
            sentence = f"{mode.name} is flown with sticks: the gate could hold nothing in it"
            return Refusal(Code.POLICY, f"{sentence} (policy: bridge.manual_modes)")
    return None
