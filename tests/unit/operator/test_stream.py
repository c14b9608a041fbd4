"""A stream of a Python program: begun, fed, refused on the way, and ended, over a fake station."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from types import SimpleNamespace

import pytest

import gcs
from gcs import ipc
from gcs.operator.station import Station
from gcs.operator.stream import Stream
from tests.unit.operator.test_station import FakeWay, flying


def words(way: FakeWay) -> list[str]:
    """What was sent, with one "sample" for all that follow one another."""
    found: list[str] = []
    for sent in way.sent[1:]:
        word = sent.word if isinstance(sent, ipc.Ask) else "sample"
        if word != "sample" or found[-1:] != ["sample"]:
            found.append(word)
    return found


def code(stream: Stream) -> str:
    """Of why its samples are refused; empty where they are not."""
    return "" if stream.refusal is None else stream.refusal.code


class VirtualTime:
    """A clock that passes only where a station waits for its time to be over."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now_s = 0.0
        passing = SimpleNamespace(monotonic=lambda: self.now_s)
        monkeypatch.setattr("gcs.operator.stream.time", passing)
        monkeypatch.setattr(Station, "wait_until", self._wait_until)

    def _wait_until(self, done: Callable[[], bool], timeout_s: float) -> None:
        if not done():
            self.now_s += timeout_s


def test_a_velocity_is_flown_for_its_seconds_and_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    station, way = flying()
    with monkeypatch.context() as patch:
        clock = VirtualTime(patch)
        station.velocity(1.0, -2.0, 0.5, 30.0, seconds=0.25)
    assert clock.now_s == pytest.approx(0.25)
    assert words(way) == ["stream_begin", "sample", "stream_end"]
    samples = [sent for sent in way.sent if isinstance(sent, ipc.Stream)]
    assert samples == [ipc.Stream(v_enu=(1.0, -2.0, 0.5), yaw_rate_deg_s=30.0)] * 3
    assert station.state == "HOVERING"


def test_a_velocity_that_is_refused_on_the_way_ends_the_stream_and_says_why() -> None:
    station, way = flying()
    with pytest.raises(gcs.Refused, match="POLICY: too fast"):
        station.velocity(11.0, 0.0, 0.0, seconds=60.0)
    assert words(way) == ["stream_begin", "sample", "stream_end"]


def test_a_stream_that_may_not_begin_sends_no_sample() -> None:
    station, way = flying()
    station.goto(3.0, 0.0, 2.0, wait=False)
    with pytest.raises(gcs.Refused, match="BUSY"):
        station.velocity(1.0, 0.0, 0.0, seconds=1.0)
    assert words(way) == ["goto", "stream_begin"]


def test_a_block_streams_what_it_wants_and_sees_a_refusal_come_and_go() -> None:
    station, way = flying()
    with station.stream() as stream:
        assert code(stream) == ""
        stream.velocity(20.0, 0.0, 0.0, yaw_deg=90.0)
        assert code(stream) == "POLICY"
        stream.velocity(1.0, 0.0, 0.0)
        assert code(stream) == ""
        stream.position(1.0, 2.0, 3.0, yaw_deg=45.0)
    assert way.sent[-2] == ipc.Stream(pos_enu=(1.0, 2.0, 3.0), yaw_deg=45.0)
    assert words(way)[-1] == "stream_end"


def test_an_attitude_is_a_sample_too() -> None:
    station, way = flying()
    with station.stream() as stream:
        stream.attitude(1.0, -5.0, 90.0, 0.5, yaw_rate_deg_s=10.0)
        stream.attitude(float("inf"), 0.0, 0.0, 0.5)
    samples = [sent for sent in way.sent if isinstance(sent, ipc.Stream)]
    assert samples == [
        ipc.Stream(roll_deg=1.0, pitch_deg=-5.0, yaw_deg=90.0, yaw_rate_deg_s=10.0, thrust=0.5),
        ipc.Stream(roll_deg=None, pitch_deg=0.0, yaw_deg=0.0, thrust=0.5),
    ]


def test_a_hold_ends_it_and_the_next_sample_says_so() -> None:
    station, way = flying()
    with station.stream() as stream:
        for _ in stream.ticks(60.0, 0.01):
            stream.velocity(1.0, 0.0, 0.0)
            station.hold()
        with pytest.raises(gcs.NotCompleted) as ended:
            stream.velocity(1.0, 0.0, 0.0)
    assert (ended.value.state, ended.value.code) == ("aborted", "OPERATOR")
    assert words(way) == ["stream_begin", "sample", "hold"]


def test_a_hold_by_another_ends_a_velocity_early() -> None:
    station, way = flying()
    stop = threading.Timer(0.1, lambda: way.send(ipc.Ask(99, "hold")))
    stop.start()
    begun_s = time.monotonic()
    with pytest.raises(gcs.NotCompleted) as ended:
        station.velocity(1.0, 0.0, 0.0, seconds=60.0)
    assert time.monotonic() - begun_s < 30.0
    assert ended.value.code == "OPERATOR"


def test_numbers_that_are_none_go_to_the_gate_as_null() -> None:
    station, way = flying()
    with station.stream() as stream:
        stream.velocity(float("nan"), 0.0, 0.0)
    assert ipc.Stream(v_enu=(None, 0.0, 0.0)) in way.sent


def test_a_sample_outside_of_its_block_is_an_error() -> None:
    station, _ = flying()
    with pytest.raises(gcs.NotCompleted, match="with"):
        station.stream().velocity(1.0, 0.0, 0.0)
    with station.stream() as stream:
        pass
    with pytest.raises(gcs.NotCompleted, match="over"):
        stream.velocity(1.0, 0.0, 0.0)


def test_a_station_that_is_gone_is_told() -> None:
    way = FakeWay()
    station = Station(way)
    station.control()
    stream = station.stream()
    stream.__enter__()
    way.closed = 1
    with pytest.raises(gcs.Disconnected) as gone:
        stream.velocity(1.0, 0.0, 0.0)
    stream.__exit__(gcs.Disconnected, gone.value, None)
