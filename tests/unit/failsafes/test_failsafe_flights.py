"""Trouble in flight, in both personalities: what strikes, when, what is done, who may take over."""

from __future__ import annotations

from math import radians

import pytest

from tests.unit.autopilot.flight import Flight
from tests.unit.failsafes.ground import said
from vehicle_sim.autopilot.interface import AttitudeSetpoint, Landed, Result, Setpoint
from vehicle_sim.autopilot.modes import Personality

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)
S = 1_000_000_000
ACTIVE, CRITICAL, EMERGENCY = 4, 5, 6


def aloft(personality: Personality, up_m: float = 5.0, **parameters: float) -> Flight:
    flight = Flight(personality)
    for name, value in parameters.items():
        flight.vehicle.parameters.set(name, value)
    return flight.airborne(up_m)


def drain(flight: Flight, left: float) -> None:
    body = flight.vehicle.blocks.body
    body.consumed_mah = (1.0 - left) * 5000.0
    flight.fly(0.3)


# ---------------------------------------------------------------------------------- battery


def test_px4_only_warns_if_that_is_set() -> None:
    flight = aloft("px4", COM_LOW_BAT_ACT=0)
    for number, left in enumerate((0.12, 0.06, 0.04), start=1):  # G2c
        drain(flight, left)
        assert flight.texts().count("Preflight Fail: low battery") == number
        assert said(flight, "System does not support shutdown") == (left == 0.04)
    assert flight.vehicle.mode_name == "AUTO.LOITER"
    assert flight.vehicle.system_status == 4


@pytest.mark.parametrize(
    ("action", "critical", "emergency"),
    [(1, "AUTO.RTL", "AUTO.RTL"), (2, "AUTO.LAND", "AUTO.LAND"), (3, "AUTO.RTL", "AUTO.LAND")],
)
def test_px4_does_about_its_battery_what_com_low_bat_act_says(
    action: int, critical: str, emergency: str
) -> None:
    flight = aloft("px4", COM_LOW_BAT_ACT=action, COM_FAIL_ACT_T=0.0)
    drain(flight, 0.12)
    assert flight.vehicle.mode_name == "AUTO.LOITER"
    drain(flight, 0.06)
    assert flight.vehicle.mode_name == critical
    drain(flight, 0.04)
    assert flight.vehicle.mode_name == emergency
    assert said(flight, "due to critical battery level")


def test_px4_waits_com_fail_act_t_before_it_acts() -> None:
    flight = aloft("px4", COM_LOW_BAT_ACT=3, COM_FAIL_ACT_T=2.0)
    drain(flight, 0.06)
    assert flight.vehicle.mode_name == "AUTO.LOITER"
    assert flight.vehicle.system_status == CRITICAL
    flight.fly(1.5)
    assert flight.vehicle.mode_name == "AUTO.LOITER"
    flight.fly(0.5)
    assert flight.vehicle.mode_name == "AUTO.RTL"


def test_px4s_wait_comes_back_in_four_times_the_time_that_it_lasted() -> None:
    """3.6 s after it was used up 0.9 s are there for the next failsafe, of 2 s."""
    flight = aloft("px4", NAV_DLL_ACT=2, COM_FAIL_ACT_T=2.0)
    silence(flight, 11)
    assert said(flight, "in 2 seconds")
    flight.vehicle.gcs_heard(112 * S)
    flight.fly(2.0)
    assert flight.vehicle.mode_name == "AUTO.RTL"
    assert flight.vehicle.set_mode_kind("hold") is Result.ACCEPTED
    flight.fly(3.0)
    silence(flight, 11)
    assert said(flight, "in 1 seconds")
    flight.fly(0.6)
    assert flight.vehicle.mode_name == "AUTO.LOITER"
    flight.fly(0.4)
    assert flight.vehicle.mode_name == "AUTO.RTL"


def test_px4_that_took_off_with_a_low_battery_has_decided_so() -> None:
    flight = Flight("px4").boot()
    flight.vehicle.parameters.set("COM_LOW_BAT_ACT", 2)
    flight.vehicle.parameters.set("COM_FAIL_ACT_T", 0.0)
    drain(flight, 0.14)
    flight.airborne(5.0)
    assert not said(flight, "Low battery")
    drain(flight, 0.06)
    assert flight.vehicle.mode_name == "AUTO.LAND"


