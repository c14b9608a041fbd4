"""Sticks of a client: what velocity they ask for, and when they fly the vehicle.

Signs and ranges are those of both autopilots (MANUAL_CONTROL: x forward, y right, z 0 to 1000 with
500 the middle, r clockwise); the channels' are `RCMAP_*`, `RC1_MIN` to `RC4_MAX` and `RC2_REVERSED`
of arducopter_4_7_params.json: 1000, 1500, 2000 us, 1 to 4 for roll, pitch, throttle and yaw.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import structs
from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.translate.meaning import Reject, Sample, Seen, Settled, Sticks, Words
from gcs.bridge.translate.settling import StickStream
from gcs.bridge.translate.translate import meaning_of
from gcs.gate.airspace.stream_samples import StreamSample, beyond_rules
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import State
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.wire.messages import Message
from tests.unit.bridge.vehicles import (
    copter_mode,
    flying,
    px4_mode,
    refusal,
    sent,
    standing,
    words,
)

BOTH = pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT], ids=lambda a: a.name)
MISSING = 0x7FFF
SECOND_NS = 1_000_000_000
PERIOD_NS = 40_000_000
"""QGroundControl sends 25 a second by default (from memory)."""
RULES = structs.replace(
    DEFAULT.stream,
    stick_speed_h_m_s=4.0,
    stick_speed_up_m_s=2.0,
    stick_speed_down_m_s=1.0,
    stick_yaw_rate_deg_s=60.0,
    stick_dead_band=0.1,
)
NORTH = 0.0


def manual(x: int = 0, y: int = 0, z: int = 500, r: int = 0, buttons: int = 0) -> Message:
    return sent(mavlink.MAVLink_manual_control_message(1, x, y, z, r, buttons))


def channels(*raw: int, **later: Any) -> Message:
    first = list(raw) + [65535] * (8 - len(raw))
    return sent(mavlink.MAVLink_rc_channels_override_message(1, 1, *first, **later))


def sticks(message: Message, seen: Seen) -> Sticks:
    meaning = meaning_of(message, seen)
    assert isinstance(meaning, Sticks), meaning
    return meaning


def hovering(autopilot: Autopilot = PX4, **changed: Any) -> Seen:
    return flying(autopilot, **{"stream": RULES, "yaw_rad": NORTH, **changed})


# ------------------------------------------------------------------------- what they ask for


@BOTH
@pytest.mark.parametrize(
    ("moved", "v_ned", "rate_deg_s"),
    [
        ({"x": 1000}, (4, 0, 0), 0),
        ({"x": -1000}, (-4, 0, 0), 0),
        ({"y": 1000}, (0, 4, 0), 0),
        ({"y": -1000}, (0, -4, 0), 0),
        ({"z": 1000}, (0, 0, -2), 0),
        ({"z": 0}, (0, 0, 1), 0),
        ({"r": 1000}, (0, 0, 0), 60),
        ({"r": -1000}, (0, 0, 0), -60),
        ({"x": 550}, (2, 0, 0), 0),
        ({"z": 775}, (0, 0, -1), 0),
        ({"x": 100, "y": -100, "z": 550, "r": 100}, (0, 0, 0), 0),
        ({"x": 1000, "y": 1000}, (4 / math.sqrt(2), 4 / math.sqrt(2), 0), 0),
        ({"x": 1000, "y": MISSING, "z": MISSING, "r": MISSING}, (4, 0, 0), 0),
        ({"x": MISSING, "z": 1000}, (0, 0, -2), 0),
        ({"z": MISSING, "r": 1000}, (0, 0, 0), 60),
    ],
    ids=str,
)
def test_manual_control_with_the_nose_north(
    autopilot: Autopilot,
    moved: Mapping[str, int],
    v_ned: tuple[float, float, float],
    rate_deg_s: float,
) -> None:
    asked = sticks(manual(**moved), hovering(autopilot))
    assert asked.sample.v_ned == pytest.approx(v_ned, abs=1e-4)
    assert asked.sample.yaw_rate_rad_s == pytest.approx(math.radians(rate_deg_s), abs=1e-4)
    assert asked.sample.pos_ned is None
    assert asked.centred is not any((*v_ned, rate_deg_s))


@pytest.mark.parametrize(
    ("moved", "v_ned", "rate_deg_s"),
    [
        ((2000,), (0, 4, 0), 0),
        ((1000,), (0, -4, 0), 0),
        ((1500, 1000), (4, 0, 0), 0),
        ((1500, 2000), (-4, 0, 0), 0),
        ((65535, 65535, 2000), (0, 0, -2), 0),
        ((0, 0, 1000), (0, 0, 1), 0),
        ((1500, 1500, 1500, 2000), (0, 0, 0), 60),
        ((2200, 1500, 1500, 1500), (0, 4, 0), 0),
        ((1550, 1450, 1550, 1450), (0, 0, 0), 0),
        ((1500, 1500, 1500, 1500), (0, 0, 0), 0),
    ],
    ids=str,
)
def test_channels_of_an_ardupilot(
    moved: tuple[int, ...], v_ned: tuple[float, float, float], rate_deg_s: float
) -> None:
    """Low pitch is forward: ArduCopter's RC2_REVERSED is 0."""
    asked = sticks(channels(*moved), hovering(ARDUPILOT))
    assert asked.sample.v_ned == pytest.approx(v_ned, abs=1e-4)
    assert asked.sample.yaw_rate_rad_s == pytest.approx(math.radians(rate_deg_s), abs=1e-4)


