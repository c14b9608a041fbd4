"""Whether the gate would let the vehicle be armed now, where somebody else asks for it."""

from __future__ import annotations

from gcs.gate.machine.memory import Memory
from gcs.gate.machine.rows.requests_to_fly import arm
from gcs.gate.machine.turn import Turn
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import State


def why_not_arm(policy: Policy, memory: Memory, now_ns: int) -> Refusal | None:
    """The refusal that a request to arm would get; None where it would be carried out.

    Asks the checks of the table's own row, and changes nothing.
    """
    turn = Turn(policy, memory, now_ns)
    if memory.state is State.STALE or turn.stale:
        return Refusal(Code.STALE, "the vehicle's position is too old")
    if memory.state is not State.GROUNDED:
        return Refusal(
            Code.ALREADY_FLYING, f"the vehicle is not on the ground: {memory.state.name}"
        )
    for check in arm.needs:
        refusal = check.refusal(turn)
        if refusal is not None:
            return refusal
    return None
