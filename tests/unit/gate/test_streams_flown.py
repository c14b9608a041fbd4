"""A client's setpoint stream is verified sample by sample, and held in its place while refused.

The default fence is a circle of 150 m about home.  px4 is trusted to react in 0.7 s and to brake at
2 m/s2; a sample counts 0.5 s and a tick, a position in these scripts is at most 0.125 s old.  So at
10 m/s it takes (0.5 + 0.05 + 0.125 + 0.7 + 10 / 4) s * 10 m/s = 38.75 m to a stop, and 2.5 m of
margin and position error beside the fence: samples straight out are refused from 108.75 m on.
"""

from __future__ import annotations

import math

import pytest

from gcs.frames import Vec3, enu_from_ned, ned_from_enu
from gcs.gate.effects import (
    CommandKind,
    OutcomeKind,
    Say,
)
from gcs.gate.inputs import StreamSeen
from gcs.gate.refusal import Code
from gcs.gate.requests import BeginStream, EndStream
from gcs.gate.states import State
from tests.unit.gate.script import Script
from tests.unit.gate.situations import default_policy, state_of
from tests.unit.gate.stream_effects import sent, told

UP = 10.0
CLIENT = "keyboard"


def velocity(east: float, north: float, up: float, source: str = CLIENT) -> StreamSeen:
    return StreamSeen(source, None, ned_from_enu((east, north, up)), None, None, None)


def position(east: float, north: float, up: float, source: str = CLIENT) -> StreamSeen:
    return StreamSeen(source, ned_from_enu((east, north, up)), None, None, None, None)


def hovering(autopilot: str = "px4", **changes: object) -> Script:
    script = Script(default_policy(**changes), autopilot).take_control(UP)
    script.forget()
    return script


def streaming(v_enu: Vec3 = (1.0, 0.0, 0.0)) -> Script:
    """A stream of this velocity is flown, and its last sample has just come."""
    script = hovering()
    script.feed(velocity(*v_enu))
    script.tick()
    assert state_of(script) is State.STREAMING
    script.feed(velocity(*v_enu))
    script.forget()
    return script


def fly(script: Script, seconds: float, sample: StreamSeen | None) -> None:
    """The vehicle flies at once what is sent, and at most 5 m/s to a position."""
    for _ in range(round(seconds * 20)):
        if sample is not None:
            script.feed(sample)
        last = sent(script)[-1] if sent(script) else None
        if last is not None and last.v_ned is not None:
            script.v_ned = last.v_ned
        elif last is not None and last.pos_ned is not None:
            left = [b - a for a, b in zip(script.pos_ned, last.pos_ned, strict=True)]
            speed = min(5.0, math.hypot(*left)) / max(1e-9, math.hypot(*left))
            script.v_ned = (left[0] * speed, left[1] * speed, left[2] * speed)
        n, e, d = (x + v * 0.05 for x, v in zip(script.pos_ned, script.v_ned, strict=True))
        script.pos_ned = (n, e, d)
        script.tick()


# ------------------------------------------------------------------------------ begin and end


def test_its_end_is_asked_for_and_completes_both_requests() -> None:
    script = hovering()
    begun = script.ask(BeginStream())
    fly(script, 2.0, velocity(4.0, 0.0, 0.0))
    ended = script.ask(EndStream())
    assert script.outcome(begun).kind is OutcomeKind.COMPLETE
    assert script.outcome(ended).kind is OutcomeKind.COMPLETE
    assert state_of(script) is State.HOVERING
    east_m = script.pos_ned[1]
    # 4 m/s: 0.125 s old is the position, and 0.3 s it takes until the vehicle reacts
    assert script.gate.hold_goal_ned == pytest.approx((0.0, east_m + 4 * 0.425, -UP))


