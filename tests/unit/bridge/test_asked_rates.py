"""Clients share the link to the vehicle with the gate: what they may have it send is bounded."""

from __future__ import annotations

import math

import pytest

from gcs.bridge.asked_rates import AskedRates
from gcs.gate.policy.parse import parse_policy
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.effects import Address
from gcs.wire.ids import Cmd, MsgId
from gcs.wire.messages import CommandLong, RequestDataStream

FAST_NEED = {int(MsgId.LOCAL_POSITION_NED): 150.0}


def rates(rules: str = "") -> AskedRates:
    return AskedRates(parse_policy(f"[bridge]\n{rules}", "my.toml").bridge, FAST_NEED)


def interval(msgid: float, interval_us: float) -> CommandLong:
    rest = (0.0,) * 5
    return CommandLong(msgid, interval_us, *rest, Cmd.SET_MESSAGE_INTERVAL, 1, 1, 0)


def stream(hz: int, group: int = 0, start: int = 1) -> RequestDataStream:
    return RequestDataStream(hz, 1, 1, group, start)


def asked_us(found: object) -> float:
    assert isinstance(found, CommandLong)
    return found.param2


# What ground stations ask for.  QGroundControl of an ArduPilot, from memory: groups at 2, 2, 2, 3,
# 10, 10 and 3 Hz; MAVProxy and DroneKit: all at 4 Hz (VEHICLE_CONTRACT.md).
QGROUNDCONTROL = ((1, 2), (2, 2), (3, 2), (6, 3), (10, 10), (11, 10), (12, 3))


def test_what_ground_stations_ask_for_passes_unchanged() -> None:
    own = rates()
    for group, hz in QGROUNDCONTROL:
        assert own.group(stream(hz, group)) == stream(hz, group)
    assert own.group(stream(4)) == stream(4)
    own = rates()
    for msgid in range(24, 34):
        assert own.command(interval(msgid, 20_000.0)) == interval(msgid, 20_000.0), "50 Hz, ten"


def test_one_message_comes_at_the_policys_rate_at_the_most() -> None:
    assert asked_us(rates().command(interval(30, 1_000.0))) == 20_000.0
    assert asked_us(rates().command(interval(30, 1e-30))) == 20_000.0
    assert asked_us(rates("message_hz = 10.0").command(interval(30, 20_000.0))) == 100_000.0


def test_what_the_gate_needs_faster_a_client_may_have_as_fast() -> None:
    assert asked_us(rates().command(interval(32, 1_000.0))) == math.ceil(1e6 / 150.0)


@pytest.mark.parametrize("interval_us", [0.0, -1.0, math.nan, math.inf, -math.inf])
def test_none_and_the_vehicles_default_are_not_counted(interval_us: float) -> None:
    own = rates("messages_hz = 50.0")
    for msgid in range(200):
        assert isinstance(own.command(interval(msgid, interval_us)), CommandLong)
    assert isinstance(own.command(interval(30, 20_000.0)), CommandLong)


def test_together_they_may_not_ask_for_more_than_the_policy_has() -> None:
    own = rates()
    for msgid in range(100, 110):
        assert isinstance(own.command(interval(msgid, 20_000.0)), CommandLong)
    refused = own.command(interval(110, 20_000.0))
    assert isinstance(refused, Refusal)
    assert refused.code is Code.POLICY
    assert dict(refused.numbers) == {"asked_hz": 50.0, "others_hz": 500.0, "max_hz": 500.0}
    assert isinstance(own.command(interval(100, 40_000.0)), CommandLong), "half of one of them"
    assert isinstance(own.command(interval(110, 40_000.0)), CommandLong), "leaves room"
    assert isinstance(own.group(stream(10, 10)), Refusal)


def test_a_group_counts_about_as_many_messages_as_were_recorded() -> None:
    """All at 4 Hz: 101 messages a second (AUTOPILOT_QUIRKS.md)."""
    assert isinstance(rates("messages_hz = 99.0").group(stream(4)), Refusal)
    assert rates("messages_hz = 101.0").group(stream(4)) == stream(4)
    assert isinstance(rates().group(stream(255)), Refusal)
    assert rates().group(stream(255, 10)) == stream(50, 10)


def test_a_stream_that_is_stopped_makes_room() -> None:
    own = rates("messages_hz = 100.0")
    assert own.group(stream(4)) == stream(4)
    assert isinstance(own.group(stream(4, 1)), Refusal)
    assert own.group(stream(4, 0, start=0)) == stream(4, 0, start=0)
    assert own.group(stream(4, 1)) == stream(4, 1)


def test_another_command_is_none_of_this() -> None:
    other = CommandLong(30.0, 1.0, *(0.0,) * 5, Cmd.REQUEST_MESSAGE, 1, 1, 0)
    assert rates().command(other) is other


AT = Address(1, 1)


def test_what_a_client_that_has_gone_asked_for_is_taken_back() -> None:
    """Or one that asks for all that there is, and leaves, would deny it to all others."""
    own = rates()
    for msgid in range(100, 110):
        own.command(interval(msgid, 20_000.0), client=1000)
    assert isinstance(own.command(interval(110, 20_000.0), client=1001), Refusal)
    back = own.client_lost(1000, AT)
    assert [each for each in back if isinstance(each, CommandLong)] == back
    assert {(each.param1, each.param2) for each in back if isinstance(each, CommandLong)} == {
        (float(msgid), 0.0) for msgid in range(100, 110)
    }
    assert own.command(interval(110, 20_000.0), client=1001) == interval(110, 20_000.0)
    assert own.client_lost(1000, AT) == []


def test_what_another_client_asked_for_since_or_the_gate_needs_goes_on() -> None:
    own = rates()
    own.command(interval(100, 20_000.0), client=1000)
    own.command(interval(100, 40_000.0), client=1001)
    own.command(interval(32, 20_000.0), client=1000)
    assert own.client_lost(1000, AT) == []


def test_a_group_of_a_client_that_has_gone_goes_on_slowly() -> None:
    own = rates()
    own.group(stream(20), client=1000)
    assert own.client_lost(1000, AT) == [stream(4)]
    assert own.group(stream(10, 6), client=1001) == stream(10, 6)
