"""What is heard of the sticks: sources, channels, ages, losses; and what sticks say by gesture."""

from __future__ import annotations

import pytest

from vehicle_sim.autopilot.manual.stick_feel import feel_of, hover_of, shaped, thrust_of
from vehicle_sim.autopilot.manual.stick_gestures import Gesture, Gestures
from vehicle_sim.autopilot.manual.sticks import CENTRED, Radio, Sticks
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters

S = 1_000_000_000
IGNORE = 65535
either = pytest.mark.parametrize("personality", ["px4", "ardupilot"])


def channels(*first: int) -> tuple[int, ...]:
    """Channels 1 .. 18, those not given left alone."""
    return (*first, *(IGNORE for _ in range(18 - len(first))))


def px4_radio(mode: int) -> Radio:
    """Sticks on the channels where transmitters have them, COM_RC_IN_MODE = `mode`."""
    parameters = Parameters("px4")
    for number, name in enumerate(("ROLL", "PITCH", "THROTTLE", "YAW"), start=1):
        parameters.set(f"RC_MAP_{name}", number)
    parameters.set("COM_RC_IN_MODE", mode)
    return Radio(parameters)


@either
def test_a_joystick_is_four_sticks_and_its_throttle_rests_in_the_middle(
    personality: Personality,
) -> None:
    radio = Radio(Parameters(personality))
    assert not radio.heard
    assert radio.sticks(0) is None
    radio.joystick(500, -1000, 500, 250, S)
    hand = radio.sticks(S)
    assert hand is not None
    assert hand.pitch == pytest.approx(0.5, abs=0.03)
    assert hand.roll == pytest.approx(-1.0)
    assert hand.yaw == pytest.approx(0.25, abs=0.04)
    assert hand.throttle == pytest.approx(0.5)
    assert hand.climb == pytest.approx(0.0)


@either
def test_an_axis_that_is_not_there_is_centred(personality: Personality) -> None:
    radio = Radio(Parameters(personality))
    radio.joystick(32767, 32767, 500, 32767, S)
    assert radio.sticks(S) == CENTRED


@pytest.mark.parametrize(
    ("personality", "lasts_s", "lost_s"), [("px4", 0.5, 0.5), ("ardupilot", 3.0, 1.0)]
)
def test_silence_ends_the_sticks_and_is_a_loss(
    personality: Personality, lasts_s: float, lost_s: float
) -> None:
    """COM_RC_LOSS_T; RC_OVERRIDE_TIME, and RC_FS_TIMEOUT for who has no receiver.

    Recorded of an ArduCopter with SIM_RC_FAIL = 1: a loss 0.96 s after the last override (B7).
    """
    parameters = Parameters(personality)
    if personality == "ardupilot":
        parameters.set("SIM_RC_FAIL", 1)
    radio = Radio(parameters)
    assert not radio.lost(100 * S)
    radio.joystick(0, 0, 700, 0, S)
    last = S + int(lasts_s * S)
    assert radio.sticks(last - 1) is not None
    assert radio.sticks(last) is None
    lost = S + int(lost_s * S)
    assert not radio.lost(lost - 1)
    assert radio.lost(lost)
    assert radio.last is not None
    radio.joystick(0, 0, 700, 0, 10 * S)
    assert not radio.lost(10 * S)


def test_ardupilots_receiver_is_heard_where_overrides_end_and_that_is_no_loss() -> None:
    """As recorded after both kinds of override (B5, B8): SITL's throttle is at its bottom."""
    radio = Radio(Parameters("ardupilot"))
    radio.joystick(500, 0, 700, 0, S)
    hand = radio.sticks(4 * S - 1)
    assert hand is not None
    assert hand.pitch == pytest.approx(0.5, abs=0.03)
    for wall_ns in (4 * S, 1000 * S):
        assert radio.sticks(wall_ns) == Sticks(0.0, 0.0, 0.0, 0.0)
        assert not radio.lost(wall_ns)
    radio.joystick(0, 0, 700, 0, 1000 * S)
    hand = radio.sticks(1000 * S)
    assert hand is not None
    assert hand.throttle == pytest.approx(0.7)


