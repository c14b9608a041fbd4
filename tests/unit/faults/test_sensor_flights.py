"""Inertial sensors, barometer and compass that lie or fall silent, on the ground and in flight."""

from __future__ import annotations

import pytest

from tests.unit.faults.stage import HOVERS, Stage, aloft, far
from vehicle_sim.autopilot.interface import Truth
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire import messages as m

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)
ARM = 400


def fault(kind: str, keys: str, at_s: float = 20.0, for_s: float | None = None) -> str:
    lasts = "" if for_s is None else f"for_s = {for_s}\n"
    return f"[[fault]]\nat_s = {at_s}\n{lasts}kind = '{kind}'\n{keys}\n"


class Strayed:
    """The farthest that the truth was from where it hovered, along the ground and in height."""

    def __init__(self, stage: Stage) -> None:
        self.at = stage.truth.pos_ned
        self.flat_m = self.up_m = self.down_m = 0.0

    def __call__(self, truth: Truth) -> None:
        self.flat_m = max(self.flat_m, far(truth, self.at))
        self.up_m = max(self.up_m, self.at[2] - truth.pos_ned[2])
        self.down_m = max(self.down_m, truth.pos_ned[2] - self.at[2])


# -------------------------------------------------------------------------------- on the ground


@either
@pytest.mark.parametrize(
    ("kind", "keys", "words"),
    [
        (
            "accel_bias",
            "offset_m_s2 = [0, 0, 2]",
            ("Preflight Fail: High Accelerometer Bias", "PreArm: Accels inconsistent"),
        ),
        (
            "baro",
            "lost = true",
            ("Preflight Fail: No valid data from Baro 0", "PreArm: Baro: not healthy"),
        ),
        (
            "mag",
            "lost = true",
            ("Preflight Fail: No valid data from Compass 0", "PreArm: Compass not healthy"),
        ),
    ],
)
def test_a_sick_sensor_prevents_arming_until_it_is_sound_again(
    personality: Personality, kind: str, keys: str, words: tuple[str, str]
) -> None:
    stage = Stage(personality, fault(kind, keys, at_s=5.0, for_s=10.0)).ready()
    stage.run_to(9.0)
    assert stage.command(ARM, 1) != 0
    assert stage.said(words[BOTH.index(personality)]), stage.texts
    assert not stage.armed
    stage.run_to(20.0)
    assert stage.command(ARM, 1) == 0
    assert stage.armed


def test_ardupilot_does_not_arm_with_a_gyroscope_far_off() -> None:
    stage = Stage("ardupilot", fault("gyro_bias", "offset_rad_s = [0.15, 0, 0]", 5.0)).ready()
    stage.run_to(15.0)
    assert stage.command(ARM, 1) != 0
    assert stage.said("PreArm: Gyros not healthy")


# ------------------------------------------------------------------------------------- in flight


@pytest.mark.parametrize(
    ("kind", "keys", "flat_m", "up_m", "down_m"),
    [
        ("accel_bias", "offset_m_s2 = [0.8, 0, 0]", 1.0, 0.4, 0.4),
        ("accel_bias", "offset_m_s2 = [0, 0, 1.0]", 0.6, 2.0, 0.4),
        ("gyro_bias", "offset_rad_s = [0.03, 0.03, 0]", 2.0, 0.4, 0.4),
        ("gyro_bias", "offset_rad_s = [0, 0, 0.05]", 0.6, 0.4, 0.4),
        ("baro", "offset_m = 3", 0.6, 0.4, 4.5),
        ("baro", "offset_m = -3", 0.6, 4.5, 0.4),
        ("baro", "offset_m = 20", 0.6, 0.5, 0.5),
        ("baro", "lost = true", 0.6, 0.6, 0.6),
        ("mag", "lost = true", 0.6, 0.4, 0.4),
        ("mag", "offset_gauss = [0, 0.05, 0]", 0.8, 0.4, 0.4),
    ],
)
def test_a_hover_stays_within_bounds(
    kind: str, keys: str, flat_m: float, up_m: float, down_m: float
) -> None:
    """Sensors and estimator are the same in both personalities."""
    stage = aloft("px4", fault(kind, keys))
    strayed, told_before = Strayed(stage), stage.texts
    stage.run(25.0, strayed)
    assert strayed.flat_m < flat_m
    assert strayed.up_m < up_m
    assert strayed.down_m < down_m
    assert stage.mode == "AUTO.LOITER"
    assert stage.texts == told_before
    assert stage.speed_m_s < 0.3


@pytest.mark.parametrize(("personality", "jump_m"), [("px4", 3.0), ("ardupilot", -3.0)])
def test_a_believed_jump_of_the_pressure_is_flown_after_and_forgotten_with_gps(
    personality: Personality, jump_m: float
) -> None:
    """Three metres are within the gate: down at once, then GPS draws it back in a minute."""
    stage = aloft(personality, fault("baro", f"offset_m = {jump_m}"), up_m=12.0)
    at_m = stage.up_m
    stage.run(6.0)
    assert abs(stage.up_m - at_m) > 2.0
    assert (stage.up_m < at_m) == (jump_m > 0.0)
    off_m = abs(stage.up_m - at_m)
    stage.run(60.0)
    assert abs(stage.up_m - at_m) < 0.6 * off_m


@either
def test_a_refused_jump_of_the_pressure_is_seen_in_the_telemetry_only(
    personality: Personality,
) -> None:
    stage = aloft(personality, fault("baro", "offset_m = 20"))
    before = stage.last(m.ScaledPressure).press_abs
    stage.run(3.0)
    # 12 Pa for a metre near the sea.
    assert before - stage.last(m.ScaledPressure).press_abs == pytest.approx(2.2, abs=0.4)
    assert stage.up_m == pytest.approx(10.0, abs=0.8)
    ratio = (
        stage.last(m.EstimatorStatus).pos_vert_ratio
        if personality == "px4"
        else stage.last(m.EkfStatusReport).pos_vert_variance
    )
    assert ratio > 1.0


@either
def test_a_wrong_compass_turns_the_nose_and_no_more(personality: Personality) -> None:
    stage = aloft(personality, fault("mag", "offset_gauss = [0, 0.05, 0]"))
    w, x, y, z = stage.truth.q_ned_from_frd
    before = 2.0 * (w * z + x * y)
    stage.run(20.0)
    w, x, y, z = stage.truth.q_ned_from_frd
    assert 0.05 < abs(2.0 * (w * z + x * y) - before) < 0.4


@either
def test_an_accelerometer_far_off_ends_when_it_ends(personality: Personality) -> None:
    text = fault("accel_bias", "offset_m_s2 = [0, 0, 1.5]", for_s=5.0)
    stage = aloft(personality, text)
    stage.run(30.0)
    assert stage.up_m == pytest.approx(10.0, abs=0.8)
    assert stage.mode == HOVERS[personality]