def test_a_stream_that_is_asked_for_stops_the_flight_to_a_goal() -> None:
    script = hovering(retarget="replace")
    goal = script.goto(20.0, 0.0, UP)
    script.tick()
    script.at(4.0, 0.0, UP, (2.0, 0.0, 0.0))
    script.ask(BeginStream())
    assert script.outcome(goal).kind is OutcomeKind.SUPERSEDED
    script.forget()
    script.tick()
    (permit,) = sent(script)
    assert permit.pos_ned is not None
    hold_ned = script.gate.hold_goal_ned
    assert hold_ned is not None
    assert enu_from_ned(hold_ned)[0] == pytest.approx(4.0 + 2.0 * 0.425)
    assert 4.0 <= enu_from_ned(permit.pos_ned)[0] <= 4.85


# ------------------------------------------------------------------------- verified samples


@pytest.mark.parametrize(("autopilot", "m"), [("px4", 35.675), ("ardupilot", 30.852)])
def test_a_velocity_straight_at_the_fence_is_flown_as_long_as_it_can_be_stopped(
    autopilot: str, m: float
) -> None:
    script = hovering(autopilot)
    fly(script, 20.0, velocity(10.0, 0.0, 0.0))
    assert told(script) == [None, Code.CANNOT_STOP]
    places = [enu_from_ned(p.pos_ned) for p in sent(script) if p.pos_ned is not None]
    last_m = max(east_m for east_m, _, _ in places)
    held_m = {"px4": 10 * 0.425, "ardupilot": 10 * 0.525}[autopilot]
    begins_m = 150.0 - 2.5 - m
    assert begins_m + held_m - 0.5 <= last_m <= begins_m + held_m + 0.5


def test_a_refused_stream_is_held_in_its_place_and_handed_back_when_it_leads_back() -> None:
    script = hovering()
    fly(script, 20.0, velocity(10.0, 0.0, 0.0))
    assert state_of(script) is State.STREAMING
    held_ned = script.gate.hold_goal_ned
    assert held_ned is not None
    script.forget()
    fly(script, 10.0, velocity(10.0, 0.0, 0.0))
    assert {permit.pos_ned for permit in sent(script)} == {held_ned}
    assert script.commands() == []
    script.forget()
    fly(script, 0.45, velocity(-5.0, 0.0, 0.0))
    assert {permit.pos_ned for permit in sent(script)} == {held_ned}  # not at the first good one
    fly(script, 2.0, velocity(-5.0, 0.0, 0.0))
    assert told(script) == [None]
    assert sent(script)[-1].v_ned == (0.0, -5.0, 0.0)
    assert state_of(script) is State.STREAMING


def test_good_and_bad_samples_by_turns_do_not_move_it() -> None:
    script = hovering()
    fly(script, 20.0, velocity(10.0, 0.0, 0.0))
    script.forget()
    for _ in range(40):
        fly(script, 0.2, velocity(-1.0, 0.0, 0.0))
        fly(script, 0.05, velocity(10.0, 0.0, 0.0))
    assert told(script) == []
    assert all(permit.v_ned is None for permit in sent(script))


def test_a_present_velocity_counts_as_much_as_the_one_asked_for() -> None:
    """At 139 m and 4 m/s outwards, (0.55 + 0.125 + 1.4 + 4 / 6.7) s * 4 m/s lead to 149.7 m: nobody
    knows how soon a vehicle stands still that is asked to.  3 m/s lead to 146.6 m."""
    script = hovering()
    script.at(139.0, 0.0, UP)
    script.feed(velocity(0.0, 0.0, 0.0))
    assert told(script) == [None]
    script.v_ned = ned_from_enu((4.0, 0.0, 0.0))
    script.position()
    script.feed(velocity(0.0, 0.0, 0.0))
    assert told(script) == [None, Code.CANNOT_STOP]
    script.v_ned = ned_from_enu((3.0, 0.0, 0.0))
    assert told(again(script, velocity(0.0, 0.0, 0.0))) == [None]


def again(script: Script, sample: StreamSeen) -> Script:
    """The vehicle says anew how it flies; the sample comes for as long as good ones have to."""
    script.forget()
    for _ in range(12):
        script.feed(sample)
        script.tick()
    return script


