"""A client never makes a stream slower than the gate needs it."""

from __future__ import annotations

import math

import pytest

from gcs.bridge.needed_rates import asked_anew, not_slower
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


@pytest.mark.parametrize("msgid", [0.0, float(MsgId.ATTITUDE), -5.0, math.nan, math.inf, 1e30])
def test_what_the_gate_does_not_need_is_the_clients(msgid: float) -> None:
    assert not_slower(interval(msgid, -1.0), NEEDED) is None


def test_another_command_is_none_of_this() -> None:
    rest = (0.0,) * 5
    other = CommandLong(32.0, -1.0, *rest, Cmd.REQUEST_MESSAGE, 1, 1, 0)
    assert not_slower(other, NEEDED) is None


def test_after_a_group_was_asked_for_the_gate_asks_for_what_it_needs_faster() -> None:
    assert asked_anew(RequestDataStream(4, 1, 1, 6, 1), NEEDED) == list(NEEDED)
    assert asked_anew(RequestDataStream(10, 1, 1, 0, 1), NEEDED) == [MsgId.LOCAL_POSITION_NED]
    assert asked_anew(RequestDataStream(50, 1, 1, 0, 0), NEEDED) == list(NEEDED), "it stops them"
