"""Flown from outside: entry, steps, velocity, silence; px4's OFFBOARD and ardupilot's GUIDED."""

from __future__ import annotations

from math import acos, cos, degrees, hypot, inf, nan, pi, sin

import pytest

from tests.unit.autopilot.flight import Flight
from vehicle_sim.autopilot.interface import AttitudeSetpoint, Landed, Result, Setpoint
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.numerics.vectors import Vec3

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)
HERE = Setpoint(pos_ned=(0.0, 0.0, -5.0))


def guided(personality: Personality) -> Flight:
    """Hovering at 5 m, flown by a stream of setpoints."""
    flight = Flight.hovering(personality, 5.0)
    flight.stream(HERE, 1.5)
    assert flight.vehicle.set_mode_kind("guided") is Result.ACCEPTED
    flight.stream(HERE, 0.1)
    return flight


def test_offboard_is_refused_without_a_stream() -> None:
    flight = Flight.hovering("px4")
    assert flight.vehicle.set_mode_kind("guided") is Result.TEMPORARILY_REJECTED
    assert flight.vehicle.mode_name == "AUTO.LOITER"


def test_offboard_asked_for_with_the_first_setpoint_begins_after_a_second_of_stream() -> None:
    flight = Flight.hovering("px4")
    flight.vehicle.set_setpoint(HERE)
    assert flight.vehicle.set_mode_kind("guided") is Result.ACCEPTED
    flight.stream(HERE, 0.9)
    assert flight.vehicle.mode_name == "AUTO.LOITER"
    flight.stream(HERE, 0.2)
    assert flight.vehicle.mode_name == "OFFBOARD"


def test_offboard_asked_for_by_a_stream_that_dies_is_never_entered() -> None:
    flight = Flight.hovering("px4")
    flight.vehicle.set_setpoint(HERE)
    flight.vehicle.set_mode_kind("guided")
    flight.fly(3.0)
    assert flight.vehicle.mode_name == "AUTO.LOITER"
    assert "Switching to OFFBOARD is currently not available" in flight.texts()


@either
@pytest.mark.parametrize(
    "step", [(1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0), (0.0, 0.0, 1.0)]
)
def test_a_step_of_a_metre_arrives_within_three_seconds_and_hardly_overshoots(
    personality: Personality, step: Vec3
) -> None:
    flight = guided(personality)
    goal = (step[0], step[1], step[2] - 5.0)
    furthest = 0.0
    arrived_s = None
    for tick in range(80):
        flight.stream(Setpoint(pos_ned=goal), 0.05)
        along = sum((p - h) * s for p, h, s in zip(flight.pos, (0, 0, -5), step, strict=True))
        furthest = max(furthest, along)
        if arrived_s is None and flight.off(goal) < 0.5:
            arrived_s = tick * 0.05
    assert arrived_s is not None
    assert arrived_s < 2.0
    assert furthest < 1.15  # 0.15 m, of which the position error has its share
    assert flight.off(goal) < 0.25
    assert flight.speed_m_s < 0.25


@either
def test_a_hop_of_three_metres_takes_about_three_seconds(personality: Personality) -> None:
    flight = guided(personality)
    flight.stream(Setpoint(pos_ned=(0.0, 3.0, -5.0)), 3.0)
    # PX4 comes to within 0.5 m of a step of 10 m in 3.3 s (I1_step_response).
    assert flight.off((0.0, 3.0, -5.0)) < (0.5 if personality == "px4" else 0.35)
    assert flight.speed_m_s < 0.5


def test_a_long_leg_is_straight_and_keeps_the_speed_limit() -> None:
    """ArduCopter's; PX4's is a step for its loops, see below."""
    flight = guided("ardupilot")
    goal = (30.0, 30.0, -15.0)
    fastest = 0.0
    for _ in range(400):
        flight.stream(Setpoint(pos_ned=goal), 0.05)
        n, e, d = flight.pos
        assert abs(n - e) < 0.5
        assert abs((-d - 5.0) - n / 3.0) < 1.0
        v = flight.vehicle.truth.v_ned
        fastest = max(fastest, (v[0] ** 2 + v[1] ** 2) ** 0.5)
    assert 0.8 * 10.0 < fastest < 1.12 * 10.0
    assert flight.off(goal) < 0.5
    assert flight.astray_m < 1.0


