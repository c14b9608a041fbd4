"""What takes real time takes longer on the clock of a sped-up session."""

from __future__ import annotations

from collections import Counter

import pytest
from msgspec import structs

from gcs.config import StationConfig
from gcs.gate.policy.parse import DEFAULT
from gcs.session.times import Times
from tests.unit.session import told, wire
from tests.unit.session.station import Script

SPEEDS = pytest.mark.parametrize("speedup", [20.0, 50.0, 100.0])


def test_at_real_time_nothing_changes() -> None:
    assert Times().policy(DEFAULT) == DEFAULT
    assert Times().real_ns(7) == 7


def test_waits_for_the_other_side_do_not_shrink_and_flights_do_not_grow() -> None:
    fast = Times(10.0).policy(DEFAULT)
    assert fast.heartbeat_age_s == 10.0 * DEFAULT.heartbeat_age_s
    assert fast.photo_timeout_s == 10.0 * DEFAULT.photo_timeout_s
    assert fast.control.stream_s == 10.0 * DEFAULT.control.stream_s
    assert fast.control.timeout_s == 10.0 * DEFAULT.control.timeout_s
    assert fast.position_age_s == 10.0 * DEFAULT.position_age_s
    same = structs.replace(
        fast,
        heartbeat_age_s=DEFAULT.heartbeat_age_s,
        position_age_s=DEFAULT.position_age_s,
        photo_timeout_s=DEFAULT.photo_timeout_s,
        control=DEFAULT.control,
    )
    assert same == DEFAULT


def test_a_position_is_never_fresh_for_less_than_the_policy_says() -> None:
    assert Times(0.5).policy(DEFAULT).position_age_s == DEFAULT.position_age_s


@SPEEDS
def test_a_vehicle_is_waited_for_in_real_time(speedup: float) -> None:
    """station.md, bug 10: "no vehicle heard" after 10 s on a clock that runs so much faster."""
    script = Script(config=StationConfig(speedup=speedup, connect_timeout_s=1.0))
    script.run(0.9 * speedup)
    assert told.troubles(script.told) == []
    script.run(0.2 * speedup + 1.0)
    (trouble,) = told.troubles(script.told)
    assert "no vehicle heard for 1 s" in trouble.text


@SPEEDS
def test_a_parameter_is_waited_for_in_real_time(speedup: float) -> None:
    """station.md, bug 10: "GF_ACTION could not be read" within milliseconds."""

    def tries() -> set[int]:
        """How often each was asked for."""
        return set(Counter(m.param_id for m in script.sent("PARAM_REQUEST_READ")).values())

    script = Script(config=StationConfig(speedup=speedup))
    script.hear(wire.heartbeat())
    script.run(0.4 * speedup)
    assert tries() == {1}
    script.run(0.2 * speedup)
    assert tries() == {2}


@SPEEDS
def test_positions_that_come_at_a_real_pace_are_not_stale(speedup: float) -> None:
    """Ten a real second; a busy machine hands them on like that."""
    script = Script(config=StationConfig(speedup=speedup))
    script.hear(wire.heartbeat(), wire.landed(wire.ON_GROUND), wire.origin(), wire.home())
    for _ in range(10):
        script.hear(wire.position(script.now_ns // wire.MS_NS, (0.0, 0.0, 0.0)))
        script.run(0.1 * speedup)
        assert script.state == "GROUNDED"


def test_snapshots_come_ten_times_a_real_second() -> None:
    script = Script(config=StationConfig(speedup=10.0))
    script.run(10.0)
    assert len(told.snapshots(script.told)) == pytest.approx(10, abs=1)
