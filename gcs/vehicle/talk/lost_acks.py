"""Commands of the gate that a heartbeat shows to be taken, though their answers were lost."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gcs.gate.effects import CommandKind
from gcs.gate.machine.gate import Gate
from gcs.gate.states import FlightMode

SHOWN_BY: Final[Mapping[CommandKind, FlightMode]] = {
    CommandKind.RETURN: FlightMode.RETURN,
    CommandKind.LAND: FlightMode.LAND,
    CommandKind.START_MISSION: FlightMode.MISSION,
    CommandKind.TAKE_OFF: FlightMode.TAKEOFF,
}
"""Those after which a flight follows.  Others end with the heartbeat that shows them.  That of an
ArduCopter which takes off in GUIDED shows nothing."""


def shown_commands(gate: Gate, mode: FlightMode) -> list[int]:
    """The requests whose command is not answered yet, and whose mode a heartbeat shows."""
    unanswered = gate.memory.outstanding
    return [request_id for request_id, kind in unanswered if SHOWN_BY.get(kind) is mode]
