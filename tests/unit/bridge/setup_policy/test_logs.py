"""A log that a client reads on the ground is not read on in the air; the policy may let it be."""

from __future__ import annotations

from typing import Any

import pytest
from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.effects import AsksVehicle, LogLine
from gcs.gate.refusal import Code
from gcs.protocol.autopilot import PX4
from gcs.wire.ids import Cmd
from tests.unit.bridge.setup_policy.wire import (
    FLYING,
    PARKED,
    allowed,
    command,
    guard,
    refused,
    sent,
)
from tests.unit.bridge.test_bridge import OWN, VEHICLE, Table, of, with_rules
from tests.unit.bridge.vehicles import standing

READ = mavlink.MAVLink_log_request_data_message(1, 1, 1, 0, 90)
SENT = mavlink.MAVLink_command_long_message(1, 1, Cmd.LOGGING_START, 0, *[0.0] * 7)
LISTED = mavlink.MAVLink_log_request_list_message(1, 1, 0, 10)


def ended(effects: Any) -> list[str]:
    """What the vehicle is asked for in the station's name."""
    asked = of(AsksVehicle, effects)
    assert all(each.source == OWN and each.message.target_system == 1 for each in asked)
    return [type(each.message).__name__ for each in asked]


@pytest.mark.parametrize(
    ("messages", "ends"),
    [
        ((LISTED,), []),
        ((READ,), ["LogRequestEnd"]),
        ((SENT,), ["CommandLong"]),
        ((READ, SENT), ["LogRequestEnd", "CommandLong"]),
        ((SENT, READ), ["LogRequestEnd", "CommandLong"]),
    ],
)
def test_it_is_ended_once_when_the_vehicle_is_armed(messages: Any, ends: list[str]) -> None:
    table = Table(seen=standing(PX4))
    assert ended(table.bridge.armed(VEHICLE)) == []
    for _ in range(2):  # once more after the next one that is read
        for message in messages:
            assert not table.says(message).refused
        armed = table.bridge.armed(VEHICLE)
        assert ended(armed) == ends
        assert len(of(LogLine, armed)) == bool(ends)
        assert ended(table.bridge.armed(VEHICLE)) == [], "a second later it is over"


def test_the_policy_may_let_it_go_on() -> None:
    table = Table(seen=standing(PX4), rules=with_rules('downloads = "forward"'))
    assert not table.says(READ).refused
    assert ended(table.bridge.armed(VEHICLE)) == []


def test_none_is_begun_in_the_air() -> None:
    allowed(guard().judge(command(Cmd.LOGGING_START), PARKED))
    reads = sent("log_request_data", 1, 1, 1, 0, 90)
    allowed(guard().judge(reads, PARKED))
    for message in (reads, command(Cmd.LOGGING_START)):
        assert refused(guard().judge(message, FLYING)).refusal.code is Code.IN_AIR
        allowed(guard('downloads = "forward"').judge(message, FLYING))
