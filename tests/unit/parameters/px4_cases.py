"""What every parameter of the px4 personality changes."""

from __future__ import annotations

from math import inf, radians

import pytest

from tests.unit.parameters import px4_scripts as own
from tests.unit.parameters import scripts as fly
from tests.unit.parameters.probing import UP_M, Case, about, flat_m_s, hand, itself, near
from vehicle_sim.autopilot.interface import Result, Setpoint
from vehicle_sim.autopilot.tasks.return_height import return_up_m
from vehicle_sim.plant.faults import AccelBias, GpsLost
from vehicle_sim.wire import messages as m

S = 1_000_000_000

_AT_ONCE = {"COM_FAIL_ACT_T": 0.0}
_HEARD = {"COM_RC_IN_MODE": 0.0, "RC_MAP_ROLL": 1.0, "RC_MAP_PITCH": 2.0, "RC_MAP_THROTTLE": 3.0,
          "RC_MAP_YAW": 4.0}  # fmt: skip
HOLD, RTL, LANDS = "AUTO.LOITER", "AUTO.RTL", "AUTO.LAND"

CASES: tuple[Case, ...] = (
    # Battery.
    Case("BAT1_CAPACITY", {2000: 50, 4000: 75}, own.percent_left),
    Case("BAT_LOW_THR", {0.12: "FINE", 0.3: "LOW"}, own.charge(0.2)),
    Case("BAT_CRIT_THR", {0.05: "LOW", 0.2: "CRITICAL"}, own.charge(0.1)),
    Case("BAT_EMERGEN_THR", {0.03: "CRITICAL", 0.1: "EMERGENCY"}, own.charge(0.06)),
    Case(
        "COM_LOW_BAT_ACT",
        {0: HOLD, 1: RTL, 2: LANDS},
        fly.mode_after(0.5, own.drained(0.06)),
        {**_AT_ONCE, "BAT1_CAPACITY": 5000.0},
    ),
    # Loss of control.
    Case("CBRK_FLIGHTTERM", {121212: "warn", 0: "terminate"}, own.upset_action(own.tilted(80.0))),
    Case(
        "COM_ACT_FAIL_ACT", {0: "warn", 2: "land", 4: "terminate"}, own.upset_action(own.DEAD_MOTOR)
    ),
    Case("FD_ACT_EN", {0: inf, 1: near(0.1, 0.03)}, own.upset_after_s(own.DEAD_MOTOR)),
    Case("FD_ACT_MOT_THR", {0.2: near(0.1, 0.03), 0.5: inf}, own.upset_after_s(own.DEAD_MOTOR)),
    Case(
        "FD_ACT_MOT_TOUT",
        {100: near(0.1, 0.03), 1000: near(1.0, 0.03)},
        own.upset_after_s(own.DEAD_MOTOR),
    ),
    Case("FD_FAIL_P", {40: near(0.3, 0.03), 60: inf}, own.upset_after_s(own.tilted(0.0, 50.0))),
    Case("FD_FAIL_P_TTRI", itself(0.03, 0.3, 2.0), own.upset_after_s(own.tilted(0.0, 70.0))),
    Case("FD_FAIL_R", {40: near(0.3, 0.03), 60: inf}, own.upset_after_s(own.tilted(50.0))),
    Case("FD_FAIL_R_TTRI", itself(0.03, 0.3, 2.0), own.upset_after_s(own.tilted(70.0))),
    # Silence.
    Case(
        "COM_DL_LOSS_T",
        itself(0.2, 5, 8),
        fly.seconds_until(fly.station_silent, fly.says("Connection to ground station lost")),
    ),
    Case(
        "NAV_DLL_ACT",
        {0: HOLD, 2: RTL, 3: LANDS, 6: "disarmed"},
        fly.mode_after(5.5, fly.station_silent),
        {**_AT_ONCE, "COM_DL_LOSS_T": 5.0},
    ),
    Case(
        "COM_FAIL_ACT_T",
        {0.0: near(5.0, 0.2), 3.0: near(8.0, 0.2)},
        fly.seconds_until(fly.station_silent, fly.leaves_mode(HOLD)),
        {"NAV_DLL_ACT": 2.0, "COM_DL_LOSS_T": 5.0},
    ),
    Case(
        "COM_OBL_RC_ACT",
        {0: "POSCTL", 3: RTL, 4: LANDS, 5: HOLD},
        fly.mode_after(2.0, own.offboard_then_silent),
    ),
    Case(
        "COM_OF_LOSS_T",
        itself(0.12, 0.5, 2.0),
        fly.seconds_until(own.offboard_then_silent, fly.leaves_mode("OFFBOARD")),
    ),
    Case(
        "NAV_RCL_ACT",
        {1: HOLD, 2: RTL, 3: LANDS},
        fly.mode_after(1.5, own.sticks_then_silent("POSCTL")),
        _AT_ONCE,
    ),
    Case(
        "COM_RCL_EXCEPT",
        {0: RTL, 2: HOLD},
        fly.mode_after(1.5, own.sticks_then_silent(HOLD)),
        _AT_ONCE,
    ),
    Case(
        "COM_RC_LOSS_T",
        itself(0.15, 0.5, 3.0),
        fly.seconds_until(own.sticks_then_silent("POSCTL"), fly.leaves_mode("POSCTL")),
        _AT_ONCE,
    ),
    # Position.
    Case(
        "COM_POSCTL_NAVL", {0: "ALTCTL", 1: LANDS}, fly.mode_after(0.0, own.position_lost_by_hand)
    ),
    Case(
        "COM_POS_FS_EPH",
        {1.0: near(2.6, 0.3), -1.0: near(5.0, 0.3)},
        fly.seconds_until(fly.strike(GpsLost()), fly.leaves_mode(HOLD)),
    ),
    Case(
        "EKF2_NOAID_TOUT",
        {2_000_000: near(2.0, 0.25), 6_000_000: near(6.0, 0.25)},
        own.lost_position_s,
        {"COM_POS_FS_EPH": -1.0},
    ),
    # Arming.
    Case("CAL_ACC0_ID", {0: True, 1310988: False}, fly.against_arming("Accel 0 uncalibrated")),
    Case("CAL_GYRO0_ID", {0: True, 1310988: False}, fly.against_arming("Gyro 0 uncalibrated")),
    Case("CAL_MAG0_ID", {0: True, 197388: False}, fly.against_arming("Compass 0 uncalibrated")),
    Case("COM_ARM_AUTH_REQ", {0: Result.ACCEPTED, 1: Result.IN_PROGRESS}, own.arms),
    Case(
        "COM_ARM_AUTH_MET",
        {0: Result.IN_PROGRESS, 1: Result.TEMPORARILY_REJECTED},
        own.arms,
        {"COM_ARM_AUTH_REQ": 1},
    ),
    Case("COM_ARM_AUTH_ID", {10: 10, 77: 77}, own.authorizer, {"COM_ARM_AUTH_REQ": 1}),
    Case(
        "COM_ARM_AUTH_TO",
        itself(0.15, 1.0, 3.0),
        own.waits_for_authorizer_s,
        {"COM_ARM_AUTH_REQ": 1},
    ),
    Case("COM_ARM_MIS_REQ", {0: False, 1: True}, fly.against_arming("no valid mission")),
    Case("COM_ARM_WO_GPS", {0: True, 1: False}, fly.against_arming("GPS fix too low", own.no_fix)),
    Case(
        "EKF2_GYR_B_LIM",
        {0.1: True, 0.4: False},
        fly.against_arming("High Gyro Bias", own.gyro_off),
    ),
    Case(
        "EKF2_ABL_LIM",
        {0.2: True, 0.8: False},
        fly.against_arming(
            "High Accelerometer Bias", lambda f: f.vehicle.inject(AccelBias((0.0, 0.0, 0.4)))
        ),
    ),
    Case("MAN_ARM_GESTURE", {0: False, 1: True}, own.armed_by_gesture),
    Case("SYS_FAILURE_EN", {0: 0, 1: 1}, own.injects),
    Case(
        "COM_DISARM_LAND",
        {0.5: near(0.5, 0.15), 4.0: near(4.0, 0.15), -1.0: inf},
        fly.disarms_after_landing_s,
    ),
    Case(
        "COM_DISARM_PRFLT",
        {3.0: near(3.0, 0.15), 10.0: near(10.0, 0.15), -1.0: inf},
        fly.disarms_idle_s,
    ),
    # Fence and rally points.
    Case(
        "GF_ACTION",
        {1: "OFFBOARD", 2: HOLD, 3: RTL, 5: LANDS},
        fly.mode_after(0.0, own.leaves_fence),
        _AT_ONCE,
    ),
    Case("GF_MAX_HOR_DIST", {0.0: 0, 30.0: 2}, own.fence_kinds(10.0, 40.0)),
    Case("GF_MAX_VER_DIST", {0.0: 0, 30.0: 1}, own.fence_kinds(40.0, 0.0)),
    Case("GF_PREDICT", {0: 0, 1: 2}, own.fence_kinds(10.0, 25.0, 35.0), {"GF_MAX_HOR_DIST": 30.0}),
    Case("RTL_TYPE", {0: 0.0, 1: 30.0}, own.returns_to),
    # Flights.
    Case("CAM_EXPOSURE_S", itself(0.1, 0.5, 3.0), fly.exposure_s),
    Case("COM_SPOOLUP_TIME", itself(0.12, 0.0, 2.0), fly.lifts_off_after_s),
    Case("COM_TAKEOFF_ACT", {0: HOLD, 1: "AUTO.MISSION"}, own.after_take_off),
    Case(
        "MIS_DIST_1WP",
        {100.0: Result.TEMPORARILY_REJECTED, 900.0: Result.ACCEPTED},
        own.mission_result,
    ),
    Case("MIS_PD_TO", itself(0.3, 2.0, 5.0), own.payload_s),
    Case(
        "MIS_TAKEOFF_ALT",
        itself(0.3, 2.5, 6.0),
        fly.take_off_height_m,
        also={"NAV_MC_ALT_RAD": 0.2},
    ),
    Case(
        "NAV_MC_ALT_RAD",
        {0.2: near(5.0 - 0.15, 0.15), 0.8: near(5.0 - 0.65, 0.15)},
        fly.take_off_height_m,
        also={"MIS_TAKEOFF_ALT": 5.0},
    ),
    Case(
        "MPC_ACC_DOWN_MAX",
        itself(0.1, 2.0, 4.0),
        fly.acceleration_m_s2(0.0, 1.0),
        {"MPC_Z_V_AUTO_DN": 4.0, "MPC_Z_VEL_MAX_DN": 4.0, "MPC_JERK_AUTO": 30.0},
    ),
    Case(
        "MPC_ACC_HOR",
        itself(0.05, 2.0, 6.0),
        fly.acceleration_m_s2(60.0, UP_M),
        {"MPC_JERK_AUTO": 30.0},
    ),
    Case(
        "MPC_ACC_UP_MAX",
        itself(0.05, 2.0, 5.0),
        fly.acceleration_m_s2(0.0, 60.0),
        {"MPC_JERK_AUTO": 30.0},
    ),
    Case(
        "MPC_LAND_ALT1",
        {6.0: near(1.5, 0.15), 11.0: near(1.1, 0.15)},
        fly.sink_at(8.0),
        {"MPC_LAND_ALT2": 5.0},
    ),
    Case("MPC_LAND_ALT2", {2.0: near(1.25, 0.12), 8.0: near(0.75, 0.12)}, fly.sink_at(7.0)),
    Case("MPC_LAND_SPEED", itself(0.1, 0.7, 1.2), fly.sink_at(3.0)),
    Case(
        "MPC_TKO_RAMP_T",
        # 1 m/s is two thirds of MPC_TKO_SPEED.
        {0.0: near(0.6, 0.3), 5.0: near(5.0 * 2 / 3 + 0.3, 0.3)},
        own.climbs_1_m_s_after_s,
    ),
    Case("MPC_TKO_SPEED", {1.0: near(1.0, 0.15), 2.5: near(2.5, 0.25)}, fly.take_off_climb_m_s),
    Case("MPC_XY_CRUISE", itself(0.4, 3.0, 8.0), fly.cruise_m_s),
    Case(
        "MPC_XY_VEL_MAX",
        {4.0: near(4.0, 0.3), 12.0: near(8.0, 0.4)},
        fly.velocity(Setpoint(v_ned=(8.0, 0.0, 0.0)), 6.0),
    ),
    Case("MPC_YAWRAUTO_MAX", {30.0: near(30.0, 4.0), 60.0: near(60.0, 6.0)}, fly.turn_deg_s),
    Case(
        "MPC_YAW_MODE",
        {0: near(-0.3, 0.6), 1: near(1.0, 0.05), 2: near(-1.0, 0.05)},
        own.nose_homewards,
    ),
    Case("MPC_Z_VEL_MAX_DN", {0.8: near(0.8, 0.2), 2.0: near(1.5, 0.2)}, fly.descent_m_s_to(2.0)),
    Case("MPC_Z_VEL_MAX_UP", {1.0: near(1.0, 0.2), 5.0: near(3.0, 0.3)}, fly.climb_m_s_to(30.0)),
    Case("MPC_Z_V_AUTO_DN", itself(0.2, 0.8, 1.5), fly.descent_m_s_to(2.0)),
    Case("MPC_Z_V_AUTO_UP", {1.0: near(1.0, 0.2), 3.0: near(3.0, 0.3)}, fly.climb_m_s_to(30.0)),
    Case("NAV_ACC_RAD", {2.0: near(1.7, 0.5), 6.0: near(5.7, 0.5)}, fly.reached_at_m),
    Case(
        "RTL_CONE_ANG",
        {0: 30.0, 45: pytest.approx(6.0)},
        lambda s: return_up_m(s.parameters(), (0.0, 0.0, 0.0), (6.0, 0.0, -2.0)),
    ),
    Case(
        "RTL_DESCEND_ALT", itself(0.5, 3.0, 8.0), fly.return_lands_from_m, {"RTL_RETURN_ALT": 12.0}
    ),
    Case(
        "RTL_LAND_DELAY",
        itself(0.6, 0.5, 4.0),
        fly.return_waits_s,
        {"RTL_RETURN_ALT": 12.0, "RTL_DESCEND_ALT": 10.0},
    ),
    Case(
        "RTL_MIN_DIST",
        {5.0: 30.0, 10.0: pytest.approx(8.0)},
        lambda s: return_up_m(s.parameters(), (0.0, 0.0, 0.0), (8.0, 0.0, -2.0)),
    ),
    Case("RTL_RETURN_ALT", itself(0.6, 15.0, 20.0), fly.return_top_m(25.0)),
    # Sticks.
    Case("COM_RC_IN_MODE", {0: False, 1: True}, own.joystick_counts),
    Case("COM_RC_OVERRIDE", {0: HOLD, 1: "POSCTL"}, fly.mode_after(0.0, own.stick_moved)),
    Case("COM_RC_STICK_OV", {30.0: "POSCTL", 60.0: HOLD}, fly.mode_after(0.0, own.stick_moved)),
    Case(
        "MC_ACRO_P_MAX",
        {50.0: pytest.approx(radians(50.0)), 100.0: pytest.approx(radians(100.0))},
        fly.feels(lambda f: -f.rates(hand(pitch=1.0))[1]),
    ),
    Case(
        "MC_ACRO_R_MAX",
        {50.0: pytest.approx(radians(50.0)), 100.0: pytest.approx(radians(100.0))},
        fly.feels(lambda f: f.rates(hand(roll=1.0))[0]),
    ),
    Case(
        "MC_ACRO_Y_MAX",
        {50.0: pytest.approx(radians(50.0)), 100.0: pytest.approx(radians(100.0))},
        fly.feels(lambda f: f.rates(hand(yaw=1.0))[2]),
    ),
    Case(
        "MPC_HOLD_DZ",
        {0.1: pytest.approx(0.0), 0.0: near(0.5, 0.3)},
        fly.feels(lambda f: f.velocity(hand(pitch=0.1))[0]),
    ),
    Case(
        "MPC_MANTHR_MIN",
        {0.08: pytest.approx(0.08), 0.2: pytest.approx(0.2)},
        fly.thrust(hand(throttle=0.0)),
    ),
    Case(
        "MPC_MAN_TILT_MAX",
        {20.0: pytest.approx(radians(20.0)), 35.0: pytest.approx(radians(35.0))},
        fly.feels(lambda f: f.lean(hand(pitch=1.0))[0]),
    ),
    Case(
        "MPC_MAN_Y_MAX",
        {50.0: pytest.approx(radians(50.0)), 150.0: pytest.approx(radians(150.0))},
        fly.feels(lambda f: f.turn(hand(yaw=1.0))),
    ),
    Case("MPC_THR_HOVER", {0.3: pytest.approx(0.3), 0.5: pytest.approx(0.5)}, fly.thrust(hand())),
    Case(
        "MPC_THR_MAX",
        {0.8: pytest.approx(0.8), 1.0: pytest.approx(1.0)},
        fly.thrust(hand(throttle=1.0)),
    ),
    Case(
        "MPC_VEL_MANUAL",
        {3.0: near(3.0, 0.3), 6.0: near(6.0, 0.4)},
        fly.by_hand("POSCTL", 5.0, flat_m_s, forward=1000),
    ),
    Case(
        "MPC_XY_MAN_EXPO",
        {0.0: near(4.444, 0.01), 1.0: near(0.878, 0.01)},
        fly.feels(lambda f: f.velocity(hand(pitch=0.5))[0]),
    ),
    Case(
        "MPC_YAW_EXPO",
        {0.0: near(1.1636, 0.01), 1.0: near(0.2298, 0.01)},
        fly.feels(lambda f: f.turn(hand(yaw=0.5))),
    ),
    Case(
        "MPC_Z_MAN_EXPO",
        {0.0: near(1.3333, 0.01), 1.0: near(0.2634, 0.01)},
        fly.feels(lambda f: f.climb(hand(throttle=0.75))),
    ),
    Case("RC_MAP_PITCH", {0: 0, 1: -79, 2: 79}, own.radio(pitch=1), {**_HEARD}),
    Case("RC_MAP_ROLL", {0: 0, 1: 79, 2: -79}, own.radio(roll=1), {**_HEARD}),
    Case("RC_MAP_THROTTLE", {1: 90, 3: 29}, own.radio(throttle=1), {**_HEARD}),
    Case("RC_MAP_YAW", {0: 0, 1: 79, 4: 38}, own.radio(yaw=1), {**_HEARD}),
    # Circles and leaders.
    Case("MC_ORBIT_RAD_MAX", {20.0: Result.DENIED, 100.0: Result.ACCEPTED}, own.orbit_result),
    Case(
        "FLW_TGT_ALT_M",
        {0: near(10.0, 0.7), 2: near(12.0, 0.7)},
        own.beside_leader(2),
        {"FLW_TGT_HT": 10.0},
    ),
    Case("FLW_TGT_DST", {8.0: near(-8.0, 1.5), 15.0: near(-15.0, 1.5)}, own.beside_leader(0)),
    Case("FLW_TGT_FA", {180.0: near(0.0, 1.5), 90.0: near(8.0, 1.5)}, own.beside_leader(1)),
    Case("FLW_TGT_HT", itself(0.7, 8.0, 15.0), own.beside_leader(2)),
    Case("FLW_TGT_MAX_VEL", {1.0: near(0.3, 0.25), 5.0: near(1.3, 0.4)}, own.goes_round_m),
    Case("FLW_TGT_RS", {0.0: near(3.0, 0.05), 1.0: near(1.2, 0.3)}, own.feeds_forward_m_s),
    # Control loops.
    Case(
        "MC_ROLLRATE_MAX",
        {100.0: near(1.9, 0.6), 220.0: near(4.0, 0.6)},
        fly.fastest("rate_x", fly.tips(fly.turned(roll=90.0)), 0.4),
    ),
    Case(
        "MC_PITCHRATE_MAX",
        {100.0: near(1.9, 0.6), 220.0: near(4.0, 0.6)},
        fly.fastest("rate_y", fly.tips(fly.turned(pitch=90.0)), 0.4),
    ),
    Case(
        "MC_YAWRATE_MAX",
        {40.0: near(0.7, 0.2), 200.0: near(2.0, 0.6)},
        fly.fastest("rate_z", fly.tips(fly.turned(yaw=90.0)), 0.8),
    ),
    Case(
        "MC_ROLLRATE_P",
        {0.075: about(0.228), 0.15: about(0.436)},
        fly.answer("rate_x", fly.spins((1.0, 0.0, 0.0)), 0.04),
    ),
    Case(
        "MC_PITCHRATE_P",
        {0.075: about(0.216), 0.15: about(0.393)},
        fly.answer("rate_y", fly.spins((0.0, 1.0, 0.0)), 0.04),
    ),
    Case(
        "MC_YAWRATE_P",
        {0.1: about(0.013), 0.2: about(0.024)},
        fly.answer("rate_z", fly.spins((0.0, 0.0, 0.1)), 0.1),
    ),
    Case(
        "MC_ROLL_P",
        {3.25: about(0.052), 6.5: about(0.1)},
        fly.answer("qx", fly.tips(fly.turned(roll=20.0)), 0.12),
    ),
    Case(
        "MC_PITCH_P",
        {3.25: about(0.053), 6.5: about(0.103)},
        fly.answer("qy", fly.tips(fly.turned(pitch=20.0)), 0.12),
    ),
    Case(
        "MC_YAW_P",
        {1.4: about(0.026), 2.8: about(0.051)},
        fly.answer("qz", fly.tips(fly.turned(yaw=20.0)), 0.3),
    ),
    Case(
        # A loop of second order with MPC_XY_VEL_P_ACC = 1.8 gives 0.25, 0.45, less the tilt's lag.
        "MPC_XY_P",
        {0.5: about(0.22), 0.95: about(0.40)},
        fly.answer("pos_n", fly.reference(ref_n=1.0, goal_n=1.0), 1.0, hover_s=6.0),
    ),
    Case(
        "MPC_XY_VEL_P_ACC",
        {1.2: about(0.32), 3.0: about(0.66)},
        fly.answer("vel_n", fly.reference(ref_n=1.0, goal_n=1.0), 0.5),
    ),
    Case(
        "MPC_Z_P",
        {0.5: about(0.306), 1.0: about(0.568)},
        fly.answer("pos_d", fly.reference(ref_d=1.0, goal_d=1.0), 1.0, hover_s=6.0),
    ),
    Case(
        "MPC_Z_VEL_P_ACC",
        {2.0: about(0.663), 6.0: about(0.855)},
        fly.answer("vel_d", fly.reference(ref_d=1.0, goal_d=1.0), 0.5),
    ),
    Case(
        "MPC_XY_VEL_I_ACC",
        {0.1: about(-0.185), 0.8: about(-1.195)},
        fly.learns("int_n", 3.0, wind_n=8.0),
    ),
    Case("MPC_Z_VEL_I_ACC", {0.5: about(-0.749), 3.0: about(-2.299)}, fly.lifts(3.0, 0.8)),
    Case(
        "MPC_JERK_AUTO", {10.0: near(1.0, 0.1), 30.0: near(3.0, 0.1)}, fly.acceleration_after(0.1)
    ),
    Case("MPC_TILTMAX_AIR", itself(1.0, 20.0, 45.0), fly.lean_deg),
    Case(
        "MPC_XY_ERR_MAX",
        {2.0: near(1.7, 0.3), 4.0: near(3.3, 0.5)},
        own.lags_m,
        {"MPC_TILTMAX_AIR": 20.0, "MPC_XY_CRUISE": 8.0},
    ),
    # Messages and logs.
    Case("MAV_HASH_CHK_EN", {0: False, 1: True}, own.home_hash),
    Case("MAV_SYS_ID", {1: 1, 7: 7}, fly.system_id),
    Case("MAV_TYPE", {2: 2, 13: 13}, fly.message(m.Heartbeat, "type")),
    Case(
        "SDLOG_MODE",
        {
            -1: (False, False, False),
            0: (False, True, False),
            1: (True, True, False),
            2: (True, True, True),
        },
        fly.logs_written,
    ),
    # Simulated sensors.
    Case("SIM_BARO_OFF_P", {0.0: near(0.0, 1.0), -240.2: near(20.0, 1.0)}, own.baro_off_m),
    Case("SIM_BAT_DRAIN", {30.0: 69, 120.0: 94}, own.percent_after_10_s),
    Case("SIM_BAT_MIN_PCT", {50.0: 100, 90.0: 92}, own.percent_after_10_s),
    Case("SIM_GPS_USED", {10: (3, 10), 14: (3, 14), 3: (1, 0)}, own.satellites),
    Case("SIM_MAG_OFFSET_X", {0.0: near(0.21, 0.1), 1.0: near(1.21, 0.1)}, own.field_gauss(0)),
    Case("SIM_MAG_OFFSET_Y", itself(0.1, 0.0, 1.0), own.field_gauss(1)),
    Case("SIM_MAG_OFFSET_Z", {0.0: near(0.44, 0.1), 1.0: near(1.44, 0.1)}, own.field_gauss(2)),
)
