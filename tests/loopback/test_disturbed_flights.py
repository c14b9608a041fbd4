"""Whole flights that something happens to, and what the gate makes of it."""

from __future__ import annotations

import math
import random

import pytest

from gcs.gate.airspace.stopping import travel_m
from gcs.gate.condition import Condition
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.states import Control, State
from gcs.session import inputs
from tests.loopback import pymavlink_decoder
from tests.loopback.flight import PEER, POLICIES, Flight, Personality
from tests.loopback.lossy_link import Weather
from vehicle_sim.simulation.world import Datagram

HOLDS = {"px4": "AUTO.LOITER", "ardupilot": "BRAKE"}


def test_somebody_else_changes_the_mode(personality: Personality) -> None:
    flight = Flight(personality).hovering(3.0)
    goal = flight.goto(20.0, 0.0, 3.0)
    flight.run(1.0)
    flight.flown_by_hand()
    flight.run(2.0)
    assert flight.is_in(State.EXTERNAL)
    assert flight.session.gate.control is Control.NONE
    assert flight.outcome(goal) == "taken over MODE_CHANGED"
    since_ns = flight.now_ns
    flight.run(3.0)
    assert flight.setpoints(since_ns) == []
    assert flight.done(flight.say("control")) == "complete"
    assert flight.is_in(State.HOVERING)


@pytest.mark.parametrize(("kind", "state"), [("return", State.RETURNING), ("land", State.LANDING)])
def test_somebody_else_sends_it_home_or_down(
    personality: Personality, kind: str, state: State
) -> None:
    flight = Flight(personality).hovering(6.0)
    flight.vehicle.set_mode_kind(kind)
    flight.run(1.5)
    assert flight.is_in(state)
    since_ns = flight.now_ns
    flight.run(2.0)
    assert flight.setpoints(since_ns) == []


def test_a_vehicle_that_goes_silent_and_comes_back(personality: Personality) -> None:
    flight = Flight(personality).hovering(3.0)
    goal = flight.goto(20.0, 0.0, 3.0)
    flight.run(1.0)
    flight.vehicle_silent = True
    flight.run(6.0)
    assert flight.is_in(State.NO_VEHICLE)
    assert (flight.outcome(goal) or "").startswith("aborted")
    since_ns = flight.now_ns
    flight.run(2.0)
    assert flight.setpoints(since_ns) == []
    flight.vehicle_silent = False
    flight.run(3.0)
    assert flight.state in (State.EXTERNAL, State.HOLDING)
    assert [line for line in flight.lines("link") if "is back" in line]
    assert flight.done(flight.say("resume")) == "complete"
    assert flight.is_in(State.HOVERING)
    assert flight.done(flight.goto(5.0, 0.0, 3.0)) == "complete"


def test_garbage_and_oversize_datagrams_change_nothing_at_either_end(
    personality: Personality,
) -> None:
    flight = Flight(personality).hovering(2.0)
    dice = random.Random(4)
    goal = flight.goto(10.0, 0.0, 2.0)
    for size in (0, 1, 8, 17, 280, 1500, 65_507, 70_000):
        for lead in (b"", b"\xfd", b"\xfe", b"Init ArduCopter\n"):
            noise = lead + dice.randbytes(size)
            flight.feed(inputs.Datagram(0, noise))
            flight.world.handle(Datagram(0, PEER, noise), flight.now_ns)
            flight.world.handle(Datagram(0, "a stranger", noise), flight.now_ns)
            flight.run(0.01)
    assert flight.done(goal) == "complete"
    assert flight.garbage()


