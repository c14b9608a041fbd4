"""A goal is compared with what the others fly: with their legs, not with where they are."""

from __future__ import annotations

import msgspec
import pytest

from gcs import ipc
from gcs.frames import Vec3
from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from gcs.session import inputs
from tests.loopback.fleet import Fleet
from tests.loopback.flight import MISSIONS, Personality
from vehicle_sim.cli import APART_M as APART_M_OF_FLEETS

APART_M = 60.0
"""Vehicle 2 starts so far east of vehicle 1; both fly 5 m up."""


class Crossing(Fleet):
    """Two PX4s in the air, and the first operator in control."""

    def __init__(self, policy: str = "") -> None:
        super().__init__(("px4", "px4"), policy=parse_policy(policy, "test"), apart_m=APART_M)
        self.all_flying()
        self.take()

    def take(self) -> None:
        self.feed(inputs.OperatorLine(1, ipc.Ask(1000, "station_take")))
        self.last_id = 2000

    def send(self, sysid: int, goal_enu: Vec3) -> ipc.VerdictEvent:
        """A goal in the vehicle's own frame, from its start; its verdict."""
        return self.judged(ipc.Ask(0, "goto", goal_enu=goal_enu, vehicle=sysid))

    def judged(self, ask: ipc.Ask) -> ipc.VerdictEvent:
        """What is asked for, judged as it was when it was only checked."""
        self.last_id += 1
        ask = msgspec.structs.replace(ask, id=self.last_id)
        self.feed(inputs.OperatorLine(1, ipc.Check(ask)))
        checked = self.of(ipc.Checked)[-1]
        self.feed(inputs.OperatorLine(1, ask))
        self.until(lambda: bool(self.verdicts(self.last_id)))
        (verdict,) = self.verdicts(self.last_id)
        assert (checked.outcome, checked.code) == (verdict.outcome, verdict.code)
        return verdict


BESIDE_M = 4.6
"""Nearer than `[separation] least_m`."""


class Beside(Crossing):
    """Two that stand beside each other, the first of them 5 m up when it is asked for."""

    def __init__(self, personality: Personality) -> None:
        Fleet.__init__(self, (personality, personality), apart_m=BESIDE_M)
        self.all_connected()
        self.take()

    def asks(self, sysid: int, word: str, up_m: float | None = None) -> ipc.VerdictEvent:
        return self.judged(ipc.Ask(0, word, up_m=up_m, vehicle=sysid))

    def arms(self, sysid: int) -> None:
        assert self.asks(sysid, "arm").outcome == "accepted"
        assert self.done(self.last_id) == "complete"

    def climbs(self, sysid: int) -> None:
        self.arms(sysid)
        assert self.asks(sysid, "takeoff", 5.0).outcome == "accepted", self.told()
        assert self.done(self.last_id) == "complete", self.told()


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_one_that_stands_beside_another_climbs_beside_it(personality: Personality) -> None:
    """Its place is as near to where the other hovers as they stood: that is no way that crosses."""
    flight = Beside(personality)
    flight.climbs(1)
    flight.climbs(2)


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_a_fleet_that_hovers_where_it_started_is_not_too_close(personality: Personality) -> None:
    """As `vehicle-sim --count` places it: what the estimates wander by is no warning."""
    flight = Fleet((personality, personality, personality), apart_m=APART_M_OF_FLEETS)
    flight.all_flying()
    flight.run(30.0)
    assert not [each.text for each in flight.of(ipc.LogEvent) if "too_close" in each.text]


def test_a_climb_into_where_another_one_flies_is_refused() -> None:
    flight = Beside("px4")
    flight.climbs(1)
    assert flight.send(1, (0.0, 0.0, 12.0)).outcome == "accepted"
    flight.reaches(1, State.HOVERING, 60.0)
    assert flight.send(1, (BESIDE_M, 0.0, 12.0)).outcome == "accepted", "the other one stands"
    flight.reaches(1, State.HOVERING, 60.0)
    flight.arms(2)
    refused = flight.asks(2, "takeoff", 10.0)
    assert (refused.code, refused.numbers["other_vehicle"]) == ("OTHER_VEHICLE", 1.0)
    assert refused.sentence.startswith("the climb comes as near as ")
    least_m = refused.numbers["least_m"]
    assert least_m is not None
    assert least_m < 2.5
    assert flight.asks(2, "takeoff", 5.0).outcome == "accepted", "7 m below it"


def test_of_two_goals_whose_legs_cross_the_second_is_refused() -> None:
    """Vehicle 1 flies north-east, vehicle 2 would fly north-west; now they are 60 m apart."""
    flight = Crossing()
    assert flight.send(1, (60.0, 60.0, 5.0)).outcome == "accepted"
    refused = flight.send(2, (-60.0, 60.0, 5.0))
    assert (refused.outcome, refused.code) == ("refused", "OTHER_VEHICLE")
    assert refused.numbers["other_vehicle"] == 1.0
    assert refused.numbers["least_m"] == 0.0
    assert "where vehicle 1 flies (5 m are to be kept)" in refused.sentence
    assert flight.state_of(2) is State.HOVERING
    assert flight.send(2, (-60.0, 60.0, 15.0)).outcome == "refused", "it climbs across"
    assert flight.send(2, (0.0, 0.0, 25.0)).outcome == "accepted", "straight up"
    flight.reaches(1, State.HOVERING, 60.0)
    flight.reaches(2, State.HOVERING, 60.0)
    assert flight.send(2, (-55.0, 0.0, 25.0)).outcome == "accepted", "20 m above where it was"


