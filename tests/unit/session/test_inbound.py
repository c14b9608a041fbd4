"""What the gate hears of a vehicle's messages, and what it does not."""

from __future__ import annotations

import math

import pytest

from gcs.gate import types as gate
from gcs.protocol.autopilot import ARDUPILOT, PX4, Personality
from gcs.session.inbound import absorb
from gcs.wire.messages import GpsGlobalOrigin, Heartbeat, HomePosition
from tests.unit.session.vehicles import HOME, SECOND_NS, global_position, position, vehicle


def origin() -> GpsGlobalOrigin:
    return GpsGlobalOrigin(latitude=473977420, longitude=85455940, altitude=488_000)


def test_a_position_is_heard_with_its_own_stamp_and_kept_with_its_arrival() -> None:
    seen = vehicle()
    heard = list(absorb(position(1000, 1.0, 2.0, -3.0), seen, 5 * SECOND_NS))
    assert gate.PositionSeen((1.0, 2.0, -3.0), (0.0, 0.0, 0.0), 1000) in heard
    assert seen.position_ns == 5 * SECOND_NS


@pytest.mark.parametrize("overtaken_ms", [1000, 970])
def test_a_duplicate_or_overtaken_position_is_not_fresh(overtaken_ms: int) -> None:
    seen = vehicle()
    list(absorb(position(1000), seen, SECOND_NS))
    assert list(absorb(position(overtaken_ms, 9.0), seen, 2 * SECOND_NS)) == []
    assert seen.position_ns == SECOND_NS
    assert seen.pos_ned == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_a_position_that_is_no_number_is_no_position(bad: float) -> None:
    seen = vehicle()
    assert list(absorb(position(1000, bad), seen, SECOND_NS)) == []
    assert seen.pos_ned is None


def test_a_clock_that_went_back_is_a_restart_and_the_origin_is_asked_for_again() -> None:
    seen = vehicle()
    list(absorb(origin(), seen, SECOND_NS))
    list(absorb(position(60_000), seen, SECOND_NS))
    heard = list(absorb(position(200), seen, 2 * SECOND_NS))
    assert gate.PositionSeen((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 200, reset=True) in heard
    assert seen.origin is None


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
    assert list(absorb(home, seen, SECOND_NS)) == []
    heard = list(absorb(origin(), seen, SECOND_NS))
    (where,) = [told.pos_ned for told in heard if isinstance(told, gate.HomeSeen)]
    assert where == pytest.approx((0.0, 0.0, -2.0), abs=1e-6)


@pytest.mark.parametrize(("east_off_deg", "disagree"), [(0.0, False), (0.001, True)])
def test_local_and_global_positions_that_disagree_are_a_condition(
    east_off_deg: float, disagree: bool
) -> None:
    seen = vehicle()
    list(absorb(origin(), seen, SECOND_NS))
    list(absorb(position(1000), seen, SECOND_NS))
    message = global_position(HOME.lat_deg, HOME.lon_deg + east_off_deg)
    heard = list(absorb(message, seen, SECOND_NS + 1))
    (told,) = [told for told in heard if isinstance(told, gate.ConditionChanged)]
    assert told.condition is gate.Condition.ORIGIN_MISMATCH
    assert told.active is disagree


def test_an_old_pair_of_positions_is_not_compared() -> None:
    seen = vehicle()
    list(absorb(origin(), seen, SECOND_NS))
    list(absorb(position(1000), seen, SECOND_NS))
    heard = list(absorb(global_position(0.0, 0.0), seen, 2 * SECOND_NS))
    assert not [told for told in heard if isinstance(told, gate.ConditionChanged)]


@pytest.mark.parametrize(
    ("personality", "custom_mode", "meaning"),
    [
        (PX4, 6 << 16, gate.FlightMode.GUIDED),
        (PX4, 4 << 16 | 3 << 24, gate.FlightMode.HOLD),
        (ARDUPILOT, 4, gate.FlightMode.GUIDED),
        (ARDUPILOT, 17, gate.FlightMode.HOLD),
        (ARDUPILOT, 99, gate.FlightMode.OTHER),
    ],
)
def test_a_heartbeat_tells_what_its_mode_means(
    personality: Personality, custom_mode: int, meaning: gate.FlightMode
) -> None:
    beat = Heartbeat(
        custom_mode=custom_mode,
        type=2,
        autopilot=personality.autopilot,
        base_mode=1 | 128,
        system_status=4,
        mavlink_version=3,
    )
    (told,) = absorb(beat, vehicle(personality), SECOND_NS)
    assert isinstance(told, gate.HeartbeatSeen)
    assert (told.armed, told.mode) == (True, meaning)