def test_a_blocked_way_home_holds_and_landing_still_works(personality: Personality) -> None:
    """The vehicle's return height is far above the lab's cage."""
    flight = Flight(personality, policy=POLICIES["lab"]).hovering(1.0)
    assert flight.done(flight.goto(3.0, 0.0, 1.0)) == "complete"
    asked_ns = flight.now_ns
    ask = flight.say("rtl")
    assert flight.outcome(ask) == "refused RTL_BLOCKED"
    [verdict] = flight.verdicts(ask)
    assert verdict.zone == "cage"
    assert verdict.numbers
    flight.run(2.0)
    assert flight.is_in(State.HOLDING)
    assert flight.vehicle.mode_name == HOLDS[personality]
    assert not flight.sent_commands(20, asked_ns)
    assert flight.truth_enu()[2] < 2.0
    assert flight.done(flight.say("land")) == "complete"
    assert flight.is_in(State.GROUNDED)


def test_a_predicted_breach_is_braked_in_the_same_tick(personality: Personality) -> None:
    flight = Flight(personality, policy=POLICIES["lab"]).hovering(1.0)
    assert flight.done(flight.goto(3.0, 0.0, 1.0)) == "complete"
    flight.run(4.0)
    goal = flight.goto(-3.0, 0.0, 1.0)
    flight.run(0.06)
    pushed_ns = flight.now_ns
    flight.push((4.5, 0.0, 0.0))
    flight.until(lambda: flight.is_in(State.HOLDING), 0.2)
    assert flight.now_ns - pushed_ns <= 100_000_000
    brake = flight.setpoints(flight.now_ns)[-1]
    assert 3.0 < brake.pos_ned[1] <= 5.0
    assert flight.outcome(goal) == "aborted FENCE_BREACH"
    order = flight.sent_types(flight.now_ns)
    assert "SET_POSITION_TARGET_LOCAL_NED" in order
    if "COMMAND_LONG" in order:  # one that setpoints stop sooner is told its hold mode when slow
        assert order.index("SET_POSITION_TARGET_LOCAL_NED") < order.index("COMMAND_LONG")
    flight.run(4.0)
    assert flight.is_in(State.HOLDING)
    assert flight.vehicle.mode_name == HOLDS[personality]
    # The lab trusts a hold with less; this is what one takes, as recorded.
    taken = DEFAULT.braking_of(personality)
    taken_m = travel_m(4.5, taken.react_s, taken.a_brake_h_m_s2) + taken.position_error_h_m
    assert flight.truth_enu()[0] < 3.0 + taken_m


def test_a_position_that_jumps_is_held_and_verified_anew(personality: Personality) -> None:
    flight = Flight(personality).hovering(3.0)
    goal = flight.goto(20.0, 0.0, 3.0)
    flight.run(1.0)
    at_enu = flight.truth_enu()
    flight.report((at_enu[0] + 40.0, at_enu[1], at_enu[2]))
    assert flight.outcome(goal) == "aborted ESTIMATOR_RESET"
    assert flight.is_in(State.HOLDING)
    jumped_ns = flight.now_ns
    flight.run(0.3)
    flight.positions_lost = False
    flight.run(2.0)
    assert flight.vehicle.mode_name == HOLDS[personality]
    assert (0.0, 20.0, -3.0) not in {s.pos_ned for s in flight.setpoints(jumped_ns)}
    assert flight.done(flight.say("resume")) == "complete"
    # A PX4 at 5 m/s, 1 s after its start, is stopped in 7.9 to 8.8 m (recorded).
    assert math.dist(flight.truth_enu(), at_enu) < 9.0


def test_a_second_station_with_our_id_is_told() -> None:
    flight = Flight().hovering(2.0)
    ours = next(sent.data for sent in flight.sent)
    flight.feed(inputs.Datagram(0, ours))
    assert Condition.OTHER_STATION in flight.conditions
    assert flight.is_in(State.HOVERING)


def test_a_recorder_that_fails_is_a_condition_and_no_more() -> None:
    flight = Flight().hovering(2.0)
    flight.feed(inputs.RecorderChanged(False, "", "no space left on device"))
    assert Condition.RECORDER_FAILED in flight.conditions
    assert flight.done(flight.goto(3.0, 0.0, 2.0)) == "complete"
    flight.feed(inputs.RecorderChanged(True, "part2.mcap", "recording again"))
    assert Condition.RECORDER_FAILED not in flight.conditions


