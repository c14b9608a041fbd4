"""A motor dies or weakens: what falls, what is told, and what goes on flying."""

from __future__ import annotations

import pytest

from tests.unit.faults.stage import HOVERS, Stage, aloft, far
from vehicle_sim.autopilot.interface import Truth
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire import messages as m

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)
airframes = pytest.mark.parametrize("airframe", ["s500", "racer250"])


def stands(truth: Truth) -> float:
    """The cosine of its lean."""
    _, x, y, _ = truth.q_ned_from_frd
    return 1.0 - 2.0 * (x * x + y * y)


def motor(number: int, health: float = 0.0, for_s: float | None = None) -> str:
    lasts = "" if for_s is None else f"for_s = {for_s}\n"
    return f"[[fault]]\nat_s = 20\n{lasts}kind = 'motor'\nmotor = {number}\nhealth = {health}\n"


@either
@airframes
@pytest.mark.parametrize("number", [1, 4])
def test_without_a_motor_a_quadrotor_falls(
    personality: Personality, airframe: str, number: int
) -> None:
    stage = aloft(personality, motor(number), airframe=airframe)
    at = stage.truth.pos_ned
    took_s = stage.until(lambda: stage.up_m < 0.2, 10.0)
    assert 1.2 < took_s < 6.0, "not faster than a stone falls ten metres, and no glide"
    upright = []
    stage.run(4.0, lambda truth: upright.append(stands(truth)))
    assert min(upright) < 0.5, "it does not stay on its feet"
    assert stage.up_m < 1.0
    assert far(stage.truth, at) < 25.0


@airframes
def test_px4_tells_of_a_dead_motor_at_once_and_of_the_upset(airframe: str) -> None:
    stage = aloft("px4", motor(2), airframe=airframe)
    stage.run(0.5)
    assert stage.said("Motor 2 failure detected")
    stage.until(lambda: stage.said("Attitude failure"), 4.0)
    stage.run(8.0)
    assert stage.armed, "the circuit breaker for flight termination is set by default"


@pytest.mark.parametrize(("action", "mode"), [(2, "AUTO.LAND"), (3, "AUTO.RTL")])
def test_px4_does_about_a_dead_motor_what_com_act_fail_act_says(action: int, mode: str) -> None:
    stage = aloft("px4", motor(2), parameters={"COM_ACT_FAIL_ACT": action, "COM_FAIL_ACT_T": 0})
    stage.run(0.6)
    assert stage.mode == mode


def test_px4_without_the_circuit_breaker_ends_the_flight() -> None:
    stage = aloft("px4", motor(2), parameters={"CBRK_FLIGHTTERM": 0})
    assert stage.until(lambda: stage.vehicle.system_status == 8, 3.0) < 1.5
    assert stage.armed
    assert stage.said("Preflight Fail: Flight termination active")
    stage.run(4.0)
    assert stage.last(m.ServoOutputRaw).servo1_raw <= 1000


@airframes
def test_ardupilot_disarms_after_the_crash_and_says_so(airframe: str) -> None:
    stage = aloft("ardupilot", motor(2), airframe=airframe)
    down_s = stage.until(lambda: stage.up_m < 0.2, 10.0)
    # The check wants 2 s without acceleration (crash_check.cpp): a racer tumbles on first.
    stage.until(lambda: not stage.armed, 6.0 if airframe == "s500" else 15.0)
    assert down_s < 6.0
    assert stage.said("Crash: Disarming: AngErr=")
    stage.run(2.0)
    assert stage.speed_m_s < 0.1
    assert stage.last(m.Heartbeat).base_mode & 128 == 0


class Sag:
    """How far it sinks and drifts from where it hovered."""

    def __init__(self, stage: Stage) -> None:
        self.at = stage.truth.pos_ned
        self.sunk_m = self.away_m = 0.0

    def __call__(self, truth: Truth) -> None:
        self.sunk_m = max(self.sunk_m, truth.pos_ned[2] - self.at[2])
        self.away_m = max(self.away_m, far(truth, self.at))


@pytest.mark.parametrize(
    ("personality", "airframe", "health"),
    [
        ("px4", "s500", 0.7),
        ("px4", "racer250", 0.9),
        ("ardupilot", "racer250", 0.7),
        ("ardupilot", "s500", 0.9),
    ],
)
def test_with_a_weak_motor_it_flies_on(
    personality: Personality, airframe: str, health: float
) -> None:
    stage = aloft(personality, motor(1, health), airframe=airframe)
    sag, told_before = Sag(stage), stage.texts
    stage.run(15.0, sag)
    assert stage.mode == HOVERS[personality]
    assert stage.texts == told_before
    assert sag.sunk_m < 0.6
    assert sag.away_m < 1.0
    assert stage.speed_m_s < 0.2


@either
def test_an_s500_without_the_thrust_to_hover_sinks_level_where_it_is(
    personality: Personality,
) -> None:
    """At 0.4 of 8.5 N that motor lifts less than the quarter of the weight that is its own."""
    stage = aloft(personality, motor(1, 0.4))
    sag = Sag(stage)
    took_s = stage.until(lambda: stage.up_m < 0.1, 30.0)
    stage.run(1.0, sag)
    assert took_s > 2.5, "it does not drop"
    assert sag.away_m < 4.0
    assert stands(stage.truth) > 0.9, "on its feet"
    assert stage.said("Potential Thrust Loss (1)") == (personality == "ardupilot")


@either
def test_a_motor_that_recovers_at_once_costs_height_only(personality: Personality) -> None:
    stage = aloft(personality, motor(3, 0.4, for_s=1.0))
    sag = Sag(stage)
    stage.run(12.0, sag)
    assert stage.mode == HOVERS[personality]
    assert stage.speed_m_s < 0.3
    assert abs(stage.up_m - 10.0) < 1.0
    assert sag.away_m < 3.0


def test_servo_output_tells_that_the_weak_motor_works_harder() -> None:
    stage = aloft("px4", motor(1, 0.6))
    stage.run(8.0)
    told = stage.last(m.ServoOutputRaw)
    assert told.servo1_raw > max(told.servo2_raw, told.servo3_raw, told.servo4_raw) + 50


@either
def test_who_lies_on_its_back_does_not_arm(personality: Personality) -> None:
    stage = aloft(personality, motor(3))
    stage.until(lambda: stage.up_m < 0.2, 8.0)
    stage.run(4.0)
    assert stage.command(400, 0, 21196) == 0
    stage.run(2.0)
    assert stands(stage.truth) < 0.0
    words = {"px4": "Preflight Fail: Attitude failure (roll)", "ardupilot": "Arm: Leaning"}
    assert stage.command(400, 1) != 0
    assert stage.said(words[personality])
