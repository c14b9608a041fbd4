"""The lab's checkpoints about requests: L1, L2, L3, L5, L10, L11, L16."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from gcs import ipc
from gcs.gate.states import State
from gcs.report import DecisionItem, FsaItem
from gcs.session import inputs
from tests.loopback import pymavlink_decoder
from tests.loopback.flight import POLICIES, Flight, Personality, lab_policy

both_policies = pytest.mark.parametrize("policy", POLICIES)
TICK_NS = 50_000_000


def in_the_cage(personality: Personality = "px4") -> Flight:
    return Flight(personality, policy=lab_policy()).hovering(1.0)


def test_L01_hovering_streams_setpoints_at_20_hz_with_down_as_minus_up(
    personality: Personality,
) -> None:
    flight = in_the_cage(personality)
    flight.run(1.0)
    since_ns = flight.now_ns
    flight.run(5.0)
    stream = flight.setpoints(since_ns + 1)
    times_ns = [setpoint.time_ns for setpoint in stream]
    assert flight.is_in(State.HOVERING)
    assert len(stream) == 100
    assert {b - a for a, b in pairwise(times_ns)} == {TICK_NS}
    hold_ned = flight.session.gate.hold_goal_ned
    assert {setpoint.pos_ned for setpoint in stream} == {hold_ned}
    assert {setpoint.type_mask for setpoint in stream} == {pymavlink_decoder.POSITION_ONLY}
    assert {setpoint.frame for setpoint in stream} == {pymavlink_decoder.LOCAL_NED}
    # PX4 hovers up to NAV_MC_ALT_RAD, 0.8 m, below the height of its take-off.
    low_m = {"px4": 0.8, "ardupilot": 0.3}[personality]
    assert stream[0].pos_ned[2] == pytest.approx(-1.0, abs=low_m)


def test_L02_movement_keys_send_nothing_and_log_one_line_a_change() -> None:
    quiet, typing = in_the_cage(), in_the_cage()
    pending = [(1.0, 0.0, 0.5), (1.0, 1.0, 0.5), (1.0, 1.0, -0.0)]
    typing.run(0.1)
    quiet.run(0.1)
    since_ns = typing.now_ns
    for goal_enu in pending:
        typing.feed(inputs.OperatorLine(1, ipc.Pending(goal_enu)))
        typing.run(0.3)
        quiet.run(0.3)
    assert typing.lines("keyboard_manager", since_ns) == [
        "Keyboard: (1.00, 0.00, 0.50)",
        "Keyboard: (1.00, 1.00, 0.50)",
        "Keyboard: (1.00, 1.00, 0.00)",
    ]
    assert typing.sent == quiet.sent
    assert typing.recorded(DecisionItem, since_ns) == []


def test_L03_enter_is_one_request_then_verifying_then_moving(personality: Personality) -> None:
    flight = in_the_cage(personality)
    since_ns = flight.now_ns
    ask = flight.goto(1.0, 0.0, 0.5)
    flight.run(0.06)
    assert flight.states(since_ns) == ["VERIFYING", "MOVING"]
    log = [line for t in ("keyboard_manager", "state_and_safety") for line in flight.lines(t)]
    assert log.count("Sending Position") == 1
    story = [
        item.outcome if isinstance(item, DecisionItem) else item.state
        for t, item in flight.records
        if t > since_ns
        and isinstance(item, DecisionItem | FsaItem)
        and not (isinstance(item, FsaItem) and item.event == "reminder")
    ]
    assert story == ["VERIFYING", "accepted", "MOVING"]
    requested = flight.lines("state_and_safety", since_ns)
    assert [line for line in requested if line.startswith("Requested Position")] != []
    assert len(flight.verdicts(ask)) == 1
    assert flight.setpoints()[-1].pos_ned == (0.0, 1.0, -0.5)


@both_policies
def test_L05_a_second_request_while_moving_is_busy_and_never_flown(
    personality: Personality, policy: str
) -> None:
    flight = Flight(personality, policy=POLICIES[policy]).hovering(1.0)
    first = flight.goto(4.0, 0.0, 1.0)
    flight.run(0.5)
    assert flight.is_in(State.MOVING)
    second = flight.goto(0.0, 3.0, 1.0)
    since_ns = flight.now_ns
    [refused] = flight.verdicts(second)
    assert (refused.outcome, refused.code) == ("refused", "BUSY")
    assert "(4.00 E, 0.00 N, 1.00 U)" in refused.sentence
    assert flight.done(first) == "complete"
    flight.run(5.0)
    flown = {setpoint.pos_ned for setpoint in flight.setpoints(since_ns)}
    assert (0.0, 4.0, -1.0) in flown
    assert all(abs(north) < 0.5 and 0.0 < east < 4.5 for north, east, _ in flown)
    # By what the vehicle knows: its GPS wanders, by chance more than half a metre.
    north_m, east_m, _ = flight.vehicle.estimate.pos_ned
    assert (east_m, north_m) == pytest.approx((4.0, 0.0), abs=0.5)


def test_L10_of_two_requests_in_one_tick_the_second_wins() -> None:
    flight = in_the_cage()
    first = flight.goto(1.0, 0.0, 1.0)
    second = flight.goto(0.0, 1.0, 1.0)
    assert flight.outcome(first) == "superseded SUPERSEDED"
    assert flight.verdicts(second) == []
    flight.run(0.06)
    assert flight.is_in(State.MOVING)
    assert flight.setpoints()[-1].pos_ned == (1.0, 0.0, -1.0)
    assert flight.done(second) == "complete"
    assert len(flight.verdicts(first)) == len(flight.verdicts(second)) == 1
    assert (0.0, 1.0, -1.0) not in {setpoint.pos_ned for setpoint in flight.setpoints()}


NONSENSE = [
    (math.nan, 0.0, 1.0),
    (0.0, math.inf, 1.0),
    (0.0, 0.0, -math.inf),
    (1e39, 0.0, 1.0),
    (0.0, -1e308, 1.0),
]


@pytest.mark.parametrize(("policy", "fence_on"), [("lab", True), ("lab", False), ("default", True)])
def test_L11_what_is_no_number_is_refused_and_never_sent(
    personality: Personality, policy: str, fence_on: bool
) -> None:
    flight = Flight(personality, policy=POLICIES[policy]).hovering(1.0)
    if not fence_on:
        assert flight.done(flight.say("fence", on=False)) == "complete"
    for goal_enu in NONSENSE:
        ask = flight.goto(*goal_enu)
        flight.run(0.2)
        assert flight.outcome(ask) == "refused NON_FINITE", goal_enu
        assert flight.is_in(State.HOVERING)
    stream = flight.setpoints()
    assert stream
    assert all(setpoint.finite for setpoint in stream)
    assert flight.done(flight.goto(1.0, 1.0, 1.0)) == "complete"


@both_policies
def test_L16_a_move_is_refused_while_a_picture_is_taken(
    personality: Personality, policy: str
) -> None:
    flight = Flight(personality, policy=POLICIES[policy]).hovering(1.0)
    photo = flight.say("photo")
    flight.run(0.5)
    assert flight.is_in(State.TAKING_PICTURE)
    move = flight.goto(1.0, 0.0, 1.0)
    assert flight.outcome(move) == "refused BUSY"
    assert flight.done(photo) == "complete"
    assert flight.vehicle.images_captured == 1
    assert flight.is_in(State.HOVERING)
    flight.run(1.0)
    assert (0.0, 1.0, -1.0) not in {setpoint.pos_ned for setpoint in flight.setpoints()}
    assert flight.done(flight.goto(1.0, 0.0, 1.0)) == "complete"
