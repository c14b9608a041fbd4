"""What the gate needs often comes to a client as often as that client asked for it."""

from __future__ import annotations

import math

import pytest
from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.rates.thinned_streams import ThinnedStreams
from gcs.protocol.effects import Address
from gcs.wire.frame import Frame
from gcs.wire.ids import Cmd, MsgId
from gcs.wire.messages import CommandLong, RequestDataStream
from tests.unit.bridge.test_bridge import frame_of

MS = 1_000_000
VEHICLE = Address(1, 1)
LINK, OTHER_LINK = 1, 2
NEEDED: dict[int, float] = {
    MsgId.LOCAL_POSITION_NED: 30.0,
    MsgId.ATTITUDE: 20.0,
    MsgId.BATTERY_STATUS: 1.0,
}
ATTITUDE = frame_of(mavlink.MAVLink_attitude_message(1, 0, 0, 0, 0, 0, 0), 1, 1)
POSITION = frame_of(mavlink.MAVLink_local_position_ned_message(1, 0, 0, 0, 0, 0, 0), 1, 1)


def command(command: Cmd, param1: float, param2: float = 0.0) -> CommandLong:
    return CommandLong(param1, param2, 0.0, 0.0, 0.0, 0.0, 0.0, command, 1, 1, 0)


def interval(interval_us: float, msgid: float = MsgId.ATTITUDE) -> CommandLong:
    return command(Cmd.SET_MESSAGE_INTERVAL, msgid, interval_us)


def group(stream: int, hz: int, start: int = 1) -> RequestDataStream:
    return RequestDataStream(hz, 1, 1, stream, start)


def passed(
    streams: ThinnedStreams, every_ms: float, frame: Frame = ATTITUDE, link: int = LINK
) -> int:
    """How many frames go to the client, of what comes for 10 s."""
    times = [round(number * every_ms * MS) for number in range(int(10_000 / every_ms))]
    return sum(link not in streams.left_out([frame], 10**12 + at) for at in times)


@pytest.mark.parametrize(("asked_hz", "comes"), [(1, 10), (2, 20), (7, 70), (15, 150), (20, 200)])
def test_it_comes_as_often_as_it_was_asked_for(asked_hz: int, comes: int) -> None:
    streams = ThinnedStreams(NEEDED)
    streams.asked(LINK, VEHICLE, interval(1e6 / asked_hz))
    assert passed(streams, 50.0) == pytest.approx(comes, abs=4)
    assert passed(streams, 50.0, POSITION) == 200, "of which it said nothing"
    assert passed(streams, 50.0, ATTITUDE._replace(sysid=2)) == 200, "another vehicle's"
    assert passed(streams, 50.0, link=OTHER_LINK) == 200, "another client"


def test_what_comes_as_asked_for_but_in_bunches_is_not_thinned() -> None:
    streams = ThinnedStreams(NEEDED)
    streams.asked(LINK, VEHICLE, interval(100_000.0))
    frames = [ATTITUDE._replace(raw=bytes((number,))) for number in range(2)]
    assert not any(streams.left_out(frames, 200 * MS * turn) for turn in range(50))


@pytest.mark.parametrize("interval_us", [0.0, math.nan])
def test_the_vehicles_own_rate_is_not_known_and_so_it_comes_as_it_is(interval_us: float) -> None:
    streams = ThinnedStreams(NEEDED)
    streams.asked(LINK, VEHICLE, interval(1e6))
    streams.asked(LINK, VEHICLE, interval(interval_us))
    assert passed(streams, 50.0) == 200


@pytest.mark.parametrize("interval_us", [-1.0, -math.inf, math.inf])
def test_none_is_none_but_for_one_that_is_asked_for_by_itself(interval_us: float) -> None:
    streams = ThinnedStreams(NEEDED)
    streams.asked(LINK, VEHICLE, interval(interval_us))
    assert passed(streams, 50.0) == 0 if interval_us < 0 else passed(streams, 50.0) <= 1
    streams.asked(LINK, VEHICLE, command(Cmd.REQUEST_MESSAGE, MsgId.ATTITUDE))
    assert passed(streams, 50.0) == 1


def test_the_last_word_counts_of_a_group_or_of_a_single_message() -> None:
    streams = ThinnedStreams(NEEDED)
    streams.asked(LINK, VEHICLE, interval(1e6))
    streams.asked(LINK, VEHICLE, group(6, 3))
    assert passed(streams, 50.0, POSITION) == pytest.approx(30, abs=1)
    assert passed(streams, 50.0) == pytest.approx(10, abs=1), "ATTITUDE is of another group"
    streams.asked(LINK, VEHICLE, group(0, 4))
    assert passed(streams, 50.0, POSITION) == pytest.approx(40, abs=1)
    assert passed(streams, 50.0) == pytest.approx(40, abs=1)
    streams.asked(LINK, VEHICLE, interval(500_000.0))
    assert passed(streams, 50.0) == pytest.approx(20, abs=1)


def test_a_vehicle_that_does_not_stop_a_group_is_heard_on() -> None:
    """As PX4: who asks it for nothing hears it all the same."""
    streams = ThinnedStreams(NEEDED)
    streams.asked(LINK, VEHICLE, group(0, 4, start=0), obeyed=False)
    assert passed(streams, 50.0) == 200
    streams.asked(LINK, VEHICLE, group(0, 4, start=0))
    assert passed(streams, 50.0) == 0


def test_one_message_of_many_batteries_and_what_the_gate_does_not_need_is_left_alone() -> None:
    streams = ThinnedStreams(NEEDED)
    for msgid in (MsgId.BATTERY_STATUS, MsgId.STATUSTEXT, MsgId.HEARTBEAT):
        streams.asked(LINK, VEHICLE, interval(-1.0, msgid))
        assert passed(streams, 50.0, ATTITUDE._replace(msgid=msgid)) == 200


def test_who_comes_on_the_link_of_one_who_has_gone_asked_for_nothing() -> None:
    streams = ThinnedStreams(NEEDED)
    streams.asked(LINK, VEHICLE, interval(1e6))
    streams.forget(LINK)
    assert passed(streams, 50.0) == 200
