"""The vehicle as it reports itself: rates, attitude, and what a restart makes unknown."""

from __future__ import annotations

import math

import pytest

from gcs.frames import quat_from_euler
from gcs.gate.states import LandedState
from gcs.protocol.autopilot import ARDUPILOT
from tests.unit.station.vehicles import HOME, SECOND_NS, vehicle

MS_NS = 1_000_000
HALF = math.sqrt(0.5)


def rotate(q: tuple[float, float, float, float], v: tuple[float, float, float]) -> list[float]:
    """v' = q v q*, by the matrix of the quaternion."""
    w, x, y, z = q
    matrix = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return [sum(a * b for a, b in zip(row, v, strict=True)) for row in matrix]


@pytest.mark.parametrize(
    ("rpy_deg", "expected"),
    [
        ((0, 0, 0), (1.0, 0.0, 0.0, 0.0)),
        ((90, 0, 0), (HALF, HALF, 0.0, 0.0)),
        ((0, 90, 0), (HALF, 0.0, HALF, 0.0)),
        ((0, 0, 90), (HALF, 0.0, 0.0, HALF)),
        ((0, 0, 180), (0.0, 0.0, 0.0, 1.0)),
        ((90, 0, 90), (0.5, 0.5, 0.5, 0.5)),
    ],
)
def test_known_attitudes_are_known_quaternions(
    rpy_deg: tuple[float, float, float], expected: tuple[float, float, float, float]
) -> None:
    assert quat_from_euler(*map(math.radians, rpy_deg)) == pytest.approx(expected, abs=1e-12)


def test_yaw_turns_the_nose_from_north_to_east_and_pitch_lifts_it() -> None:
    nose = (1.0, 0.0, 0.0)
    east = rotate(quat_from_euler(0.0, 0.0, math.pi / 2), nose)
    assert east == pytest.approx((0.0, 1.0, 0.0), abs=1e-12)
    up = rotate(quat_from_euler(0.0, math.radians(30), 0.0), nose)
    assert up == pytest.approx((math.cos(math.radians(30)), 0.0, -0.5), abs=1e-12)


def test_roll_lowers_the_right_side_whatever_the_heading() -> None:
    for yaw_rad in (0.0, 1.0, -2.0):
        right = rotate(quat_from_euler(math.radians(30), 0.0, yaw_rad), (0.0, 1.0, 0.0))
        assert right[2] == pytest.approx(0.5)


def test_the_rate_of_frames_is_renewed_every_two_seconds() -> None:
    telemetry = vehicle()
    for n in range(1, 100):
        telemetry.count_frames(1, n * 20 * MS_NS)
    assert telemetry.rx_hz == 0.0
    telemetry.count_frames(1, 2 * SECOND_NS)
    assert telemetry.rx_hz == pytest.approx(50.0)
    for n in range(1, 6):
        telemetry.count_frames(4, 2 * SECOND_NS + n * 400 * MS_NS)
    assert telemetry.rx_hz == pytest.approx(10.0)


def test_the_rate_of_setpoints_is_that_of_the_last_two_seconds() -> None:
    telemetry = vehicle()
    for n in range(101):
        telemetry.count_setpoint(n * 50 * MS_NS)
    assert telemetry.setpoint_hz(5 * SECOND_NS) == pytest.approx(20.0)
    assert len(telemetry.setpoints_sent) <= 41


def test_a_stream_that_stopped_has_no_rate() -> None:
    telemetry = vehicle()
    for n in range(20):
        telemetry.count_setpoint(n * 50 * MS_NS)
    last_ns = 19 * 50 * MS_NS
    assert telemetry.setpoint_hz(last_ns + 200 * MS_NS) == pytest.approx(20.0)
    assert telemetry.setpoint_hz(last_ns + 300 * MS_NS) == 0.0


@pytest.mark.parametrize("count", [0, 1])
def test_less_than_two_setpoints_are_no_stream(count: int) -> None:
    telemetry = vehicle()
    for _ in range(count):
        telemetry.count_setpoint(SECOND_NS)
    assert telemetry.setpoint_hz(SECOND_NS) == 0.0


def test_after_a_restart_the_place_is_unknown_and_the_vehicle_is_the_same() -> None:
    telemetry = vehicle(ARDUPILOT)
    telemetry.origin, telemetry.home = HOME, (47.0, 8.0, 488.0)
    telemetry.home_ned, telemetry.landed = (0.0, 0.0, 0.0), LandedState.IN_AIR
    telemetry.forget_place()
    assert [telemetry.origin, telemetry.home, telemetry.home_ned] == [None, None, None]
    assert telemetry.landed is LandedState.UNDEFINED
    assert telemetry.label == "1/1 ardupilot quadrotor"


def test_what_was_not_reported_is_not_known() -> None:
    telemetry = vehicle()
    assert telemetry.armed is None
    assert telemetry.pos_ned is None
    assert telemetry.prearm_ok is None
    assert telemetry.battery_pct is None
    assert telemetry.landed is LandedState.UNDEFINED
