"""Sticks that are lost, a clock that jumps, an autopilot that starts anew, a link that is out."""

from __future__ import annotations

from itertools import pairwise

import pytest

from tests.unit.faults.stage import HOVERS, S, Stage, aloft, far
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire import messages as m

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)
ARM, SET_MODE, INJECT = 400, 176, 420
CENTRED = m.ManualControl(x=0, y=0, z=500, r=0, buttons=0, target=1)
ATTITUDE = m.Attitude


def fault(kind: str, keys: str = "", at_s: float = 20.0, for_s: float | None = None) -> str:
    lasts = "" if for_s is None else f"for_s = {for_s}\n"
    return f"[[fault]]\nat_s = {at_s}\n{lasts}kind = '{kind}'\n{keys}\n"


def by_hand(personality: Personality, text: str, **parameters: float) -> Stage:
    """In position mode, with sticks that come all the time."""
    stage = aloft(personality, text, parameters=parameters)
    stage.sticks = CENTRED
    stage.run(0.05)
    main_mode = 3 if personality == "px4" else 5
    assert stage.command(SET_MODE, 1, main_mode) == 0
    assert stage.mode == {"px4": "POSCTL", "ardupilot": "LOITER"}[personality]
    return stage


# -------------------------------------------------------------------------------------- sticks


def test_px4_without_sticks_holds_for_five_seconds_then_returns() -> None:
    stage = by_hand("px4", fault("rc_lost", at_s=22.0))
    stage.run_to(23.0)
    assert stage.said("Failsafe activated, entering Hold for 5 seconds")
    assert stage.mode == "AUTO.LOITER"
    stage.run_to(28.0)
    assert stage.mode == "AUTO.RTL"


def test_ardupilot_without_sticks_returns() -> None:
    stage = by_hand("ardupilot", fault("rc_lost", at_s=22.0, for_s=10.0), RTL_ALT=1000)
    stage.until(lambda: stage.mode == "RTL", 8.0)
    assert stage.said("Radio Failsafe")
    stage.run_to(33.0)
    assert stage.said("Radio Failsafe Cleared")
    assert stage.mode == "RTL", "who wants to fly again says so"


@either
def test_who_flies_by_itself_does_not_miss_sticks_that_it_never_had(
    personality: Personality,
) -> None:
    stage = aloft(personality, fault("rc_lost"))
    stage.run(10.0)
    assert stage.mode == HOVERS[personality]


# --------------------------------------------------------------------------------------- clock


def stamps(stage: Stage, since_s: float) -> list[int]:
    return [each.time_boot_ms for each in stage.all(ATTITUDE, round(since_s * S))]


@either
@pytest.mark.parametrize("by_s", [7.0, -4.0])
def test_a_clock_that_jumps_is_seen_in_every_stamp_and_nowhere_else(
    personality: Personality, by_s: float
) -> None:
    stage = aloft(personality, fault("clock_jump", f"by_s = {by_s}", for_s=5.0))
    at = stage.truth.pos_ned
    stage.run(10.0)
    steps_ms = [after - before for before, after in pairwise(stamps(stage, 19.0))]
    jumps_ms = [step for step in steps_ms if not 0 <= step <= 500]
    assert [round(jump / 1000.0) for jump in jumps_ms] == [by_s, -by_s]
    assert stage.last(m.SystemTime).time_boot_ms == pytest.approx(30_000, abs=1_100)
    assert far(stage.truth, at) < 0.5
    assert stage.mode == HOVERS[personality]


# -------------------------------------------------------------------------------------- reboot