def test_a_radio_that_hears_nothing_any_more_has_no_receiver_either() -> None:
    """INJECT_FAILURE of the radio, where SIM_RC_FAIL says that there is one."""
    radio = Radio(Parameters("ardupilot"))
    radio.joystick(0, 0, 700, 0, S)
    radio.deaf = True
    radio.joystick(0, 0, 700, 0, 2 * S)
    assert not radio.lost(2 * S - 1)
    assert radio.lost(2 * S)
    assert radio.sticks(4 * S) is None
    radio.deaf = False
    assert not radio.lost(4 * S)


def test_channels_are_overridden_left_alone_and_given_back_one_by_one() -> None:
    radio = Radio(Parameters("ardupilot"))
    radio.override(channels(1500, 1500, 1700, 1500), S)
    radio.override((IGNORE, 1900, *(0 for _ in range(16))), S)
    # The second frame leaves channel 1 alone and gives 3 .. 8 back.
    assert radio.channels_us(S)[:4] == (1500, 1900, 0, 0)
    hand = radio.sticks(S)
    assert hand is not None
    assert hand.pitch < -0.7, "a high pitch channel is a stick pulled back"


def test_from_channel_nine_on_zero_leaves_alone_and_65534_gives_back() -> None:
    radio = Radio(Parameters("ardupilot"))
    radio.override((*(0 for _ in range(8)), 1800, *(0 for _ in range(9))), S)
    assert radio.channel_us(9, S) == 1800
    radio.override(tuple(0 for _ in range(18)), S)
    assert radio.channel_us(9, S) == 1800
    radio.override((*(0 for _ in range(8)), 65534, *(0 for _ in range(9))), S)
    assert radio.channel_us(9, S) == 0


def test_all_channels_given_back_are_no_loss() -> None:
    radio = Radio(Parameters("ardupilot"))
    radio.override(channels(1500, 1500, 1500, 1500), S)
    radio.override(tuple(0 for _ in range(18)), 2 * S)
    assert not radio.heard
    assert not radio.lost(20 * S)


def test_an_override_time_of_zero_takes_no_override_and_minus_one_keeps_it() -> None:
    parameters = Parameters("ardupilot")
    radio = Radio(parameters)
    parameters.set("RC_OVERRIDE_TIME", 0)
    radio.override(channels(1500, 1500, 1500, 1500), S)
    assert radio.sticks(S) is None
    parameters.set("RC_OVERRIDE_TIME", -1)
    assert radio.sticks(1000 * S) is not None


def test_px4_flies_by_a_radio_only_where_its_channels_are_mapped() -> None:
    unmapped = Radio(Parameters("px4"))
    unmapped.override(channels(1500, 1500, 1500, 1500), S)
    assert unmapped.sticks(S) is None
    assert unmapped.channel_us(1, S) == 1500
    assert px4_radio(3).sticks(S) is None


@pytest.mark.parametrize(
    ("mode", "both", "radio_alone", "joystick_alone"),
    [(0, 0.5, 0.5, None), (1, 1.0, None, 1.0), (2, 0.5, 0.5, 1.0), (4, None, None, None)],
)
def test_which_source_flies(
    mode: int, both: float | None, radio_alone: float | None, joystick_alone: float | None
) -> None:
    """COM_RC_IN_MODE; the radio's throttle is 0.5, the joystick's 1."""

    def throttle(radio: Radio) -> float | None:
        hand = radio.sticks(S)
        return None if hand is None else hand.throttle

    middle = channels(1500, 1500, 1500, 1500)
    one, two, three = px4_radio(mode), px4_radio(mode), px4_radio(mode)
    one.override(middle, S)
    one.joystick(0, 0, 1000, 0, S)
    two.override(middle, S)
    three.joystick(0, 0, 1000, 0, S)
    assert (throttle(one), throttle(two), throttle(three)) == (both, radio_alone, joystick_alone)


