"""What an operator who joins is told of what was before: bounded, and as it was."""

from __future__ import annotations

from gcs import ipc
from gcs.gate.effects import Level
from gcs.session.work import Log
from gcs.station.history import LINES, POINTS, History
from tests.unit.operator.fake_station import FakeStation


def flown_for(seconds: int) -> History:
    history, station = History(), FakeStation()
    station.armed, station.pos = True, (1.0, 2.0, 3.0)
    for tenth in range(seconds * 10):
        station.time_s = tenth / 10
        history.seen(station.snapshot())
    return history


def test_a_second_of_flight_is_a_point_and_the_trail_is_bounded() -> None:
    told = flown_for(POINTS + 60).told()[0]
    assert isinstance(told, ipc.History)
    assert len(told.trail) == POINTS
    assert told.trail[-1].time_ns - told.trail[0].time_ns == (POINTS - 1) * 10**9
    assert told.trail[0].pos_enu == (1.0, 2.0, 3.0)
    assert told.in_air_since_ns == 0
    # One line must go through the socket of an operator beside all else (256 KiB).
    assert len(ipc.encode(told)) < 64 << 10


def test_of_the_log_the_latest_lines_are_kept_and_no_debug_ones() -> None:
    history = History()
    for n in range(LINES + 10):
        history.logged(Log(Level.INFO, "gate", f"line {n}"), n, "")
        history.logged(Log(Level.DEBUG, "loop", "late"), n, "")
    told = history.told()[0]
    assert isinstance(told, ipc.History)
    assert [line.text for line in told.log] == [f"line {n}" for n in range(10, LINES + 10)]