@pytest.mark.parametrize(
    ("yaw_deg", "north", "east"), [(90, 0, 4), (180, -4, 0), (-90, 0, -4), (30, 3.4641, 2)]
)
def test_forward_is_where_the_nose_points(yaw_deg: float, north: float, east: float) -> None:
    seen = hovering(yaw_rad=math.radians(yaw_deg))
    forward = sticks(manual(x=1000), seen).sample.v_ned
    assert forward == pytest.approx((north, east, 0), abs=1e-4)
    right = sticks(manual(y=1000), seen).sample.v_ned
    assert right == pytest.approx((-east, north, 0), abs=1e-4)


@BOTH
@pytest.mark.parametrize(
    "moved", [{"x": 1001}, {"y": -1001}, {"z": -1}, {"z": 1001}, {"r": -32768}], ids=str
)
def test_what_is_no_stick_is_refused(autopilot: Autopilot, moved: Mapping[str, int]) -> None:
    """A throttle from -1000 would mean a full descent at its middle."""
    text = refusal(meaning_of(manual(**moved), hovering(autopilot)))
    assert text.startswith("UNSUPPORTED")
    assert f"{next(iter(moved))} of {next(iter(moved.values()))} is no stick" in text


def test_channels_that_are_no_sticks_are_refused() -> None:
    """Channel 5 switches ArduCopter's flight mode (FLTMODE_CH)."""
    seen = hovering(ARDUPILOT)
    for message in (
        channels(1500, 1500, 1500, 1500, 1900),
        channels(0, chan9_raw=1800),
        channels(0, chan18_raw=1000),
        channels(65534),
        channels(1500, 799),
        channels(1500, 1500, 2201),
    ):
        assert refusal(meaning_of(message, seen)).startswith("UNSUPPORTED")


def test_channels_of_a_px4_are_refused_unless_released() -> None:
    """RC_MAP_ROLL to RC_MAP_YAW are 0 in px4_1_14_params.json: no channel is a stick."""
    text = refusal(meaning_of(channels(1500, 1000, 1500, 1500), hovering()))
    assert text.startswith("UNSUPPORTED")
    assert "MANUAL_CONTROL" in text
    assert words(meaning_of(channels(), hovering())) == []


@BOTH
def test_where_the_nose_points_must_be_known(autopilot: Autopilot) -> None:
    blind = hovering(autopilot, yaw_rad=None)
    assert refusal(meaning_of(manual(x=1000), blind)).startswith("NO_POSITION")
    assert sticks(manual(), blind).centred


def test_without_a_policy_sticks_fly_nothing() -> None:
    assert refusal(meaning_of(manual(x=1000), hovering(stream=None))).startswith("UNSUPPORTED")


axes = st.integers(-1000, 1000) | st.just(MISSING)


