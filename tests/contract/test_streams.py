"""What is sent unasked, or at a rate that was asked for, and whether it is true."""

from __future__ import annotations

import math
from collections import Counter
from fractions import Fraction

import pytest
from pymavlink.dialects.v20 import all as mavlink

from tests.contract.client import (
    ACCEPTED,
    BOTH,
    DENIED,
    FAILED,
    NAN,
    Client,
    Sky,
    connected,
)
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.plant.faults import WindChange

either = pytest.mark.parametrize("personality", BOTH)

PX4_STREAMS = frozenset(
    {
        *("HEARTBEAT", "SYS_STATUS", "GPS_RAW_INT", "GLOBAL_POSITION_INT", "LOCAL_POSITION_NED"),
        *("POSITION_TARGET_LOCAL_NED", "EXTENDED_SYS_STATE", "ATTITUDE", "ATTITUDE_QUATERNION"),
        *("VFR_HUD", "BATTERY_STATUS", "HIGHRES_IMU", "SCALED_PRESSURE", "SERVO_OUTPUT_RAW"),
        *("ESTIMATOR_STATUS", "WIND_COV", "SYSTEM_TIME", "HOME_POSITION", "ATTITUDE_TARGET"),
        *("ALTITUDE", "VIBRATION", "CURRENT_MODE", "POSITION_TARGET_GLOBAL_INT"),
    }
)
ARDUPILOT_STREAMS = frozenset(
    {
        *("HEARTBEAT", "SYS_STATUS", "GPS_RAW_INT", "GLOBAL_POSITION_INT", "LOCAL_POSITION_NED"),
        *("POSITION_TARGET_LOCAL_NED", "EXTENDED_SYS_STATE", "ATTITUDE", "VFR_HUD"),
        *("BATTERY_STATUS", "RAW_IMU", "SCALED_PRESSURE", "SERVO_OUTPUT_RAW", "RC_CHANNELS"),
        *("EKF_STATUS_REPORT", "WIND", "SYSTEM_TIME", "MISSION_CURRENT"),
        *("NAV_CONTROLLER_OUTPUT", "POWER_STATUS", "MEMINFO", "HWSTATUS", "VIBRATION"),
    }
)
STREAMS = {"px4": PX4_STREAMS, "ardupilot": ARDUPILOT_STREAMS}


def flying(personality: Personality) -> Client:
    """Hovering in a wind from the west, with all streams on."""
    client = connected(personality)
    client.sky.vehicles[0].inject(WindChange((0.0, 5.0, 0.0), 0.0))
    if personality == "ardupilot":
        client.send(mavlink.MAVLink_request_data_stream_message(1, 1, 0, 10, 1))
    client.take_off(8.0)
    client.sky.run(20.0)
    client.forget()
    client.sky.run(4.0)
    return client


@either
def test_all_streams_are_there_and_tell_the_truth(personality: Personality) -> None:
    """streams."""
    client = flying(personality)
    assert {each.message.get_type() for each in client.heard} >= STREAMS[personality]
    truth, estimate = client.sky.truth(), client.sky.vehicles[0].estimate

    where = client.last("GLOBAL_POSITION_INT")
    assert where.lat == pytest.approx(truth.lat_deg * 1e7, abs=200)
    assert where.lon == pytest.approx(truth.lon_deg * 1e7, abs=200)
    assert where.alt / 1e3 == pytest.approx(truth.alt_amsl_m, abs=1.5)
    assert where.relative_alt / 1e3 == pytest.approx(8.0, abs=1.0)
    local = client.last("LOCAL_POSITION_NED")
    assert (local.x, local.y, local.z) == pytest.approx(truth.pos_ned, abs=1.5)
    target = client.last("POSITION_TARGET_LOCAL_NED")
    assert target.z == pytest.approx(local.z, abs=0.5)
    attitude = client.last("ATTITUDE")
    lean_deg = math.degrees(math.hypot(attitude.roll, attitude.pitch))
    assert 1.0 < lean_deg < 15.0, "it leans against the wind"
    hud = client.last("VFR_HUD")
    assert hud.alt == pytest.approx(truth.alt_amsl_m, abs=1.5)
    assert hud.heading == pytest.approx(math.degrees(estimate.heading_rad) % 360, abs=2)
    assert 20 < hud.throttle < 80
    gps = client.last("GPS_RAW_INT")
    assert (gps.fix_type, gps.satellites_visible > 5) == (3, True)
    battery = client.last("BATTERY_STATUS")
    assert battery.voltages[0] / 1e3 == pytest.approx(client.sky.vehicles[0].power.voltage_v, 0.02)
    assert battery.current_battery > 300
    status = client.last("SYS_STATUS")
    needed = mavlink.MAV_SYS_STATUS_PREARM_CHECK | mavlink.MAV_SYS_STATUS_SENSOR_GPS
    assert status.onboard_control_sensors_health & needed == needed
    assert client.last("EXTENDED_SYS_STATE").landed_state == mavlink.MAV_LANDED_STATE_IN_AIR
    clock = client.last("SYSTEM_TIME")
    assert clock.time_unix_usec / 1e6 == pytest.approx(
        1_800_000_000 + clock.time_boot_ms / 1e3, abs=0.01
    )
    servo = client.last("SERVO_OUTPUT_RAW")
    assert 1100 < servo.servo1_raw < 1900
    shaking = client.last("VIBRATION")
    assert 0.0 < shaking.vibration_z < 1.0
    pressure = client.last("SCALED_PRESSURE").press_abs
    assert pressure == pytest.approx(
        1013.25 * (1 - truth.alt_amsl_m / 44330.77) ** 5.25588, abs=0.5
    )


