"""What the gate hears of a vehicle's messages, and what it does not."""

from __future__ import annotations

import math
from collections.abc import Iterable

import pytest

from gcs.gate import inputs
from gcs.gate.condition import Condition
from gcs.gate.states import FlightMode
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.session.work import GateInput, Work, condition
from gcs.vehicle.message_to_telemetry import updates
from gcs.wire.messages import Attitude, GpsGlobalOrigin, Heartbeat, HomePosition
from tests.unit.station.vehicles import (
    HOME,
    SECOND_NS,
    attitude,
    global_position,
    position,
    system_status,
    vehicle,
)


def given(found: Iterable[Work]) -> list[inputs.Input]:
    """What the gate is told."""
    return [item.given for item in found if isinstance(item, GateInput)]


def origin() -> GpsGlobalOrigin:
    return GpsGlobalOrigin(latitude=473977420, longitude=85455940, altitude=488_000)


def test_a_position_is_heard_with_its_own_stamp_and_kept_with_its_arrival() -> None:
    seen = vehicle()
    heard = list(updates(position(1000, 1.0, 2.0, -3.0), seen, 5 * SECOND_NS))
    assert GateInput(inputs.PositionSeen((1.0, 2.0, -3.0), (0.0, 0.0, 0.0), 1000)) in heard
    assert seen.position_ns == 5 * SECOND_NS


def test_a_position_comes_with_the_heading_that_was_told_of_late() -> None:
    seen = vehicle()
    list(updates(Attitude(0, 0.0, 0.0, 0.7, 0.0, 0.0, 0.0), seen, SECOND_NS))
    for more_ns, yaw_rad in enumerate((0.7, None)):
        (heard,) = given(updates(position(1000 + more_ns), seen, 2 * SECOND_NS + more_ns))
        assert isinstance(heard, inputs.PositionSeen)
        assert heard.yaw_rad == yaw_rad


@pytest.mark.parametrize("overtaken_ms", [1000, 970])
def test_a_duplicate_or_overtaken_position_is_not_fresh(overtaken_ms: int) -> None:
    seen = vehicle()
    list(updates(position(1000), seen, SECOND_NS))
    assert list(updates(position(overtaken_ms, 9.0), seen, 2 * SECOND_NS)) == []
    assert seen.position_ns == SECOND_NS
    assert seen.pos_ned == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_a_position_that_is_no_number_is_no_position(bad: float) -> None:
    seen = vehicle()
    assert list(updates(position(1000, bad), seen, SECOND_NS)) == []
    assert seen.pos_ned is None


