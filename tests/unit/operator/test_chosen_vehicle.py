"""A program of an operator that flies one vehicle of several."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from gcs import ipc
from gcs.operator.chosen_vehicle import ChosenVehicle
from gcs.operator.client import Polled, Readable, StationEvent
from tests.unit.operator.fake_station import FakeConnection, FakeStation

FIRST = msgspec.structs.replace(FakeStation().snapshot(), vehicle="1/1 px4 quadrotor")
SECOND = msgspec.structs.replace(FIRST, vehicle="2/1 ardupilot quadrotor")
NOT_MET = msgspec.structs.replace(FIRST, vehicle="")
ASKS: tuple[ipc.Command, ...] = (
    ipc.Ask(1, "land"),
    ipc.Stream(v_enu=(1.0, 0.0, 0.0)),
    ipc.Preflight(2),
    ipc.Leave("quit"),
    ipc.Ask(3, "abort", vehicle=ipc.EVERY),
    ipc.Ask(4, "land", vehicle=3),
)


class Told(FakeConnection):
    """Says what the test puts into it, and nothing else."""

    def __init__(self) -> None:
        super().__init__()
        self.next: list[StationEvent] = []

    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> Polled:
        events, self.next = self.next, []
        return Polled(events)


def test_what_is_asked_is_asked_of_the_chosen_one_unless_it_names_its_own() -> None:
    told = Told()
    chosen = ChosenVehicle(told)
    for command in ASKS:
        chosen.send(command)
    assert told.sent == [*ASKS], "none is chosen: the station knows what that means"
    chosen.choose(2)
    chosen.send(ipc.Check(ipc.Ask(5, "arm")))
    for command in ASKS:
        chosen.send(command)
    show, check, *asked = told.sent[len(ASKS) :]
    assert show == ipc.Show(2)
    assert check == ipc.Check(ipc.Ask(5, "arm", vehicle=2))
    assert [getattr(each, "vehicle", None) for each in asked] == [2, 2, 2, None, ipc.EVERY, 3]


def test_snapshots_of_the_one_before_that_were_under_way_are_passed_over() -> None:
    told = Told()
    chosen = ChosenVehicle(told)
    told.next = [FIRST]
    assert chosen.poll(0.0).events == [FIRST]
    chosen.choose(2)
    told.next = [FIRST, NOT_MET, SECOND]
    assert chosen.poll(0.0).events == [NOT_MET, SECOND]
