"""A client never makes a stream slower than the gate needs it."""

from __future__ import annotations

import math

import msgspec
import pytest

from gcs.bridge.rates.needed_rates import asked_anew, not_slower
from gcs.wire.ids import Cmd, MsgId
from gcs.wire.messages import CommandLong, RequestDataStream

NEEDED = {int(MsgId.LOCAL_POSITION_NED): 30.0, int(MsgId.EXTENDED_SYS_STATE): 5.0}


def interval(msgid: float, interval_us: float) -> CommandLong:
    rest = (0.0,) * 5
    return CommandLong(msgid, interval_us, *rest, Cmd.SET_MESSAGE_INTERVAL, 1, 1, 0)


@pytest.mark.parametrize("interval_us", [-1.0, 0.0, 33_334.0, 1e6, math.inf, math.nan])
def test_a_slower_interval_or_none_becomes_the_gates(interval_us: float) -> None:
    instead = not_slower(interval(MsgId.LOCAL_POSITION_NED, interval_us), NEEDED)
    assert instead == interval(MsgId.LOCAL_POSITION_NED, 33_333.0)


@pytest.mark.parametrize("interval_us", [1.0, 20_000.0, 33_333.0])
def test_a_faster_one_stays(interval_us: float) -> None:
    assert not_slower(interval(MsgId.LOCAL_POSITION_NED, interval_us), NEEDED) is None


@pytest.mark.parametrize("msgid", [float(MsgId.ATTITUDE)])
def test_what_the_gate_does_not_need_is_the_clients(msgid: float) -> None:
    assert not_slower(interval(msgid, -1.0), NEEDED) is None


@pytest.mark.parametrize("interval_us", [-1.0, 1e9, math.inf, math.nan])
@pytest.mark.parametrize("msgid", [0.0, -0.5, -5.0, math.nan, math.inf, 1e30])
def test_nobody_stops_the_heartbeat(msgid: float, interval_us: float) -> None:
    """ArduPilot has it among the messages whose interval can be set (GCS_Common.cpp)."""
    instead = not_slower(interval(msgid, interval_us), NEEDED)
    assert instead is not None
    assert (instead.param2, instead.command) == (1e6, Cmd.SET_MESSAGE_INTERVAL)


@pytest.mark.parametrize("msgid", [MsgId.HOME_POSITION, MsgId.GPS_GLOBAL_ORIGIN, MsgId.EVENT])
def test_what_comes_unasked_goes_on(msgid: MsgId) -> None:
    stopped = not_slower(interval(msgid, -1.0), NEEDED)
    assert stopped is not None
    assert 0.0 < stopped.param2 <= 2e6
    assert not_slower(interval(msgid, 0.0), NEEDED) is None, "the vehicle's default"
    assert not_slower(interval(msgid, 1e5), NEEDED) is None


@pytest.mark.parametrize("msgid", [31.5, 31.9, 32.4])
def test_an_id_between_two_is_either(msgid: float) -> None:
    """PX4: `(int)(param1 + 0.5f)`; ArduPilot cuts (mavlink_receiver.cpp, GCS_Common.cpp)."""
    instead = not_slower(interval(msgid, -1.0), NEEDED)
    assert instead is not None
    assert instead.param2 == 33_333.0


@pytest.mark.parametrize("msgid", [float(MsgId.ATTITUDE), float(MsgId.LOCAL_POSITION_NED), 9e3])
def test_nobody_sets_the_bytes_of_the_whole_link(msgid: float) -> None:
    """PX4: `set_message_interval(param1, param2, param3)`, the third is `data_rate`."""
    command = msgspec.structs.replace(interval(msgid, 1e4), param3=1.0)
    assert not_slower(command, NEEDED) == interval(msgid, 1e4)
    unset = msgspec.structs.replace(interval(msgid, 1e4), param3=math.nan)
    assert not_slower(unset, NEEDED) is None, "MAVSDK fills up with NaN"


def test_another_command_is_none_of_this() -> None:
    rest = (0.0,) * 5
    other = CommandLong(32.0, -1.0, *rest, Cmd.REQUEST_MESSAGE, 1, 1, 0)
    assert not_slower(other, NEEDED) is None


def test_after_a_group_was_asked_for_the_gate_asks_for_what_it_needs_faster() -> None:
    assert asked_anew(RequestDataStream(4, 1, 1, 6, 1), NEEDED) == list(NEEDED)
    assert asked_anew(RequestDataStream(10, 1, 1, 0, 1), NEEDED) == [MsgId.LOCAL_POSITION_NED]
    assert asked_anew(RequestDataStream(50, 1, 1, 0, 0), NEEDED) == list(NEEDED), "it stops them"