def test_px4_flies_a_far_setpoint_as_fast_as_it_ever_flies() -> None:
    """I1_step_response: OFFBOARD's steps are not smoothed; neither cruise speed nor line count."""
    flight = Flight("px4").airborne(5.0)
    flight.stream(HERE, 1.5)
    assert flight.vehicle.set_mode_kind("guided") is Result.ACCEPTED
    goal = (60.0, 60.0, -15.0)
    fastest = steepest = 0.0
    for _ in range(500):
        flight.stream(Setpoint(pos_ned=goal), 0.05)
        v = flight.vehicle.truth.v_ned
        fastest = max(fastest, hypot(v[0], v[1]))
        _, x, y, _ = flight.vehicle.truth.q_ned_from_frd
        steepest = max(steepest, degrees(acos(1.0 - 2.0 * (x * x + y * y))))
    assert 0.9 * 12.0 < fastest < 1.12 * 12.0  # MPC_XY_VEL_MAX
    assert 40.0 < steepest < 50.0  # MPC_TILTMAX_AIR; 48 as recorded
    assert flight.off(goal) < 0.5


@either
def test_a_velocity_setpoint_is_flown(personality: Personality) -> None:
    flight = guided(personality)
    flight.stream(Setpoint(v_ned=(2.0, -1.0, 0.0)), 4.0)
    assert flight.vehicle.truth.v_ned == pytest.approx((2.0, -1.0, 0.0), abs=0.2)
    assert flight.vehicle.target.v_ned == (2.0, -1.0, 0.0)


@either
def test_an_acceleration_setpoint_is_flown(personality: Personality) -> None:
    flight = guided(personality)
    flight.stream(Setpoint(a_ned=(1.0, 0.0, 0.0)), 2.0)
    # 2 m/s, less what the drag of rotors and body takes of it on the way.
    assert flight.vehicle.truth.v_ned[0] == pytest.approx(1.75, abs=0.4)


@either
def test_the_heading_follows_yaw_and_yaw_rate(personality: Personality) -> None:
    flight = guided(personality)
    flight.stream(Setpoint(pos_ned=(0.0, 0.0, -5.0), yaw_rad=1.5), 4.0)
    assert flight.vehicle.estimate.heading_rad == pytest.approx(1.5, abs=0.05)
    flight.stream(Setpoint(pos_ned=(0.0, 0.0, -5.0), yaw_rate_rad_s=-0.5), 4.0)
    assert flight.vehicle.estimate.heading_rad == pytest.approx(2.0 * pi - 0.5, abs=0.15)
    assert flight.off((0.0, 0.0, -5.0)) < 0.4


def test_offboard_loss_without_sticks_comes_down_lands_and_disarms() -> None:
    """behaviour.json: 1.0 s after the last setpoint, at 0.70 to 0.85 m/s; then OFFBOARD again."""
    flight = guided("px4")
    flight.stream(Setpoint(v_ned=(2.0, 0.0, 0.0)), 3.0)
    flight.fly(0.8)
    assert flight.vehicle.mode_name == "OFFBOARD"
    flight.fly(0.3)
    assert flight.vehicle.mode_name == "POSCTL"
    assert flight.vehicle.base_mode == 209
    assert flight.vehicle.system_status == 5
    flight.fly(3.0)
    north, east, down = flight.vehicle.truth.v_ned
    assert hypot(north, east) < 0.3
    assert 0.70 < down < 0.85
    flight.fly(20.0, lambda: not flight.vehicle.armed)
    assert flight.up_m < 0.1
    flight.fly(0.2)
    assert flight.vehicle.mode_name == "OFFBOARD"


@pytest.mark.parametrize(
    ("action", "mode"), [(3, "AUTO.RTL"), (4, "AUTO.LAND"), (5, "AUTO.LOITER")]
)
def test_offboard_loss_does_what_the_parameter_says(action: int, mode: str) -> None:
    flight = guided("px4")
    flight.vehicle.parameters.set("COM_OBL_RC_ACT", action)
    flight.vehicle.parameters.set("COM_OF_LOSS_T", 0.5)
    flight.fly(0.6)
    assert flight.vehicle.mode_name == mode


def test_offboard_does_not_arm_without_its_stream() -> None:
    flight = Flight("px4").boot()
    flight.stream(HERE, 1.5)
    flight.vehicle.set_mode_kind("guided")
    assert flight.armable()
    flight.fly(1.0)
    assert not flight.armable()


def test_offboard_loss_runs_on_wall_time() -> None:
    flight = guided("px4")
    flight.vehicle.wall(10_000_000_000)
    flight.vehicle.set_setpoint(HERE)
    flight.fly(5.0)
    assert flight.vehicle.mode_name == "OFFBOARD"
    flight.vehicle.wall(11_100_000_000)
    flight.fly(0.1)
    assert flight.vehicle.mode_name == "POSCTL"