def test_a_bad_link_brings_a_flight_home_all_the_same(personality: Personality) -> None:
    rough = Weather(loss=0.1, duplicate=0.1, corrupt=0.03, delay_s=(0.005, 0.12))
    flight = Flight(personality, seed=5, up=rough, down=rough).hovering(3.0)
    for goal_enu in ((6.0, 0.0, 3.0), (0.0, 6.0, 4.0)):
        assert flight.done(flight.goto(*goal_enu)) == "complete"
    assert flight.done(flight.say("land"), 120.0) == "complete"
    assert flight.is_in(State.GROUNDED)


def test_what_was_asked_of_the_vehicle_in_vain_is_asked_again(personality: Personality) -> None:
    """Not one request of the first seconds arrives: no stream, no origin, no parameter."""
    flight = Flight(personality, up=Weather(loss=1.0))
    flight.run(9.0)
    flight.up.weather = Weather()
    flight.until(lambda: flight.home_ned is not None)
    flight.until(lambda: flight.session.gate.memory.return_up_m is not None)
    flight.hovering(2.0)
    assert flight.done(flight.goto(2.0, 0.0, 2.0)) == "complete"


def test_after_an_abort_no_further_try_of_an_arm_leaves(personality: Personality) -> None:
    flight = Flight(personality).connected()
    if personality == "ardupilot":  # which arms in GUIDED only, and is asked for that first
        flight.vehicle.set_mode_kind("guided")
        flight.run(1.5)
    flight.up.weather = Weather(loss=1.0)
    arm = flight.say("arm")
    flight.run(0.7)
    assert len(flight.sent_commands(400)) == 2
    aborted_ns = flight.now_ns
    flight.say("abort")
    assert flight.outcome(arm) == "aborted OPERATOR"
    flight.run(5.0)
    tries = [pymavlink_decoder.read(sent.data) for sent in flight.sent_commands(400, aborted_ns)]
    assert tries
    assert {m.param1 for m in tries} == {0.0}
    flight.up.weather = Weather()
    flight.run(3.0)
    assert not flight.vehicle.armed


def test_after_a_hold_no_further_try_of_a_return_leaves(personality: Personality) -> None:
    flight = Flight(personality).hovering(3.0)
    flight.up.weather = Weather(loss=1.0)
    going_home = flight.say("rtl")
    flight.run(0.2)
    held_ns = flight.now_ns
    flight.say("hold")
    assert flight.outcome(going_home) == "aborted OPERATOR"
    flight.run(4.0)
    assert flight.sent_commands(20, held_ns) == []
    assert len(flight.sent_commands(176, held_ns)) >= 4


def test_a_hold_that_nobody_answers_is_repeated_until_it_is_seen(personality: Personality) -> None:
    flight = Flight(personality).hovering(3.0)
    flight.goto(100.0, 0.0, 3.0)
    flight.run(2.0)
    flight.up.weather = Weather(loss=1.0)
    held = flight.say("hold")
    flight.run(8.0)
    assert flight.outcome(held) == "timed out NO_ANSWER"
    back_ns = flight.now_ns
    flight.up.weather = Weather()
    flight.run(3.0)
    assert flight.sent_commands(176, back_ns)
    assert flight.vehicle.mode_name == HOLDS[personality]


def test_after_a_blackout_of_the_link_no_stream_is_said_to_have_stopped(
    personality: Personality,
) -> None:
    flight = Flight(personality)
    flight.connected()
    for seconds in (2.2, 3.0, 4.1):
        clear, flight.down.weather = flight.down.weather, Weather(loss=1.0)
        flight.run(seconds)
        flight.down.weather = clear
        flight.run(3.0)
    assert "sends no positions" not in str(flight.told())
