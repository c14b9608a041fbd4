"""The sentences of the gate's own refusals and outcomes.

Refusals by the verifier carry sentences of their own (`gcs/gate/airspace/explain.py`).
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from gcs.gate.effects import CommandKind
from gcs.gate.refusal import Code

REFUSED: Final[Mapping[Code, str]] = MappingProxyType(
    {
        Code.BUSY: "another request is under way",
        Code.NO_VEHICLE: "no vehicle is heard",
        Code.STALE: "the vehicle's position is too old",
        Code.NOT_IN_CONTROL: "somebody else flies the vehicle: take control first",
        Code.CONTROL_PENDING: "control is being taken, the heartbeat has not confirmed it yet",
        Code.NOT_FLYING: "the vehicle is not flying: arm and take off first",
        Code.ALREADY_FLYING: "the vehicle flies already",
        Code.HOLDING: "the vehicle is held: resume first",
        Code.IN_AIR: "the vehicle is not known to stand on the ground",
        Code.OPERATOR_LOST: "the operator is gone: only hold, land, abort and disarm are left",
        Code.POLICY: "the policy does not allow it",
        Code.RTL_BLOCKED: "the way home is not clear: land instead",
    }
)
"""Why a request is refused in this state."""

ENDED: Final[Mapping[Code, str]] = MappingProxyType(
    {
        Code.OPERATOR: "stopped by the operator",
        Code.OPERATOR_LOST: "the operator is lost",
        Code.SUPERSEDED: "a later request took its place",
        Code.DEADLINE: "it took longer than its deadline",
        Code.NO_ANSWER: "the vehicle did not do it in time",
        Code.VEHICLE_REFUSED: "the vehicle refused",
        Code.STALE: "the vehicle's position is too old",
        Code.LINK_LOST: "the vehicle is not heard any more",
        Code.MODE_CHANGED: "the vehicle's mode was changed by somebody else",
        Code.NOT_ARMED: "the vehicle disarmed",
        Code.NOT_FLYING: "the vehicle stands on the ground",
        Code.ESTIMATOR_RESET: "the vehicle's position jumped",
        Code.HOME_MOVED: "home moved while the vehicle flew",
        Code.FENCE_BREACH: "the vehicle would have left the fence",
        Code.TOO_HIGH: "the vehicle climbed above the height that was verified",
        Code.TOO_CLOSE: "no verified place to hover",
        Code.SEVERITY: "severity forbids motion",
    }
)
"""Why a request ended otherwise than complete."""

ASKED_FOR: Final[Mapping[CommandKind, str]] = MappingProxyType(
    {
        CommandKind.HOLD: "hold mode",
        CommandKind.GUIDED: "guided mode",
        CommandKind.ARM: "arming",
        CommandKind.DISARM: "disarming",
        CommandKind.FORCE_DISARM: "the forced disarm",
        CommandKind.TAKE_OFF: "take-off",
        CommandKind.LAND: "landing",
        CommandKind.RETURN: "the return",
        CommandKind.PHOTO: "the picture",
        CommandKind.START_MISSION: "the mission",
        CommandKind.SET_MODE: "the mode",
    }
)
"""What a command asks for, for "the vehicle refused ..." and "No answer to the request for ..."."""

RESULTS: Final[Mapping[int, str]] = MappingProxyType(
    {
        1: "TEMPORARILY_REJECTED",
        2: "DENIED",
        3: "UNSUPPORTED",
        4: "FAILED",
        6: "CANCELLED",
        7: "COMMAND_LONG_ONLY",
        8: "COMMAND_INT_ONLY",
        9: "COMMAND_UNSUPPORTED_MAV_FRAME",
        10: "NOT_IN_CONTROL",
    }
)
"""MAV_RESULT, as an answer is told; ACCEPTED and IN_PROGRESS are told by what follows."""


def result_word(result: int) -> str:
    """MAV_RESULT in a word; a number that no standard knows as it came."""
    return RESULTS.get(result, f"result {result}")