@pytest.mark.parametrize(
    ("name", "act"), [("BATT_LOW_MAH", "BATT_FS_LOW_ACT"), ("BATT_CRT_MAH", "BATT_FS_CRT_ACT")]
)
@pytest.mark.parametrize(
    ("action", "mode"),
    [
        (0, "GUIDED"),
        (1, "LAND"),
        (2, "RTL"),
        (3, "RTL"),
        (4, "LAND"),
        (6, "RTL"),
        (7, "BRAKE"),
    ],
)
def test_ardupilot_does_about_its_charge_what_the_parameters_say(
    name: str, act: str, action: int, mode: str
) -> None:
    flight = aloft("ardupilot", **{name: 1000.0, act: action})
    drain(flight, 0.25)
    assert flight.vehicle.mode_name == "GUIDED"
    drain(flight, 0.15)
    assert said(flight, "Battery 1 is " + ("low" if "LOW" in name else "critical"))
    assert flight.vehicle.mode_name == mode
    assert said(flight, "Battery Failsafe")  # also where nothing is done: G6


def test_ardupilot_terminates_when_told_to() -> None:
    flight = aloft("ardupilot", BATT_LOW_MAH=1000.0, BATT_FS_LOW_ACT=5)
    drain(flight, 0.15)
    assert not flight.vehicle.armed


@pytest.mark.parametrize("timer", [3, 10])
def test_ardupilots_low_voltage_must_last(timer: int) -> None:
    flight = aloft("ardupilot", BATT_FS_LOW_ACT=2, BATT_LOW_TIMER=timer)
    flight.vehicle.parameters.set("BATT_LOW_VOLT", 25.0)
    flight.fly(timer - 0.5)
    assert flight.vehicle.mode_name == "GUIDED"
    flight.fly(1.0)
    assert flight.vehicle.mode_name == "RTL"


def test_ardupilots_critical_voltage_is_worse_than_its_low_one() -> None:
    flight = aloft("ardupilot", BATT_FS_LOW_ACT=2, BATT_FS_CRT_ACT=1, BATT_LOW_TIMER=0)
    flight.vehicle.parameters.set("BATT_LOW_VOLT", 25.0)
    flight.fly(0.3)
    assert flight.vehicle.mode_name == "RTL"
    flight.vehicle.parameters.set("BATT_CRT_VOLT", 25.0)
    flight.fly(0.3)
    assert flight.vehicle.mode_name == "LAND"


# -------------------------------------------------------------------------- ground station


def silence(flight: Flight, seconds: int) -> None:
    flight.vehicle.wall(100 * S)
    flight.vehicle.gcs_heard(100 * S)
    flight.fly(0.3)
    flight.vehicle.wall((100 + seconds) * S)
    flight.fly(0.2)


@pytest.mark.parametrize(
    ("action", "mode"), [(0, "AUTO.LOITER"), (1, "AUTO.LOITER"), (2, "AUTO.RTL"), (3, "AUTO.LAND")]
)
def test_px4_without_its_ground_station(action: int, mode: str) -> None:
    flight = aloft("px4", NAV_DLL_ACT=action, COM_FAIL_ACT_T=0.0)
    assert flight.vehicle.system_status == ACTIVE
    silence(flight, 9)
    flight.fly(11.0)
    assert not said(flight, "lost"), "wall time counts"
    silence(flight, 11)
    assert said(flight, "Connection to ground station lost")
    assert said(flight, "GCS connection loss") == (action > 0)
    assert flight.vehicle.mode_name == mode
    assert (flight.vehicle.system_status == CRITICAL) == (action > 0)
    flight.vehicle.gcs_heard(112 * S)
    flight.fly(0.1)
    assert said(flight, "GCS connection regained")


@pytest.mark.parametrize("action", [5, 6])
def test_px4_ends_the_flight_for_its_ground_station_where_told_to(action: int) -> None:
    flight = aloft("px4", NAV_DLL_ACT=action)
    silence(flight, 11)
    assert flight.vehicle.motor_outputs == (0.0, 0.0, 0.0, 0.0)
    assert flight.vehicle.armed == (action == 5)  # who terminates stays armed: H5


@pytest.mark.parametrize(
    ("action", "mode"),
    [(0, "GUIDED"), (1, "RTL"), (3, "RTL"), (4, "LAND"), (5, "LAND"), (6, "RTL"), (7, "BRAKE")],
)
def test_ardupilot_without_its_ground_station(action: int, mode: str) -> None:
    flight = aloft("ardupilot", FS_GCS_ENABLE=action)
    silence(flight, 6)
    assert flight.vehicle.mode_name == mode
    assert said(flight, "GCS Failsafe") == (action > 0)
    assert (flight.vehicle.system_status == CRITICAL) == (action > 0)
    flight.vehicle.gcs_heard(107 * S)
    flight.fly(0.1)
    assert said(flight, "GCS Failsafe Cleared") == (action > 0)


