"""What an operator of the station may change and read of the set-up: the clients' rules, and on the
ground more.

What is guarded from clients an operator in control may set while the vehicle is disarmed and not
known to be in the air: somebody must be able to.  In the air it is refused to everybody.
"""

from __future__ import annotations

from gcs.bridge.setup_policy.parameters import KEY, ParameterGuard
from gcs.bridge.setup_policy.verdict import on_ground_only
from gcs.gate.policy.policy import BridgeRules
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.autopilot import ParamEncoding


def why_not_write(rules: BridgeRules, autopilot: str, name: str, *, stands: bool) -> Refusal | None:
    """`stands`: the vehicle is disarmed, and not known to be in the air."""
    why = ParameterGuard(rules, autopilot, ParamEncoding.CAST).why_refused(name)
    if why is None or (stands and rules.parameters == "guard"):
        return None
    if rules.parameters == "guard":
        sentence = f"{why}; it is set while the vehicle is disarmed on the ground only"
        return Refusal(Code.IN_AIR, f"{sentence} ({KEY})")
    return Refusal(Code.POLICY, f"{why} ({KEY})")


def why_not_read_file(rules: BridgeRules, *, stands: bool) -> Refusal | None:
    """Reading a file or a log of the vehicle, which fills the link."""
    if rules.downloads == "forward" or (stands and rules.downloads == "on_ground"):
        return None
    if rules.downloads == "on_ground":
        return Refusal(Code.IN_AIR, on_ground_only("reading files and logs", "downloads"))
    sentence = "reading files and logs is not allowed (policy: bridge.downloads)"
    return Refusal(Code.POLICY, sentence)