def test_the_source_that_was_first_stays() -> None:
    radio = px4_radio(3)
    radio.joystick(0, 0, 1000, 0, S)
    radio.override(channels(1500, 1500, 1500, 1500), S + 1)
    hand = radio.sticks(S + 1)
    assert hand is not None
    assert hand.throttle == 1.0
    assert radio.sticks(2 * S) is None, "the radio does not step in"


@either
def test_the_middle_of_the_throttle_hovers_and_its_ends_do_not(personality: Personality) -> None:
    parameters = Parameters(personality)
    low, middle, high = (
        thrust_of(parameters, Sticks(0.0, 0.0, 0.0, part)) for part in (0.0, 0.5, 1.0)
    )
    assert middle == pytest.approx(hover_of(parameters), abs=0.01)
    assert low < 0.1
    assert high == pytest.approx(1.0)


def test_curves_have_a_dead_zone_and_reach_the_end() -> None:
    assert shaped(0.09, 0.1, 0.6) == 0.0
    assert shaped(1.0, 0.1, 0.6) == pytest.approx(1.0)
    assert shaped(-1.0, 0.1, 0.6) == pytest.approx(-1.0)
    assert shaped(0.55, 0.1, 0.6) < shaped(0.55, 0.1, 0.0)


@either
def test_both_sticks_in_a_corner_are_no_faster_than_one_at_its_end(
    personality: Personality,
) -> None:
    feel = feel_of(Parameters(personality))
    forward, right = feel.velocity(Sticks(1.0, 1.0, 0.0, 0.5))
    assert (forward**2 + right**2) ** 0.5 == pytest.approx(feel.speed_m_s)


@pytest.mark.parametrize(("personality", "held_s"), [("px4", 1.0), ("ardupilot", 2.0)])
def test_a_corner_held_long_enough_is_told_once(personality: Personality, held_s: float) -> None:
    gestures = Gestures(Parameters(personality))
    corner, other = Sticks(0.0, 0.0, 1.0, 0.0), Sticks(0.0, 0.0, -1.0, 0.0)
    held_ns = int(held_s * S)
    assert gestures.seen(corner, S) is None
    assert gestures.seen(corner, S + held_ns - 1) is None
    assert gestures.seen(corner, S + held_ns) is Gesture.ARM
    assert gestures.seen(corner, S + 5 * held_ns) is None
    assert gestures.seen(other, 10 * S) is None
    assert gestures.seen(other, 10 * S + held_ns) is Gesture.DISARM


@pytest.mark.parametrize(
    ("personality", "name"), [("px4", "MAN_ARM_GESTURE"), ("ardupilot", "ARMING_RUDDER")]
)
def test_gestures_can_be_forbidden(personality: Personality, name: str) -> None:
    parameters = Parameters(personality)
    parameters.set(name, 0)
    gestures = Gestures(parameters)
    corner = Sticks(0.0, 0.0, 1.0, 0.0)
    assert gestures.seen(corner, S) is None
    assert gestures.seen(corner, 9 * S) is None


def test_the_mode_channel_has_six_positions_and_speaks_when_it_is_moved() -> None:
    parameters = Parameters("ardupilot")
    radio, gestures = Radio(parameters), Gestures(parameters)

    def switched(value_us: int, at_ns: int) -> int | None:
        radio.override(channels(IGNORE, IGNORE, IGNORE, IGNORE, value_us), at_ns)
        gestures.mode(radio, at_ns)
        return gestures.mode(radio, at_ns + S // 2)

    expected = [parameters.get(f"FLTMODE{number}") for number in range(1, 7)]
    levels = (1165, 1295, 1425, 1555, 1685, 1815)
    seen = [switched(level, (1 + number) * S) for number, level in enumerate(levels)]
    assert seen == expected
    assert switched(1815, 9 * S) is None
