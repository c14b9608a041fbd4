"""A stream of attitudes in the gate's machine: flown, held while refused, and handed back.

The fence is a circle of 150 m about home, the vehicle hovers 25 m up.
"""

from __future__ import annotations

import math

import pytest
from msgspec import structs

from gcs.frames import Vec3
from gcs.gate.attitude import Attitude, HoverThrust, ThrustMeaning, UnknownThrust, attitude_of
from gcs.gate.effects import Ruling, Say
from gcs.gate.inputs import StreamSeen
from gcs.gate.refusal import Code
from gcs.gate.requests import BeginStream
from gcs.gate.states import State
from tests.unit.gate.script import Script
from tests.unit.gate.situations import default_policy, state_of
from tests.unit.gate.stream_effects import sent, told

UP = 25.0
CLIENT = "keyboard"
RULES = structs.replace(
    default_policy().stream, tilt_deg=10.0, attitude_error_m_s2=1.0, deadman_s=0.2
)


def tilted(pitch_deg: float = -5.0, means: ThrustMeaning | None = None) -> Attitude:
    """Nose down: to the north."""
    means = means or HoverThrust(0.5)
    return Attitude(attitude_of(0.0, math.radians(pitch_deg), 0.0), 0.5, means)


def sample(
    attitude: Attitude | None = None, source: str = CLIENT, yaw_rate: float | None = None
) -> StreamSeen:
    return StreamSeen(source, None, None, None, None, yaw_rate, attitude or tilted())


def moving(v_ned: Vec3) -> StreamSeen:
    return StreamSeen(CLIENT, None, v_ned, None, None, None)


def hovering(**changes: object) -> Script:
    anywhere = {"stream": RULES, "jump_speed_m_s": 1e5, **changes}
    script = Script(default_policy(**anywhere), "px4").take_control(UP)
    script.forget()
    return script


def goes_on(script: Script, seconds: float, given: StreamSeen | None) -> None:
    for _ in range(round(seconds * 20)):
        if given is not None:
            script.feed(given)
        script.tick()


def test_it_is_flown_tick_by_tick_as_it_came() -> None:
    script = hovering()
    given = sample(yaw_rate=0.5)
    script.feed(given)
    assert script.states() == [State.STREAMING]
    goes_on(script, 0.2, given)
    assert len(sent(script)) == 4
    for permit in sent(script):
        assert (permit.attitude, permit.yaw_rate_rad_s) == (given.attitude, 0.5)
        assert (permit.pos_ned, permit.v_ned, permit.a_ned, permit.yaw_rad) == (None,) * 4
    assert told(script) == [None]


def test_a_silent_one_is_held_for() -> None:
    script = hovering()
    goes_on(script, 0.2, sample())
    goes_on(script, 0.6, None)
    last = sent(script)[-1]
    assert last.attitude is None
    assert last.pos_ned is not None
    assert told(script) == [None, Code.DEADLINE]


def test_it_is_held_in_its_place_at_the_fence_and_handed_back() -> None:
    """At 142 m 8.7 m ahead and 2.5 m are too much; to the south there is."""
    script = hovering()
    goes_on(script, 0.2, sample())
    script.pos_ned = (142.0, 0.0, -UP)
    goes_on(script, 1.0, sample())
    assert told(script) == [None, Code.CANNOT_STOP]
    assert state_of(script) is State.STREAMING
    held = sent(script)[-1]
    assert held.pos_ned == pytest.approx((142.0, 0.0, -UP))
    assert held.attitude is None
    goes_on(script, 0.4, sample(tilted(pitch_deg=5.0)))
    assert sent(script)[-1].attitude is None  # not good for long enough yet
    goes_on(script, 0.4, sample(tilted(pitch_deg=5.0)))
    assert sent(script)[-1].attitude == tilted(pitch_deg=5.0)
    assert told(script) == [None, Code.CANNOT_STOP, None]


def test_a_thrust_that_means_nothing_known_is_refused_with_the_reason() -> None:
    script = hovering()
    script.feed(sample(tilted(means=UnknownThrust("the vehicle has not told its X yet"))))
    script.tick()
    assert told(script) == [Code.UNSUPPORTED]
    assert any("has not told its X yet" in said.text for said in script.all(Say))
    assert [permit.attitude for permit in sent(script)] == [None]


def test_numbers_that_are_none_are_refused() -> None:
    for bad in (
        Attitude((math.nan, 0.0, 0.0, 0.0), 0.5, HoverThrust(0.5)),
        Attitude((1.0, 0.0, 0.0, 0.0), math.inf, HoverThrust(0.5)),
        Attitude((1.0, 0.0, 0.0, 0.0), 0.5, HoverThrust(math.nan)),
    ):
        script = hovering()
        script.feed(sample(bad))
        assert told(script) == [Code.NON_FINITE]