@given(axes, axes, st.integers(0, 1000) | st.just(MISSING), axes, st.floats(-math.pi, math.pi))
def test_no_stick_asks_for_more_than_a_stream_may(
    x: int, y: int, z: int, r: int, yaw_rad: float
) -> None:
    """Full stick is the policy's most here, to the last bit of a float32."""
    rules = structs.replace(
        RULES,
        stick_speed_h_m_s=20.0,
        stick_speed_up_m_s=20.0,
        stick_speed_down_m_s=20.0,
        stick_yaw_rate_deg_s=400.0,
    )
    sample = sticks(manual(x, y, z, r), hovering(stream=rules, yaw_rad=yaw_rad)).sample
    assert sample.v_ned is not None
    assert sample.yaw_rate_rad_s is not None
    assert all(map(math.isfinite, (*sample.v_ned, sample.yaw_rate_rad_s)))
    asked = StreamSample(v_ned=sample.v_ned, yaw_rate_rad_s=sample.yaw_rate_rad_s)
    assert beyond_rules(asked, rules) is None


def test_buttons_are_ignored_and_told_once() -> None:
    stream = StickStream()
    pressed = sticks(manual(x=1000, buttons=4), hovering())
    assert pressed.sample == sticks(manual(x=1000), hovering()).sample
    assert "ignored" in stream.news(pressed)
    assert not stream.news(sticks(manual(), hovering()))
    assert not stream.news(pressed)


# ----------------------------------------------------------------------------- when they fly


class Joystick:
    """One client's, 25 times a second; `seen` is what the gate does by now."""

    def __init__(self, **changed: Any) -> None:
        self.seen = hovering(**changed)
        self.stream = StickStream()
        self.now_ns = 5 * SECOND_NS

    def sends(self, seconds: float = 0.04, **moved: int) -> list[Settled]:
        """What is made of each message."""
        made: list[Settled] = []
        for _ in range(round(seconds * 1e9 / PERIOD_NS)):
            self.now_ns += PERIOD_NS
            meant = sticks(manual(**moved), self.seen)
            made.append(self.stream.settle(meant, self.seen, self.now_ns))
        return made

    def is_in(self, state: State) -> None:
        self.seen = hovering(state=state)


def nothing(made: list[Settled]) -> bool:
    return all(each == Words(()) for each in made)


def test_sticks_in_the_middle_begin_nothing() -> None:
    joystick = Joystick()
    for state in (State.HOVERING, State.MOVING, State.FLYING_MISSION, State.HOLDING):
        joystick.is_in(state)
        assert nothing(joystick.sends(3.0))
    joystick.is_in(State.STREAMING)  # it is this client's stream, or another's, but no stick's
    assert nothing(joystick.sends(3.0))


def test_a_stick_flies_and_let_go_of_it_stands_still_and_the_stream_ends() -> None:
    joystick = Joystick()
    joystick.sends()
    (first,) = joystick.sends(x=1000)
    assert isinstance(first, Sample)
    joystick.is_in(State.STREAMING)
    assert all(isinstance(each, Sample) for each in joystick.sends(1.0, x=1000))
    released = joystick.sends(1.0)
    assert [each.v_ned for each in released if isinstance(each, Sample)] == [(0.0, 0.0, 0.0)] * 25
    assert words(joystick.sends()[0]) == ["stream_end"]
    joystick.is_in(State.HOVERING)
    assert nothing(joystick.sends(3.0))


def test_a_stick_that_passes_the_middle_goes_on() -> None:
    joystick = Joystick()
    joystick.sends()
    joystick.sends(x=1000)
    joystick.is_in(State.STREAMING)
    for _ in range(5):
        assert all(isinstance(each, Sample) for each in joystick.sends(0.6))
        assert all(isinstance(each, Sample) for each in joystick.sends(0.6, x=-1000))


def test_a_stream_that_did_not_begin_needs_no_end() -> None:
    """The gate refused its samples, or the vehicle is another client's."""
    joystick = Joystick()
    joystick.sends()
    joystick.sends(1.0, x=1000)
    assert nothing(joystick.sends(3.0))


def test_who_is_not_in_control_ends_no_stream_of_another() -> None:
    joystick = Joystick()
    joystick.sends()
    joystick.sends(x=1000)
    joystick.seen = hovering(state=State.STREAMING, in_control=False)
    joystick.sends(1.0)
    assert nothing(joystick.sends(1.0))