@pytest.mark.parametrize(("options", "mode"), [(16, "LOITER"), (0, "RTL")])
def test_fs_options_let_the_pilot_fly_on_without_a_station(options: int, mode: str) -> None:
    flight = aloft("ardupilot", FS_GCS_ENABLE=1, FS_OPTIONS=options)
    flight.vehicle.set_mode_kind("hold")
    silence(flight, 6)
    assert flight.vehicle.mode_name == mode
    assert said(flight, "GCS Failsafe - Continuing Pilot Control") == (options == 16)


@pytest.mark.parametrize(("options", "mode"), [(8, "LAND"), (0, "RTL")])
def test_fs_options_let_a_landing_end(options: int, mode: str) -> None:
    flight = aloft("ardupilot", 15.0, FS_GCS_ENABLE=1, FS_OPTIONS=options)
    flight.vehicle.land()
    silence(flight, 6)
    assert flight.vehicle.mode_name == mode


def test_ardupilot_on_the_ground_disarms() -> None:
    flight = Flight("ardupilot").boot()
    flight.vehicle.parameters.set("FS_GCS_ENABLE", 1)
    flight.vehicle.arm(False)
    silence(flight, 6)
    assert said(flight, "GCS Failsafe - Disarming")
    assert not flight.vehicle.armed


# ----------------------------------------------------------------------------------- sticks


def hands_off(flight: Flight, away_s: float) -> None:
    """Sticks for a moment, then none."""
    vehicle = flight.vehicle
    vehicle.wall(50 * S)
    vehicle.joystick(0, 0, 500, 0, 50 * S)
    flight.fly(0.3)
    vehicle.wall(50 * S + int(away_s * S))
    flight.fly(0.2)


@pytest.mark.parametrize(
    ("action", "mode"), [(1, "AUTO.LOITER"), (2, "AUTO.RTL"), (3, "AUTO.LAND")]
)
def test_px4_without_sticks_that_it_had(action: int, mode: str) -> None:
    flight = aloft("px4", NAV_RCL_ACT=action, COM_FAIL_ACT_T=0.0)
    flight.vehicle.set_mode_kind("position")
    hands_off(flight, 0.4)
    assert not said(flight, "manual control loss")
    hands_off(flight, 0.6)
    assert said(flight, "due to manual control loss")
    assert flight.vehicle.mode_name == mode


@pytest.mark.parametrize(("exceptions", "mode"), [(0, "AUTO.RTL"), (2, "AUTO.LOITER")])
def test_px4_goes_on_without_sticks_where_com_rcl_except_says_so(
    exceptions: int, mode: str
) -> None:
    flight = aloft("px4", COM_RCL_EXCEPT=exceptions, COM_FAIL_ACT_T=0.0)
    hands_off(flight, 1.0)
    assert flight.vehicle.mode_name == mode


def test_px4_that_never_had_sticks_misses_none() -> None:
    flight = aloft("px4", COM_FAIL_ACT_T=0.0)
    flight.fly(5.0)
    assert flight.vehicle.mode_name == "AUTO.LOITER"


@pytest.mark.parametrize(
    ("action", "mode"),
    [(0, "LOITER"), (1, "RTL"), (3, "LAND"), (4, "RTL"), (5, "LAND"), (6, "RTL"), (7, "BRAKE")],
)
def test_ardupilot_without_sticks_that_it_had(action: int, mode: str) -> None:
    """Recorded of FS_THR_ENABLE = 1 with no receiver: 0.96 s after the last override (B7)."""
    flight = aloft("ardupilot", FS_THR_ENABLE=action, SIM_RC_FAIL=1)
    flight.vehicle.set_mode_kind("hold")
    hands_off(flight, 0.9)
    assert flight.vehicle.mode_name == "LOITER"
    assert not said(flight, "Radio Failsafe")
    hands_off(flight, 1.1)
    assert flight.vehicle.mode_name == mode
    assert said(flight, "Radio Failsafe") == (action > 0)
    assert (flight.vehicle.system_status == CRITICAL) == (action > 0)
    flight.vehicle.joystick(0, 0, 500, 0, flight.vehicle.state.sense().wall_ns)
    flight.fly(0.3)
    assert said(flight, "Radio Failsafe Cleared") == (action > 0)
    assert flight.vehicle.mode_name == mode