def test_a_clock_that_went_back_is_a_restart_and_the_origin_is_asked_for_again() -> None:
    seen = vehicle()
    list(updates(origin(), seen, SECOND_NS))
    list(updates(position(60_000), seen, SECOND_NS))
    assert list(updates(position(200), seen, 2 * SECOND_NS)) == []
    heard = list(updates(position(230), seen, 2 * SECOND_NS + 30_000_000))
    assert (
        GateInput(inputs.PositionSeen((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 230, reset=True)) in heard
    )
    assert seen.origin is None
    assert seen.home_ned is None


def test_one_position_that_lost_its_way_for_long_is_no_restart() -> None:
    seen = vehicle()
    list(updates(position(60_000), seen, SECOND_NS))
    assert list(updates(position(200), seen, SECOND_NS + 1)) == []
    assert len(list(updates(position(60_030), seen, SECOND_NS + 30_000_000))) == 2
    assert list(updates(position(231), seen, SECOND_NS + 40_000_000)) == []


def test_a_position_that_waited_on_the_way_is_old_when_it_comes() -> None:
    seen = vehicle()
    list(updates(position(1_000), seen, 10 * SECOND_NS))
    assert list(updates(position(1_100), seen, 13 * SECOND_NS)) == []
    assert len(list(updates(position(4_000), seen, 13 * SECOND_NS + 1))) == 2


def test_an_attitude_that_is_no_number_is_none() -> None:
    seen = vehicle()
    list(updates(attitude(math.inf), seen, SECOND_NS))
    assert seen.yaw_rad is None
    list(updates(attitude(0.5), seen, SECOND_NS))
    assert seen.yaw_rad == 0.5


def test_a_battery_that_is_not_measured_is_not_empty() -> None:
    seen = vehicle()
    assert list(updates(system_status(-1), seen, SECOND_NS)) == []
    assert seen.battery_pct is None


def test_a_heartbeat_of_another_kind_from_the_same_ids_is_not_the_vehicle_s() -> None:
    station = Heartbeat(
        custom_mode=0, type=6, autopilot=8, base_mode=0, system_status=4, mavlink_version=3
    )
    assert list(updates(station, vehicle(), SECOND_NS)) == []


def test_home_is_placed_by_the_origin_and_never_by_its_own_local_fields() -> None:
    seen = vehicle()
    home = HomePosition(
        latitude=473977420,
        longitude=85455940,
        altitude=490_000,
        x=99.0,
        y=99.0,
        z=99.0,
        q=(1.0, 0.0, 0.0, 0.0),
        approach_x=0.0,
        approach_y=0.0,
        approach_z=0.0,
    )
    assert list(updates(home, seen, SECOND_NS)) == []
    heard = list(updates(origin(), seen, SECOND_NS))
    (where,) = [told.pos_ned for told in given(heard) if isinstance(told, inputs.HomeSeen)]
    assert where == pytest.approx((0.0, 0.0, -2.0), abs=1e-6)


@pytest.mark.parametrize(("east_off_deg", "disagree"), [(0.0, False), (0.001, True)])
def test_local_and_global_positions_that_disagree_are_a_condition(
    east_off_deg: float, disagree: bool
) -> None:
    seen = vehicle()
    list(updates(origin(), seen, SECOND_NS))
    list(updates(position(1000), seen, SECOND_NS))
    message = global_position(HOME.lat_deg, HOME.lon_deg + east_off_deg)
    heard = list(updates(message, seen, SECOND_NS + 1))
    (told,) = [told for told in given(heard) if isinstance(told, inputs.ConditionChanged)]
    assert told.condition is Condition.ORIGIN_MISMATCH
    assert told.active is disagree


@pytest.mark.parametrize(("north_m", "east_m"), [(500.0, 0.0), (0.0, 500.0), (-300.0, 200.0)])
def test_away_from_the_origin_a_pair_of_positions_that_agrees_is_none(
    north_m: float, east_m: float
) -> None:
    """On px4's sphere of 6,371,000 m a degree of latitude is 111,194.93 m."""
    seen = vehicle()
    list(updates(origin(), seen, SECOND_NS))
    list(updates(position(1000, north_m, east_m), seen, SECOND_NS))
    degree_m = 111_194.93
    east_degree_m = degree_m * math.cos(math.radians(HOME.lat_deg))
    message = global_position(
        HOME.lat_deg + north_m / degree_m, HOME.lon_deg + east_m / east_degree_m
    )
    heard = list(updates(message, seen, SECOND_NS + 1))
    (told,) = [told for told in given(heard) if isinstance(told, inputs.ConditionChanged)]
    assert not told.active


def test_an_old_pair_of_positions_is_not_compared() -> None:
    seen = vehicle()
    list(updates(origin(), seen, SECOND_NS))
    list(updates(position(1000), seen, SECOND_NS))
    heard = list(updates(global_position(0.0, 0.0), seen, 2 * SECOND_NS))
    assert not [told for told in given(heard) if isinstance(told, inputs.ConditionChanged)]


@pytest.mark.parametrize(
    ("autopilot", "custom_mode", "meaning"),
    [
        (PX4, 6 << 16, FlightMode.GUIDED),
        (PX4, 4 << 16 | 3 << 24, FlightMode.HOLD),
        (ARDUPILOT, 4, FlightMode.GUIDED),
        (ARDUPILOT, 17, FlightMode.HOLD),
        (ARDUPILOT, 99, FlightMode.OTHER),
    ],
)
def test_a_heartbeat_tells_what_its_mode_means(
    autopilot: Autopilot, custom_mode: int, meaning: FlightMode
) -> None:
    beat = Heartbeat(
        custom_mode=custom_mode,
        type=2,
        autopilot=autopilot.mav_autopilot,
        base_mode=1 | 128,
        system_status=4,
        mavlink_version=3,
    )
    first, failsafe = updates(beat, vehicle(autopilot), SECOND_NS)
    assert isinstance(first, GateInput)
    told = first.given
    assert isinstance(told, inputs.HeartbeatSeen)
    assert (told.armed, told.mode) == (True, meaning)
    assert failsafe == condition(Condition.VEHICLE_FAILSAFE_ACTIVE, False, "")
