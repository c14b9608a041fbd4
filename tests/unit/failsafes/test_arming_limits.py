"""The numbers of the arming checks, and when an armed vehicle disarms by itself.

Asked of the checks directly: each limit from both sides.
"""

from __future__ import annotations

from dataclasses import replace
from math import radians

import pytest

from tests.unit.failsafes.failsafe_inputs import FULL, WELL, S, parameters_of
from vehicle_sim.autopilot.failsafes.arming import AutoDisarm, Readiness, reasons
from vehicle_sim.autopilot.fence.geofence import Geofence
from vehicle_sim.autopilot.interface import Power
from vehicle_sim.autopilot.modes import MODES, Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters

_MODE: dict[Personality, str] = {"px4": "AUTO.LOITER", "ardupilot": "LOITER"}


def against(
    personality: Personality, values: dict[str, float] | None = None, **changes: object
) -> tuple[str, ...]:
    """What speaks against arming a good vehicle of which these are otherwise."""
    parameters = parameters_of(personality, values or {})
    ready = Readiness(
        mode=MODES[personality][_MODE[personality]], health=WELL, power=FULL, remaining=0.98,
        gyro_bias_rad_s=0.001, accel_off_m_s2=0.05, roll_rad=0.0, pitch_rad=0.0,
        geofence=Geofence(parameters), mission_ok=True, has_mission=False, setpoints=False,
        sticks=False, sticks_lost=False, station_lost=False, battery_failed=False, calibration=(),
        needs_terrain=False, log_download=False,
    )  # fmt: skip
    return reasons(parameters, replace(ready, **changes))  # type: ignore[arg-type]  # as asked


LOW: dict[str, float] = {"BATT_LOW_VOLT": 14.0, "BATT_CRT_VOLT": 13.0, "BATT_LOW_MAH": 1000}
LAST_MAH = Power(16.0, 1.0, 4500.0, 10)


@pytest.mark.parametrize(
    ("values", "changes", "words"),
    [
        ({}, {}, ""),
        # EKF2_GYR_B_LIM 0.15 rad/s and EKF2_ABL_LIM 0.4 m/s^2: three quarters of them
        ({}, {"gyro_bias_rad_s": 0.112}, ""),
        ({}, {"gyro_bias_rad_s": 0.113}, "High Gyro Bias"),
        ({}, {"accel_off_m_s2": 0.299}, ""),
        ({}, {"accel_off_m_s2": 0.301}, "High Accelerometer Bias"),
        ({}, {"roll_rad": radians(59.9)}, ""),
        ({}, {"roll_rad": -radians(60.1)}, "Attitude failure (roll)"),
        ({}, {"pitch_rad": radians(60.1)}, "Attitude failure (pitch)"),
        ({"FD_FAIL_P": 0}, {"pitch_rad": radians(80.0)}, ""),
        ({}, {"remaining": 0.071}, ""),
        ({}, {"remaining": 0.069}, "low battery"),
        ({}, {"station_lost": True}, ""),
        ({"NAV_DLL_ACT": 1}, {"station_lost": True}, "No connection to the ground control station"),
        ({"COM_ARM_MIS_REQ": 1}, {}, "no valid mission available"),
        ({"COM_ARM_MIS_REQ": 1}, {"has_mission": True}, ""),
        ({}, {"mode": MODES["px4"]["OFFBOARD"]}, "no offboard setpoints"),
        ({}, {"mode": MODES["px4"]["OFFBOARD"], "setpoints": True}, ""),
        ({}, {"mode": MODES["px4"]["AUTO.MISSION"], "mission_ok": False}, "no valid mission"),
        ({}, {"mode": MODES["px4"]["AUTO.RTL"]}, "not in mode AUTO.RTL"),
        ({}, {"mode": MODES["px4"]["ALTCTL"]}, "No manual control input"),
        ({}, {"mode": MODES["px4"]["ALTCTL"], "sticks": True}, ""),
        ({}, {"health": replace(WELL, gps_ok=False)}, ""),
        ({"COM_ARM_WO_GPS": 0}, {"health": replace(WELL, gps_ok=False)}, "GPS fix too low"),
        ({"CAL_ACC0_ID": 0}, {}, "Accel 0 uncalibrated"),
        ({"CAL_GYRO0_ID": 0}, {}, "Gyro 0 uncalibrated"),
        ({"CAL_MAG0_ID": 0}, {}, "Compass 0 uncalibrated"),
        ({}, {"health": replace(WELL, attitude_ok=False)}, "ekf2 missing data"),
    ],
)
def test_px4s_limits(values: dict[str, float], changes: dict[str, object], words: str) -> None:
    found = against("px4", values, **changes)
    assert any(words in why for why in found) if words else found == ()


