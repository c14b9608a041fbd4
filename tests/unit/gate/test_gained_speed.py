"""Who takes a vehicle off its leg is judged by the speed that it may have gained there."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.frames import Vec3
from gcs.gate.airspace.gained_speed import gained_velocity, speed_to_stop_within
from gcs.gate.airspace.stopping import Leg, Stops, stops_of, travel_m
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code
from gcs.gate.requests import BeginStream, GoTo, Hold, Request, Resume
from gcs.gate.states import State
from tests.unit.gate.reactions import default_policy
from tests.unit.gate.script import Script
from tests.unit.gate.stream_effects import told
from tests.unit.gate.test_streams_flown import UP, velocity

PX4, ARDUPILOT = stops_of(DEFAULT, "px4"), stops_of(DEFAULT, "ardupilot")
FAR = Leg((0.0, 0.0, -10.0), (100.0, 0.0, -10.0))
"""Northwards."""


@given(st.floats(0.0, 500.0), st.floats(0.0, 3.0), st.floats(0.5, 10.0))
def test_it_stops_just_within_the_distance(
    distance_m: float, react_s: float, a_brake_m_s2: float
) -> None:
    speed_m_s = speed_to_stop_within(distance_m, react_s, a_brake_m_s2)
    assert travel_m(speed_m_s, react_s, a_brake_m_s2) == pytest.approx(distance_m, abs=1e-6)


@pytest.mark.parametrize(
    ("stops", "tilt_deg", "react_s"), [(PX4, 45.0, 0.7), (ARDUPILOT, 30.0, 1.2)]
)
def test_it_gains_as_much_as_it_may_lean(stops: Stops, tilt_deg: float, react_s: float) -> None:
    """MPC_TILTMAX_AIR and ATC_ANGLE_MAX of the recorded parameters."""
    most_m_s2 = 9.81 * math.tan(math.radians(tilt_deg))
    gained = gained_velocity((0.0, 0.0, -10.0), (1.0, 0.0, 0.5), FAR, stops)
    assert gained is not None
    assert gained == pytest.approx((1.0 + most_m_s2 * react_s, 0.0, 0.5), abs=0.01)


def test_it_gains_no_more_than_it_can_stop_from_at_its_goal() -> None:
    """It flies 2 m north, and most_h_m or share_h of that past its goal."""
    near = Leg((0.0, 0.0, -10.0), (2.0, 0.0, -10.0))
    gained = gained_velocity((0.0, 0.0, -10.0), (0.0, 0.0, 0.0), near, PX4)
    assert gained is not None
    past_m = min(PX4.overshoot.share_h * 2.0, PX4.overshoot.most_h_m)
    way_m = travel_m(gained[0], PX4.approach.react_s, PX4.approach.a_brake_h_m_s2)
    assert way_m == pytest.approx(2.0 + past_m)


def test_it_gains_nothing_near_its_goal() -> None:
    assert gained_velocity((99.5, 0.0, -10.0), (6.0, 0.0, 0.0), FAR, PX4) is None
    assert gained_velocity(FAR.goal_ned, (0.0, 0.0, 0.0), FAR, PX4) is not None
    here = Leg(FAR.goal_ned, FAR.goal_ned)
    assert gained_velocity(FAR.goal_ned, (0.0, 0.0, 0.0), here, PX4) is None


def flying(speed_m_s: float, north_m: float) -> Script:
    """North to a goal at 143 m, reported with this speed since then; the fence ends at 150 m."""
    script = Script(default_policy(retarget="replace"), "px4").take_control(UP)
    script.goto(0.0, north_m, UP)
    script.tick()
    script.at(0.0, north_m, UP)
    script.tick(60)
    assert state(script) is State.HOVERING
    script.forget()
    script.goto(0.0, 143.0, UP)
    script.tick()
    assert state(script) is State.MOVING
    reported(script, speed_m_s)
    return script


def reported(script: Script, speed_m_s: float) -> None:
    """At the next tick."""
    script.v_ned = (speed_m_s, 0.0, 0.0)
    script.tick()


def state(script: Script) -> State:
    return script.gate.state


INSTEAD = [BeginStream(), GoTo((100.0, 0.0, -UP))]


@pytest.mark.parametrize("instead", INSTEAD)
def test_just_after_it_was_sent_there_its_reports_do_not_show_its_speed_yet(
    instead: Request,
) -> None:
    """At rest by its report, and 7 m/s may be gained before a hold acts: 17 m to a stop."""
    script = flying(0.0, 134.0)
    request_id = script.ask(instead)
    script.tick()
    assert script.refusal(request_id) is Code.CANNOT_STOP
    refusal = script.verdict(request_id).refusal
    assert refusal is not None
    assert refusal.sentence.startswith("it gains speed on its way: at 6.9 m/s")


@pytest.mark.parametrize("instead", INSTEAD)
def test_once_its_reports_rise_no_more_they_are_what_counts(instead: Request) -> None:
    script = flying(1.0, 134.0)
    for _ in range(15):  # 0.75 s, and react_s is 0.7
        reported(script, 1.1)
    request_id = script.ask(instead)
    script.tick()
    assert not script.ended(request_id)
    assert state(script) in (State.STREAMING, State.MOVING)


def test_while_its_reports_rise_it_may_gain_more() -> None:
    script = flying(1.0, 128.0)
    for number in range(20):
        reported(script, 1.0 + 0.1 * number)
    assert script.refusal(script.ask(BeginStream())) is Code.CANNOT_STOP


def test_what_it_may_have_gained_counts_for_the_samples_after_that_too() -> None:
    """Room enough for the hold that begins a stream, and not for half a second of it."""
    script = flying(0.0, 128.0)
    script.ask(BeginStream())
    assert state(script) is State.STREAMING
    script.forget()
    script.feed(velocity(0.0, 0.0, 0.0))
    assert told(script) == [Code.CANNOT_STOP]
    for _ in range(30):  # refused for good_again_s, too
        script.tick()
        script.feed(velocity(0.0, 0.0, 0.0))
    assert told(script) == [Code.CANNOT_STOP, None]


def test_after_a_hold_it_is_resumed_at_once_and_what_it_gained_counts_for_what_follows() -> None:
    """Resumed, it is held where it is, which is no worse than the hold."""
    script = flying(0.0, 134.0)
    script.ask(Hold())
    assert state(script) is State.HOLDING
    resumed = script.ask(Resume())
    assert not script.ended(resumed)
    assert script.gate.memory.gained_ned == pytest.approx((6.87, 0.0, 0.0), abs=0.01)


def test_the_same_goal_again_is_no_other_leg() -> None:
    script = flying(0.0, 134.0)
    request_id = script.ask(GoTo((143.0, 0.0, -UP)))
    script.tick()
    assert not script.ended(request_id)
    v_ned: Vec3 = script.v_ned
    assert v_ned == (0.0, 0.0, 0.0)