@pytest.mark.parametrize("action", [0, 1, 3])
def test_ardupilots_receiver_has_the_sticks_after_overrides(action: int) -> None:
    """As recorded (B5): its throttle at the bottom sinks a LOITER by 2.5 m/s, all the way down."""
    flight = aloft("ardupilot", 12.0, FS_THR_ENABLE=action)
    flight.vehicle.set_mode_kind("hold")
    hands_off(flight, 2.9)
    assert flight.up_m == pytest.approx(12.0, abs=0.5)
    before = len(flight.texts())
    hands_off(flight, 3.1)
    flight.fly(3.0)
    assert flight.vehicle.truth.v_ned[2] == pytest.approx(2.5, abs=0.1)
    flight.fly(10.0, lambda: flight.landed() is Landed.ON_GROUND)
    assert flight.vehicle.mode_name == "LOITER"
    assert flight.vehicle.armed
    assert flight.texts()[before:] == []


@pytest.mark.parametrize(
    ("options", "mode", "text"),
    [
        (4, "GUIDED", "Radio Failsafe - Continuing Guided Mode"),
        (0, "RTL", "Radio Failsafe"),
    ],
)
def test_fs_options_let_guided_go_on_without_sticks(options: int, mode: str, text: str) -> None:
    flight = aloft("ardupilot", FS_OPTIONS=options, SIM_RC_FAIL=1)
    hands_off(flight, 6.0)
    assert flight.vehicle.mode_name == mode
    assert text in flight.texts()


def test_ardupilot_flown_from_outside_goes_on_with_its_receiver() -> None:
    """Overrides end in GUIDED: nothing strikes, and the throttle at the bottom is not flown."""
    flight = aloft("ardupilot", FS_OPTIONS=0)
    hands_off(flight, 6.0)
    flight.fly(3.0)
    assert flight.vehicle.mode_name == "GUIDED"
    assert not said(flight, "Radio Failsafe")
    assert flight.up_m == pytest.approx(5.0, abs=0.5)


# --------------------------------------------------------------------------------- position


def test_px4_descends_without_a_position_and_goes_back_when_it_returns() -> None:
    flight = aloft("px4", 18.0)
    sensed = flight.vehicle.blocks.sensed
    sensed.gps_lost = True
    flight.fly(4.0)
    assert flight.vehicle.mode_name == "AUTO.LOITER"
    flight.fly(2.5)
    assert said(flight, "triggering Descend")
    assert flight.vehicle.mode_name == "AUTO.LAND"
    assert flight.vehicle.system_status == EMERGENCY
    up_m = flight.up_m
    flight.fly(2.0)
    assert flight.up_m < up_m - 1.0
    sensed.gps_lost = False
    flight.fly(2.0)
    assert flight.vehicle.mode_name == "AUTO.LOITER"
    flight.fly(3.0)
    assert flight.speed_m_s < 0.5


def test_px4_takes_up_what_its_lost_position_had_overruled() -> None:
    flight = aloft("px4", 20.0, NAV_DLL_ACT=2, COM_FAIL_ACT_T=0.0)
    silence(flight, 11)
    assert flight.vehicle.mode_name == "AUTO.RTL"
    flight.vehicle.blocks.sensed.gps_lost = True
    flight.fly(6.5)
    assert flight.vehicle.mode_name == "AUTO.LAND"
    flight.vehicle.blocks.sensed.gps_lost = False
    flight.fly(2.0)
    assert flight.vehicle.mode_name == "AUTO.RTL"
    assert flight.vehicle.system_status == CRITICAL


@either
def test_a_descent_without_a_position_ends_on_the_ground(personality: Personality) -> None:
    flight = aloft(personality, 8.0)
    flight.vehicle.blocks.sensed.gps_lost = True
    flight.fly(60.0, lambda: flight.landed() is Landed.ON_GROUND)
    flight.fly(12.0, lambda: not flight.vehicle.armed)
    assert flight.vehicle.mode_name in ("AUTO.LOITER", "LAND")


