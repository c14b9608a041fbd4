"""The lab's checkpoint L15: abort in each state holds, and nothing revives the goal."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from gcs.gate.states import State
from tests.loopback.flight import MISSIONS, POLICIES, Flight, Personality

GOAL_ENU = (4.0, 1.0, 1.5)
HOLDS = {"px4": "AUTO.LOITER", "ardupilot": "BRAKE"}
LOW_RETURN = {"px4": {"RTL_RETURN_ALT": 1.5}, "ardupilot": {"RTL_ALT": 150.0}}


def taking_off(flight: Flight) -> None:
    flight.connected().do("arm")
    flight.say("takeoff", up_m=1.5)
    flight.until(lambda: flight.truth_enu()[2] > 0.6)


def hovering(flight: Flight) -> None:
    flight.hovering(1.0)


def verifying(flight: Flight) -> None:
    """The goal waits for its tick, and VERIFYING begins and ends in that tick."""
    flight.hovering(1.0).goto(*GOAL_ENU)


def moving(flight: Flight) -> None:
    flight.hovering(1.0).goto(*GOAL_ENU)
    flight.run(0.8)


def taking_picture(flight: Flight) -> None:
    flight.hovering(1.0).say("photo")
    flight.run(0.5)


def flying_mission(flight: Flight) -> None:
    flight.hovering(1.0)
    flight.do("mission_upload", path=str(MISSIONS / "lab3" / "square.toml"))
    flight.say("mission_start")
    flight.until(lambda: flight.vehicle.mode_name in ("AUTO.MISSION", "AUTO"))
    flight.run(1.5)


def returning(flight: Flight) -> None:
    flight.hovering(1.0)
    assert flight.done(flight.goto(3.0, 0.0, 1.0)) == "complete"
    flight.say("rtl")
    flight.until(lambda: flight.vehicle.mode_name in ("AUTO.RTL", "RTL"))
    flight.run(0.5)


def landing(flight: Flight) -> None:
    flight.hovering(1.5).say("land")
    flight.run(0.6)


def holding(flight: Flight) -> None:
    flight.hovering(1.0).do("hold")


def external(flight: Flight) -> None:
    flight.hovering(1.0)
    flight.flown_by_hand()
    flight.run(2.0)


def stale(flight: Flight) -> None:
    moving(flight)
    flight.positions_lost = True
    flight.run(1.2)


IN_THE_AIR: dict[State, Callable[[Flight], None]] = {
    State.TAKING_OFF: taking_off,
    State.HOVERING: hovering,
    State.MOVING: moving,
    State.TAKING_PICTURE: taking_picture,
    State.FLYING_MISSION: flying_mission,
    State.RETURNING: returning,
    State.LANDING: landing,
    State.HOLDING: holding,
    State.EXTERNAL: external,
    State.STALE: stale,
}

both_policies = pytest.mark.parametrize("policy", POLICIES)


@both_policies
@pytest.mark.parametrize("state", IN_THE_AIR)
def test_L15_abort_in_the_air_holds_and_nothing_revives_the_goal(
    state: State, personality: Personality, policy: str
) -> None:
    flight = Flight(personality, policy=POLICIES[policy], params=LOW_RETURN[personality])
    IN_THE_AIR[state](flight)
    assert flight.is_in(state)
    aborted_ns, aborted_enu = flight.now_ns, flight.truth_enu()
    assert flight.done(flight.say("abort")) == "complete"
    assert flight.vehicle.mode_name == HOLDS[personality]
    flight.positions_lost = False
    flight.run(6.0)  # a real ArduCopter takes 4.2 s to rest from 2 m/s in BRAKE (tests/real/facts)
    assert flight.is_in(State.HOLDING)
    rest_enu = flight.truth_enu()
    assert rest_enu[2] > 0.2
    flight.run(2.0)
    assert math.dist(flight.truth_enu(), rest_enu) < 0.3  # hovering, both wander by 0.2 m in 2 s
    flown = {setpoint.pos_ned for setpoint in flight.setpoints(aborted_ns + 1)}
    assert (GOAL_ENU[1], GOAL_ENU[0], -GOAL_ENU[2]) not in flown
    assert all(math.dist(pos_ned, _ned(aborted_enu)) < 2.5 for pos_ned in flown)


@both_policies
@pytest.mark.parametrize(
    ("begin", "ended"),
    [(verifying, "superseded SUPERSEDED"), (moving, "aborted OPERATOR")],
    ids=["VERIFYING", "MOVING"],
)
def test_L15_an_arrival_after_the_abort_completes_nothing(
    begin: Callable[[Flight], None], ended: str, personality: Personality, policy: str
) -> None:
    flight = Flight(personality, policy=POLICIES[policy])
    begin(flight)
    goto = flight.last_id
    assert flight.done(flight.say("abort")) == "complete"
    assert flight.outcome(goto) == ended
    since_ns = flight.now_ns
    flight.positions_lost = True
    for _ in range(40):
        flight.run(0.05)
        flight.report(GOAL_ENU)
    assert flight.outcome(goto) == ended
    assert len(flight.verdicts(goto)) == 1
    assert flight.states(since_ns) in ([], ["HOLDING"])
    assert "Complete" not in " ".join(flight.lines("state_and_safety", since_ns + 1))


@both_policies
def test_L15_abort_on_the_ground_disarms(personality: Personality, policy: str) -> None:
    flight = Flight(personality, policy=POLICIES[policy]).connected()
    flight.do("arm")
    assert flight.done(flight.say("abort")) == "complete"
    assert not flight.vehicle.armed
    assert flight.is_in(State.GROUNDED)


def test_L15_abort_without_a_vehicle_is_refused() -> None:
    flight = Flight()
    flight.vehicle_silent = True
    flight.run(1.0)
    assert flight.is_in(State.NO_VEHICLE)
    assert flight.done(flight.say("abort")) == "refused NO_VEHICLE"


@both_policies
def test_L15_abort_to_a_vehicle_that_went_silent_is_sent_all_the_same(
    personality: Personality, policy: str
) -> None:
    flight = Flight(personality, policy=POLICIES[policy])
    moving(flight)
    flight.vehicle_silent = True
    flight.run(4.0)
    assert flight.is_in(State.NO_VEHICLE)
    flight.vehicle.set_mode_kind("guided")
    flight.say("abort")
    flight.run(1.0)
    assert flight.vehicle.mode_name == HOLDS[personality]


def _ned(enu: tuple[float, float, float]) -> tuple[float, float, float]:
    return (enu[1], enu[0], -enu[2])
