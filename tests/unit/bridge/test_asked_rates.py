"""Clients share the link to the vehicle with the gate: what they may have it send is bounded."""

from __future__ import annotations

import math

import pytest

from gcs.bridge.rates.asked_rates import OF_ALL, AskedRates
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
    for msgid in range(24, 29):
        assert own.command(interval(msgid, 20_000.0)) == interval(msgid, 20_000.0), "50 Hz, five"


def test_one_message_comes_at_the_policys_rate_at_the_most() -> None:
    assert asked_us(rates().command(interval(30, 1_000.0))) == 20_000.0
    assert asked_us(rates().command(interval(30, 1e-30))) == 20_000.0
    assert asked_us(rates("message_hz = 10.0").command(interval(30, 20_000.0))) == 100_000.0


def test_what_the_gate_needs_faster_a_client_may_have_as_fast() -> None:
    assert asked_us(rates().command(interval(32, 1_000.0))) == math.ceil(1e6 / 150.0)


@pytest.mark.parametrize("interval_us", [0.0, -1.0, math.nan, math.inf, -math.inf])
def test_none_and_the_vehicles_default_are_not_counted(interval_us: float) -> None:
    own = rates("messages_hz = 100.0")
    for msgid in range(200):
        assert isinstance(own.command(interval(msgid, interval_us)), CommandLong)
    assert isinstance(own.command(interval(30, 20_000.0)), CommandLong)


def test_one_client_may_have_half_of_what_the_policy_has() -> None:
    """The first to ask must not have all of it: the next one's screen would stay empty."""
    own = rates()
    for msgid in range(100, 105):
        assert isinstance(own.command(interval(msgid, 20_000.0), client=1000), CommandLong)
    refused = own.command(interval(110, 20_000.0), client=1000)
    assert isinstance(refused, Refusal)
    assert refused.code is Code.POLICY
    numbers = {"asked_hz": 50.0, "own_hz": 250.0, "share_hz": 250.0, "others_hz": 0.0}
    assert dict(refused.numbers) == {**numbers, "max_hz": 500.0}
    assert isinstance(own.command(interval(100, 40_000.0), client=1000), CommandLong), "half of one"
    assert isinstance(own.command(interval(110, 40_000.0), client=1000), CommandLong), "makes room"
    assert isinstance(own.group(stream(1, 10), client=1000), Refusal)


def test_the_next_client_may_have_half_of_what_the_first_left_and_so_on() -> None:
    own = rates()
    had_hz = []
    for client in range(1000, 1008):
        asked = [own.command(interval(client * 1000 + n, 1e6), client) for n in range(300)]
        had_hz.append(sum(isinstance(each, CommandLong) for each in asked))
    assert had_hz == [250, 125, 62, 31, 16, 8, 4, 2]


def test_all_clients_together_never_have_what_the_policy_has() -> None:
    own = rates("messages_hz = 200.0")
    counted: dict[int, float] = {}
    for turn in range(400):
        msgid, hz, client = turn * 7 % 90, 1.0 + turn % 50, 1000 + turn % 5
        if isinstance(own.command(interval(msgid, 1e6 / hz), client), CommandLong):
            counted[msgid] = hz
    assert 150.0 < sum(counted.values()) < 200.0


def test_who_asks_for_no_more_than_there_is_may_always_do_so() -> None:
    """A second screen that wants what comes already, or less, costs the link nothing."""
    own = rates("messages_hz = 200.0")
    for msgid in (100, 101):
        own.command(interval(msgid, 20_000.0), client=1000)
    own.command(interval(102, 20_000.0), client=1001)
    assert isinstance(own.command(interval(103, 20_000.0), client=1001), Refusal), "it has 50 of 50"
    assert own.command(interval(100, 20_000.0), client=1001) == interval(100, 20_000.0)
    assert own.command(interval(101, 21_000.0), client=1001) == interval(101, 21_000.0)


def test_a_group_counts_about_as_many_messages_as_were_recorded() -> None:
    """All at 4 Hz: 101 messages a second (AUTOPILOT_QUIRKS.md).  Half of 202 is 101."""
    assert isinstance(rates("messages_hz = 198.0").group(stream(4)), Refusal)
    assert rates("messages_hz = 202.0").group(stream(4)) == stream(4)
    assert isinstance(rates().group(stream(255)), Refusal)
    assert rates().group(stream(255, 10)) == stream(50, 10)


def test_a_stream_that_is_stopped_makes_room() -> None:
    own = rates("messages_hz = 200.0")
    assert own.group(stream(4)) == stream(4)
    assert isinstance(own.group(stream(4, 1)), Refusal)
    assert own.group(stream(4, 0, start=0)) == stream(4, 0, start=0)
    assert own.group(stream(4, 1)) == stream(4, 1)


