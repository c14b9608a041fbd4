"""Setpoints: masks, frames, and values that must not be flown."""

from __future__ import annotations

import math

import pytest

from tests.unit.vehicle_services.fake_vehicle import Bench, S
from vehicle_sim.autopilot.interface import AttitudeSetpoint, Setpoint
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import MavFrame

POSITION = 3576
POSITION_AND_YAW = 2552
VELOCITY = 0x0DC7
YAW_EAST = (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))


def local(
    mask: int,
    x: float = 0.0,
    y: float = 0.0,
    z: float = 0.0,
    vx: float = 0.0,
    vy: float = 0.0,
    vz: float = 0.0,
    yaw: float = 0.0,
    frame: int = MavFrame.LOCAL_NED,
) -> m.SetPositionTargetLocalNed:
    return m.SetPositionTargetLocalNed(0, x, y, z, vx, vy, vz, 0, 0, 0, yaw, 0, mask, 1, 1, frame)


def flown(bench: Bench) -> list[object]:
    return [call[0] for call in bench.vehicle.named("set_setpoint")]


def test_a_position_alone() -> None:
    bench = Bench()
    bench.send(local(POSITION, 1.0, 2.0, -3.0, vx=math.nan, yaw=math.nan))
    assert flown(bench) == [Setpoint(pos_ned=(1.0, 2.0, -3.0))]


def test_a_position_with_a_heading() -> None:
    bench = Bench()
    bench.send(local(POSITION_AND_YAW, 1.0, 2.0, -3.0, yaw=0.5))
    assert flown(bench) == [Setpoint(pos_ned=(1.0, 2.0, -3.0), yaw_rad=0.5)]


def test_a_velocity_in_the_body_frame_turns_with_the_vehicle() -> None:
    bench = Bench()
    bench.vehicle.q_ned_from_frd = YAW_EAST
    bench.send(local(VELOCITY, vx=2.0, frame=MavFrame.BODY_NED))
    (setpoint,) = flown(bench)
    assert isinstance(setpoint, Setpoint)
    assert setpoint.v_ned == pytest.approx((0.0, 2.0, 0.0), abs=1e-6)


def test_offsets_count_from_where_the_vehicle_is_on_ardupilot() -> None:
    bench = Bench("ardupilot")
    bench.vehicle.q_ned_from_frd = YAW_EAST
    bench.send(local(POSITION, 1.0, 0.0, -1.0, frame=MavFrame.LOCAL_OFFSET_NED))
    bench.send(local(POSITION, 1.0, 0.0, -1.0, frame=MavFrame.BODY_OFFSET_NED))
    first, second = flown(bench)
    assert isinstance(first, Setpoint)
    assert isinstance(second, Setpoint)
    assert first.pos_ned == pytest.approx((11.0, 20.0, -6.0))
    assert second.pos_ned == pytest.approx((10.0, 21.0, -6.0))


@pytest.mark.parametrize(
    ("personality", "frame"),
    [
        ("px4", MavFrame.LOCAL_OFFSET_NED),
        ("px4", MavFrame.BODY_OFFSET_NED),
        ("px4", MavFrame.GLOBAL_INT),
        ("ardupilot", MavFrame.GLOBAL_TERRAIN_ALT_INT),
        ("ardupilot", 99),
    ],
)
def test_a_frame_that_the_autopilot_does_not_know_is_refused(
    personality: Personality, frame: int
) -> None:
    bench = Bench(personality)
    bench.send(local(POSITION, frame=frame))
    assert flown(bench) == []


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 3e38])
@pytest.mark.parametrize("field", range(4), ids=["x", "y", "z", "yaw"])
def test_nothing_absurd_is_flown_and_the_log_says_so_once(field: int, bad: float) -> None:
    bench = Bench("ardupilot")
    x, y, z, yaw = (bad if number == field else 0.0 for number in range(4))
    asked = local(POSITION_AND_YAW, x, y, z, yaw=yaw)
    bench.send(asked)
    bench.send(asked)
    assert flown(bench) == []
    assert len([line for line in bench.logs if line.level == "warning"]) == 1


def test_a_number_that_is_none_is_left_out_by_px4() -> None:
    """MAVLink's NaN is PX4's own "not this one": no heading."""
    bench = Bench("px4")
    bench.send(local(POSITION_AND_YAW, 1.0, 2.0, -3.0, yaw=math.nan))
    assert flown(bench) == [Setpoint(pos_ned=(1.0, 2.0, -3.0))]
    assert not [line for line in bench.logs if line.level == "warning"]