@pytest.mark.parametrize(("choice", "mode"), [(0, "ALTCTL"), (1, "AUTO.LAND")])
def test_px4_in_position_mode_without_a_position(choice: int, mode: str) -> None:
    flight = aloft("px4", 15.0, COM_POSCTL_NAVL=choice)
    flight.vehicle.joystick(0, 0, 500, 0, flight.vehicle.time_ns)
    flight.vehicle.set_mode_kind("position")
    flight.vehicle.blocks.sensed.gps_lost = True
    for tick in range(70):
        flight.vehicle.joystick(0, 0, 500, 0, flight.vehicle.time_ns)
        flight.fly(0.1)
        if tick == 30:
            assert flight.vehicle.mode_name == "POSCTL"
    assert flight.vehicle.mode_name == mode


def test_px4_trusts_its_position_as_far_as_com_pos_fs_eph() -> None:
    flight = aloft("px4", 15.0, COM_POS_FS_EPH=1.0)
    flight.vehicle.blocks.sensed.gps_lost = True
    flight.fly(3.5)
    assert flight.vehicle.mode_name == "AUTO.LAND"


@pytest.mark.parametrize(
    ("action", "mode"), [(0, "GUIDED"), (1, "LAND"), (2, "ALT_HOLD"), (3, "LAND")]
)
def test_ardupilot_without_a_position(action: int, mode: str) -> None:
    flight = aloft("ardupilot", 15.0, FS_EKF_ACTION=action)
    sensed = flight.vehicle.blocks.sensed
    sensed.gps_lost = True
    flight.fly(5.5)
    assert flight.vehicle.mode_name == "GUIDED"
    flight.fly(1.5)
    assert said(flight, "EKF variance")
    assert flight.vehicle.mode_name == mode
    sensed.gps_lost = False
    flight.fly(5.0)
    assert said(flight, "EKF Failsafe Cleared")
    assert flight.vehicle.mode_name == mode


@pytest.mark.parametrize(("action", "mode"), [(1, "ALT_HOLD"), (3, "LAND")])
def test_ardupilot_in_a_mode_without_position(action: int, mode: str) -> None:
    flight = aloft("ardupilot", 15.0, FS_EKF_ACTION=action)
    flight.vehicle.set_mode_kind("altitude")
    flight.vehicle.blocks.sensed.gps_lost = True
    flight.fly(8.0)
    assert flight.vehicle.mode_name == mode


def test_ardupilot_does_not_look_at_its_estimate_with_fs_ekf_thresh_0() -> None:
    flight = aloft("ardupilot", 15.0, FS_EKF_THRESH=0.0)
    flight.vehicle.blocks.sensed.gps_lost = True
    flight.fly(8.0)
    assert flight.vehicle.mode_name == "GUIDED"


# ------------------------------------------------------------------------------- setpoints


@pytest.mark.parametrize(
    ("action", "mode"),
    [
        (0, "POSCTL"),
        (1, "ALTCTL"),
        (2, "MANUAL"),
        (3, "AUTO.RTL"),
        (4, "AUTO.LAND"),
        (5, "AUTO.LOITER"),
    ],
)
def test_px4_without_its_setpoints_acts_at_once(action: int, mode: str) -> None:
    flight = aloft("px4", COM_OBL_RC_ACT=action)
    flight.stream(Setpoint(v_ned=(0.5, 0.0, 0.0)), 1.2)
    flight.vehicle.set_mode_kind("guided")
    flight.fly(1.2)
    assert flight.vehicle.mode_name == mode
    assert flight.vehicle.system_status == CRITICAL


# ----------------------------------------------------------------------- loss of control


def lean(flight: Flight, seconds: float, roll_deg: float = 75.0) -> None:
    """OFFBOARD by attitude, far over."""
    half = radians(roll_deg) / 2.0
    q = (1.0 - half * half / 2.0 + half**4 / 24.0, half - half**3 / 6.0 + half**5 / 120.0, 0.0, 0.0)
    size = (q[0] * q[0] + q[1] * q[1]) ** 0.5
    level = AttitudeSetpoint((1.0, 0.0, 0.0, 0.0), None, 0.6)
    over = AttitudeSetpoint((q[0] / size, q[1] / size, 0.0, 0.0), None, 0.6)
    for tick in range(round((1.2 + seconds) * 20)):
        flight.vehicle.set_attitude(level if tick < 24 else over)
        if tick == 22:
            flight.vehicle.set_mode_kind("guided")
        flight.fly(0.05)


