"""Whole flights in good order: up, out, home, down, pictures, stops, and a vehicle taken over."""

from __future__ import annotations

import math

import pytest

from gcs.gate.refusal import Code
from gcs.gate.states import State
from gcs.session import inputs
from tests.loopback.flight import POLICIES, Flight, Personality
from tests.loopback.lossy_link import Weather
from vehicle_sim.autopilot.interface import Result

HOLDS = {"px4": "AUTO.LOITER", "ardupilot": "BRAKE"}


def test_out_and_home_by_return(personality: Personality) -> None:
    flight = Flight(personality).hovering(5.0)
    assert flight.done(flight.goto(15.0, -8.0, 6.0)) == "complete"
    ask = flight.say("rtl")
    flight.run(2.0)
    assert flight.is_in(State.RETURNING)
    assert flight.done(ask, 180.0) == "complete"
    assert flight.is_in(State.GROUNDED)
    assert math.hypot(*flight.truth_enu()[:2]) < 1.0
    flight.until(lambda: not flight.vehicle.armed)


def test_land_where_it_is(personality: Personality) -> None:
    flight = Flight(personality).hovering(3.0)
    assert flight.done(flight.goto(4.0, 4.0, 3.0)) == "complete"
    east_m, north_m, _ = flight.truth_enu()
    assert flight.done(flight.say("land")) == "complete"
    assert flight.is_in(State.GROUNDED)
    assert flight.truth_enu() == pytest.approx((east_m, north_m, 0.0), abs=0.6)
    landed_ns = flight.now_ns
    flight.until(lambda: not flight.vehicle.armed)
    assert flight.setpoints(landed_ns) == []


def test_hold_stops_and_resume_hovers_there_the_goal_is_gone(personality: Personality) -> None:
    flight = Flight(personality).hovering(3.0)
    goal = flight.goto(20.0, 0.0, 3.0)
    flight.run(2.0)
    assert flight.done(flight.say("hold")) == "complete"
    assert flight.outcome(goal) == "aborted OPERATOR"
    assert flight.vehicle.mode_name == HOLDS[personality]
    assert flight.done(flight.goto(0.0, 0.0, 3.0)) == "refused HOLDING"
    flight.run(2.0)
    at_enu = flight.truth_enu()
    resumed_ns = flight.now_ns
    assert flight.done(flight.say("resume")) == "complete"
    assert flight.is_in(State.HOVERING)
    flight.run(5.0)
    assert math.dist(flight.truth_enu(), at_enu) < 0.5
    assert (0.0, 20.0, -3.0) not in {s.pos_ned for s in flight.setpoints(resumed_ns)}


def test_two_pictures(personality: Personality) -> None:
    flight = Flight(personality).hovering(2.0)
    for _ in range(2):
        assert flight.done(flight.say("photo")) == "complete"
        flight.run(0.5)
    assert flight.vehicle.images_captured == 2


def test_a_vehicle_that_already_flies_is_external_until_control_is_taken(
    personality: Personality,
) -> None:
    flight = Flight(personality)
    flight.run(2.0)
    vehicle = flight.vehicle
    vehicle.set_mode_kind("guided" if personality == "ardupilot" else "hold")
    vehicle.arm(False)
    vehicle.take_off(6.0)
    flight.until(lambda: flight.truth_enu()[2] > 5.1)  # PX4 may end it NAV_MC_ALT_RAD = 0.8 m low
    vehicle.set_mode_kind("hold")
    flight.run(2.0)
    assert flight.is_in(State.EXTERNAL)
    assert flight.setpoints() == []
    assert flight.done(flight.goto(1.0, 1.0, 6.0)) == "refused NOT_IN_CONTROL"
    asked_ns = flight.now_ns
    assert flight.done(flight.say("control")) == "complete"
    assert flight.is_in(State.HOVERING)
    assert flight.vehicle.mode_name in ("OFFBOARD", "GUIDED")
    if personality == "px4":
        taken_ns = flight.setpoints(asked_ns)[0].time_ns
        [offboard_ns] = [s.time_ns for s in flight.sent_commands(176, asked_ns)][:1]
        assert offboard_ns - taken_ns >= 1_000_000_000
    assert flight.done(flight.goto(1.0, 1.0, 6.0)) == "complete"


def test_the_operator_is_lost_in_flight(personality: Personality) -> None:
    flight = Flight(personality).hovering(3.0)
    goal = flight.goto(20.0, 0.0, 3.0)
    flight.run(2.0)
    left_ns = flight.now_ns
    flight.feed(inputs.OperatorGone(1, "the command stream ended"))
    flight.run(3.5)
    assert flight.finish is not None
    assert flight.finish.exit_code == 0
    assert HOLDS[personality] in flight.finish.sentence
    assert flight.vehicle.mode_name == HOLDS[personality]
    assert flight.outcome(goal) == "aborted OPERATOR_LOST"
    assert flight.sent[-1].time_ns - left_ns < 3_000_000_000
    assert (0.0, 20.0, -3.0) not in {s.pos_ned for s in flight.setpoints(left_ns)}


def test_the_operator_is_lost_and_the_link_with_him() -> None:
    flight = Flight().hovering(3.0)
    flight.up.weather = Weather(loss=1.0)
    left_ns = flight.now_ns
    flight.feed(inputs.OperatorGone(1, "killed"))
    flight.run(4.0)
    assert flight.finish is not None
    assert "not seen to hold" in flight.finish.sentence
    holds = [s.time_ns for s in flight.sent_commands(176, left_ns)]
    assert len(holds) >= 3
    assert holds[0] == left_ns
    assert holds[-1] - left_ns <= 3_000_000_000


def test_leaving_a_vehicle_on_the_ground_is_at_once() -> None:
    flight = Flight().connected()
    flight.feed(inputs.OperatorGone(1, "quit"))
    assert flight.finish is not None
    assert flight.finish.sentence == "the vehicle is on the ground"
    assert flight.finish.exit_code == 0


def test_a_start_outside_the_fence_is_an_error() -> None:
    flight = Flight(policy=POLICIES["lab"])
    flight.until(lambda: flight.session.telemetry is not None)
    for _ in range(40):
        flight.report((9.0, 0.0, 0.0))
        flight.run(0.1)
    assert flight.finish is not None
    assert flight.finish.exit_code == 6
    assert "outside" in flight.finish.sentence


def test_no_vehicle_is_told_with_a_hint() -> None:
    flight = Flight()
    flight.vehicle_silent = True
    flight.run(11.0)
    [trouble] = flight.troubles()
    assert trouble.exit_code == 3
    assert "no vehicle" in trouble.text
    assert trouble.hint
    assert flight.done(flight.goto(0.0, 0.0, 1.0)) == f"refused {Code.NO_VEHICLE}"


def test_arming_a_px4_that_was_told_to_take_off_is_no_take_off() -> None:
    """PX4 takes NAV_TAKEOFF disarmed (D2_calibration_wrong_state, recorded) and climbs once it is
    armed; past the gate somebody has told it so."""
    flight = Flight("px4").connected()
    assert flight.vehicle.take_off(5.0) is Result.ACCEPTED
    flight.run(2.0)
    flight.do("arm")
    flight.run(5.0)
    stays = flight.state is State.GROUNDED
    assert stays
    assert flight.truth_enu()[2] < 0.1
    flight.do("takeoff", up_m=2.0)
    assert flight.state is State.HOVERING
