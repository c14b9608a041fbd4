"""`gcs fly` with two vehicles: each is named, shown, and stopped alone or with the other."""

from __future__ import annotations

from pathlib import Path

import pytest

from gcs import ipc
from gcs.config import StationConfig
from gcs.gate.states import State
from gcs.record.writer import Recorder
from gcs.session import effects, inputs
from tests.audits import audited, read
from tests.loopback.copies import fly_or_copy
from tests.loopback.fleet import Fleet
from tests.loopback.observed import START_NS

FLEET = StationConfig(name="fleet", fleet=True)
OTHER = 2
"""An operator beside the first."""
APART_M = 60.0
"""Vehicle 2 starts so far east of vehicle 1."""


class TwoFlown(Fleet):
    """Two PX4s; what each operator was told is kept, its latest snapshot too."""

    def __init__(self, *, links: int = 1) -> None:
        self.told_to: dict[int, list[ipc.Event]] = {1: [], OTHER: []}
        self.shown: dict[int, ipc.Snapshot] = {}
        super().__init__(("px4", "px4"), config=FLEET, links=links, apart_m=APART_M)

    def _carry_out(self, effect: effects.Effect) -> list[inputs.Input]:
        if isinstance(effect, effects.Emit):
            for operator in [effect.operator] if effect.operator else [1, OTHER]:
                self.told_to[operator].append(effect.event)
                if isinstance(effect.event, ipc.Snapshot):
                    self.shown[operator] = effect.event
        return super()._carry_out(effect)

    def line(self, operator: int, command: ipc.Command) -> None:
        self.feed(inputs.OperatorLine(operator, command))

    def ask_for(
        self,
        word: str,
        vehicle: int = 0,
        *,
        operator: int = 1,
        goal_enu: ipc.Vec3 | None = None,
        up_m: float | None = None,
    ) -> int:
        """One request; its number."""
        self.last_id += 1
        ask = ipc.Ask(self.last_id, word, goal_enu=goal_enu, up_m=up_m, vehicle=vehicle)
        self.line(operator, ask)
        return self.last_id

    def both_up(self) -> TwoFlown:
        """Both hover 5 m above where they stood."""
        fly_or_copy(self, ("both up", self._made_of), self._take_off_both)
        return self

    def _take_off_both(self) -> None:
        self.all_connected()
        for sysid in self.vehicles:
            for word in ("arm", "takeoff"):
                assert self.done(self.ask_for(word, sysid, up_m=5.0)) == "complete", self.told()

    def refused(self, ask_id: int) -> str:
        self.run(0.1)
        (verdict,) = self.verdicts(ask_id)
        return verdict.code


@pytest.mark.parametrize("links", [1, 2])
def test_each_is_flown_by_its_number_and_none_without_one(links: int) -> None:
    flight = TwoFlown(links=links)
    flight.all_connected()
    for word in ("arm", "takeoff", "goto", "resume", "orbit", "mission_start", "param_get"):
        ask = flight.ask_for(word, up_m=2.0, goal_enu=(1.0, 0.0, 2.0))
        assert flight.refused(ask) == "SEVERAL_VEHICLES"
    assert "vehicle 1" in flight.verdicts(ask)[0].sentence
    assert flight.refused(flight.ask_for("arm", 7)) == "NO_VEHICLE"
    assert not any(vehicle.armed for vehicle in flight.vehicles.values())
    assert flight.done(flight.ask_for("arm", 2)) == "complete"
    assert flight.done(flight.ask_for("takeoff", 2, up_m=3.0)) == "complete"
    assert [vehicle.armed for vehicle in flight.vehicles.values()] == [False, True]
    assert flight.done(flight.ask_for("goto", 2, goal_enu=(4.0, 3.0, 3.0))) == "complete"
    east_m, north_m, _ = flight.place_enu(2)
    assert (east_m, north_m) == pytest.approx((4.0, 3.0), abs=1.0)


def test_a_stop_is_for_the_named_one_or_for_every_one() -> None:
    flight = TwoFlown().both_up()
    for vehicle, stopped in ((2, {2}), (ipc.EVERY, {1, 2})):
        for sysid, up_m in ((1, 5.0), (2, 15.0)):
            here = flight.place_enu(sysid)[0]
            goal_enu = (here + 40.0 * (-1) ** sysid, 0.0, up_m)
            flight.ask_for("goto", sysid, goal_enu=goal_enu)
        flight.run(1.0)
        assert [flight.state_of(sysid) for sysid in (1, 2)] == [State.MOVING, State.MOVING]
        assert flight.done(flight.ask_for("abort", vehicle)) == "complete"
        flight.run(3.0)
        held = {sysid for sysid in (1, 2) if flight.state_of(sysid) is State.HOLDING}
        assert held == stopped
        if vehicle == 2:
            assert flight.done(flight.ask_for("abort", 1)) == "complete"
        for sysid in (1, 2):
            flight.reaches(sysid, State.HOLDING)
            assert flight.done(flight.ask_for("resume", sysid)) == "complete"