@pytest.mark.parametrize("moved", [{"z": 0}, {"x": 1000}], ids=str)
def test_a_stick_that_was_never_in_the_middle_flies_nothing(moved: Mapping[str, int]) -> None:
    """A throttle without a spring, after a take-off; a stick that was held through a hold."""
    joystick = Joystick()
    joystick.is_in(State.TAKING_OFF)
    joystick.sends()
    joystick.sends(1.0, **moved)
    joystick.is_in(State.HOVERING)
    for made in joystick.sends(1.0, **moved):
        assert "let go of them once" in refusal(made)
    joystick.sends()
    assert isinstance(joystick.sends(**moved)[0], Sample)


def test_a_client_that_was_silent_starts_in_the_middle_again() -> None:
    joystick = Joystick()
    joystick.sends()
    joystick.now_ns += 3 * SECOND_NS
    assert refusal(joystick.sends(x=1000)[0]).startswith("POLICY")


def test_a_gap_in_a_flown_stream_needs_no_middle() -> None:
    joystick = Joystick()
    joystick.sends()
    joystick.sends(x=1000)
    joystick.is_in(State.STREAMING)
    joystick.now_ns += SECOND_NS
    assert isinstance(joystick.sends(x=1000)[0], Sample)
    joystick.is_in(State.STALE)
    assert isinstance(joystick.sends(x=1000)[0], Sample)
    joystick.is_in(State.STREAMING)
    assert isinstance(joystick.sends(x=1000)[0], Sample)


def test_a_stream_that_a_position_too_old_interrupts_is_not_ended_meanwhile() -> None:
    joystick = Joystick()
    joystick.sends()
    joystick.sends(x=1000)
    joystick.is_in(State.STALE)
    assert all(isinstance(each, Sample) for each in joystick.sends(2.0))
    joystick.is_in(State.STREAMING)
    assert words(joystick.sends()[0]) == ["stream_end"]


def test_a_stick_that_was_held_through_a_hold_flies_nothing() -> None:
    joystick = Joystick()
    joystick.sends()
    joystick.sends(x=1000)
    joystick.is_in(State.HOLDING)
    assert all(isinstance(each, Sample) for each in joystick.sends(1.0, x=1000)), "told HOLDING"
    joystick.is_in(State.HOVERING)
    assert refusal(joystick.sends(x=1000)[0]).startswith("POLICY")


def test_in_the_air_a_throttle_at_its_bottom_asks_for_a_descent() -> None:
    """Which a hold does not fly, and the gate says so."""
    joystick = Joystick()
    joystick.is_in(State.HOLDING)
    assert isinstance(joystick.sends(z=0)[0], Sample)


@BOTH
def test_on_the_ground_a_throttle_at_its_bottom_asks_for_nothing(autopilot: Autopilot) -> None:
    stream, ground = StickStream(), standing(autopilot)
    for armed in (False, True):
        ground = standing(autopilot, armed=armed)
        for z in (500, 200, 0):
            assert stream.settle(sticks(manual(z=z), ground), ground, 0) == Words(())


@BOTH
@pytest.mark.parametrize("moved", [{"z": 1000}, {"z": 0, "r": 1000}, {"x": 1000}], ids=str)
def test_on_the_ground_no_stick_arms_or_takes_off(
    autopilot: Autopilot, moved: Mapping[str, int]
) -> None:
    """A sample: the gate refuses it as NOT_FLYING, and tells so once."""
    ground = standing(autopilot, armed=True)
    assert isinstance(StickStream().settle(sticks(manual(**moved), ground), ground, 0), Sample)


# ------------------------------------------------------------------------------------- modes


POSITION = pytest.mark.parametrize(
    ("autopilot", "message"),
    [
        (PX4, px4_mode("POSCTL")),
        (ARDUPILOT, copter_mode("POSHOLD")),
        (ARDUPILOT, copter_mode("LOITER")),
    ],
    ids=["POSCTL", "POSHOLD", "LOITER"],
)


@POSITION
@pytest.mark.parametrize(
    "state", [State.MOVING, State.TAKING_OFF, State.FLYING_MISSION, State.RETURNING, State.LANDING]
)
def test_the_position_mode_of_who_has_sticks_stops_and_hovers(
    autopilot: Autopilot, message: Message, state: State
) -> None:
    seen = hovering(autopilot, state=state, has_sticks=True)
    meaning = meaning_of(message, seen)
    assert words(meaning) == ["hold", "resume"]
    assert isinstance(meaning, Words)
    assert "verifies what the sticks ask for" in meaning.note


