"""What sensors and estimator report, by builder: true values, true units, true flags."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.unit.vehicle_services.fake_vehicle import FakeVehicle
from vehicle_sim.autopilot.interface import FenceState
from vehicle_sim.services.profile import PROFILES, Profile
from vehicle_sim.services.telemetry import sensors as build
from vehicle_sim.services.telemetry.sys_status import sys_status
from vehicle_sim.wire.ids import EkfFlag, EstimatorFlag, Sensor

PX4, ARDUPILOT = PROFILES["px4"], PROFILES["ardupilot"]
GOOD_FLAGS = 831  # what both autopilots report with GPS and without a range finder
NO_GPS_FLAGS = 165  # attitude, climb, height, constant position mode
LOST = {"gps_ok": False, "gps_fix": 1, "satellites": 0}


def fake(**changes: object) -> FakeVehicle:
    vehicle = FakeVehicle()
    vehicle.health = replace(vehicle.health, **changes)  # type: ignore[arg-type]
    return vehicle


def unhealthy(vehicle: FakeVehicle) -> Sensor:
    """Present, and said to be not healthy."""
    status = sys_status(vehicle, ARDUPILOT)
    return Sensor(status.onboard_control_sensors_present & ~status.onboard_control_sensors_health)


def test_a_sound_vehicle_has_nothing_unhealthy() -> None:
    assert unhealthy(fake()) == Sensor(0)


@pytest.mark.parametrize(
    ("changes", "bits"),
    [
        ({"mag_ok": False}, Sensor.MAG_3D),
        ({"baro_ok": False}, Sensor.ABSOLUTE_PRESSURE),
        ({"height_ok": False}, Sensor.Z_ALTITUDE_CONTROL),
        (LOST, Sensor.GPS),
        ({**LOST, "position_ok": False}, Sensor.GPS | Sensor.XY_POSITION_CONTROL),
        ({"position_ok": False}, Sensor.GPS | Sensor.XY_POSITION_CONTROL),
        (
            {"attitude_ok": False},
            Sensor.AHRS | Sensor.ATTITUDE_STABILIZATION | Sensor.YAW_POSITION,
        ),
    ],
)
def test_each_trouble_takes_its_own_health_bits(changes: dict[str, object], bits: Sensor) -> None:
    assert unhealthy(fake(**changes)) == bits


def test_px4_tells_the_sensors_that_the_real_one_tells() -> None:
    """behaviour.json rank 3: present 0x0220002d, enabled 0x0221002d, of health 0x2220803f to
    0x3220803f; PREARM_CHECK (0x10000000) is present here, too."""
    vehicle = fake()
    status = sys_status(vehicle, PX4)
    assert status.onboard_control_sensors_present == 0x0220002D | Sensor.PREARM_CHECK
    assert status.onboard_control_sensors_enabled == 0x0221002D | Sensor.PREARM_CHECK
    assert status.onboard_control_sensors_health == 0x3220803F
    vehicle.armable = False
    assert sys_status(vehicle, PX4).onboard_control_sensors_health == 0x2220803F


@pytest.mark.parametrize(("profile", "healthy"), [(PX4, False), (ARDUPILOT, True)])
def test_a_fence_that_there_is_not_is_healthy(profile: Profile, healthy: bool) -> None:
    """ArduPilot's `sys_status_failed`; MAVProxy says "fence breach" without the bit, as it does
    of a real PX4, which is recorded without it."""
    vehicle = fake()
    status = sys_status(vehicle, profile)
    assert not status.onboard_control_sensors_present & Sensor.GEOFENCE
    assert bool(status.onboard_control_sensors_health & Sensor.GEOFENCE) is healthy
    vehicle.fence_state = FenceState(True, True, True, 1, 3, 0)
    status = sys_status(vehicle, profile)
    assert not status.onboard_control_sensors_health & Sensor.GEOFENCE, "breached"


def test_gps_raw_int_is_the_receiver_and_not_the_estimate() -> None:
    fix = build.gps_raw_int(fake(), PX4)
    assert (fix.lat, fix.lon, fix.alt) == (473978500, 85459500, 492000)
    assert (fix.fix_type, fix.satellites_visible) == (3, 12)
    assert (fix.vel, fix.cog) == (500, 5313)  # 3 m/s north, 4 m/s east
    assert (fix.eph, fix.epv) == (80, 110)  # dilutions of precision, times 100
    assert (fix.h_acc, fix.v_acc) == (600, 900)


def test_without_a_fix_gps_raw_int_says_unknown() -> None:
    vehicle = fake()
    vehicle.gps = vehicle.gps._replace(
        fix_type=1, satellites=0, eph_m=float("inf"), epv_m=float("inf")
    )
    fix = build.gps_raw_int(vehicle, PX4)
    assert (fix.fix_type, fix.satellites_visible) == (1, 0)
    assert (fix.eph, fix.epv, fix.vel, fix.cog) == (65535,) * 4
    assert (fix.h_acc, fix.v_acc, fix.vel_acc) == (0, 0, 0)


def test_estimator_status_has_the_filters_own_figures() -> None:
    status = build.estimator_status(fake(accuracy_m=4.5, mag_ratio=0.4), PX4)
    assert status.flags == GOOD_FLAGS
    assert (status.vel_ratio, status.pos_horiz_ratio) == (0.05, 0.1)
    assert (status.pos_vert_ratio, status.mag_ratio) == (0.03, 0.4)
    assert status.pos_horiz_accuracy == 4.5


@pytest.mark.parametrize(
    ("changes", "px4", "ardupilot"),
    [
        ({}, GOOD_FLAGS, GOOD_FLAGS),
        # Fresh from the outage the position is still good.
        (LOST, GOOD_FLAGS, GOOD_FLAGS),
        ({**LOST, "position_ok": False, "velocity_ok": False}, NO_GPS_FLAGS, NO_GPS_FLAGS),
        (
            {"gps_ok": False},
            GOOD_FLAGS | EstimatorFlag.GPS_GLITCH,
            GOOD_FLAGS | EkfFlag.GPS_GLITCHING,
        ),
        (
            {
                **LOST,
                "attitude_ok": False,
                "height_ok": False,
                "position_ok": False,
                "velocity_ok": False,
            },
            EstimatorFlag.CONST_POS_MODE,
            EkfFlag.UNINITIALIZED | EstimatorFlag.CONST_POS_MODE,
        ),
    ],
)
def test_flags_of_both_filters(changes: dict[str, object], px4: int, ardupilot: int) -> None:
    vehicle = fake(**changes)
    assert build.estimator_status(vehicle, PX4).flags == px4
    assert build.ekf_status_report(vehicle, ARDUPILOT).flags == ardupilot


def test_ekf_status_report_has_the_innovations() -> None:
    report = build.ekf_status_report(fake(), ARDUPILOT)
    assert report[:5] == (0.05, 0.1, 0.03, 0.02, 0.0)


def test_highres_imu_is_si_and_gauss_and_what_the_sensors_say() -> None:
    imu = build.highres_imu(fake(), PX4)
    assert (imu.xacc, imu.yacc, imu.zacc) == (0.1, 0.2, -9.8)
    assert (imu.xgyro, imu.ygyro, imu.zgyro) == (0.01, -0.02, 0.03)
    assert (imu.xmag, imu.ymag, imu.zmag) == (0.21, 0.01, 0.43)
    assert imu.pressure_alt == 493.5
    assert imu.fields_updated == 0xBFF


def test_raw_and_scaled_imu_are_in_thousandths() -> None:
    thousandths = (10, 20, -999, 10, -20, 30, 210, 10, 430)
    assert build.raw_imu(fake(), ARDUPILOT)[1:10] == thousandths
    assert build.scaled_imu(fake(), ARDUPILOT)[1:10] == thousandths


def test_pressure_is_the_standard_atmospheres() -> None:
    vehicle = fake()
    # ISA tables: 955.3 hPa at 493.5 m.
    assert build.scaled_pressure(vehicle, PX4).press_abs == pytest.approx(955.3, abs=0.1)
    assert build.highres_imu(vehicle, PX4).abs_pressure == pytest.approx(955.3, abs=0.1)