@pytest.mark.parametrize(
    ("values", "changes", "words"),
    [
        ({}, {}, ""),
        ({}, {"gyro_bias_rad_s": 0.074}, ""),
        ({}, {"gyro_bias_rad_s": 0.076}, "Gyros not healthy"),
        ({}, {"accel_off_m_s2": 0.749}, ""),  # ARMING_ACCTHRESH 0.75 m/s^2
        ({}, {"accel_off_m_s2": 0.751}, "Accels inconsistent"),
        ({}, {"roll_rad": radians(29.9)}, ""),  # ANGLE_MAX 30 degrees
        ({}, {"roll_rad": radians(30.1)}, "Leaning"),
        ({}, {"roll_rad": radians(22.0), "pitch_rad": radians(22.0)}, "Leaning"),
        ({}, {"sticks_lost": True}, "Radio failsafe on"),
        ({"FS_THR_ENABLE": 0}, {"sticks_lost": True}, ""),
        ({}, {"station_lost": True}, ""),
        ({"FS_GCS_ENABLE": 1}, {"station_lost": True}, "GCS failsafe on"),
        ({}, {"battery_failed": True}, "Battery failsafe"),
        ({"BATT_MONITOR": 0}, {"battery_failed": True}, ""),
        (LOW, {"power": replace(FULL, voltage_v=13.9)}, "low voltage failsafe"),
        (LOW, {"power": replace(FULL, voltage_v=12.9)}, "critical voltage failsafe"),
        (LOW, {"power": LAST_MAH}, "low capacity failsafe"),
        ({"BATT_ARM_VOLT": 15.0}, {"power": replace(FULL, voltage_v=15.0)}, ""),
        (
            {"BATT_ARM_VOLT": 15.0},
            {"power": replace(FULL, voltage_v=14.9)},
            "below minimum arming voltage",
        ),
        ({"BATT_ARM_MAH": 500}, {"power": LAST_MAH}, ""),
        ({"BATT_ARM_MAH": 501}, {"power": LAST_MAH}, "below minimum arming capacity"),
        ({}, {"mode": MODES["ardupilot"]["AUTO"]}, "Auto mode not armable"),
        ({"AUTO_OPTIONS": 1}, {"mode": MODES["ardupilot"]["AUTO"]}, ""),
        ({"AUTO_OPTIONS": 2}, {"mode": MODES["ardupilot"]["AUTO"]}, "Auto mode not armable"),
        ({}, {"mode": MODES["ardupilot"]["BRAKE"]}, "Brake mode not armable"),
        ({"FRAME_CLASS": 2}, {}, "Check frame class and type"),
        ({"FRAME_TYPE": 0}, {}, "Check frame class and type"),
        ({}, {"health": replace(WELL, attitude_ok=False)}, "AHRS: not healthy"),
        ({}, {"calibration": ("Compass calibration running",)}, "Compass calibration running"),
    ],
)
def test_ardupilots_limits(
    values: dict[str, float], changes: dict[str, object], words: str
) -> None:
    found = against("ardupilot", values, **changes)
    assert any(words in why for why in found) if words else found == ()


BIT_OF: dict[int, dict[str, object]] = {
    1 << 1: {"health": replace(WELL, baro_ok=False)},
    1 << 2: {"health": replace(WELL, mag_ok=False)},
    1 << 3: {"health": replace(WELL, gps_ok=False)},
    1 << 4: {"gyro_bias_rad_s": 0.1},
    1 << 6: {"sticks_lost": True},
    1 << 7: {"battery_failed": True},
    1 << 8: {"battery_failed": True},
}
"""Bits of ARMING_CHECK (AP_Arming.h) and something that each looks for."""


@pytest.mark.parametrize("bit", BIT_OF)
def test_ardupilot_makes_the_checks_of_arming_check(bit: int) -> None:
    others = sum(other for other, trouble in BIT_OF.items() if trouble != BIT_OF[bit])
    for checks, told in ((1, True), (bit, True), (others, False), (0, False)):
        assert bool(against("ardupilot", {"ARMING_CHECK": checks}, **BIT_OF[bit])) is told


@pytest.mark.parametrize("trouble", [{"accel_off_m_s2": 1.0}, {"roll_rad": 1.0}])
def test_ardupilots_inertial_checks_share_a_bit(trouble: dict[str, object]) -> None:
    assert against("ardupilot", {"ARMING_CHECK": 1 << 4}, **trouble)
    assert not against("ardupilot", {"ARMING_CHECK": 510 & ~(1 << 4)}, **trouble)


# ------------------------------------------------------------------------------ by itself


def due(parameters: Parameters, flown: bool, own_landing: bool, after_ns: int) -> bool:
    waits = AutoDisarm()
    waits.on_ground(flown, 100 * S)
    return waits.due(parameters, own_landing, 100 * S + after_ns)


@pytest.mark.parametrize(
    ("personality", "name", "flown", "seconds"),
    [
        ("px4", "COM_DISARM_LAND", True, 2),
        ("px4", "COM_DISARM_PRFLT", False, 10),
        ("ardupilot", "DISARM_DELAY", False, 10),
    ],
)
def test_it_disarms_after_com_disarm_land_com_disarm_prflt_and_disarm_delay(
    personality: Personality, name: str, flown: bool, seconds: int
) -> None:
    parameters = parameters_of(personality)
    assert not due(parameters, flown, False, seconds * S - 1)
    assert due(parameters, flown, False, seconds * S)
    for never in (0.0, -1.0) if personality == "px4" else (0.0,):
        assert not due(parameters_of(personality, {name: never}), flown, False, 1000 * S)


def test_px4_waits_com_disarm_land_after_any_landing_ardupilot_only_after_its_own() -> None:
    assert due(parameters_of("px4"), True, True, 2 * S)
    assert not due(parameters_of("px4"), True, True, 2 * S - 1)
    assert due(parameters_of("ardupilot"), True, True, S)
    assert not due(parameters_of("ardupilot"), True, False, 10 * S - 1)
    assert due(parameters_of("ardupilot"), True, False, 10 * S)
