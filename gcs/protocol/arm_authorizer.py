"""The station as the vehicle's arm authorizer: the vehicle asks before its motors start.

PX4 (COM_ARM_AUTH_REQ, COM_ARM_AUTH_ID) sends MAV_CMD_ARM_AUTHORIZATION_REQUEST whoever asked it to
arm: another station, a program on board, a remote control.  The answer is a COMMAND_ACK.  Pure.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Final

from gcs.protocol.effects import Address
from gcs.wire.ids import Cmd, Result
from gcs.wire.messages import CommandAck, CommandLong

VALID_S: Final = 10
"""How long a grant holds: long enough for the second step of COM_ARM_AUTH_MET = 1."""


class DeniedReason(IntEnum):
    """MAV_ARM_AUTH_DENIED_REASON, as far as it is used."""

    NONE = 1
    """The authorizer tells the reason itself, in words."""


@dataclass(frozen=True, slots=True)
class Answer:
    """To the vehicle, and to people."""

    ack: CommandAck
    granted: bool
    text: str


def answer(
    asked: CommandLong, asker: Address, own: Address, troubles: Sequence[str]
) -> Answer | None:
    """What a request is answered with; None where `asked` is none to us.

    `troubles` is what speaks against arming, in words; empty where nothing does.  MAVLink's XML has
    the seconds granted in `progress` and the reason of a denial in `result_param2`, PX4 reads them
    the other way round (ArmAuthorization.cpp, from memory): each stands in both.
    """
    if asked.command != Cmd.ARM_AUTHORIZATION_REQUEST or asked.target_system != own.sysid:
        return None
    if asked.target_component not in (0, own.compid):
        return None
    granted = not troubles
    detail = VALID_S if granted else DeniedReason.NONE
    ack = CommandAck(
        command=Cmd.ARM_AUTHORIZATION_REQUEST,
        result=Result.ACCEPTED if granted else Result.DENIED,
        progress=detail,
        result_param2=detail,
        target_system=asker.sysid,
        target_component=asker.compid,
    )
    if granted:
        return Answer(ack, True, f"the vehicle may arm within {VALID_S} s")
    return Answer(ack, False, "the vehicle may not arm: " + "; ".join(troubles))
