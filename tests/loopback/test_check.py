"""What a request is answered with when it is only checked is what it gets when it is made."""

from __future__ import annotations

import pytest

from gcs import ipc
from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from gcs.session import inputs
from tests.loopback.flight import Flight, Personality

GOALS = {
    "inside": (3.0, 0.0, 3.0),
    "outside": (500.0, 0.0, 3.0),
    "below the floor": (3.0, 0.0, -4.0),
    "no number": (None, 0.0, 3.0),
}
ASKS = {
    **{f"goto {name}": ipc.Ask(7, "goto", goal_enu=goal) for name, goal in GOALS.items()},
    **{word: ipc.Ask(7, word) for word in ("arm", "land", "rtl", "hold", "resume", "photo")},
    "takeoff 3": ipc.Ask(7, "takeoff", up_m=3.0),
    "takeoff 300": ipc.Ask(7, "takeoff", up_m=300.0),
    "no such word": ipc.Ask(7, "jump"),
}


def grounded(personality: Personality) -> Flight:
    return Flight(personality).connected()


def armed(personality: Personality) -> Flight:
    flight = grounded(personality)
    flight.do("arm")
    return flight


def hovering(personality: Personality) -> Flight:
    return Flight(personality).hovering(3.0)


def moving(personality: Personality) -> Flight:
    flight = hovering(personality)
    flight.goto(9.0, 0.0, 3.0)
    flight.until(lambda: flight.is_in(State.MOVING), 1.0)
    return flight


def holding(personality: Personality) -> Flight:
    flight = hovering(personality)
    flight.do("hold")
    return flight


def check(flight: Flight, ask: ipc.Ask) -> ipc.Checked:
    before = len(flight.events)
    flight.feed(inputs.OperatorLine(1, ipc.Check(ask)))
    (told,) = flight.events[before:]
    assert isinstance(told, ipc.Checked)
    return told


def verdict(flight: Flight, ask: ipc.Ask) -> ipc.VerdictEvent:
    before = len(flight.events)
    flight.feed(inputs.OperatorLine(1, ask))
    flight.run(0.1)
    told = [each for each in flight.events[before:] if isinstance(each, ipc.VerdictEvent)]
    (mine,) = [each for each in told if each.id == ask.id]
    return mine


@pytest.mark.parametrize("situation", [grounded, armed, hovering, moving, holding])
@pytest.mark.parametrize("name", ASKS)
def test_a_check_tells_the_verdict(situation: object, name: str, personality: Personality) -> None:
    flight = situation(personality)  # type: ignore[operator]
    told = check(flight, ASKS[name])
    got = verdict(flight, ASKS[name])
    assert (told.outcome, told.code, told.zone) == (got.outcome, got.code, got.zone)
    assert told.sentence == got.sentence or got.outcome == "accepted"


def test_nothing_follows_from_a_check(personality: Personality) -> None:
    flight = hovering(personality)
    sent, records = len(flight.sent), len(flight.records)
    memory = flight.session.gate.memory
    for ask in ASKS.values():
        check(flight, ask)
    assert flight.session.gate.memory == memory
    assert len(flight.sent) == sent
    told = [type(item).__name__ for _, item in flight.records[records:]]
    assert set(told) == {"InputItem"}, "that it was asked, and nothing that it led to"
    flight.run(1.0)
    assert flight.is_in(State.HOVERING)


def test_a_goal_is_judged_before_the_vehicle_can_fly_to_it(personality: Personality) -> None:
    flight = grounded(personality)
    inside, outside = (check(flight, ASKS[f"goto {name}"]) for name in ("inside", "outside"))
    assert (inside.outcome, inside.code, inside.goal_code) == ("refused", "NOT_FLYING", "")
    assert (outside.code, outside.goal_code) == ("NOT_FLYING", "OUTSIDE_FENCE")
    flight = moving(personality)
    outside = check(flight, ASKS["goto outside"])
    assert (outside.code, outside.goal_code) == ("BUSY", "OUTSIDE_FENCE")


def test_a_goal_at_the_end_of_the_climb_waits(personality: Personality) -> None:
    flight = Flight(personality, policy=parse_policy('retarget = "replace"', "replace.toml"))
    flight.connected().do("arm")
    flight.say("takeoff", up_m=10.0)
    flight.until(lambda: flight.truth_enu()[2] > 5.0, 20.0)
    goal = ASKS["goto inside"]
    assert check(flight, goal).code == "BUSY"
    flight.until(lambda: check(flight, goal).outcome != "refused", 20.0)
    assert (flight.state, check(flight, goal).outcome) == (State.TAKING_OFF, "waits")


def test_what_the_gate_does_not_decide_alone_is_not_checked(personality: Personality) -> None:
    flight = hovering(personality)
    for word in ("mission_start", "orbit", "station_end"):
        told = check(flight, ipc.Ask(3, word))
        assert (told.outcome, told.code) == ("refused", "BAD_REQUEST")