def test_px4_tells_of_an_upset_and_ends_the_flight_only_without_the_breaker() -> None:
    told = aloft("px4", 22.0)
    lean(told, 1.0)
    assert said(told, "Attitude failure (roll)")
    assert told.vehicle.system_status != 8
    ended = aloft("px4", 22.0, CBRK_FLIGHTTERM=0)
    lean(ended, 1.0)
    assert ended.vehicle.motor_outputs == (0.0, 0.0, 0.0, 0.0)
    assert ended.vehicle.system_status == 8


@pytest.mark.parametrize(("name", "value"), [("FD_FAIL_R", 0.0), ("FD_FAIL_R_TTRI", 4.0)])
def test_px4_calls_no_upset_what_the_parameters_do_not(name: str, value: float) -> None:
    flight = aloft("px4", 22.0, **{name: value})
    lean(flight, 1.0)
    assert not said(flight, "Attitude failure (roll)")


@pytest.mark.parametrize(
    ("action", "mode"), [(0, "AUTO.LOITER"), (1, "AUTO.LOITER"), (2, "AUTO.LAND"), (3, "AUTO.RTL")]
)
def test_px4_with_a_dead_motor(action: int, mode: str) -> None:
    flight = aloft("px4", 22.0, COM_ACT_FAIL_ACT=action, COM_FAIL_ACT_T=0.0)
    flight.vehicle.blocks.body.health_2 = 0.0
    flight.fly(0.4)
    assert said(flight, "Motor 2 failure detected")
    assert flight.vehicle.mode_name == mode


def test_px4_ends_the_flight_with_a_dead_motor_where_told_to() -> None:
    flight = aloft("px4", 22.0, COM_ACT_FAIL_ACT=4)
    flight.vehicle.blocks.body.health_2 = 0.0
    flight.fly(0.4)
    assert flight.vehicle.system_status == 8


@pytest.mark.parametrize(
    ("name", "value"), [("FD_ACT_EN", 0), ("FD_ACT_MOT_TOUT", 5000), ("FD_ACT_MOT_THR", 1.0)]
)
def test_px4_finds_dead_motors_as_the_parameters_say(name: str, value: float) -> None:
    flight = aloft("px4", 22.0, **{name: value})
    flight.vehicle.blocks.body.health_2 = 0.0
    flight.fly(0.4)
    assert not said(flight, "Motor 2")


@pytest.mark.parametrize("check", [1, 0])
def test_ardupilot_that_has_crashed_disarms(check: int) -> None:
    flight = aloft("ardupilot", 6.0, FS_CRASH_CHECK=check)
    flight.vehicle.blocks.body.health_1 = 0.0
    flight.fly(12.0)
    assert flight.vehicle.armed == (check == 0)
    assert said(flight, "Crash: Disarming: AngErr=") == (check == 1)


# ------------------------------------------------------------------- precedence, takeover


@either
def test_the_worse_of_two_wins_and_the_lesser_is_only_told(personality: Personality) -> None:
    if personality == "px4":
        flight = aloft("px4", NAV_DLL_ACT=2, COM_LOW_BAT_ACT=2, COM_FAIL_ACT_T=0.0)
        left, landing, lesser = 0.06, "AUTO.LAND", "Connection to ground station lost"
    else:
        flight = aloft(
            "ardupilot", FS_GCS_ENABLE=1, BATT_FS_LOW_ACT=1, BATT_LOW_MAH=1000.0, FS_OPTIONS=0
        )
        left, landing, lesser = 0.1, "LAND", "GCS Failsafe"
    drain(flight, left)
    assert flight.vehicle.mode_name == landing
    silence(flight, 11)
    assert said(flight, lesser)
    assert flight.vehicle.mode_name == landing


@either
def test_an_operator_takes_over_and_a_new_trouble_acts_anew(personality: Personality) -> None:
    if personality == "px4":
        flight = aloft("px4", NAV_DLL_ACT=2, COM_LOW_BAT_ACT=3, COM_FAIL_ACT_T=0.0)
        home, left = "AUTO.RTL", 0.06
    else:
        flight = aloft("ardupilot", FS_GCS_ENABLE=1, BATT_FS_LOW_ACT=2, BATT_LOW_MAH=1000.0)
        home, left = "RTL", 0.1
    silence(flight, 11)
    assert flight.vehicle.mode_name == home
    assert flight.vehicle.system_status == CRITICAL
    assert flight.vehicle.set_mode_kind("hold") is Result.ACCEPTED
    flight.fly(1.0)
    assert flight.vehicle.mode_name != home
    assert flight.vehicle.system_status == 4
    drain(flight, left)
    assert flight.vehicle.mode_name == home
