"""The session's grid: 20 Hz from its start; what is late is told and never made up for."""

from __future__ import annotations

from itertools import pairwise

import pytest

from gcs.config import StationConfig
from gcs.session.inputs import Wake
from tests.unit.station import told, wire
from tests.unit.station.station import TICK_NS, Script, is_frame, is_snapshot
from tests.unit.station.wire import MS_NS, SECOND_NS, START_NS

SETPOINT = "SET_POSITION_TARGET_LOCAL_NED"


def test_the_heartbeat_leaves_once_a_second_from_the_session_s_own_tick() -> None:
    script = Script()
    script.run(10.0)
    times_ns = script.times_ns(is_frame("HEARTBEAT"))
    assert len(times_ns) == 10
    assert {b - a for a, b in pairwise(times_ns)} == {SECOND_NS}


def test_the_operator_sees_ten_snapshots_a_second() -> None:
    script = Script()
    script.run(2.0)
    assert len(script.times_ns(is_snapshot)) == 20


def test_a_wake_before_the_deadline_does_nothing() -> None:
    script = Script()
    script.feed(Wake())
    assert script.sent() == []
    assert script.session.deadline_ns == START_NS + TICK_NS


def test_after_a_late_tick_the_next_one_is_on_the_grid_and_to_come() -> None:
    script = Script()
    script.wake(late_ms=130)
    assert script.session.deadline_ns == START_NS + 4 * TICK_NS
    assert len(script.sent("HEARTBEAT")) == 1
    script.wake()
    assert script.now_ns == START_NS + 4 * TICK_NS


@pytest.mark.parametrize("late_ms", [0.0, 50.0, 100.0])
def test_a_tick_that_is_late_by_whole_periods_is_not_repeated_in_its_own_instant(
    late_ms: float,
) -> None:
    script = Script()
    script.wake(late_ms=late_ms)
    assert script.session.deadline_ns == script.now_ns + TICK_NS


def test_missed_setpoints_are_not_made_up_for_by_a_burst() -> None:
    script = Script().hovering()
    script.forget()
    script.wake(late_ms=400)
    script.run(0.2)
    times_ns = script.times_ns(is_frame(SETPOINT))
    assert len(set(times_ns)) == len(times_ns) == 5
    assert {(time_ns - START_NS) % TICK_NS for time_ns in times_ns} == {0}


def test_setpoints_leave_at_20_hz_while_hovering() -> None:
    script = Script().hovering()
    script.forget()
    script.run(1.0)
    assert len(script.sent(SETPOINT)) == 20
    assert told.snapshots(script.told)[-1].setpoint_hz == pytest.approx(20.0)


def test_a_late_tick_is_told_with_how_late_it_was() -> None:
    script = Script()
    assert "late" not in told.log(script.wake())
    assert "a tick came 130 ms late" in told.log(script.wake(late_ms=130))


def test_a_tick_so_late_that_the_stream_had_a_gap_is_a_condition_for_ten_seconds() -> None:
    script = Script().met()
    script.wake(late_ms=200)
    assert "tick_late" not in script.conditions
    script.wake(late_ms=300)
    assert "tick_late" in script.conditions
    script.run(9.9)
    assert "tick_late" in script.conditions
    script.run(0.2)
    assert "tick_late" not in script.conditions


def test_lateness_counts_in_real_time() -> None:
    """Ten times as fast, 300 ms of the session's clock are 30 ms of everybody's."""
    script = Script(config=StationConfig(speedup=10.0))
    effects = script.wake(late_ms=300)
    assert "a tick came 30 ms late" in told.log(effects)
    assert script.conditions == set()


def test_looking_at_the_deadline_changes_nothing() -> None:
    script = Script().met()
    assert script.session.deadline_ns == script.session.deadline_ns
    assert script.session.deadline_ns > script.now_ns


def test_nobody_is_heard_for_the_time_that_was_given_and_it_is_told_once() -> None:
    script = Script(config=StationConfig(connect_timeout_s=3.0))
    assert told.troubles(script.run(2.9)) == []
    (trouble,) = told.troubles(script.run(10.0))
    assert trouble.exit_code == 3  # no link
    assert "no vehicle heard for 3 s (udpin://127.0.0.1:14540)" in trouble.text


def test_a_station_is_no_vehicle_for_the_one_who_waits_for_one() -> None:
    script = Script(config=StationConfig(connect_timeout_s=3.0))
    other = wire.Sender(254, 190)
    script.sender = other
    script.hear(wire.heartbeat(wire.NO_AUTOPILOT, type_=wire.GCS))
    assert len(told.troubles(script.run(4.0))) == 1


def test_once_a_vehicle_is_heard_nobody_is_told_that_there_is_none() -> None:
    script = Script(config=StationConfig(connect_timeout_s=3.0))
    script.hear(wire.heartbeat())
    assert told.troubles(script.run(10.0)) == []


def test_what_is_still_missing_is_asked_for_again_and_no_more_once_it_came() -> None:
    def asked_for_origin() -> int:
        return sum(m.command == 512 and m.param1 == 49 for m in script.sent("COMMAND_LONG"))

    script = Script()
    script.reporting = True
    script.hear(wire.heartbeat())
    script.run(0.2)
    assert asked_for_origin() == 1
    script.run(5.0)
    assert asked_for_origin() > 1
    script.hear(wire.origin(), wire.home())
    script.forget()
    script.run(10.0)
    assert asked_for_origin() == 0


def test_an_origin_that_never_comes_is_a_condition_until_it_does() -> None:
    script = Script()
    script.reporting = True
    script.hear(wire.heartbeat())
    script.run(9.0)
    assert "origin_missing" not in script.conditions
    script.run(3.0)
    assert "origin_missing" in script.conditions
    script.hear(wire.origin())
    script.run(1.1)
    assert "origin_missing" not in script.conditions


def test_the_clock_of_a_setpoint_counts_from_the_session_s_start() -> None:
    script = Script().hovering()
    script.forget()
    script.run(0.1)
    (first, _) = script.sent(SETPOINT)
    (time_ns, _) = script.times_ns(is_frame(SETPOINT))
    assert first.time_boot_ms == (time_ns - START_NS) // MS_NS