def test_the_circle_that_another_one_flies_is_in_the_way() -> None:
    """Vehicle 2 flies round its start, 12 m from it and 60 m east of vehicle 1."""
    flight = Crossing()
    circle = ipc.Circle((0.0, 0.0, 5.0), radius_m=12.0, speed_m_s=1.0, turns=0.0)
    flight.feed(inputs.OperatorLine(1, ipc.Ask(1001, "orbit", orbit=circle, vehicle=2)))
    flight.reaches(2, State.STREAMING)
    flight.run(1.0)
    refused = flight.send(1, (APART_M, 0.0, 5.0))
    assert refused.code == "OTHER_VEHICLE", "its middle, across the circle"
    assert flight.send(1, (APART_M - 16.0, 0.0, 5.0)).code == "OTHER_VEHICLE", "4 m beside it"
    assert flight.send(1, (APART_M - 19.0, 0.0, 5.0)).outcome == "accepted", "7 m beside it"


def test_all_of_the_mission_that_another_one_flies_is_in_the_way() -> None:
    """Its waypoints are at most 4 m from the start of vehicle 2, 2 to 3 m up."""
    flight = Crossing()
    for number, word in ((1001, "mission_upload"), (1002, "mission_start")):
        path = str(MISSIONS / "demo.toml") if word == "mission_upload" else ""
        flight.feed(inputs.OperatorLine(1, ipc.Ask(number, word, path=path, vehicle=2)))
        if path:
            assert flight.done(number) == "complete", flight.told()
    flight.reaches(2, State.FLYING_MISSION)
    assert flight.send(1, (APART_M + 4.0, 8.0, 3.0)).code == "OTHER_VEHICLE"
    assert flight.send(1, (APART_M - 10.0, 8.0, 3.0)).outcome == "accepted"


def test_an_orbit_that_is_asked_for_is_compared_whole() -> None:
    """Vehicle 2 would fly round a place between both, past the one that hovers."""
    flight = Crossing()
    for number, radius_m, outcome in ((1001, 27.0, "refused"), (1002, 22.0, "accepted")):
        circle = ipc.Circle((-30.0, 0.0, 5.0), radius_m=radius_m, speed_m_s=1.0, turns=0.0)
        flight.feed(inputs.OperatorLine(1, ipc.Ask(number, "orbit", orbit=circle, vehicle=2)))
        flight.run(0.5)
        verdict = flight.verdicts(number)[0]
        assert verdict.outcome == outcome, verdict
        assert (flight.state_of(2) is State.STREAMING) == (outcome == "accepted")
    assert flight.verdicts(1001)[0].sentence.startswith("the orbit comes as near as ")


def test_a_mission_that_is_asked_for_is_compared_whole() -> None:
    """It is verified from where the vehicle is, so that counts as it would be flown."""
    flight = Crossing()
    path = str(MISSIONS / "demo.toml")
    ask = ipc.Ask(1001, "mission_upload", path=path, vehicle=2)
    flight.feed(inputs.OperatorLine(1, ask))
    assert flight.done(1001) == "complete", flight.told()
    assert flight.send(1, (APART_M + 4.0, 8.0, 3.0)).outcome == "accepted"
    flight.feed(inputs.OperatorLine(1, ipc.Ask(1002, "mission_start", vehicle=2)))
    flight.until(lambda: bool(flight.verdicts(1002)))
    (refused,) = flight.verdicts(1002)
    assert (refused.code, flight.state_of(2)) == ("OTHER_VEHICLE", State.HOVERING)
    assert refused.sentence.startswith("the mission comes as near as ")
    flight.reaches(1, State.HOVERING, 60.0)
    assert flight.send(1, (APART_M - 40.0, 30.0, 3.0)).outcome == "accepted"
    flight.reaches(1, State.HOVERING, 60.0)
    flight.feed(inputs.OperatorLine(1, ipc.Ask(1003, "mission_start", vehicle=2)))
    flight.reaches(2, State.FLYING_MISSION)


def test_two_goals_of_one_moment_are_compared_too() -> None:
    flight = Crossing()
    for number, (sysid, east_m) in enumerate(((1, 30.0), (2, -30.0))):
        ask = ipc.Ask(3000 + number, "goto", goal_enu=(east_m, 0.0, 5.0), vehicle=sysid)
        flight.feed(inputs.OperatorLine(1, ask))
    flight.run(0.1)
    outcomes = [flight.verdicts(3000 + number)[0].outcome for number in (0, 1)]
    assert outcomes == ["accepted", "refused"]


def test_a_place_where_another_hovers_is_refused() -> None:
    flight = Crossing()
    assert flight.send(1, (57.0, 0.0, 5.0)).code == "OTHER_VEHICLE"
    assert flight.send(1, (54.0, 0.0, 13.0)).outcome == "accepted"


def test_one_that_has_passed_is_in_the_way_no_more() -> None:
    flight = Crossing()
    assert flight.send(1, (60.0, 60.0, 5.0)).outcome == "accepted"
    flight.reaches(1, State.HOVERING, 60.0)
    assert flight.send(2, (-60.0, 60.0, 5.0)).outcome == "accepted"


def test_who_is_too_close_already_may_fly_away_and_no_nearer() -> None:
    flight = Crossing("separation.least_m = 100.0")
    assert flight.send(2, (-10.0, 0.0, 5.0)).code == "OTHER_VEHICLE"
    assert flight.send(2, (20.0, 0.0, 5.0)).outcome == "accepted"


def test_the_policy_may_compare_nothing() -> None:
    flight = Crossing("separation.least_m = 0.0")
    assert flight.send(1, (30.0, 0.0, 5.0)).outcome == "accepted"
    assert flight.send(2, (-30.0, 0.0, 5.0)).outcome == "accepted"