def test_px4_tells_heights_wind_and_estimator() -> None:
    client = flying("px4")
    heights = client.last("ALTITUDE")
    assert heights.altitude_relative == pytest.approx(8.0, abs=1.0)
    assert heights.altitude_amsl == pytest.approx(client.sky.truth().alt_amsl_m, abs=1.5)
    assert math.isnan(heights.altitude_terrain)
    wind = client.last("WIND_COV")
    assert (wind.wind_x, wind.wind_y) == pytest.approx((0.0, 5.0), abs=1.2)
    imu = client.last("HIGHRES_IMU")
    assert imu.zacc == pytest.approx(-9.8, abs=0.5)
    estimator = client.last("ESTIMATOR_STATUS")
    assert estimator.flags & mavlink.ESTIMATOR_PRED_POS_HORIZ_ABS
    goal, attitude = client.last("ATTITUDE_TARGET"), client.last("ATTITUDE_QUATERNION")
    dot = sum(
        a * b
        for a, b in zip(goal.q, (attitude.q1, attitude.q2, attitude.q3, attitude.q4), strict=True)
    )
    assert abs(dot) > 0.99


def test_ardupilot_tells_navigation_wind_and_filter() -> None:
    client = flying("ardupilot")
    wind = client.last("WIND")
    assert wind.direction == pytest.approx(-90.0, abs=15.0)
    assert wind.speed == pytest.approx(5.0, abs=1.2)
    ekf = client.last("EKF_STATUS_REPORT")
    assert ekf.flags & mavlink.EKF_PRED_POS_HORIZ_ABS
    imu = client.last("RAW_IMU")
    assert imu.zacc == pytest.approx(-1000, abs=60)
    lat, lon = client.sky.home.lat_deg, client.sky.home.lon_deg + 4e-4
    asked = client.int_(192, -1, 1, 0, NAN, x=round(lat * 1e7), y=round(lon * 1e7), z=8.0)
    assert asked == [ACCEPTED]
    client.sky.run(2.0)
    output = client.last("NAV_CONTROLLER_OUTPUT")
    assert output.target_bearing == pytest.approx(90, abs=5)
    assert output.wp_dist == pytest.approx(36.3 - client.sky.truth().pos_ned[1], abs=2)
    assert output.nav_roll**2 + output.nav_pitch**2 > 4.0


def test_px4_sends_about_300_messages_a_second_and_ardupilot_almost_none() -> None:
    px4, ardupilot = connected("px4"), connected("ardupilot")
    px4.take_off(5.0)
    for client in (px4, ardupilot):
        client.forget()
        client.sky.run(10.0)
    assert len(px4.heard) / 10 == pytest.approx(313, abs=30)
    assert px4.rate_hz("SERVO_OUTPUT_RAW", 10) == px4.rate_hz("ATTITUDE_TARGET", 10) == 50
    kinds = Counter(each.message.get_type() for each in ardupilot.heard)
    assert kinds == {"HEARTBEAT": 10}


# ------------------------------------------------------------------------------------ rates


@either
def test_rates_are_honoured_on_each_link(personality: Personality) -> None:
    """SET_MESSAGE_INTERVAL, GET_MESSAGE_INTERVAL, REQUEST_DATA_STREAM."""
    client = connected(personality)
    other = client.sky.client("other", system=254)
    other.beat_if_due()
    for number, hertz in ((30, 25.0), (33, 8.0), (74, 1.0), (1, 0.5)):
        assert client.long(511, number, 1e6 / hertz) == [ACCEPTED]
        client.forget()
        assert client.long(510, number) == [ACCEPTED]
        told = client.last("MESSAGE_INTERVAL")
        assert (told.message_id, told.interval_us) == (number, 1e6 / hertz)
    assert client.long(511, 24, -1) == [ACCEPTED]
    client.forget()
    other.forget()
    client.sky.run(10.0)
    for name, hertz in (
        ("ATTITUDE", 25.0),
        ("GLOBAL_POSITION_INT", 8.0),
        ("VFR_HUD", 1.0),
        ("SYS_STATUS", 0.5),
        ("GPS_RAW_INT", 0.0),
    ):
        assert client.rate_hz(name, 10.0) == pytest.approx(hertz, rel=0.01)
    assert other.rate_hz("ATTITUDE", 10.0) == (50.0 if personality == "px4" else 0.0)
    assert client.long(511, 12345, 1e5) == [FAILED if personality == "px4" else DENIED]
    assert client.long(511, 30, NAN) == [DENIED]
    client.forget()
    if personality == "ardupilot":
        assert client.long(510, 12345) == [FAILED], "as recorded in K1_small_services"
    else:
        assert client.long(510, 12345) == [ACCEPTED]
        assert client.last("MESSAGE_INTERVAL").interval_us == 0, "not available"


