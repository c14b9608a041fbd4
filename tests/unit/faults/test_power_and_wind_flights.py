"""Cells collapse and the wind rises: thrust is made up for, the place held, the charge told."""

from __future__ import annotations

import pytest

from tests.unit.faults.stage import HOVERS, Stage, aloft, far
from vehicle_sim.autopilot.interface import Truth
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire import messages as m

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)
airframes = pytest.mark.parametrize("airframe", ["s500", "racer250"])


def cells(lost: float, for_s: float | None = None) -> str:
    lasts = "" if for_s is None else f"for_s = {for_s}\n"
    return f"[[fault]]\nat_s = 20\n{lasts}kind = 'battery'\ncells = {lost}\n"


def wind(north_m_s: float, east_m_s: float, gust_m_s: float = 0.0) -> str:
    return (
        f"[[fault]]\nat_s = 20\nkind = 'wind'\nwind_ned_m_s = [{north_m_s}, {east_m_s}, 0]\n"
        f"gust_m_s = {gust_m_s}\n"
    )


TOLD_ONLY: dict[Personality, dict[str, float]] = {
    "px4": {"COM_LOW_BAT_ACT": 0},
    "ardupilot": {},  # as it is delivered
}
"""Nothing is done about a low battery."""


class Drift:
    """The farthest from where it hovered, horizontally and in height."""

    def __init__(self, stage: Stage) -> None:
        self.at = stage.truth.pos_ned
        self.flat_m = self.height_m = 0.0

    def __call__(self, truth: Truth) -> None:
        self.flat_m = max(self.flat_m, far(truth, self.at))
        self.height_m = max(self.height_m, abs(truth.pos_ned[2] - self.at[2]))


@either
@airframes
def test_a_lost_cell_is_seen_in_the_voltage_and_made_up_for(
    personality: Personality, airframe: str
) -> None:
    stage = aloft(personality, cells(1.0), airframe=airframe, parameters=TOLD_ONLY[personality])
    drift, before = Drift(stage), stage.last(m.SysStatus)
    stage.run(10.0, drift)
    after = stage.last(m.SysStatus)
    assert before.voltage_battery - after.voltage_battery == pytest.approx(4150, abs=200)
    assert drift.height_m < 0.4
    assert drift.flat_m < 0.5
    assert stage.mode == HOVERS[personality]
    assert stage.truth.battery > 0.93, "the charge of the other cells is all there"


@pytest.mark.parametrize(
    ("lost", "told"),
    [
        (0.25, []),
        (0.6, ["Preflight Fail: low battery\t", "Failsafe activated\t"]),
        (
            1.0,
            [
                "Preflight Fail: low battery\t",
                "Transition denied: Armed to Shutdown\t",
                "System does not support shutdown\t",
                "Failsafe activated\t",
            ],
        ),
    ],
)
def test_px4_takes_the_lost_voltage_for_lost_charge(lost: float, told: list[str]) -> None:
    stage = aloft("px4", cells(lost), parameters=TOLD_ONLY["px4"])
    assert stage.last(m.SysStatus).battery_remaining > 95
    said_before = stage.texts
    stage.run(2.0)
    assert stage.texts[len(said_before) :] == told
    assert stage.last(m.SysStatus).battery_remaining < {0.25: 75, 0.6: 15, 1.0: 5}[lost]
    assert stage.mode == "AUTO.LOITER"


def test_px4_lands_at_once_for_a_lost_cell_where_com_low_bat_act_says_so() -> None:
    stage = aloft("px4", cells(1.0), parameters={"COM_LOW_BAT_ACT": 3, "COM_FAIL_ACT_T": 0})
    stage.run(0.5)
    assert stage.mode == "AUTO.LAND"
    stage.until(lambda: not stage.armed, 40.0)
    assert stage.up_m < 0.1


def test_px4_whose_cell_recovers_says_no_more_and_tells_the_charge_again() -> None:
    stage = aloft("px4", cells(0.5, for_s=3.0))
    stage.run(6.0)
    assert stage.last(m.SysStatus).battery_remaining > 90