NAN = math.nan
SAMPLES = {
    "a velocity of 10.1 m/s": (velocity(10.1, 0.0, 0.0), Code.POLICY),
    "3.1 m/s up": (velocity(0.0, 0.0, 3.1), Code.POLICY),
    "2.1 m/s down": (velocity(0.0, 0.0, -2.1), Code.POLICY),
    "6 m/s2": (StreamSeen(CLIENT, None, None, (6.0, 0.0, 0.0), None, None), Code.POLICY),
    "100 degrees/s": (
        StreamSeen(CLIENT, None, (0.0, 0.0, 0.0), None, None, math.radians(100.0)),
        Code.POLICY,
    ),
    "a velocity that is no number": (velocity(NAN, 0.0, 0.0), Code.NON_FINITE),
    "a position that is no number": (position(NAN, 0.0, UP), Code.NON_FINITE),
    "an acceleration that is no number": (
        StreamSeen(CLIENT, None, None, (NAN, 0.0, 0.0), None, None),
        Code.NON_FINITE,
    ),
    "a yaw that is no number": (
        StreamSeen(CLIENT, (0.0, 0.0, -UP), None, None, NAN, None),
        Code.NON_FINITE,
    ),
    "a yaw rate that is no number": (
        StreamSeen(CLIENT, None, (0.0, 0.0, 0.0), None, None, NAN),
        Code.NON_FINITE,
    ),
    "nothing": (StreamSeen(CLIENT, None, None, None, 1.0, None), Code.UNSUPPORTED),
    "a position with an acceleration": (
        StreamSeen(CLIENT, (0.0, 0.0, -UP), None, (0.0, 0.0, 0.0), None, None),
        Code.UNSUPPORTED,
    ),
    "a position outside": (position(200.0, 0.0, UP), Code.OUTSIDE_FENCE),
    "a position in the margin": (position(149.0, 0.0, UP), Code.TOO_CLOSE),
    "a velocity down to the floor": (velocity(0.0, 0.0, -2.0), None),
}


@pytest.mark.parametrize("name", SAMPLES)
def test_a_sample_is_judged(name: str) -> None:
    sample, code = SAMPLES[name]
    script = hovering()
    script.feed(sample)
    script.tick()
    assert told(script) == [code]
    assert (state_of(script) is State.STREAMING) == (code is None)


@pytest.mark.parametrize("name", [name for name, (_, code) in SAMPLES.items() if code is not None])
def test_a_refused_sample_is_not_sent_and_told_once(name: str) -> None:
    script = streaming()
    for _ in range(10):
        script.feed(SAMPLES[name][0])
        script.tick()
    assert told(script) == [SAMPLES[name][1]]
    assert len(script.all(Say)) == 1
    assert [permit.v_ned for permit in sent(script)] == [None] * 10


def test_at_the_limits_of_the_policy_it_is_flown() -> None:
    script = hovering()
    script.feed(velocity(6.0, 8.0, 3.0))
    script.feed(StreamSeen(CLIENT, None, (0.0, 0.0, 2.0), (3.0, 4.0, 0.0), 1.0, 1.5))
    script.tick()
    assert told(script) == [None]
    (permit,) = sent(script)
    assert (permit.v_ned, permit.a_ned) == ((0.0, 0.0, 2.0), (3.0, 4.0, 0.0))
    assert (permit.yaw_rad, permit.yaw_rate_rad_s) == (1.0, 1.5)


def test_an_acceleration_counts_by_the_speed_that_it_leads_to() -> None:
    """From rest 5 m/s2 lead in 0.675 s and the reaction of 1.4 s to 10.375 m/s, and from there, as
    if it were flown all the time, 10.375 m/s * (2.075 s + 1.549 s) = 37.6 m on."""
    sample = StreamSeen(CLIENT, None, None, (0.0, 5.0, 0.0), None, None)
    for east_m, code in ((109.0, None), (111.0, Code.CANNOT_STOP)):
        script = hovering()
        script.at(east_m, 0.0, UP)
        script.forget()
        script.feed(sample)
        assert told(script) == [code]