RECORDED_AFTER_ALL_AT_2_HZ = {
    "POSITION_TARGET_LOCAL_NED": 5.0,
    "EXTENDED_SYS_STATE": 5.0,
    "HEARTBEAT": 2.0,
    "LOCAL_POSITION_NED": 2.0,
    "GPS_RAW_INT": 2.0,
}
"""Of an ArduCopter 4.7 (scenarios_arducopter.json, K1_small_services).  LOCAL_POSITION_NED came at
200 Hz before, GPS_RAW_INT at 1 and HEARTBEAT at 2, each by an interval of its own."""
ALONE = sorted(int(MsgId[name]) for name in ("POSITION_TARGET_LOCAL_NED", "EXTENDED_SYS_STATE"))


def test_all_streams_leave_the_intervals_of_messages_that_are_in_no_group() -> None:
    """So these go on counting, or two requests in turn would be twice what the policy has."""
    own = rates("messages_hz = 400.0")
    for msgid in ALONE:
        assert own.command(interval(msgid, 20_000.0)) == interval(msgid, 20_000.0)
    refused = own.group(stream(5))
    assert isinstance(refused, Refusal), "100 + 125"
    assert dict(refused.numbers)["own_hz"] == 100.0
    assert own.group(stream(4)) == stream(4), "100 + 100"
    assert isinstance(own.command(interval(200, 1e6)), Refusal)


def test_all_streams_set_the_interval_of_a_message_in_a_group_anew() -> None:
    own = rates("messages_hz = 300.0")
    assert own.command(interval(MsgId.ATTITUDE, 20_000.0)) == interval(30, 20_000.0)
    assert own.group(stream(4)) == stream(4)
    assert own.command(interval(200, 20_000.0)) == interval(200, 20_000.0), "100 + 50"


def test_a_vehicle_that_does_not_act_on_groups_sends_its_messages_as_before() -> None:
    """PX4 1.14: after all at 2 Hz ATTITUDE still came at 50 (scenarios_px4.json, K1)."""
    own = rates("messages_hz = 300.0")
    own.command(interval(MsgId.ATTITUDE, 20_000.0))
    assert own.group(stream(4), obeyed=False) == stream(4)
    assert isinstance(own.command(interval(200, 20_000.0)), Refusal), "50 + 100 + 50"


def test_which_messages_all_streams_set_is_as_recorded() -> None:
    for name, hz in RECORDED_AFTER_ALL_AT_2_HZ.items():
        kept_its_own = name in ("POSITION_TARGET_LOCAL_NED", "EXTENDED_SYS_STATE", "HEARTBEAT")
        assert (MsgId[name] not in OF_ALL) == kept_its_own, (name, hz)


def test_another_command_is_none_of_this() -> None:
    other = CommandLong(30.0, 1.0, *(0.0,) * 5, Cmd.REQUEST_MESSAGE, 1, 1, 0)
    assert rates().command(other) is other


AT = Address(1, 1)


def test_what_a_client_that_has_gone_asked_for_is_taken_back() -> None:
    """Or one that asks for all that there is, and leaves, would deny it to all others."""
    own = rates()
    for msgid in range(100, 105):
        own.command(interval(msgid, 20_000.0), client=1000)
    for msgid in (110, 111):
        assert isinstance(own.command(interval(msgid, 20_000.0), client=1001), CommandLong)
    assert isinstance(own.command(interval(112, 20_000.0), client=1001), Refusal), "125 of 250"
    back = own.client_lost(1000, AT)
    assert [each for each in back if isinstance(each, CommandLong)] == back
    assert {(each.param1, each.param2) for each in back if isinstance(each, CommandLong)} == {
        (float(msgid), 0.0) for msgid in range(100, 105)
    }
    assert own.command(interval(112, 20_000.0), client=1001) == interval(112, 20_000.0)
    assert own.client_lost(1000, AT) == []


def test_what_another_client_asked_for_since_or_the_gate_needs_goes_on() -> None:
    own = rates()
    own.command(interval(100, 20_000.0), client=1000)
    own.command(interval(100, 40_000.0), client=1001)
    own.command(interval(32, 20_000.0), client=1000)
    assert own.client_lost(1000, AT) == []


def test_a_group_of_a_client_that_has_gone_goes_on_slowly() -> None:
    own = rates()
    own.group(stream(10), client=1000)
    assert own.client_lost(1000, AT) == [stream(4)]
    assert own.group(stream(10, 6), client=1001) == stream(10, 6)
