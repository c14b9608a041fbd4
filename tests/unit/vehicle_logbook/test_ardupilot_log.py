"""The ardupilot log is a DataFlash file: pymavlink's DFReader is the oracle."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from tests.unit.vehicle_logbook.flights import MS, START_S, Flight, read_dataflash
from vehicle_sim.autopilot.interface import AttitudeGoal, Landed, StatusText, Target


def of(records: list[Any], name: str) -> list[Any]:
    return [record for record in records if record.get_type() == name]


def test_everything_is_read_and_nothing_complained_about(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    flight = Flight("ardupilot")
    flight.fly()
    reader, records = read_dataflash(flight.logs[0], tmp_path)
    assert capfd.readouterr() == ("", "")
    assert sum(len(record.get_msgbuf()) for record in records) == len(flight.logs[0])
    assert reader.mav_type == 2, "a quadrotor"


def test_positions_are_those_that_the_vehicle_reported_at_their_times(tmp_path: Path) -> None:
    flight = Flight("ardupilot")
    flight.fly()
    _, records = read_dataflash(flight.logs[0], tmp_path)
    estimates = of(records, "XKF1")
    assert len(estimates) == 21
    assert [estimate.TimeUS % 100_000 for estimate in estimates[1:]] == [0] * 20
    for estimate in estimates:
        seconds = estimate.TimeUS / 1e6
        told = (estimate.PN, estimate.PE, estimate.PD)
        assert told == pytest.approx((seconds, 2.0 * seconds, -seconds / 2.0), rel=1e-6)
        assert (estimate.VN, estimate.VE, estimate.VD) == (1.0, 0.0, 0.0)
    place = of(records, "POS")[0]
    assert (place.Lat, place.Lng, place.Alt) == (47.3978, 8.5459, 493.0)
    assert place.RelHomeAlt == 5.0


def test_speed(tmp_path: Path) -> None:
    flight = Flight("ardupilot")
    flight.vehicle.v_ned = (1.0, -2.0, 3.0)
    flight.fly()
    _, records = read_dataflash(flight.logs[0], tmp_path)
    estimate, tuning = of(records, "XKF1")[0], of(records, "CTUN")[0]
    assert (estimate.VN, estimate.VE, estimate.VD, estimate.dPD) == (1.0, -2.0, 3.0, 3.0)
    assert tuning.CRt == -300, "it sinks"


def test_the_date_comes_from_the_gps_time(tmp_path: Path) -> None:
    flight = Flight("ardupilot")
    flight.fly()
    _, records = read_dataflash(flight.logs[0], tmp_path)
    last = of(records, "ATT")[-1]
    assert last._timestamp == pytest.approx(START_S + last.TimeUS / 1e6, abs=0.01)


def test_a_vehicle_without_a_date_says_so(tmp_path: Path) -> None:
    flight = Flight("ardupilot", start_s=0)
    flight.fly()
    _, records = read_dataflash(flight.logs[0], tmp_path)
    assert {(gps.GWk, gps.GMS) for gps in of(records, "GPS")} == {(0, 0)}


def test_attitude_battery_motors_and_setpoints(tmp_path: Path) -> None:
    flight = Flight("ardupilot")
    roll = math.radians(30.0)
    flight.vehicle.q_ned_from_frd = (math.cos(roll / 2), math.sin(roll / 2), 0.0, 0.0)
    flight.vehicle.target = Target((1.0, 2.0, -3.0), (0.5, 0.0, -1.0), None)
    flight.vehicle.motor_outputs = (0.25, 0.5, 0.75, 1.0)
    flight.fly()
    _, records = read_dataflash(flight.logs[0], tmp_path)
    attitude = of(records, "ATT")[0]
    assert attitude.Roll == pytest.approx(30.0, abs=1e-4)
    assert attitude.Pitch == pytest.approx(0.0, abs=1e-4)
    assert math.isnan(attitude.DesRoll), "not known, and not 0"
    battery = of(records, "BAT")[0]
    assert (battery.Volt, battery.Curr) == pytest.approx((15.2, 4.0), rel=1e-6)
    assert (battery.CurrTot, battery.RemPct) == (120.0, 96)
    motors = of(records, "RCOU")[0]
    assert (motors.C1, motors.C2, motors.C3, motors.C4) == (1250, 1500, 1750, 2000)
    north, down = of(records, "PSCN")[0], of(records, "PSCD")[0]
    assert (north.TPN, north.TVN, down.TPD, down.TVD) == (1.0, 0.5, -3.0, -1.0)
    tuning = of(records, "CTUN")[0]
    assert (tuning.DAlt, tuning.Alt, tuning.DCRt) == (3.0, 5.0, 100)
    gps, reported = of(records, "GPS")[-1], flight.gps()
    assert (gps.Lat, gps.Lng) == (reported.lat / 1e7, reported.lon / 1e7)
    assert (gps.Status, gps.NSats) == (reported.fix_type, reported.satellites_visible)


def test_what_the_sensors_say_and_what_is_wanted_of_the_attitude(tmp_path: Path) -> None:
    flight = Flight("ardupilot")
    west = (math.sqrt(0.5), 0.0, 0.0, -math.sqrt(0.5))
    rates_rad_s = (math.radians(10.0), math.radians(-20.0), math.radians(30.0))
    flight.vehicle.attitude_goal = AttitudeGoal(west, rates_rad_s, 0.75)
    flight.fly()
    _, records = read_dataflash(flight.logs[0], tmp_path)
    attitude, rate = of(records, "ATT")[0], of(records, "RATE")[0]
    assert (attitude.DesRoll, attitude.DesPitch) == pytest.approx((0.0, 0.0), abs=1e-6)
    assert attitude.DesYaw == pytest.approx(270.0, abs=1e-4)
    assert (rate.RDes, rate.PDes, rate.YDes) == pytest.approx((10.0, -20.0, 30.0), rel=1e-6)
    assert (rate.R, rate.AOut) == (0.0, 0.75)
    imu, mag, readings = of(records, "IMU")[0], of(records, "MAG")[0], flight.vehicle.readings
    assert (imu.GyrX, imu.GyrY, imu.GyrZ) == pytest.approx(readings.gyro_frd, rel=1e-6)
    assert (imu.AccX, imu.AccY, imu.AccZ) == pytest.approx(readings.accel_frd, rel=1e-6)
    assert (mag.MagX, mag.MagY, mag.MagZ) == (210, 10, 430)


def test_modes_texts_and_events_are_in_it_when_they_happen(tmp_path: Path) -> None:
    flight = Flight("ardupilot")
    flight.vehicle.custom_mode = 4
    flight.vehicle.armed = True
    flight.advance(510 * MS, StatusText(6, "Arming motors"))
    flight.vehicle.custom_mode = 9
    flight.vehicle.landed = Landed.IN_AIR
    flight.advance(500 * MS)
    flight.vehicle.landed = Landed.ON_GROUND
    flight.advance(500 * MS)
    flight.vehicle.armed = False
    flight.advance(4 * MS)
    reader, records = read_dataflash(flight.logs[0], tmp_path)
    modes = [(mode.TimeUS, mode.Mode) for mode in of(records, "MODE")]
    assert modes == [(4000, 4), (516_000, 9)]
    assert [mode for mode, _, _ in reader.flightmode_list()][-2:] == ["GUIDED", "LAND"]
    texts = [text.Message for text in of(records, "MSG")]
    assert texts == ["ArduCopter V4.5.7", "Frame: QUAD/X", "Arming motors"]
    assert [event.Id for event in of(records, "EV")] == [10, 28, 18, 11]


def test_parameters_with_their_defaults_and_changes_in_flight(tmp_path: Path) -> None:
    flight = Flight("ardupilot")
    default = flight.parameters.get("RTL_ALT")
    flight.parameters.set("RTL_ALT", default + 100.0)
    flight.vehicle.armed = True
    flight.advance(500 * MS)
    flight.parameters.set("RTL_ALT", default + 200.0)
    flight.advance(500 * MS)
    _, records = read_dataflash(flight.logs[0], tmp_path)
    told = of(records, "PARM")
    count = len(flight.parameters)
    assert [record.Name for record in told[:count]] == [s.name for s in flight.parameters.specs]
    values = [(each.Value, each.Default) for each in told if each.Name == "RTL_ALT"]
    assert values == [(default + 100.0, default), (default + 200.0, default)]


def test_units_are_those_that_fmtu_names(tmp_path: Path) -> None:
    flight = Flight("ardupilot")
    flight.fly()
    reader, _ = read_dataflash(flight.logs[0], tmp_path)
    formats = {form.name: form for form in reader.formats.values()}
    assert formats["ATT"].get_unit("Roll") == "deg"
    assert formats["BAT"].get_unit("CurrTot") == "mAh"
    assert formats["RCOU"].get_unit("C1") == "us"
    assert formats["GPS"].get_unit("GMS") == "ms"
    assert {form.get_unit("TimeUS") for form in reader.formats.values() if form.name != "FMT"} == {
        "µs"
    }
