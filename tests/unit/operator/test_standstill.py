"""A stop is complete with its mode; that the vehicle stands is told when it does."""

from __future__ import annotations

import msgspec

from gcs import ipc
from gcs.operator.standstill import Standstill
from tests.unit.operator.fake_station import FakeStation

HOLDING = msgspec.structs.replace(FakeStation("airborne").snapshot(), state="HOLDING")
DONE = ipc.EndingEvent(1, "abort", "complete")


def at(speed_m_s: float, state: str = "HOLDING") -> ipc.Snapshot:
    return msgspec.structs.replace(HOLDING, v_enu=(speed_m_s, 0.0, 0.0), state=state)


def test_the_outcome_says_how_fast_it_still_is_and_a_line_follows_when_it_stands() -> None:
    watch = Standstill()
    line = "abort: complete: hold mode seen, still moving at 4.5 m/s"
    assert watch.outcome("abort", DONE, at(4.5)) == line
    assert [watch.news(at(speed)) for speed in (3.0, 0.4, 0.2, 0.1)] == [
        *("", ""),
        "abort: the vehicle stands",
        "",
    ]


def test_of_a_vehicle_that_stands_and_of_what_is_no_stop_nothing_more_is_said() -> None:
    watch = Standstill()
    assert watch.outcome("abort", DONE, at(0.1)) == "abort: complete"
    assert (
        watch.outcome("goto", ipc.EndingEvent(1, "goto", "complete"), at(4.0)) == "goto: complete"
    )
    refused = ipc.EndingEvent(1, "hold", "aborted", "VEHICLE_REFUSED", "it says no")
    assert watch.outcome("hold", refused, at(4.0)) == "hold: aborted VEHICLE_REFUSED: it says no"
    assert not watch.stopping


def test_whoever_flies_on_is_not_told_that_it_stands() -> None:
    watch = Standstill()
    watch.outcome("hold", DONE, at(4.5))
    assert watch.news(at(2.0, "MOVING")) == ""
    assert watch.news(at(0.0)) == ""
