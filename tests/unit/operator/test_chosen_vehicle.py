"""A program of an operator that flies one vehicle of several."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from gcs import ipc
from gcs.operator.chosen_vehicle import ChosenVehicle
from gcs.operator.client import Polled, Readable, StationEvent
from tests.unit.operator.fake_station import FakeConnection, FakeStation

FIRST = msgspec.structs.replace(FakeStation().snapshot(), vehicle="1/1 px4 quadrotor")
SECOND = ipc.BridgeVehicle(
    2, "2/1 ardupilot quadrotor", "MOVING", "OURS", "CAUTION", ["too_close"], "GUIDED", True,
    pos_enu=(1.0, 2.0, 3.0), v_enu=(0.5, 0.0, 0.0), battery_pct=71.0,
)  # fmt: skip


class Told(FakeConnection):
    """Says what the test puts into it, and nothing else."""

    def __init__(self) -> None:
        super().__init__()
        self.next: list[StationEvent] = []

    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> Polled:
        events, self.next = self.next, []
        return Polled(events)


def seen(chosen: ChosenVehicle, told: Told, *events: StationEvent) -> ipc.Snapshot:
    told.next = [*events, FIRST]
    found = chosen.poll(0.0).events[-1]
    assert isinstance(found, ipc.Snapshot)
    return found


def test_what_is_asked_is_asked_of_the_chosen_one() -> None:
    told = Told()
    chosen = ChosenVehicle(told, 2)
    for command in (ipc.Ask(1, "land"), ipc.Stream(v_enu=(1.0, 0.0, 0.0)), ipc.Leave("quit")):
        chosen.send(command)
    assert [getattr(each, "vehicle", None) for each in told.sent] == [2, 2, None]


def test_its_snapshots_are_of_the_chosen_one() -> None:
    told = Told()
    chosen = ChosenVehicle(told, 2)
    before = seen(chosen, told)
    assert (before.vehicle, before.state) == ("", "NO_VEHICLE")
    shown = seen(chosen, told, ipc.BridgeStatus(0, [], [], [SECOND]))
    assert (shown.vehicle, shown.state) == ("2/1 ardupilot quadrotor", "MOVING")
    assert (shown.pos_enu, shown.battery_pct) == ((1.0, 2.0, 3.0), 71.0)
    assert (shown.log_path, shown.in_control) == (FIRST.log_path, FIRST.in_control)
    assert shown.home_enu is None, "that is not told of it"
    gone = seen(chosen, told, ipc.BridgeStatus(1, [], [], []))
    assert gone.vehicle == ""


def test_of_the_first_one_all_is_known() -> None:
    told = Told()
    assert seen(ChosenVehicle(told, 1), told) == FIRST