def test_none_is_flown_by_the_default_policy() -> None:
    script = hovering(stream=default_policy().stream)
    script.feed(sample())
    assert told(script) == [Code.POLICY]
    assert state_of(script) is State.HOVERING


@pytest.mark.parametrize(
    ("v_ned", "refused"),
    [
        ((9.9, 0.0, 0.0), False),
        ((0.0, -10.1, 0.0), True),
        ((8.0, 8.0, 0.0), True),
        ((0.0, 0.0, -2.9), False),
        ((0.0, 0.0, -3.1), True),
        ((0.0, 0.0, 1.9), False),
        ((0.0, 0.0, 2.1), True),
    ],
)
def test_it_makes_the_vehicle_no_faster_than_the_policy_has_it(v_ned: Vec3, refused: bool) -> None:
    """10 m/s, 3 m/s up, 2 m/s down: an attitude asks for no speed, and may lead to any."""
    wide = structs.replace(RULES, hover_thrust_error=0.0, attitude_error_m_s2=0.0)
    script = hovering(stream=wide)
    script.v_ned = v_ned
    script.position()
    script.feed(sample(tilted(pitch_deg=0.0)))
    assert told(script) == [Code.POLICY if refused else None]


# ------------------------------------------------------------ what the vehicle did before it


def nearest_begin_m(before: StreamSeen | None) -> float:
    """How near to the fence's north a level attitude is flown right after `before`."""
    for north_m in range(148, 100, -1):
        script = hovering()
        if before is not None:
            goes_on(script, 0.3, before)
        script.pos_ned = (float(north_m), 0.0, -UP)
        script.forget()
        script.feed(sample(tilted(pitch_deg=0.0)))
        script.tick()
        flown = [permit.attitude for permit in sent(script)]
        if flown[-1] == tilted(pitch_deg=0.0):
            return 150.0 - north_m
    raise AssertionError("nowhere")


def test_it_needs_more_room_after_a_lean_and_most_after_a_velocity() -> None:
    """Level: 1 m/s2 of wind, north and east, for 0.2 + 0.05 + 0.125 + 1.4 s lead to 1.775 m/s each,
    and for as long and 2.51 / 6.7 s to 3.82 m; and the margin with the position's error, 2.5 m.
    After 10 degrees to the north (2.1 m/s2 more for 0.425 s) 6.01 m; after standing at a velocity,
    when it may lean by 45 degrees, any way, 16.2 m, and as far east, where the circle is 0.9 m
    nearer.  To whole metres."""
    after_hover, after_lean = nearest_begin_m(None), nearest_begin_m(sample(tilted(-10.0)))
    after_velocity = nearest_begin_m(moving((0.0, 0.0, 0.0)))
    assert (after_hover, after_lean, after_velocity) == (7.0, 9.0, 20.0)


def test_a_lean_of_long_ago_counts_no_more() -> None:
    script = hovering()
    goes_on(script, 0.3, sample(tilted(-10.0)))
    goes_on(script, 2.0, sample(tilted(0.0)))
    script.pos_ned = (143.0, 0.0, -UP)
    script.forget()
    goes_on(script, 0.1, sample(tilted(0.0)))
    assert sent(script)[-1].attitude == tilted(0.0)


def test_a_velocity_after_a_lean_needs_room_for_the_lean() -> None:
    """At rest, asked to stand still, 4 m from the fence: fine by itself, not while it leans."""
    for leant, flown in ((False, True), (True, False)):
        script = hovering()
        goes_on(script, 0.3, sample(tilted(-10.0)) if leant else moving((0.0, 0.0, 0.0)))
        script.pos_ned = (146.0, 0.0, -UP)
        script.forget()
        script.feed(moving((0.0, 0.0, 0.0)))
        script.tick()
        assert (sent(script)[-1].v_ned is not None) == flown


def test_a_goal_that_was_flown_to_counts_as_a_lean() -> None:
    """A stream takes the place of a goal, where the policy has it so; asked for first or not."""
    for asked in (False, True):
        script = hovering(retarget="replace")
        script.goto(0.0, 143.0, UP)
        script.tick()
        assert state_of(script) is State.MOVING
        script.pos_ned = (140.0, 0.0, -UP)
        script.tick(20)  # it gains no more speed
        assert state_of(script) is State.MOVING
        if asked:
            begun = script.ask(BeginStream())
            assert script.verdict(begun).ruling is Ruling.ACCEPTED
        script.forget()
        script.feed(sample(tilted(0.0)))
        assert told(script) == [Code.CANNOT_STOP]
