"""What every parameter of the ardupilot personality changes."""

from __future__ import annotations

from math import inf, radians

import pytest

from tests.unit.parameters import ardupilot_scripts as own
from tests.unit.parameters import scripts as fly
from tests.unit.parameters.probing import UP_M, Case, about, climb_m_s, flat_m_s, hand, itself, near
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.plant.faults import AccelBias
from vehicle_sim.wire import messages as m

S = 1_000_000_000
HOME = (0.0, 0.0, 0.0)

_FENCED = {"FENCE_ENABLE": 1.0}
_FOLLOW = {"FOLL_OFS_X": -10.0}
CASES: tuple[Case, ...] = (
    # Battery.
    Case(
        "BATT_ARM_MAH",
        {0: False, 4900: True},
        fly.against_arming("minimum arming capacity", own.drained(200.0)),
    ),
    Case("BATT_ARM_VOLT", {0: False, 20.0: True}, fly.against_arming("minimum arming voltage")),
    Case("BATT_CAPACITY", {2000: 50, 4000: 75}, own.percent_left),
    Case("BATT_CRT_MAH", {0.0: "FINE", 2000.0: "CRITICAL"}, own.charge(15.0, 4000.0)),
    Case("BATT_CRT_VOLT", {0.0: "FINE", 14.0: "CRITICAL"}, own.charge(13.0, 0.0)),
    Case("BATT_LOW_MAH", {0.0: "FINE", 2000.0: "LOW"}, own.charge(15.0, 4000.0)),
    Case("BATT_LOW_VOLT", {10.5: "FINE", 14.0: "LOW"}, own.charge(13.0, 0.0)),
    Case(
        "BATT_FS_CRT_ACT",
        {0: "GUIDED", 1: "LAND", 2: "RTL", 7: "BRAKE"},
        fly.mode_after(0.5, own.drained(4000.0)),
        {"BATT_CRT_MAH": 2000.0},
    ),
    Case(
        "BATT_FS_LOW_ACT",
        {0: "GUIDED", 1: "LAND", 2: "RTL", 7: "BRAKE"},
        fly.mode_after(0.5, own.drained(4000.0)),
        {"BATT_LOW_MAH": 2000.0},
    ),
    Case(
        "BATT_LOW_TIMER",
        itself(0.25, 2, 6),
        fly.seconds_until(own.low_voltage, fly.leaves_mode("GUIDED")),
        {"BATT_FS_LOW_ACT": 1.0},
    ),
    Case("BATT_MONITOR", {0: False, 4: True}, own.volts_told),
    # Silence.
    Case(
        "FS_GCS_ENABLE",
        {0: "GUIDED", 1: "RTL", 5: "LAND", 7: "BRAKE"},
        fly.mode_after(6.0, fly.station_silent),
    ),
    Case(
        "FS_GCS_TIMEOUT",
        itself(0.2, 3.0, 8.0),
        fly.seconds_until(fly.station_silent, fly.leaves_mode("GUIDED")),
        {"FS_GCS_ENABLE": 1.0},
    ),
    Case(
        "FS_OPTIONS",
        {0: "RTL", 16: "LOITER"},
        fly.mode_after(6.0, own.station_silent_in("LOITER")),
        {"FS_GCS_ENABLE": 1.0},
    ),
    Case(
        "FS_THR_ENABLE",
        {0: "LOITER", 1: "RTL", 3: "LAND"},
        fly.mode_after(6.0, own.sticks_then_silent("LOITER")),
        {"SIM_RC_FAIL": 1.0},
    ),
    Case("RC_OVERRIDE_TIME", itself(0.15, 1.0, 3.0), own.override_gone_s),
    Case(
        "RC_FS_TIMEOUT",  # B7: 0.96 s after the last override, where there is no receiver
        itself(0.15, 1.0, 3.0),
        fly.seconds_until(own.sticks_then_silent("LOITER"), fly.leaves_mode("LOITER")),
        {"SIM_RC_FAIL": 1.0},
    ),
    Case(
        "GUID_TIMEOUT",
        {1.0: near(1.6, 0.4), 4.0: near(4.6, 0.4)},
        fly.seconds_until(own.velocity_then_silent, own.brakes),
    ),
    Case(
        "GUID_OPTIONS",
        {0: near(1.2, 0.4), 8: near(4.4, 0.8)},
        fly.attitude_climb,
        {"WPNAV_ACCEL_Z": 250.0},
    ),
    # Position and crashes.
    Case(
        "FS_EKF_ACTION",
        {0: "GUIDED", 1: "LAND", 2: "ALT_HOLD"},
        fly.mode_after(8.0, own.position_lost),
    ),
    Case("FS_EKF_THRESH", {0.0: "GUIDED", 0.8: "LAND"}, fly.mode_after(8.0, own.position_lost)),
    Case("FS_CRASH_CHECK", {0: True, 1: False}, own.crashed),
    # Arming.
    Case(
        "ARMING_ACCTHRESH",
        {0.3: True, 2.0: False},
        fly.against_arming(
            "Accels inconsistent", lambda f: f.vehicle.inject(AccelBias((0.0, 0.0, 1.0)))
        ),
    ),
    Case("ARMING_CHECK", {1: True, 4: False}, fly.against_arming("Baro", own.no_baro)),
    Case("ARMING_RUDDER", {0: False, 2: True}, own.armed_by_gesture),
    Case("AUTO_OPTIONS", {1: False, 3: True}, own.takes_off_by_itself),
    Case("FRAME_CLASS", {1: False, 2: True}, fly.against_arming("Check frame class")),
    Case("FRAME_TYPE", {1: False, 0: True}, fly.against_arming("Check frame class")),
    Case("DISARM_DELAY", {3: near(3.0, 0.15), 10: near(10.0, 0.15), 0: inf}, fly.disarms_idle_s),
    Case("MOT_SPIN_ARM", itself(0.01, 0.08, 0.15), own.idle_speed),
    Case(
        "MOT_SPOOL_TIME",
        # After the delay of 2 s, and with 0.05 s until the throttle is open; asked at 10 Hz.
        {0.05: near(2.15, 0.12), 2.0: near(4.1, 0.12)},
        fly.lifts_off_after_s,
        also={"TKOFF_SLEW_TIME": 0.25, "MOT_THST_HOVER": 0.2},
    ),
    Case(
        "TKOFF_SLEW_TIME",
        {2.0: near(2.5 + 0.39 * 2.0, 0.12), 5.0: near(4.45, 0.12)},
        fly.lifts_off_after_s,
        also={"MOT_THST_HOVER": 0.39},
    ),
    # Fence and rally points.
    Case(
        "FENCE_ACTION",
        {0: "ALT_HOLD", 1: "RTL", 2: "LAND", 4: "BRAKE"},
        fly.mode_after(0.0, own.climbs_out),
        {"FENCE_ALT_MAX": 15.0},
    ),
    Case("FENCE_ALT_MAX", {50.0: 1, 100.0: 0}, own.fence_kinds(60.0, 0.0), _FENCED),
    Case(
        "FENCE_ALT_MIN",
        {-10.0: 0, 10.0: 8},
        own.fence_kinds(5.0, 0.0),
        {**_FENCED, "FENCE_TYPE": 15.0},
    ),
    Case("FENCE_ENABLE", {0: 0, 1: 2}, own.fence_kinds(60.0, 400.0)),
    Case(
        "FENCE_MARGIN",
        {2.0: 8, 10.0: 0},
        own.fence_kinds(5.0, 0.0),
        {**_FENCED, "FENCE_TYPE": 15.0, "FENCE_ALT_MIN": 40.0},
    ),
    Case(
        "FENCE_OPTIONS",
        {1: Result.FAILED, 0: Result.ACCEPTED},
        own.leaves_recovery,
        {"FENCE_ALT_MAX": 15.0},
    ),
    Case("FENCE_RADIUS", {100.0: 2, 300.0: 0}, own.fence_kinds(60.0, 200.0), _FENCED),
    Case("FENCE_TYPE", {2: 2, 1: 1, 3: 3}, own.fence_kinds(150.0, 400.0), _FENCED),
    Case("RALLY_INCL_HOME", {0: 60.0, 1: 0.0}, own.returns_to(10.0, 60.0)),
    Case(
        "RALLY_LIMIT_KM",
        {0.3: 0.0, 1.0: 600.0},
        own.returns_to(200.0, 600.0),
        {"RALLY_INCL_HOME": 0.0},
    ),
    # Flights.
    Case("CAM_EXPOSURE_S", itself(0.1, 0.5, 3.0), fly.exposure_s),
    Case("LAND_ALT_LOW", {500: near(1.5, 0.15), 1000: near(0.5, 0.15)}, fly.sink_at(7.0)),
    Case("LAND_SPEED", {50: near(0.5, 0.1), 120: near(1.2, 0.1)}, fly.sink_at(3.0)),
    Case(
        "LAND_SPEED_HIGH",
        {0: near(1.5, 0.15), 80: near(0.8, 0.15)},
        fly.sink_at(7.0),
        {"LAND_ALT_LOW": 500.0},
    ),
    Case("MIS_RESTART", {0: 2, 1: 1}, own.mission_goes_on_at),
    Case("PILOT_TKOFF_ALT", {250: near(2.5, 0.3), 600: near(6.0, 0.3)}, fly.take_off_height_m),
    Case("RTL_ALT", {1500: near(15.0, 0.6), 2000: near(20.0, 0.6)}, fly.return_top_m(25.0)),
    Case(
        "RTL_ALT_FINAL",
        {0: near(0.0, 0.3), 500: near(5.0, 0.5)},
        own.ends_return_m,
        {"RTL_ALT": 1200.0, "WPNAV_SPEED_DN": 300.0, "LAND_SPEED": 200.0},
    ),
    Case("RTL_CLIMB_MIN", {0: 15.0, 1000: pytest.approx(24.0)}, own.return_from(50.0, 14.0)),
    Case("RTL_CONE_SLOPE", {0.0: 15.0, 1.0: pytest.approx(6.0)}, own.return_from(6.0, 2.0)),
    Case(
        "RTL_LOIT_TIME",
        {1000: near(1.0, 2.0), 6000: near(6.0, 2.0)},
        fly.return_waits_s,
        {"RTL_ALT": 1000.0},
    ),
    Case(
        "RTL_SPEED",
        {0: near(5.0, 0.5), 200: near(2.0, 0.3)},
        fly.return_m_s,
        {"WPNAV_SPEED": 500.0},
    ),
    Case("WP_YAW_BEHAVIOR", {0: False, 2: True}, own.nose_on_leg),
    Case(
        "WPNAV_ACCEL", {100: near(1.0, 0.1), 400: near(4.0, 0.1)}, fly.acceleration_m_s2(60.0, UP_M)
    ),
    Case(
        # The acceleration a grows by the jerk J = 5 m/s^3 up to A, or as long as it is less than
        # J / A (2.5 m/s - a^2 / 2 J): for A = 4 m/s^2 up to 2.4.
        "WPNAV_ACCEL_Z",
        {100: near(1.0, 0.1), 200: near(2.0, 0.1), 400: near(2.4, 0.1)},
        fly.acceleration_m_s2(0.0, 60.0),
    ),
    Case("WPNAV_RADIUS", {200: near(1.7, 0.5), 600: near(5.7, 0.5)}, fly.reached_at_m),
    Case("WPNAV_SPEED", {300: near(3.0, 0.4), 800: near(8.0, 0.4)}, fly.cruise_m_s),
    Case("WPNAV_SPEED_DN", {80: near(0.8, 0.2), 150: near(1.5, 0.2)}, fly.descent_m_s_to(2.0)),
    Case("WPNAV_SPEED_UP", {100: near(1.0, 0.2), 250: near(2.5, 0.3)}, fly.climb_m_s_to(30.0)),
    # Sticks.
    Case(
        "ACRO_RP_RATE",
        {90: pytest.approx(radians(90.0)), 360: pytest.approx(radians(360.0))},
        fly.feels(lambda f: f.rates(hand(roll=1.0))[0]),
    ),
    Case(
        "ACRO_Y_RATE",
        {90: pytest.approx(radians(90.0)), 202.5: pytest.approx(radians(202.5))},
        fly.feels(lambda f: f.rates(hand(yaw=1.0))[2]),
    ),
    Case("ANGLE_MAX", {2000: near(20.0, 1.0), 4500: near(45.0, 1.0)}, fly.lean_deg),
    Case(
        "LOIT_ACC_MAX",
        {200: pytest.approx(2.0), 500: pytest.approx(5.0)},
        fly.feels(lambda f: f.accel_m_s2),
    ),
    Case(
        "LOIT_SPEED",
        {300: near(3.0, 0.5), 600: near(6.0, 0.5)},
        fly.by_hand("LOITER", 5.0, flat_m_s, forward=1000),
    ),
    Case("MOT_THST_HOVER", itself(0.02, 0.3, 0.5), fly.thrust(hand())),
    Case(
        "PILOT_ACCEL_Z",
        {100: near(1.0, 0.1), 400: near(4.0, 0.1)},
        own.hand_accel_m_s2,
        {"PILOT_SPEED_UP": 500.0},
    ),
    Case(
        "PILOT_SPEED_DN",
        {0: pytest.approx(-2.5), 100: pytest.approx(-1.0)},
        fly.feels(lambda f: f.climb(hand(throttle=0.0))),
    ),
    Case(
        "PILOT_SPEED_UP",
        {100: near(1.0, 0.2), 250: near(2.5, 0.3)},
        fly.by_hand("ALT_HOLD", 3.0, climb_m_s, up=1000),
    ),
    Case(
        "PILOT_Y_RATE",
        {45: pytest.approx(radians(45.0)), 90: pytest.approx(radians(90.0))},
        fly.feels(lambda f: f.turn(hand(yaw=1.0))),
    ),
    Case("THR_DZ", {100: 0.0, 0: near(0.5, 0.1)}, fly.feels(lambda f: f.climb(hand(throttle=0.6)))),
    Case("RCMAP_PITCH", {1: -79, 2: 79}, own.radio("pitch")),
    Case("RCMAP_ROLL", {1: 79, 2: -79}, own.radio("roll")),
    Case("RCMAP_THROTTLE", {1: 90, 3: 29}, own.radio("throttle")),
    Case("RCMAP_YAW", {1: 79, 4: 38}, own.radio("yaw")),
    Case("FLTMODE1", {5: "LOITER", 9: "LAND"}, own.switched(1100)),
    Case("FLTMODE2", {5: "LOITER", 9: "LAND"}, own.switched(1300)),
    Case("FLTMODE3", {5: "LOITER", 9: "LAND"}, own.switched(1400)),
    Case("FLTMODE4", {5: "LOITER", 9: "LAND"}, own.switched(1550)),
    Case("FLTMODE5", {5: "LOITER", 9: "LAND"}, own.switched(1700)),
    Case("FLTMODE6", {5: "LOITER", 9: "LAND"}, own.switched(1900)),
    Case(
        "FLTMODE_CH",
        {0: "GUIDED", 5: "LOITER", 6: "LAND"},
        own.switched(1100),
        {"FLTMODE1": 5.0, "FLTMODE4": 9.0, "FLTMODE3": 9.0},
    ),
    Case("SYSID_MYGCS", {255: False, 250: True}, own.obeys, {"SYSID_ENFORCE": 1.0}),
    Case("SYSID_ENFORCE", {0: True, 1: False}, own.obeys),
    # Circles and leaders.
    Case("CIRCLE_RADIUS", {1000: near(10.0, 1.0), 2000: near(20.0, 1.5)}, own.circle_m),
    Case("CIRCLE_RATE", {10: near(10.0, 1.5), 20: near(20.0, 2.0)}, own.circle_deg_s),
    Case(
        "CIRCLE_OPTIONS", {1: (False, False), 2: (True, False), 4: (False, True)}, own.circle_nose
    ),
    Case("FOLL_ALT_TYPE", {0: near(16.0, 0.5), 1: near(30.0, 0.5)}, own.leader_height_m),
    Case(
        "FOLL_DIST_MAX",
        {10.0: near(-80.0, 9.0), 100.0: near(-10.0, 1.5)},
        own.beside_leader(0),
        _FOLLOW,
    ),
    Case("FOLL_ENABLE", {0: Result.FAILED, 1: Result.ACCEPTED}, own.follows_at_all),
    Case("FOLL_OFS_TYPE", {0: near(-10.0, 1.5), 1: near(0.0, 1.5)}, own.beside_leader(0), _FOLLOW),
    Case("FOLL_OFS_X", itself(1.5, -10.0, -20.0), own.beside_leader(0), {"FOLL_OFS_TYPE": 0.0}),
    Case("FOLL_OFS_Y", itself(1.5, -10.0, -20.0), own.beside_leader(1), {"FOLL_OFS_TYPE": 0.0}),
    Case("FOLL_OFS_Z", itself(0.7, -5.0, -10.0), own.beside_leader(2)),
    Case(
        "FOLL_SYSID",
        {0: near(-10.0, 1.5), 9: near(-80.0, 9.0)},
        own.beside_leader(0),
        {**_FOLLOW, "FOLL_OFS_TYPE": 0.0},
    ),
    Case(
        "FOLL_YAW_BEHAVE",
        {1: "south", 2: "east", 3: "north"},
        own.follow_heading,
        {"FOLL_OFS_X": 15.0, "FOLL_OFS_TYPE": 0.0},
    ),
    # Control loops.
    Case(
        "ATC_RATE_R_MAX",
        {0: near(4.0, 0.6), 100: near(1.9, 0.6)},
        fly.fastest("rate_x", fly.tips(fly.turned(roll=90.0)), 0.4),
    ),
    Case(
        "ATC_RATE_P_MAX",
        {0: near(4.0, 0.6), 100: near(1.9, 0.6)},
        fly.fastest("rate_y", fly.tips(fly.turned(pitch=90.0)), 0.4),
    ),
    Case(
        "ATC_RATE_Y_MAX",
        {0: near(1.6, 0.3), 40: near(0.7, 0.2)},
        fly.fastest("rate_z", fly.tips(fly.turned(yaw=90.0)), 0.8),
    ),
    Case(
        "ATC_RAT_RLL_P",
        {0.07: about(0.226), 0.135: about(0.424)},
        fly.answer("rate_x", fly.spins((1.0, 0.0, 0.0)), 0.04),
    ),
    Case(
        "ATC_RAT_PIT_P",
        {0.07: about(0.229), 0.135: about(0.423)},
        fly.answer("rate_y", fly.spins((0.0, 1.0, 0.0)), 0.04),
    ),
    Case(
        "ATC_RAT_YAW_P",
        {0.1667: about(0.024), 0.3333: about(0.043)},
        fly.answer("rate_z", fly.spins((0.0, 0.0, 0.1)), 0.1),
    ),
    Case(
        "ATC_ANG_RLL_P",
        {3.0: about(0.052), 6.0: about(0.099)},
        fly.answer("qx", fly.tips(fly.turned(roll=20.0)), 0.12),
    ),
    Case(
        "ATC_ANG_PIT_P",
        {3.0: about(0.052), 6.0: about(0.099)},
        fly.answer("qy", fly.tips(fly.turned(pitch=20.0)), 0.12),
    ),
    Case(
        "ATC_ANG_YAW_P",
        {3.0: about(0.036), 9.0: about(0.078)},
        fly.answer("qz", fly.tips(fly.turned(yaw=20.0)), 0.3),
    ),
    Case("ATC_SLEW_YAW", {3000: near(30.0, 4.0), 6000: near(60.0, 6.0)}, fly.turn_deg_s),
    Case(
        "PSC_JERK_XY",  # times 0.1 s
        {5.0: near(0.5, 0.1), 15.0: near(1.5, 0.1)},
        fly.acceleration_after(0.1),
    ),
    Case(
        # By integrating the loops, as PSC_VELXY_P below.
        "PSC_POSXY_P",
        {0.5: about(0.243), 1.0: about(0.469)},
        fly.answer("pos_n", fly.reference(ref_n=1.0, goal_n=1.0), 1.0),
    ),
    Case(
        # By integrating the loops: D of 0.25 takes a fifth of P and I, attitude 1 / 0.15 s.
        "PSC_VELXY_P",
        {1.2: about(0.358), 3.0: about(0.718)},
        fly.answer("vel_n", fly.reference(ref_n=1.0, goal_n=1.0), 0.5),
    ),
    Case(
        "PSC_POSZ_P",
        {0.5: about(0.265), 1.0: about(0.53)},
        fly.answer("pos_d", fly.reference(ref_d=1.0, goal_d=1.0), 1.0, hover_s=6.0),
    ),
    Case(
        "PSC_VELZ_P",
        {2.0: about(0.349), 6.0: about(0.705)},
        fly.answer("vel_d", fly.reference(ref_d=1.0, goal_d=1.0), 0.5, hover_s=2.0),
    ),
    Case(
        # What the two loops come to (position 1/s, velocity 2/s) with an attitude 0.18 s late, in
        # the drag of an s500 and a wind that rises by exp(-t / s).
        "PSC_VELXY_I",
        {0.1: about(-0.176), 1.0: about(-1.287)},
        fly.learns("int_n", 3.0, wind_n=8.0),
    ),
    Case("PSC_ACCZ_I", {0.2: about(-0.116), 2.0: about(-0.964)}, fly.lifts(3.0, 0.8)),
    # Messages and logs.
    Case("LOG_BACKEND_TYPE", {0: (False, False, False), 1: (False, True, False)}, fly.logs_written),
    Case("LOG_DISARMED", {0: (False, True, False), 1: (True, True, True)}, fly.logs_written),
    Case("SR0_EXTRA1", {0: 0.0, 4: 4.0}, fly.rate_hz(m.Attitude)),
    Case("SR0_EXTRA2", {0: 0.0, 4: 4.0}, fly.rate_hz(m.VfrHud)),
    Case("SR0_EXTRA3", {0: 0.0, 4: 4.0}, fly.rate_hz(m.BatteryStatus)),
    Case("SR0_EXT_STAT", {0: 0.0, 4: 4.0}, fly.rate_hz(m.SysStatus)),
    Case("SR0_POSITION", {0: 0.0, 4: 4.0}, fly.rate_hz(m.GlobalPositionInt)),
    Case("SR0_RAW_SENS", {0: 0.0, 4: 4.0}, fly.rate_hz(m.RawImu)),
    Case("SR0_RC_CHAN", {0: 0.0, 4: 4.0}, fly.rate_hz(m.ServoOutputRaw)),
    Case("SYSID_THISMAV", {1: 1, 7: 7}, fly.system_id),
    # Simulated troubles.
    Case("SIM_ACC1_BIAS_X", itself(0.2, 0.0, 2.0), own.sensed("accel_x")),
    Case("SIM_ACC1_BIAS_Y", itself(0.2, 0.0, 2.0), own.sensed("accel_y")),
    Case("SIM_ACC1_BIAS_Z", {0.0: near(-9.8, 0.2), 2.0: near(-7.8, 0.2)}, own.sensed("accel_z")),
    Case("SIM_GYR1_BIAS_X", itself(0.05, 0.0, 0.3), own.sensed("gyro_x")),
    Case("SIM_GYR1_BIAS_Y", itself(0.05, 0.0, 0.3), own.sensed("gyro_y")),
    Case("SIM_GYR1_BIAS_Z", itself(0.05, 0.0, 0.3), own.sensed("gyro_z")),
    Case("SIM_BARO_DISABLE", {0: True, 1: False}, own.baro_heard),
    Case("SIM_BARO_GLITCH", itself(1.0, 0.0, 20.0), own.sensed("baro_up_m")),
    Case("SIM_BATT_VOLTAGE", itself(0.1, 16.8, 12.6), own.volts),
    Case(
        "SIM_ENGINE_FAIL",
        {0: (1.0, 1.0, 1.0, 1.0), 5: (0.0, 1.0, 0.0, 1.0)},
        own.healths,
        {"SIM_ENGINE_MUL": 0.0},
    ),
    Case(
        "SIM_ENGINE_MUL",
        {1.0: (1.0, 1.0, 1.0, 1.0), 0.5: (1.0, 0.5, 1.0, 1.0)},
        own.healths,
        {"SIM_ENGINE_FAIL": 2.0},
    ),
    Case("SIM_GPS_DISABLE", {0: 3, 1: 1}, own.fix),
    Case("SIM_GPS_GLITCH_X", {0.0: near(0.0, 2.0), 0.001: near(111.3, 2.0)}, own.sensed("gps_n")),
    Case("SIM_GPS_GLITCH_Y", {0.0: near(0.0, 2.0), 0.001: near(90.8, 2.0)}, own.sensed("gps_e")),
    Case("SIM_GPS_GLITCH_Z", {0.0: near(0.0, 2.0), 30.0: near(-30.0, 2.0)}, own.sensed("gps_d")),
    Case("SIM_MAG1_FAIL", {0: True, 1: False}, own.compass_heard),
    Case(
        "SIM_RC_FAIL",  # B5: its receiver is heard again; B7: without one it goes home
        {0: "LOITER", 1: "RTL"},
        fly.mode_after(4.0, own.sticks_then_silent("LOITER")),
    ),
    Case(
        "SIM_WIND_DIR",
        {180.0: near(8.0, 0.3), 0.0: near(-8.0, 0.3)},
        own.air_m_s(0),
        {"SIM_WIND_SPD": 8.0},
    ),
    Case(
        "SIM_WIND_SPD",
        {0.0: near(0.0, 0.1), 8.0: near(8.0, 0.3)},
        own.air_m_s(1),
        {"SIM_WIND_DIR": 270.0},
    ),
    Case("SIM_WIND_TURB", {0.0: 0.0, 3.0: near(5.0, 3.0)}, own.gusts),
)