@POSITION
def test_the_position_mode_that_would_be_refused_stops_nothing_but_a_hold_stops(
    autopilot: Autopilot, message: Message
) -> None:
    """LOITER is a hold as well, and a hold is never refused."""
    why = Refusal(Code.SEVERITY, "severity is RETURN: battery_critical")
    seen = hovering(autopilot, state=State.RETURNING, has_sticks=True, why_not_resume=lambda: why)
    meaning = meaning_of(message, seen)
    if message == copter_mode("LOITER"):
        assert words(meaning) == ["hold"]
    else:
        assert meaning == Reject(why)


@POSITION
def test_the_position_mode_leaves_a_hold(autopilot: Autopilot, message: Message) -> None:
    for state in (State.HOLDING, State.EXTERNAL):
        seen = hovering(autopilot, state=state, has_sticks=True)
        assert words(meaning_of(message, seen))[-1] == "resume"


@pytest.mark.parametrize("message", [px4_mode("POSCTL")])
def test_posctl_where_the_gate_hovers_already(message: Message) -> None:
    assert words(meaning_of(message, hovering(has_sticks=True))) == []
    streaming = hovering(state=State.STREAMING, has_sticks=True)
    assert words(meaning_of(message, streaming)) == []
    taken = hovering(mode_name="AUTO.LOITER", has_sticks=True)
    assert words(meaning_of(message, taken)) == []
    other = hovering(has_sticks=True, in_control=False)
    assert words(meaning_of(message, other)) == ["control"]


def test_posctl_on_the_ground_is_a_mode_that_px4_arms_in() -> None:
    """B4_posctl_mode_without_stream of scenarios_px4.json: arming in POSCTL is
    TEMPORARILY_REJECTED while the vehicle hears no sticks, and it hears none of a client's."""
    meaning = meaning_of(px4_mode("POSCTL"), standing(PX4, has_sticks=True))
    assert words(meaning) == ["hold"]
    assert isinstance(meaning, Words)
    assert "take off, then the sticks fly" in meaning.note
    assert words(meaning_of(px4_mode("POSCTL"), standing(PX4))) == ["mode"]
    armed = standing(PX4, has_sticks=True, armed=True)
    assert refusal(meaning_of(px4_mode("POSCTL"), armed)).startswith("POLICY")


def test_loiter_is_a_stop_for_everybody_else() -> None:
    """Never refused: who is not in control, who has no sticks, on the ground."""
    for changed in ({"in_control": False}, {"has_sticks": False}, {"on_ground": True}):
        seen = hovering(ARDUPILOT, state=State.MOVING, **{"has_sticks": True, **changed})
        assert words(meaning_of(copter_mode("LOITER"), seen)) == ["hold"]


def test_the_hold_of_the_autopilot_stays_a_hold_for_who_has_sticks() -> None:
    for autopilot, message in ((PX4, px4_mode("LOITER")), (ARDUPILOT, copter_mode("BRAKE"))):
        seen = hovering(autopilot, state=State.MOVING, has_sticks=True)
        assert words(meaning_of(message, seen)) == ["hold"]


@pytest.mark.parametrize(
    ("autopilot", "message"),
    [(PX4, px4_mode("POSCTL")), (ARDUPILOT, copter_mode("POSHOLD"))],
    ids=["POSCTL", "POSHOLD"],
)
def test_without_sticks_there_is_no_position_mode(autopilot: Autopilot, message: Message) -> None:
    """As PX4 itself has it: B4_posctl_mode_without_stream of scenarios_px4.json."""
    text = refusal(meaning_of(message, hovering(autopilot)))
    assert text.startswith("POLICY")
    assert "no MANUAL_CONTROL comes" in text


@pytest.mark.parametrize(
    ("autopilot", "message"),
    [
        (PX4, px4_mode("ALTCTL")),
        (PX4, px4_mode("STABILIZED")),
        (ARDUPILOT, copter_mode("ALT_HOLD")),
    ],
    ids=["ALTCTL", "STABILIZED", "ALT_HOLD"],
)
def test_modes_that_hold_no_position_stay_refused(autopilot: Autopilot, message: Message) -> None:
    seen = hovering(autopilot, has_sticks=True)
    assert refusal(meaning_of(message, seen)).startswith("POLICY")