def test_a_mask_that_leaves_nothing_is_refused() -> None:
    bench = Bench()
    bench.send(local(0x0FFF))
    assert flown(bench) == []


def test_a_part_of_a_vector_is_taken_on_px4_and_ignored_whole_on_ardupilot() -> None:
    """Velocity over the ground, and a height."""
    asked = local(VELOCITY & ~0x4 | 0x20, 1.0, 2.0, -3.0, 1.0, 0.5, 0.0)
    px4, ardupilot = Bench("px4"), Bench("ardupilot")
    px4.send(asked)
    ardupilot.send(asked)
    (setpoint,) = flown(px4)
    assert isinstance(setpoint, Setpoint)
    assert setpoint.pos_ned is not None
    assert setpoint.v_ned is not None
    assert (setpoint.pos_ned[2], setpoint.v_ned[:2]) == (-3.0, (1.0, 0.5))
    assert all(map(math.isnan, (*setpoint.pos_ned[:2], setpoint.v_ned[2])))
    assert flown(ardupilot) == []


def test_an_axis_without_position_and_velocity_is_refused_on_px4() -> None:
    bench = Bench("px4")
    bench.send(local(VELOCITY | 0x20, 0.0, 0.0, 0.0, 1.0, 0.5, 0.0))
    assert flown(bench) == []


def global_int(frame: int, lat: int, lon: int, alt: float) -> m.SetPositionTargetGlobalInt:
    return m.SetPositionTargetGlobalInt(
        0, lat, lon, alt, 0, 0, 0, 0, 0, 0, 0, 0, POSITION, 1, 1, frame
    )


@pytest.mark.parametrize(
    ("frame", "alt"), [(MavFrame.GLOBAL_INT, 500.0), (MavFrame.GLOBAL_RELATIVE_ALT_INT, 12.0)]
)
def test_a_global_place_knows_its_datum(frame: int, alt: float) -> None:
    bench = Bench()
    bench.send(global_int(frame, 473977420, 85455940, alt))
    (setpoint,) = flown(bench)
    assert isinstance(setpoint, Setpoint)
    assert setpoint.pos_ned == pytest.approx((0.0, 0.0, -12.0), abs=1e-3)


def test_a_global_place_needs_an_origin_and_must_be_on_earth() -> None:
    bench = Bench()
    bench.send(global_int(MavFrame.GLOBAL_INT, 1_900_000_000, 0, 0.0))
    bench.vehicle.origin = None
    bench.send(global_int(MavFrame.GLOBAL_INT, 473977420, 85455940, 500.0))
    assert flown(bench) == []


def attitude(mask: int, q: tuple[float, ...], thrust: float) -> m.SetAttitudeTarget:
    return m.SetAttitudeTarget(0, q, 0.1, 0.2, 0.3, thrust, 1, 1, mask)


def test_an_attitude_is_normalised_and_its_rates_are_masked_one_by_one() -> None:
    bench = Bench()
    bench.send(attitude(0b0000_0001, (1.01, 0.0, 0.0, 0.0), 0.5))
    ((setpoint,),) = bench.vehicle.named("set_attitude")
    assert isinstance(setpoint, AttitudeSetpoint)
    assert setpoint.q_ned_from_frd == (1.0, 0.0, 0.0, 0.0)
    assert setpoint.rates_frd == pytest.approx((0.0, 0.2, 0.3))


@pytest.mark.parametrize(
    ("mask", "q", "thrust"),
    [
        (0x40, (1.0, 0.0, 0.0, 0.0), 0.5),
        (0x87, (1.0, 0.0, 0.0, 0.0), 0.5),
        (0x07, (0.0, 0.0, 0.0, 0.0), 0.5),
        (0x07, (math.nan, 0.0, 0.0, 0.0), 0.5),
        (0x07, (1.0, 0.0, 0.0, 0.0), math.nan),
        (0x07, (1.0, 0.0, 0.0, 0.0), 1.5),
    ],
)
def test_an_attitude_that_cannot_be_flown_is_not(
    mask: int, q: tuple[float, ...], thrust: float
) -> None:
    bench = Bench()
    bench.send(attitude(mask, q, thrust))
    assert bench.vehicle.named("set_attitude") == []


def test_a_ground_stations_heartbeat_is_heard_with_wall_time_and_a_vehicles_is_not() -> None:
    bench = Bench()
    bench.advance(1 * S)
    bench.send(m.Heartbeat(0, 6, 8, 0, 4, 3))
    bench.send(m.Heartbeat(0, 2, 12, 0, 4, 3), system=2, component=1)
    assert bench.vehicle.named("gcs_heard") == [(1 * S,)]
