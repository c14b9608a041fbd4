"""The px4 log is a ULog: pyulog, which is PX4's own reader, is the oracle."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tests.unit.vehicle_logbook.flights import MS, START_S, Flight, S, read_ulog
from vehicle_sim.autopilot.interface import AttitudeGoal, Geodetic, Landed, StatusText, Target

pytest.importorskip("pyulog")


def topic(log: Any, name: str) -> dict[str, Any]:
    data: dict[str, Any] = log.get_dataset(name).data
    return data


@pytest.fixture(name="log")
def flown() -> Any:
    flight = Flight("px4")
    flight.fly(2 * S, StatusText(4, "Wind is high"))
    (log,) = flight.logs
    return read_ulog(log)


def test_it_is_read_whole_with_no_dropouts(log: Any) -> None:
    assert not log.file_corruption
    assert log.dropouts == []
    assert log.start_timestamp == 1_004_000
    assert log.last_timestamp == 3_004_000


def test_it_says_what_wrote_it(log: Any) -> None:
    assert log.msg_info_dict["sys_name"] == "PX4"
    assert log.msg_info_dict["ver_hw"] == "PX4_SITL"
    assert log.msg_info_dict["ver_sw_release"] == 0x010E03FF


def test_positions_are_those_that_the_vehicle_reported_at_their_times(log: Any) -> None:
    local = topic(log, "vehicle_local_position")
    seconds = local["timestamp"] / 1e6
    np.testing.assert_array_equal(local["x"], seconds.astype(np.float32))
    np.testing.assert_array_equal(local["y"], (2.0 * seconds).astype(np.float32))
    np.testing.assert_array_equal(local["z"], (-seconds / 2.0).astype(np.float32))
    assert set(local["vx"]) == {1.0}
    assert set(local["xy_valid"]) == {1}
    assert local["ref_lat"][0] == 47.397742
    where = topic(log, "vehicle_global_position")
    assert (where["lat"][0], where["lon"][0], where["alt"][0]) == (47.3978, 8.5459, 493.0)


def test_speed_and_heading() -> None:
    """Headings are -pi .. pi, as PX4 has them."""
    flight = Flight("px4")
    flight.vehicle.v_ned = (1.0, -2.0, 3.0)
    flight.vehicle.heading_rad = 1.5 * math.pi
    flight.fly()
    local = topic(read_ulog(flight.logs[0]), "vehicle_local_position")
    told = [local[name][0] for name in ("vx", "vy", "vz", "z_deriv")]
    assert told == [1.0, -2.0, 3.0, 3.0]
    assert local["heading"][0] == pytest.approx(-0.5 * math.pi)


def test_ten_samples_a_second_on_a_grid_of_the_vehicles_own_time(log: Any) -> None:
    for name in ("vehicle_attitude", "vehicle_local_position", "actuator_motors"):
        times = topic(log, name)["timestamp"]
        assert list(times[1:] % 100_000) == [0] * (len(times) - 1), name
        assert len(times) == 21, name


def test_texts_are_logged_with_their_severity(log: Any) -> None:
    texts = [(text.log_level_str(), text.message) for text in log.logged_messages]
    assert texts == [("WARNING", "Wind is high")]


def test_battery_gps_and_attitude_have_the_reported_values() -> None:
    flight = Flight("px4")
    half = math.sqrt(0.5)
    flight.vehicle.q_ned_from_frd = (half, 0.0, 0.0, half)
    flight.fly()
    log = read_ulog(flight.logs[0])
    battery = topic(log, "battery_status")
    assert battery["voltage_v"][0] == np.float32(15.2)
    assert battery["remaining"][0] == np.float32(0.96)
    assert battery["discharged_mah"][0] == 120.0
    gps, reported = topic(log, "vehicle_gps_position"), flight.gps()
    assert (gps["lat"][-1], gps["lon"][-1], gps["alt"][-1]) == reported[1:4]
    assert gps["fix_type"][-1] == reported.fix_type
    assert gps["time_utc_usec"][0] == START_S * 1_000_000 + gps["timestamp"][0]
    attitude = topic(log, "vehicle_attitude")
    read = [attitude[f"q[{index}]"][0] for index in range(4)]
    assert read == [np.float32(part) for part in flight.vehicle.q_ned_from_frd]


def test_setpoints_and_motors() -> None:
    flight = Flight("px4")
    flight.vehicle.target = Target((1.0, 2.0, -3.0), None, 0.5)
    flight.vehicle.motor_outputs = (0.25, 0.5, 0.75, 1.0)
    flight.fly()
    log = read_ulog(flight.logs[0])
    setpoint = topic(log, "trajectory_setpoint")
    assert [setpoint[f"position[{axis}]"][0] for axis in range(3)] == [1.0, 2.0, -3.0]
    assert np.isnan(setpoint["velocity[0]"]).all()
    assert setpoint["yaw"][0] == 0.5
    motors, outputs = topic(log, "actuator_motors"), topic(log, "actuator_outputs")
    assert [motors[f"control[{number}]"][0] for number in range(4)] == [0.25, 0.5, 0.75, 1.0]
    assert np.isnan(motors["control[4]"]).all()
    assert [outputs[f"output[{number}]"][0] for number in range(4)] == [1250, 1500, 1750, 2000]


def test_what_the_sensors_say_and_what_is_wanted_of_the_attitude() -> None:
    flight = Flight("px4")
    flight.vehicle.attitude_goal = AttitudeGoal((1.0, 0.0, 0.0, 0.0), (0.5, 0.25, -0.5), 0.75)
    flight.fly()
    log = read_ulog(flight.logs[0])
    readings = flight.vehicle.readings
    for name, field, told in (
        ("sensor_combined", "gyro_rad", readings.gyro_frd),
        ("sensor_combined", "accelerometer_m_s2", readings.accel_frd),
        ("vehicle_magnetometer", "magnetometer_ga", readings.mag_frd),
        ("vehicle_attitude_setpoint", "q_d", (1.0, 0.0, 0.0, 0.0)),
        ("vehicle_attitude_setpoint", "thrust_body", (0.0, 0.0, -0.75)),
    ):
        data = topic(log, name)
        logged = [data[f"{field}[{axis}]"][0] for axis in range(len(told))]
        assert logged == [np.float32(value) for value in told], field
    rates = topic(log, "vehicle_rates_setpoint")
    assert (rates["roll"][0], rates["pitch"][0], rates["yaw"][0]) == (0.5, 0.25, -0.5)
    assert topic(log, "vehicle_air_data")["baro_alt_meter"][0] == 493.5


def test_where_nothing_is_controlled_there_is_no_attitude_setpoint(log: Any) -> None:
    with pytest.raises(IndexError):
        topic(log, "vehicle_attitude_setpoint")


def test_the_estimate_is_logged_with_its_judgement() -> None:
    flight = Flight("px4")
    flight.vehicle.health = replace(
        flight.vehicle.health, position_ok=False, accuracy_m=7.5, dead_s=3.0
    )
    flight.fly()
    local = topic(read_ulog(flight.logs[0]), "vehicle_local_position")
    told = [local[name][0] for name in ("xy_valid", "v_xy_valid", "eph", "dead_reckoning")]
    assert told == [0, 1, 7.5, 1]


def test_modes_arming_and_landing_are_in_it_when_they_happen() -> None:
    flight = Flight("px4")
    flight.vehicle.armed = True
    flight.advance(510 * MS)
    flight.vehicle.custom_mode = 4 << 16 | 6 << 24
    flight.vehicle.landed = Landed.IN_AIR
    flight.advance(500 * MS)
    flight.vehicle.armed = False
    flight.advance(4 * MS)
    log = read_ulog(flight.logs[0])
    status = log.get_dataset("vehicle_status")
    changes = [(int(t), int(x)) for t, x in status.list_value_changes("nav_state")]
    assert changes == [(4000, 4), (516_000, 18)]
    changes = [(int(t), int(x)) for t, x in status.list_value_changes("arming_state")]
    assert changes == [(4000, 2), (1_016_000, 1)]
    assert status.data["system_id"][0] == 7
    landed = log.get_dataset("vehicle_land_detected").list_value_changes("landed")
    assert [int(x) for _, x in landed] == [1, 0]


def test_parameters_with_the_defaults_of_those_that_differ() -> None:
    flight = Flight("px4")
    default = flight.parameters.get("MIS_TAKEOFF_ALT")
    flight.parameters.set("MIS_TAKEOFF_ALT", 7.5)
    flight.fly()
    log = read_ulog(flight.logs[0])
    assert log.initial_parameters.keys() == {spec.name for spec in flight.parameters.specs}
    assert log.initial_parameters["MIS_TAKEOFF_ALT"] == 7.5
    assert log.initial_parameters["MAV_SYS_ID"] == 1
    assert isinstance(log.initial_parameters["MAV_SYS_ID"], int)
    assert log.get_default_parameters(0) == {"MIS_TAKEOFF_ALT": default}
    assert log.changed_parameters == []


def test_a_parameter_that_is_set_in_flight_is_logged_with_the_next_sample() -> None:
    flight = Flight("px4")
    flight.vehicle.armed = True
    flight.advance(500 * MS)
    flight.parameters.set("MIS_TAKEOFF_ALT", 9.0)
    flight.advance(500 * MS)
    log = read_ulog(flight.logs[0])
    assert [change[1:] for change in log.changed_parameters] == [("MIS_TAKEOFF_ALT", 9.0)]


def test_before_the_first_fix_there_is_no_global_position() -> None:
    flight = Flight("px4")
    flight.vehicle.origin = flight.vehicle.home = None
    flight.vehicle.home_pos_ned = None
    flight.vehicle.armed = True
    flight.advance(500 * MS)
    flight.vehicle.origin = flight.vehicle.home = Geodetic(1.0, 2.0, 3.0)
    flight.vehicle.home_pos_ned = (0.0, 0.0, 0.0)
    flight.advance(500 * MS)
    log = read_ulog(flight.logs[0])
    assert topic(log, "vehicle_global_position")["timestamp"][0] == 600_000
    local = topic(log, "vehicle_local_position")
    assert list(local["xy_global"][4:8]) == [0, 0, 1, 1]
    assert math.isnan(local["ref_lat"][0])
    assert topic(log, "home_position")["lat"][0] == 1.0
