"""A goal is compared with what the others fly: with their legs, not with where they are."""

from __future__ import annotations

from gcs import ipc
from gcs.frames import Vec3
from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from gcs.session import inputs
from tests.loopback.fleet import Fleet
from tests.loopback.flight import MISSIONS

APART_M = 60.0
"""Vehicle 2 starts so far east of vehicle 1; both fly 5 m up."""


class Crossing(Fleet):
    """Two PX4s in the air, and the first operator in control."""

    def __init__(self, policy: str = "") -> None:
        super().__init__(("px4", "px4"), policy=parse_policy(policy, "test"), apart_m=APART_M)
        self.all_flying()
        self.feed(inputs.OperatorLine(1, ipc.Ask(1000, "station_take")))
        self.last_id = 2000

    def send(self, sysid: int, goal_enu: Vec3) -> ipc.VerdictEvent:
        """A goal in the vehicle's own frame, from its start; its verdict."""
        self.last_id += 1
        ask = ipc.Ask(self.last_id, "goto", goal_enu=goal_enu, vehicle=sysid)
        self.feed(inputs.OperatorLine(1, ipc.Check(ask)))
        checked = self.of(ipc.Checked)[-1]
        self.feed(inputs.OperatorLine(1, ask))
        self.run(0.1)
        (verdict,) = self.verdicts(self.last_id)
        assert (checked.outcome, checked.code) == (verdict.outcome, verdict.code)
        return verdict


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