def test_a_landing_of_all_ends_when_the_last_has_landed_and_is_answered_once() -> None:
    flight = TwoFlown().both_up()
    assert flight.done(flight.ask_for("goto", 2, goal_enu=(0.0, 0.0, 15.0))) == "complete"
    landing = flight.ask_for("land", ipc.EVERY)
    flight.reaches(1, State.GROUNDED, 60.0)
    assert flight.state_of(2) is State.LANDING
    assert flight.outcome(landing) is None
    assert flight.done(landing) == "complete"
    assert flight.state_of(2) is State.GROUNDED
    endings = [each for each in flight.of(ipc.EndingEvent) if each.id == landing]
    assert (len(flight.verdicts(landing)), len(endings)) == (1, 1)
    for sysid in (1, 2):
        assert f"vehicle {sysid}: Complete: land" in flight.told()


def test_a_landing_of_all_ends_as_the_one_that_is_not_complete() -> None:
    flight = TwoFlown().both_up()
    landing = flight.ask_for("land")
    assert flight.done(flight.ask_for("hold", 2)) == "complete"
    assert flight.outcome(landing) is None, "the other one still lands"
    assert flight.done(landing) == "aborted OPERATOR"
    (ended,) = [each for each in flight.of(ipc.EndingEvent) if each.id == landing]
    assert (ended.code, ended.sentence.split(":")[0]) == ("OPERATOR", "vehicle 2")
    assert flight.state_of(1) is State.GROUNDED


def test_a_vehicle_that_comes_later_leaves_the_first_one_meant() -> None:
    flight = TwoFlown()
    flight.silent.add(2)
    flight.until(lambda: flight.is_in(State.GROUNDED) and flight.vehicles[1].armable)
    flight.run(1.0)
    assert flight.done(flight.ask_for("arm")) == "complete"
    flight.silent.clear()
    flight.until(lambda: len(flight.session.vehicles) == 2)
    assert flight.done(flight.ask_for("takeoff", up_m=3.0)) == "complete"
    assert [vehicle.armed for vehicle in flight.vehicles.values()] == [True, False]


def test_each_operator_is_shown_the_vehicle_that_it_chose() -> None:
    flight = TwoFlown().both_up()
    flight.feed(inputs.OperatorJoined(OTHER, "a second screen"))
    flight.line(OTHER, ipc.Subscribe(["ATTITUDE"]))
    flight.line(OTHER, ipc.Show(2))
    told = flight.told_to[OTHER]
    history = next(each for each in reversed(told) if isinstance(each, ipc.History))
    assert history.trail, "where it flew before is told at once"
    assert [zone.name for zone in next(e for e in told if isinstance(e, ipc.Fences)).zones]
    del told[:]
    flight.ask_for("goto", 1, goal_enu=(0.0, 30.0, 5.0))
    flight.run(1.0)
    assert [flight.shown[one].sysid for one in (1, OTHER)] == [1, 2]
    assert [flight.shown[one].state for one in (1, OTHER)] == ["MOVING", "HOVERING"]
    assert not any(isinstance(event, ipc.StateEvent) for event in told)
    heard = {event.sysid for event in told if isinstance(event, ipc.MessageEvent)}
    assert heard == {2}
    (other,) = flight.shown[OTHER].others
    assert (other.vehicle, other.state, other.armed, other.on_ground) == (1, "MOVING", True, False)
    assert other.goal_enu is not None
    assert other.goal_enu == pytest.approx((-APART_M, 30.0, 5.0), abs=0.5), "in the frame of 2"
    assert refused_of(flight, OTHER, "goto", 2) == "OTHER_OPERATOR"
    assert flight.done(flight.ask_for("abort", 2, operator=OTHER)) == "complete"
    assert flight.state_of(1) is State.MOVING, "only the one that it named"
    flight.ask_for("station_take", operator=OTHER)
    assert flight.done(flight.ask_for("resume", 2, operator=OTHER)) == "complete"
    flight.line(OTHER, ipc.Show(7))
    assert (flight.shown[OTHER].sysid, flight.shown[OTHER].state) == (0, "NO_VEHICLE")
    assert [each.vehicle for each in flight.shown[OTHER].others] == [1, 2]


def refused_of(flight: TwoFlown, operator: int, word: str, vehicle: int) -> str:
    ask = flight.ask_for(word, vehicle, operator=operator, goal_enu=(0.0, 0.0, 6.0))
    return flight.refused(ask)


def test_when_the_operator_is_lost_both_are_held() -> None:
    flight = TwoFlown().both_up()
    flight.feed(inputs.OperatorGone(1, "its terminal closed"))
    for sysid in (1, 2):
        flight.reaches(sysid, State.HOLDING)


def test_the_record_of_both_is_audited(tmp_path: Path) -> None:
    recorder = Recorder.open(tmp_path, "fleet", "20260101-000000", START_NS, sealed=True)
    flight = TwoFlown()
    flight.recorder = recorder
    flight.both_up()
    flight.feed(inputs.OperatorJoined(OTHER, "a second screen"))
    flight.line(OTHER, ipc.Show(2))
    flight.line(1, ipc.Show(2))
    flight.line(1, ipc.Pending((1.0, 2.0, 3.0)))
    assert flight.refused(flight.ask_for("goto", 1, goal_enu=(APART_M, 0.0, 5.0))) == (
        "OTHER_VEHICLE"
    )
    flight.ask_for("goto", 1, goal_enu=(10.0, 0.0, 5.0))
    flight.run(2.0)
    flight.ask_for("abort", ipc.EVERY)
    flight.run(1.0)
    flight.feed(inputs.SignalCame("SIGTERM"))
    flight.run(4.0)
    assert recorder.close(flight.now_ns)
    result = audited(*read(recorder.path))
    assert (result.first, result.notes, result.good) == ([], [], True)
