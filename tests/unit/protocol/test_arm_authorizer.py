"""What is answered to a vehicle that asks whether it may arm."""

from __future__ import annotations

import pytest

from gcs.protocol.arm_authorizer import answer
from gcs.protocol.effects import Address
from gcs.wire.ids import Cmd, Result
from gcs.wire.messages import CommandLong

VEHICLE, OWN = Address(1, 1), Address(255, 191)


def asked(
    command: int = Cmd.ARM_AUTHORIZATION_REQUEST, sysid: int = 255, compid: int = 0
) -> CommandLong:
    return CommandLong(*(0.0,) * 7, command, sysid, compid, 0)


def test_without_troubles_it_is_granted_for_some_seconds() -> None:
    told = answer(asked(), VEHICLE, OWN, ())
    assert told is not None
    assert (told.granted, told.ack.result) == (True, Result.ACCEPTED)
    assert told.ack.progress == told.ack.result_param2 == 10
    assert (told.ack.target_system, told.ack.target_component) == (1, 1)


def test_each_trouble_is_named_and_the_reason_is_that_we_tell_it() -> None:
    told = answer(asked(compid=191), VEHICLE, OWN, ("the fence is off", "no record"))
    assert told is not None
    assert (told.granted, told.ack.result) == (False, Result.DENIED)
    assert told.ack.progress == told.ack.result_param2 == 1  # MAV_ARM_AUTH_DENIED_REASON_NONE
    assert told.text == "the vehicle may not arm: the fence is off; no record"


@pytest.mark.parametrize(
    "other", [asked(command=400), asked(sysid=10), asked(sysid=0), asked(compid=190)]
)
def test_what_is_not_for_us_is_not_answered(other: CommandLong) -> None:
    assert answer(other, VEHICLE, OWN, ()) is None
