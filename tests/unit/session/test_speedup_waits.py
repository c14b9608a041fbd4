"""What takes real time takes longer on the clock of a sped-up session."""

from __future__ import annotations

from collections import Counter

import pytest
from msgspec import structs

from gcs.config import StationConfig
from gcs.gate.policy.parse import DEFAULT
from gcs.session.speedup_waits import Times
from tests.unit.station import told, wire
from tests.unit.station.station import Script

DO_SET_MODE = 176
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
    assert fast.control.hold_every_s == 10.0 * DEFAULT.control.hold_every_s
    assert fast.control.disarm_wait_s == 10.0 * DEFAULT.control.disarm_wait_s
    assert fast.control.force_repeat_s == 10.0 * DEFAULT.control.force_repeat_s
    assert fast.position_age_s == 10.0 * DEFAULT.position_age_s
    assert fast.stale_grace_s == 10.0 * DEFAULT.stale_grace_s
    assert fast.deadline_min_s == 10.0 * DEFAULT.deadline_min_s
    assert fast.arm_timeout_s == 10.0 * DEFAULT.arm_timeout_s
    assert fast.land_timeout_s == 10.0 * DEFAULT.land_timeout_s
    assert fast.takeoff.timeout_s == 10.0 * DEFAULT.takeoff.timeout_s
    assert fast.stream == structs.replace(
        DEFAULT.stream, deadman_s=5.0, good_again_s=5.0, ends_after_s=50.0, position_age_s=5.0
    )
    same = structs.replace(
        fast,
        heartbeat_age_s=DEFAULT.heartbeat_age_s,
        position_age_s=DEFAULT.position_age_s,
        stale_grace_s=DEFAULT.stale_grace_s,
        deadline_min_s=DEFAULT.deadline_min_s,
        arm_timeout_s=DEFAULT.arm_timeout_s,
        land_timeout_s=DEFAULT.land_timeout_s,
        takeoff=DEFAULT.takeoff,
        photo_timeout_s=DEFAULT.photo_timeout_s,
        control=DEFAULT.control,
        stream=DEFAULT.stream,
    )
    assert same == DEFAULT


@pytest.mark.slow
@SPEEDS
def test_a_hold_is_commanded_again_after_a_real_second(speedup: float) -> None:
    """The acknowledgement and the heartbeat that shows it take real time to come."""
    script = Script(config=StationConfig(speedup=speedup)).flying()
    script.forget()
    script.ask("hold")
    assert holds(script) == 1
    script.run(0.45 * speedup)
    assert holds(script) == 1
    script.run(0.75 * speedup)
    assert holds(script) > 1


def holds(script: Script) -> int:
    return sum(m.command == DO_SET_MODE for m in script.sent("COMMAND_LONG"))


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
