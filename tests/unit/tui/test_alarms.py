"""Alarms: they ring, they stay, and a key acknowledges them."""

from __future__ import annotations

import msgspec
import pytest
from textual.pilot import Pilot

from gcs import ipc
from gcs.gate.condition import Condition
from gcs.tui.alarms import BELL_AGAIN_S, NAMES, Alarms
from gcs.tui.app import FlyApp
from tests.unit.operator.fake_station import FakeStation
from tests.unit.tui.flown import drawn, flown, screen_text
from tests.unit.tui.listening_station import ListeningStation

GOOD = FakeStation().snapshot()


def with_conditions(*conditions: str, at_s: float = 0.0) -> ipc.Snapshot:
    return msgspec.structs.replace(
        GOOD, conditions=list(conditions), time_ns=round(at_s * 1e9), state="HOVERING"
    )


def after(*events: ipc.Event, lost: bool = False) -> Alarms:
    alarms = Alarms()
    for event in events:
        alarms.told(event, lost=lost)
    return alarms


@pytest.mark.parametrize("condition", NAMES)
def test_each_bad_condition_rings_and_stays_when_it_is_over(condition: str) -> None:
    alarms = after(with_conditions(condition), with_conditions(condition, at_s=12.0))
    assert alarms.words() == f"{NAMES[condition]} 12 s"
    assert alarms.rings(0.0)
    alarms.told(with_conditions(), lost=False)
    assert alarms.words() == f"{NAMES[condition]} (over)"
    assert alarms.acknowledge()
    assert alarms.words() == ""


def test_a_vehicle_that_goes_silent_is_an_alarm_and_one_never_heard_is_none() -> None:
    silent = msgspec.structs.replace(GOOD, state="NO_VEHICLE")
    assert after(silent, lost=True).words() == "LINK LOST 0 s"
    assert after(msgspec.structs.replace(silent, vehicle="")).words() == ""


def test_control_that_somebody_else_takes_is_an_alarm_and_a_hold_of_ours_is_none() -> None:
    taken = ipc.StateEvent("MOVING", "EXTERNAL", "mode_changed", "NONE", "NOMINAL")
    assert after(taken).words() == "CONTROL LOST"
    held = ipc.StateEvent("MOVING", "HOLDING", "abort", "OURS", "NOMINAL")
    started = ipc.StateEvent("GROUNDED", "EXTERNAL", "airborne", "NONE", "NOMINAL")
    assert after(held, started).words() == ""


def test_it_rings_again_until_it_is_acknowledged_or_over() -> None:
    alarms = after(with_conditions(Condition.GPS_LOST))
    assert [alarms.rings(s) for s in (0.0, 1.0, BELL_AGAIN_S, BELL_AGAIN_S + 1.0)] == [
        True, False, True, False,
    ]  # fmt: skip
    alarms.acknowledge()
    assert not alarms.rings(100.0)


def test_what_was_acknowledged_is_quiet_until_it_comes_again() -> None:
    alarms = after(with_conditions(Condition.GPS_LOST))
    alarms.acknowledge()
    alarms.told(with_conditions(Condition.GPS_LOST), lost=False)
    assert alarms.words() == ""
    alarms.told(with_conditions(), lost=False)
    alarms.told(with_conditions(Condition.GPS_LOST), lost=False)
    assert alarms.words() == "GPS LOST 0 s"


def test_on_a_small_screen_gps_estimator_link_and_conditions_are_in_sight() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        rung: list[None] = []
        app.bell = lambda: rung.append(None)  # type: ignore[method-assign]
        bad = with_conditions(Condition.GPS_LOST, Condition.BATTERY_LOW)
        bad = msgspec.structs.replace(bad, gps="no fix, 3 satellites", estimator="no position")
        station.say(bad, ipc.VerdictEvent(1, "goto", "refused", "POLICY", "far away " * 20))
        await drawn(app, pilot)
        shown = screen_text(app)
        top = shown.splitlines()[1]
        assert "GPS LOST" in top
        assert "BATTERY LOW" in top
        for needed in ("gps  no fix", "ekf  no position", "cond gps lost, battery low", "120 Hz"):
            assert needed in shown, needed
        assert len(rung) == 1
        await pilot.press("n")
        await drawn(app, pilot)
        assert "GPS LOST" not in screen_text(app)

    flown(script, (80, 24))