def test_a_position_with_a_velocity_is_judged_by_both() -> None:
    """The vehicle may come to rest as far beyond the position as the velocity carries it."""
    for east_m, code in ((100.0, None), (115.0, Code.CANNOT_STOP)):
        script = hovering()
        goal, v_ned = ned_from_enu((east_m, 0.0, UP)), ned_from_enu((10.0, 0.0, 0.0))
        script.feed(StreamSeen(CLIENT, goal, v_ned, None, None, None))
        assert told(script) == [code]


def test_velocities_towards_the_ground_are_stopped_above_the_floor() -> None:
    script = hovering()
    fly(script, 10.0, velocity(0.0, 0.0, -2.0))
    assert told(script) == [None, Code.CANNOT_STOP]
    assert state_of(script) is State.STREAMING
    assert script.pos_ned[2] < -0.5


def test_positions_are_flown_as_they_come() -> None:
    script = hovering()
    for step in range(40):
        fly(script, 0.05, position(0.1 * step, 0.0, UP))
    assert told(script) == [None]
    last_ned = sent(script)[-1].pos_ned
    assert last_ned is not None
    assert script.pos_ned[1] <= last_ned[1] <= 3.9 + 1e-9
    fly(script, 1.5, position(3.9, 0.0, UP))
    assert sent(script)[-1].pos_ned == pytest.approx((0.0, 3.9, -UP))


# ------------------------------------------------------------------------------ dead-man's time


def test_a_sample_after_a_silence_waits_for_others() -> None:
    script = streaming()
    script.wait(1.0)
    script.forget()
    fly(script, 0.45, velocity(1.0, 0.0, 0.0))
    assert told(script) == []
    fly(script, 0.2, velocity(1.0, 0.0, 0.0))
    assert told(script) == [None]


def test_samples_with_gaps_are_not_good_again() -> None:
    script = streaming()
    script.wait(1.0)
    script.forget()
    for _ in range(6):
        script.feed(velocity(1.0, 0.0, 0.0))
        script.wait(0.55)
    assert told(script) == []


def test_a_stream_that_is_refused_is_not_over() -> None:
    script = hovering()
    begun = script.ask(BeginStream())
    fly(script, 10.0, velocity(11.0, 0.0, 0.0))
    assert not script.ended(begun)


# --------------------------------------------------------------------------------- positions


def test_without_a_fresh_position_no_sample_is_flown() -> None:
    """0.5 s is as old as a position may be for a sample; the stream goes on with the next one."""
    script = streaming()
    script.reports_position = False
    for _ in range(11):
        script.feed(velocity(1.0, 0.0, 0.0))
        script.tick()
    assert told(script) == [Code.STALE]
    assert state_of(script) is State.STREAMING
    script.reports_position = True
    script.forget()
    fly(script, 1.0, velocity(1.0, 0.0, 0.0))
    assert told(script) == [None]


def test_a_position_too_old_interrupts_it_and_the_hold_goes_on_for_the_grace() -> None:
    script = streaming()
    script.reports_position = False
    for _ in range(24):
        script.feed(velocity(1.0, 0.0, 0.0))
        script.tick()
    assert state_of(script) is State.STALE
    assert told(script) == [Code.STALE]
    assert sent(script)[-1].pos_ned is not None
    script.reports_position = True
    script.tick()
    assert state_of(script) is State.STREAMING
    script.forget()
    fly(script, 1.0, velocity(1.0, 0.0, 0.0))
    assert told(script) == [None]


def test_a_position_too_old_for_longer_than_the_grace_is_held() -> None:
    script = hovering()
    begun = script.ask(BeginStream())
    script.feed(velocity(1.0, 0.0, 0.0))
    script.reports_position = False
    for _ in range(40):
        script.feed(velocity(1.0, 0.0, 0.0))
        script.tick()
    assert script.commands()[0] is CommandKind.HOLD
    assert script.outcome(begun).code is Code.STALE
