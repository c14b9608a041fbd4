"""Several vehicles on one screen: keys are for the one that is shown, and all are told of."""

from __future__ import annotations

import msgspec
import pytest
from textual.pilot import Pilot

from gcs import ipc
from gcs.tui import fleet
from gcs.tui.alarms import Alarms
from gcs.tui.app import FlyApp
from tests.unit.operator.fake_station import FakeStation
from tests.unit.tui.flown import drawn, flown, screen_text
from tests.unit.tui.listening_station import ListeningStation


def other(sysid: int, **told: object) -> ipc.OtherVehicle:
    row = ipc.OtherVehicle(sysid, "HOVERING", "NOMINAL", [], "OFFBOARD", True, False)
    return msgspec.structs.replace(row, **told)


def seen_with(*others: ipc.OtherVehicle, sysid: int = 2, **told: object) -> ipc.Snapshot:
    seen = FakeStation("airborne", shown=sysid, others=list(others)).snapshot()
    return msgspec.structs.replace(seen, **told)


@pytest.mark.parametrize(("shown", "following"), [(1, 2), (2, 5), (5, 1)])
def test_the_next_one_is_that_with_the_next_number(shown: int, following: int) -> None:
    others = [other(each) for each in (5, 1, 2) if each != shown]
    assert fleet.next_of(seen_with(*others, sysid=shown)) == following
    marks = fleet.marks(seen_with(*others, sysid=shown))
    assert [mark.sysid for mark in marks] == [1, 2, 5]
    assert [mark.sysid for mark in marks if mark.shown] == [shown]


def test_one_alone_has_no_next_and_no_mark() -> None:
    assert (fleet.next_of(seen_with()), fleet.marks(seen_with())) == (0, [])


@pytest.mark.parametrize(
    ("rows", "count"),
    [
        ((), 1),
        ((other(1),), 2),
        ((other(1, on_ground=True),), 1),
        ((other(1, armed=False), other(3, state="NO_VEHICLE")), 1),
    ],
)
def test_those_in_the_air_are_counted(rows: tuple[ipc.OtherVehicle, ...], count: int) -> None:
    seen = seen_with(*rows, armed=True, landed="IN_AIR", state="HOVERING")
    assert fleet.flying(seen) == count


def test_alarms_of_all_have_their_number_and_follow_no_switch() -> None:
    alarms = Alarms()
    close = other(1, conditions=["too_close"])
    alarms.told(seen_with(close, conditions=["gps_lost"], state="HOVERING"), lost=False)
    assert alarms.words() == "2: GPS LOST 0 s · 1: TOO CLOSE 0 s"
    switched = seen_with(
        other(2, conditions=["gps_lost"]), sysid=1, conditions=["too_close"], state="HOVERING"
    )
    assert alarms.rings(0.0)
    alarms.told(switched, lost=False)
    assert {each.name for each in alarms.open} == {"2: GPS LOST", "1: TOO CLOSE"}
    assert not alarms.rings(0.1), "neither is news"
    alarms.told(
        seen_with(other(2, state="EXTERNAL"), other(3, state="NO_VEHICLE"), sysid=1), lost=False
    )
    assert "2: CONTROL LOST" in alarms.words()
    assert "3: LINK LOST 0 s" in alarms.words()


@pytest.mark.slow  # the screen's own timers
def test_keys_are_for_the_vehicle_that_is_shown() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.station.others = [other(1, pos_enu=(5.0, 0.0, 2.0)), other(2)]
        station.fly(0.2)
        await pilot.pause()
        assert ipc.Show(1) in station.sent, "from now on each request names it"
        await pilot.press("right", "space")
        await pilot.press("tab", "space", "A")
        station.fly(0.2)
        await pilot.pause()
        assert app.scene.pending.goal_enu[0] == 0.0, "the goal was one of the other's"
        await drawn(app, pilot)
        assert "[2]" in screen_text(app).splitlines()[0]
        asked = [each for each in station.sent if isinstance(each, ipc.Ask)]
        assert [each.word for each in asked] == ["abort", "abort", "abort"]
        assert [each.vehicle for each in asked] == [1, 2, ipc.EVERY]
        await pilot.press(":", *"vehicle", "space", "1", "enter")
        station.fly(0.2)
        await pilot.pause()
        assert app.scene.pending.goal_enu[0] == 1.0
        await pilot.press(":", *"vehicle", "space", "7", "enter")
        await drawn(app, pilot)
        assert "vehicle 7: not heard; there are: 1, 2" in screen_text(app)
        assert [each for each in station.sent if isinstance(each, ipc.Show)][-1] == ipc.Show(1)

    flown(script)
