"""What a stream led to in a script of the gate: what was sent, and what its client was told."""

from __future__ import annotations

from gcs.gate.effects import SendSetpoint, StreamVerdict
from gcs.gate.permit import Permit
from gcs.gate.refusal import Code
from tests.unit.gate.script import Script


def sent(script: Script) -> list[Permit]:
    return [effect.permit for effect in script.all(SendSetpoint)]


def told(script: Script) -> list[Code | None]:
    """What the client was told of its stream: the codes of refusals, None for flown."""
    return [v.refusal.code if v.refusal else None for v in script.all(StreamVerdict)]
