"""MAV_MISSION_RESULT: how a client is told, in one number, what became of its plan."""

from __future__ import annotations

from typing import Final

from gcs.gate.refusal import Code
from gcs.wire.ids import MissionResult

_RESULTS: Final = {
    Code.BAD_MISSION: MissionResult.INVALID,
    Code.UNSUPPORTED: MissionResult.UNSUPPORTED,
    Code.UNSUPPORTED_VEHICLE: MissionResult.UNSUPPORTED,
    Code.NO_VEHICLE: MissionResult.ERROR,
    Code.NO_ANSWER: MissionResult.ERROR,
    Code.LINK_LOST: MissionResult.ERROR,
    Code.DEADLINE: MissionResult.ERROR,
    Code.VEHICLE_REFUSED: MissionResult.ERROR,
    Code.NO_ORIGIN: MissionResult.ERROR,
    Code.OPERATOR: MissionResult.OPERATION_CANCELLED,
    Code.OPERATOR_LOST: MissionResult.OPERATION_CANCELLED,
}
"""All others say that the plan is not allowed: DENIED."""

NAMED: Final = {
    result.name: result for result in MissionResult if result is not MissionResult.ACCEPTED
}


def result_of(code: str, sentence: str) -> MissionResult:
    """Of a refusal, or of an ending that is not complete.

    Where the vehicle itself refused, its own result is passed on: the sentence ends with its name.
    """
    known = Code(code) if code in Code.__members__ else Code.UNSUPPORTED
    if known is Code.VEHICLE_REFUSED:
        return NAMED.get(sentence.rpartition(" ")[2], MissionResult.ERROR)
    if known is Code.BAD_MISSION and ": frame " in sentence:
        return MissionResult.UNSUPPORTED_FRAME
    return _RESULTS.get(known, MissionResult.DENIED)