@either
def test_a_reboot_in_flight_is_a_fall_and_a_new_start_where_it_lies(
    personality: Personality,
) -> None:
    stage = aloft(personality, fault("reboot"))
    at = stage.truth.pos_ned
    stage.run_to(20.1)
    assert not stage.armed
    assert stage.last(m.Heartbeat).base_mode & 128 == 0
    took_s = stage.until(lambda: stage.up_m < 0.1, 5.0)
    assert 1.2 < took_s < 2.5, "free fall takes 1.43 s"
    stage.run_to(24.0)
    times_ms = stamps(stage, 19.5)
    assert times_ms[-1] == pytest.approx(4_000, abs=300), "its clock starts anew"
    assert max(times_ms) < 20_100
    assert far(stage.truth, at) < 3.0
    stage.run_to(27.0)
    if personality == "ardupilot":
        assert stage.command(SET_MODE, 1, 4) == 0
    assert stage.command(ARM, 1) == 0, stage.texts


@either
def test_a_reboot_on_the_ground_disarms_and_is_ready_again(personality: Personality) -> None:
    stage = Stage(personality, fault("reboot", at_s=6.0)).ready()
    assert stage.command(ARM, 1) == 0
    stage.run_to(6.1)
    assert not stage.armed
    assert stage.until(lambda: stage.vehicle.armable, 3.0) > 0.1
    stage.run_to(9.0)
    assert stamps(stage, 8.0)[-1] < 3_100


@either
def test_parameters_and_plan_survive_a_reboot(personality: Personality) -> None:
    stage = Stage(personality, fault("reboot", at_s=6.0)).ready()
    name = {"px4": "RTL_RETURN_ALT", "ardupilot": "RTL_ALT"}[personality]
    stage.vehicle.parameters.set(name, 125.0)
    stage.run_to(9.0)
    assert stage.vehicle.parameters.get(name) == 125.0


# ---------------------------------------------------------------------------------------- link


@pytest.mark.parametrize(
    ("personality", "parameters", "after_s", "mode"),
    [
        ("px4", {"NAV_DLL_ACT": 2.0, "COM_FAIL_ACT_T": 0.0}, 10.0, "AUTO.RTL"),
        ("ardupilot", {"FS_GCS_ENABLE": 1.0}, 5.0, "RTL"),
    ],
)
def test_a_link_that_is_out_too_long_brings_it_home_and_telemetry_comes_back(
    personality: Personality, parameters: dict[str, float], after_s: float, mode: str
) -> None:
    text = fault("link", "out = true", for_s=after_s + 3.0)
    stage = aloft(personality, text, parameters=parameters)
    stage.run_to(20.1)
    heard = len(stage.heard)
    stage.run_to(20.0 + after_s - 1.5)
    assert len(stage.heard) == heard, "nothing comes through"
    assert stage.mode == HOVERS[personality]
    stage.run_to(20.0 + after_s + 1.0)
    assert stage.mode == mode
    assert len(stage.heard) == heard
    stage.run_to(20.0 + after_s + 5.0)
    since_ns = round((20.0 + after_s + 3.0) * S)
    assert len(stage.all(m.Heartbeat, since_ns)) >= 2
    assert stage.all(ATTITUDE, since_ns)
    regained = {"px4": "GCS connection regained", "ardupilot": "GCS Failsafe Cleared"}
    assert stage.said(regained[personality])


@either
def test_a_link_out_in_one_direction_only(personality: Personality) -> None:
    """It is heard and does not hear, or the other way round."""
    deaf = aloft(personality, fault("link", "out = true\ndirection = 'in'", for_s=5.0))
    deaf.run(3.0)
    assert deaf.all(ATTITUDE, 21 * S)
    heard = len(deaf.all(m.CommandAck))
    deaf.send(m.CommandLong(0, 0, 0, 0, 0, 0, 0, 21, 1, 1, 0))
    deaf.run(0.5)
    assert len(deaf.all(m.CommandAck)) == heard
    assert deaf.mode == HOVERS[personality]
    mute = aloft(personality, fault("link", "out = true\ndirection = 'out'", for_s=5.0))
    mute.run_to(20.2)
    heard = len(mute.heard)
    mute.send(m.CommandLong(0, 0, 0, 0, 0, 0, 0, 21, 1, 1, 0))
    mute.run(0.5)
    assert len(mute.heard) == heard
    assert mute.mode in ("AUTO.LAND", "LAND"), "the order arrived"