def test_ardupilots_voltage_failsafe_waits_its_ten_seconds() -> None:
    stage = aloft(
        "ardupilot",
        cells(1.0),
        parameters={"BATT_LOW_VOLT": 12.6, "BATT_FS_LOW_ACT": 2, "RTL_ALT": 1000},
    )
    stage.run(9.5)
    assert stage.mode == "GUIDED"
    stage.run(1.5)
    assert stage.said("Battery 1 is low 12.")
    assert stage.mode == "RTL"
    stage.until(lambda: not stage.armed, 60.0)
    assert stage.up_m < 0.1
    assert stage.last(m.SysStatus).battery_remaining > 90, "it counts the charge"


def test_ardupilots_low_voltage_must_last_without_a_break() -> None:
    """BATT_LOW_TIMER, 10 s: a voltage that recovers in between starts it anew."""
    twice = cells(1.0, for_s=6.0) + cells(1.0, for_s=6.0).replace("at_s = 20", "at_s = 27")
    stage = aloft("ardupilot", twice, parameters={"BATT_LOW_VOLT": 12.6, "BATT_FS_LOW_ACT": 2})
    stage.run(14.0)
    assert not stage.said("Battery 1 is low")
    assert stage.mode == "GUIDED"


def test_px4_does_not_hold_once_more_for_a_worse_failsafe() -> None:
    """COM_FAIL_ACT_T, 5 s, is waited before the first action; the next one comes at once."""
    worse = cells(0.66) + cells(1.0).replace("at_s = 20", "at_s = 33")
    low = {"COM_LOW_BAT_ACT": 3, "COM_FAIL_ACT_T": 5, "RTL_RETURN_ALT": 60}
    stage = aloft("px4", worse, parameters=low)
    stage.run(1.5)
    assert stage.said("Failsafe activated, entering Hold for 5 seconds")
    assert stage.mode == "AUTO.LOITER"
    stage.run(6.0)
    assert stage.mode == "AUTO.RTL"
    stage.run_to(33.6)
    assert stage.mode == "AUTO.LAND"


@either
def test_a_voltage_that_is_too_low_to_hover_on_brings_it_down_on_its_feet(
    personality: Personality,
) -> None:
    stage = aloft(personality, cells(1.5))
    took_s = stage.until(lambda: stage.up_m < 0.1, 30.0)
    assert took_s > 2.5
    stage.run(1.0)
    _, x, y, _ = stage.truth.q_ned_from_frd
    assert 1.0 - 2.0 * (x * x + y * y) > 0.9


@either
@airframes
def test_a_step_of_wind_is_held(personality: Personality, airframe: str) -> None:
    stage = aloft(personality, wind(0.0, 10.0), airframe=airframe, seed=2)
    drift, told_before = Drift(stage), stage.texts
    stage.run(10.0, drift)
    # PX4's loops have its own gains, MPC_XY_P 0.95 and MPC_XY_VEL_P_ACC 1.8.
    held_m, settled_m = (2.2, 0.7) if personality == "px4" else (1.5, 0.5)
    assert 0.3 < drift.flat_m < held_m, "the blow is felt, and held"
    assert drift.height_m < 1.0
    settled = Drift(stage)
    stage.run(5.0, settled)
    assert settled.flat_m < settled_m
    assert stage.texts == told_before
    w, x, y, z = stage.truth.q_ned_from_frd
    assert 2.0 * (w * x - y * z) < -0.05, "its thrust leans against the wind, to the west"
    assert stage.mode == HOVERS[personality]


@either
@airframes
def test_gusts_are_held(personality: Personality, airframe: str) -> None:
    stage = aloft(personality, wind(4.0, 4.0, 2.0), airframe=airframe)
    drift = Drift(stage)
    stage.run(30.0, drift)
    assert 0.2 < drift.flat_m < 2.0
    assert drift.height_m < 1.5
    assert stage.mode == HOVERS[personality]


def test_wind_that_it_cannot_hold_carries_it_away_and_the_telemetry_says_so() -> None:
    """30 m/s is more than a lean of 35 degrees can stand against."""
    stage = aloft("px4", wind(0.0, 30.0))
    at = stage.truth.pos_ned
    stage.run(20.0)
    assert stage.truth.pos_ned[1] - at[1] > 20.0, "downwind"
    assert stage.astray_m < 4.0
    told = stage.last(m.LocalPositionNed)
    assert told.y > 18.0