def test_ardupilot_keeps_a_position_goal_when_the_stream_ends() -> None:
    flight = guided("ardupilot")
    flight.vehicle.set_setpoint(Setpoint(pos_ned=(20.0, 0.0, -5.0)))
    flight.fly(15.0)
    assert flight.off((20.0, 0.0, -5.0)) < 0.4
    assert flight.vehicle.mode_name == "GUIDED"


def test_ardupilot_brakes_three_seconds_after_the_last_velocity() -> None:
    flight = guided("ardupilot")
    flight.stream(Setpoint(v_ned=(2.0, 0.0, 0.0)), 3.0)
    flight.fly(2.5)
    assert flight.speed_m_s > 1.8
    flight.fly(3.0)
    assert flight.speed_m_s < 0.25
    assert flight.vehicle.target.v_ned is None


def test_px4_offboard_takes_off_by_a_setpoint_above_the_ground() -> None:
    flight = Flight("px4").boot()
    up = Setpoint(pos_ned=(0.0, 0.0, -3.0))
    flight.stream(up, 1.5)
    flight.vehicle.set_mode_kind("guided")
    flight.vehicle.arm(False)
    flight.stream(up, 5.0)
    assert flight.up_m == pytest.approx(3.0, abs=0.3)
    flight.stream(Setpoint(pos_ned=(0.0, 0.0, 1.0)), 6.0)
    assert flight.landed() is Landed.ON_GROUND


def test_ardupilot_guided_does_not_take_off_by_a_setpoint() -> None:
    flight = Flight("ardupilot").boot()
    flight.vehicle.set_mode_kind("guided")
    flight.vehicle.arm(False)
    flight.stream(Setpoint(pos_ned=(0.0, 0.0, -3.0)), 3.0)
    assert flight.up_m < 0.01


@either
def test_an_attitude_setpoint_is_flown(personality: Personality) -> None:
    flight = guided(personality)
    tilt = 0.1
    q = (cos(tilt / 2.0), 0.0, -sin(tilt / 2.0), 0.0)  # nose down: forwards
    thrust = 0.5 if personality == "ardupilot" else 1.5 * 9.80665 / (4 * 8.5)
    for _ in range(40):
        flight.vehicle.set_attitude(AttitudeSetpoint(q, None, thrust))
        flight.fly(0.05)
    assert flight.vehicle.truth.v_ned[0] > 1.0
    assert abs(flight.vehicle.truth.v_ned[2]) < 0.8


@either
def test_reposition_flies_there_and_stays(personality: Personality) -> None:
    flight = Flight.hovering(personality, 5.0)
    assert flight.vehicle.reposition((4.0, 4.0, -6.0), 0.5, 3.0) is Result.ACCEPTED
    flight.fly(6.0)
    assert flight.off((4.0, 4.0, -6.0)) < 0.35
    assert flight.vehicle.estimate.heading_rad == pytest.approx(0.5, abs=0.05)
    assert flight.vehicle.mode_name == ("AUTO.LOITER" if personality == "px4" else "GUIDED")


@either
def test_hold_stops_in_mid_leg_within_the_braking_distance(personality: Personality) -> None:
    flight = guided(personality)
    flight.stream(Setpoint(pos_ned=(60.0, 0.0, -5.0)), 5.0)
    speed, north = flight.speed_m_s, flight.pos[0]
    assert speed > 4.5
    flight.vehicle.set_mode_kind("brake")
    flight.fly(1.0 + speed * 0.8)
    assert flight.speed_m_s < 0.25
    assert flight.pos[0] - north < speed * 0.8 + speed * speed / (2.0 * 1.5)
    assert abs(flight.up_m - 5.0) < 0.4


@either
@pytest.mark.parametrize(
    "bad",
    [
        Setpoint(pos_ned=(nan, 0.0, -5.0)),
        Setpoint(v_ned=(0.0, inf, 0.0)),
        Setpoint(pos_ned=(0.0, 0.0, -5.0), yaw_rad=nan),
        AttitudeSetpoint((0.0, 0.0, 0.0, 0.0), None, 0.5),
        AttitudeSetpoint(None, (nan, 0.0, 0.0), 0.5),
        AttitudeSetpoint(None, None, nan),
    ],
)
def test_a_setpoint_that_is_no_number_is_as_good_as_not_sent(
    personality: Personality, bad: Setpoint | AttitudeSetpoint
) -> None:
    flight, without = guided(personality), guided(personality)
    if isinstance(bad, Setpoint):
        flight.vehicle.set_setpoint(bad)
    else:
        flight.vehicle.set_attitude(bad)
    flight.fly(0.5)
    without.fly(0.5)
    assert flight.vehicle.target.pos_ned == (0.0, 0.0, -5.0)
    assert flight.pos == without.pos