@either
def test_rates_hold_per_second_of_wall_time(personality: Personality) -> None:
    client = connected(personality, speedup=Fraction(20))
    client.long(511, 33, 1e5)
    client.forget()
    client.sky.run(5.0)
    assert client.rate_hz("GLOBAL_POSITION_INT", 5.0) == pytest.approx(10.0, abs=0.3)
    assert client.rate_hz("HEARTBEAT", 5.0) == pytest.approx(1.0, abs=0.3)


def test_data_streams_are_ardupilots_groups() -> None:
    groups = {
        1: {"RAW_IMU", "SCALED_PRESSURE"},
        2: {"SYS_STATUS", "GPS_RAW_INT", "MISSION_CURRENT", "NAV_CONTROLLER_OUTPUT", "MEMINFO"},
        3: {"SERVO_OUTPUT_RAW", "RC_CHANNELS"},
        6: {"GLOBAL_POSITION_INT", "LOCAL_POSITION_NED"},
        10: {"ATTITUDE"},
        11: {"VFR_HUD"},
        12: {"SYSTEM_TIME", "HWSTATUS", "BATTERY_STATUS", "EKF_STATUS_REPORT", "VIBRATION"},
    }
    for group, kinds in groups.items():
        client = connected("ardupilot")
        client.send(mavlink.MAVLink_request_data_stream_message(1, 1, group, 4, 1))
        client.forget()
        client.sky.run(5.0)
        rates = Counter(each.message.get_type() for each in client.heard)
        assert all(rates[kind] == 20 for kind in kinds), (group, rates)
        client.send(mavlink.MAVLink_request_data_stream_message(1, 1, group, 0, 0))
        client.forget()
        client.sky.run(3.0)
        assert not kinds & {each.message.get_type() for each in client.heard}


# --------------------------------------------------------------------------- home and origin


@either
def test_home_and_origin_are_told_and_can_be_moved(personality: Personality) -> None:
    """GET_HOME_POSITION, DO_SET_HOME, REQUEST_MESSAGE(49)."""
    sky = Sky(personality)
    client = sky.client()
    client.beat_if_due()
    sky.run(2.0)
    (origin,) = client.all("GPS_GLOBAL_ORIGIN")
    assert origin.latitude == pytest.approx(sky.home.lat_deg * 1e7, abs=200)
    assert client.all("HOME_POSITION")
    late = sky.client("late", system=240)
    late.beat_if_due()
    assert late.all("HOME_POSITION"), "at first contact"
    assert late.all("GPS_GLOBAL_ORIGIN")
    client.forget()
    sky.run(10.0)
    assert client.rate_hz("HOME_POSITION", 10.0) == (0.5 if personality == "px4" else 0.0)
    client.forget()
    assert client.long(410) == [ACCEPTED]
    assert client.last("HOME_POSITION").altitude == pytest.approx(
        sky.home.alt_amsl_m * 1e3, abs=1500
    )
    assert client.request_message(49)[0] == ACCEPTED
    lat, lon = sky.home.lat_deg + 1e-4, sky.home.lon_deg
    x, y, z = round(lat * 1e7), round(lon * 1e7), sky.home.alt_amsl_m + 3.0
    client.forget()
    assert client.int_(179, 0, x=x, y=y, z=z, frame=0) == [ACCEPTED]
    sky.run(0.2)
    moved = client.last("HOME_POSITION")
    assert (moved.latitude, moved.altitude) == (x, pytest.approx(z * 1e3, abs=2))
    assert client.int_(179, 0, x=2_000_000_000, y=y, z=z, frame=0) == [DENIED]
    assert client.long(179, 1) == [ACCEPTED]
    sky.run(0.2)
    assert client.last("HOME_POSITION").latitude == pytest.approx(sky.home.lat_deg * 1e7, abs=200)


@either
def test_texts_reach_every_link(personality: Personality) -> None:
    client = connected(personality)
    other = client.sky.client("other", system=254)
    other.beat_if_due()
    client.take_off(5.0)
    assert client.texts()
    assert client.texts()[-1] == other.texts()[-1]
