"""At which nanosecond a thing is due."""

from __future__ import annotations

import pytest

from gcs.gate.effects import CommandKind, Effect
from gcs.gate.inputs import (
    HeartbeatSeen,
    LandedSeen,
    OperatorLost,
    Requested,
    Tick,
)
from gcs.gate.machine.gate import Gate
from gcs.gate.requests import (
    Hold,
    Land,
    ReturnHome,
    TakeControl,
    TakeOff,
    TakePhoto,
)
from gcs.gate.states import FlightMode, LandedState, State
from tests.unit.gate.script import MS, SECOND, Script, policy
from tests.unit.gate.situations import (
    UP,
    default_policy,
    ended,
    flight,
    lead_to,
    state_of,
)


def fresh(script: Script, *, position: bool = True) -> int:
    """Everything is reported this instant; the time of it."""
    script.feed(HeartbeatSeen(script.armed, script.mode, script.mode.value))
    script.feed(LandedSeen(script.landed))
    if position:
        script.position()
    return script.now_ns


def tick_at(script: Script, now_ns: int) -> list[Effect]:
    script.now_ns = now_ns
    return script.feed(Tick(0))


class TestDue:
    """Just before it is due nothing happens; at the very nanosecond it does."""

    def test_a_position_is_too_old_when_it_is_older_than_a_second(self) -> None:
        script, _ = flight(State.MOVING)
        now_ns = fresh(script)
        tick_at(script, now_ns + SECOND)
        assert state_of(script) is State.MOVING
        tick_at(script, now_ns + SECOND + 1)
        assert state_of(script) is State.STALE

    def test_the_grace_is_over_half_a_second_later(self) -> None:
        script, request_id = flight(State.MOVING)
        begun_ns = fresh(script) + SECOND + 1
        tick_at(script, begun_ns)
        tick_at(script, begun_ns + SECOND // 2 - 1)
        assert not script.ended(request_id)
        tick_at(script, begun_ns + SECOND // 2)
        assert ended(script, request_id) == "aborted STALE"

    def test_a_vehicle_is_lost_three_and_a_half_seconds_after_its_heartbeat(self) -> None:
        script, _ = flight(State.GROUNDED)
        now_ns = fresh(script)
        tick_at(script, now_ns + 3_500 * MS - 1)
        assert state_of(script) is State.STALE
        tick_at(script, now_ns + 3_500 * MS)
        assert state_of(script) is State.NO_VEHICLE

    def test_so_is_its_landed_state(self) -> None:
        script, _ = flight(State.GROUNDED)
        now_ns = fresh(script)
        script.now_ns = now_ns + 2 * SECOND
        script.heartbeat()
        for early_ns, landed in ((1, LandedState.ON_GROUND), (0, LandedState.UNDEFINED)):
            tick_at(script, now_ns + 3_500 * MS - early_ns)
            assert script.gate.memory.landed is landed

    def test_a_deadline(self) -> None:
        script, request_id = flight(State.TAKING_PICTURE)
        task = script.gate.memory.task
        assert task is not None
        assert task.deadline_ns is not None
        for now_ns, over in ((task.deadline_ns - 1, False), (task.deadline_ns, True)):
            script.now_ns = now_ns
            fresh(script)
            script.feed(Tick(0))
            assert script.ended(request_id) is over

    def test_a_mode_that_is_not_shown(self) -> None:
        script = Script(policy("default")).take_control(UP)
        request_id = script.ask(Land())
        asked_ns = script.now_ns
        for now_ns, over in ((asked_ns + 5 * SECOND - 1, False), (asked_ns + 5 * SECOND, True)):
            script.now_ns = now_ns
            fresh(script)
            script.feed(Tick(0))
            assert script.ended(request_id) is over

    def test_until_then_another_mode_is_that_of_before(self) -> None:
        for late_ns, state in ((5 * SECOND - 1, State.LANDING), (5 * SECOND, State.EXTERNAL)):
            script = Script(policy("default")).take_control(UP)
            script.ask(Land())
            script.now_ns += late_ns
            script.heartbeat(FlightMode.OTHER)
            assert state_of(script) is state

    def test_the_next_hold(self) -> None:
        script, _ = flight(State.HOLDING)
        asked_ns = script.now_ns
        tick_at(script, asked_ns + SECOND - 1)
        assert script.commands() == []
        tick_at(script, asked_ns + SECOND)
        assert script.commands() == [CommandKind.HOLD]

    def test_guided_of_ours_for_ten_seconds(self) -> None:
        for late_ns, sent in ((10 * SECOND - 1, [CommandKind.HOLD]), (10 * SECOND, [])):
            script = Script(policy("default"), "ardupilot").fly(UP)
            script.ask(TakeControl())
            script.tick()
            asked_ns = script.now_ns
            script.ask(Hold())
            script.heartbeat(FlightMode.HOLD)
            script.forget()
            script.now_ns = asked_ns + late_ns
            script.heartbeat(FlightMode.GUIDED)
            assert script.commands() == sent

    def test_a_take_off_of_ours_for_ten_seconds(self) -> None:
        for late_ns, state in ((10 * SECOND - 1, State.HOLDING), (10 * SECOND, State.EXTERNAL)):
            script = Script(policy("default"))
            lead_to(State.GROUNDED, script)
            script.ask(TakeOff(2.0))
            asked_ns = script.now_ns
            script.answer(CommandKind.TAKE_OFF, None)
            script.now_ns = asked_ns + late_ns
            fresh(script)
            script.land_state(LandedState.IN_AIR)
            assert state_of(script) is state

    def test_while_one_may_come_it_is_not_sure_to_stand(self) -> None:
        for late_ns, stands in ((10 * SECOND - 1, False), (10 * SECOND, True)):
            script = Script(policy("default"))
            lead_to(State.GROUNDED, script)
            script.ask(TakeOff(2.0))
            asked_ns = script.now_ns
            script.answer(CommandKind.TAKE_OFF, None)
            script.now_ns = asked_ns + late_ns
            fresh(script)
            assert script.ended(script.ask(Land())) is stands

    @pytest.mark.parametrize("given", [Requested(9, "keyboard", TakePhoto()), OperatorLost("quit")])
    def test_a_request_and_a_lost_operator_are_judged_by_the_time_they_come(
        self, given: Requested | OperatorLost
    ) -> None:
        script, _ = flight(State.HOVERING)
        script.now_ns = fresh(script) + 2 * SECOND
        script.feed(given)
        assert State.STALE in script.states()

    def test_a_report_is_not(self) -> None:
        script, _ = flight(State.MOVING)
        script.now_ns = fresh(script) + 2 * SECOND
        script.heartbeat()
        assert state_of(script) is State.MOVING


class TestNextDue:
    """`deadline_ns` is the earliest of what is due; asking changes nothing."""

    def due(self, script: Script) -> int:
        before = script.gate.memory
        due_ns = script.gate.deadline_ns
        assert due_ns is not None
        assert script.gate.memory == before
        return due_ns - script.now_ns

    def test_nothing_is_due_with_nobody(self) -> None:
        assert Gate(policy("default"), "px4", 0).deadline_ns is None

    def test_the_position_goes_first(self) -> None:
        script, _ = flight(State.TAKING_PICTURE)
        fresh(script)
        assert self.due(script) == SECOND

    def test_in_stale_the_grace_and_then_the_heartbeat(self) -> None:
        script, _ = flight(State.MOVING)
        now_ns = fresh(script)
        tick_at(script, now_ns + SECOND + 1)
        assert self.due(script) == SECOND // 2
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        now_ns = fresh(script)
        tick_at(script, now_ns + SECOND + 1)
        assert self.due(script) == 2_500 * MS - 1

    @pytest.mark.parametrize(
        ("photo_s", "expected_ns"), [(0.75, 750 * MS), (1.25, SECOND)], ids=["task", "position"]
    )
    def test_the_task_where_it_is_earlier(self, photo_s: float, expected_ns: int) -> None:
        script = Script(default_policy(photo_timeout_s=photo_s)).take_control(UP)
        fresh(script)
        script.ask(TakePhoto())
        assert self.due(script) == expected_ns

    def test_the_hold_to_be_repeated(self) -> None:
        script, _ = flight(State.HOLDING)
        script.now_ns += 500 * MS
        fresh(script)
        assert self.due(script) == 500 * MS

    def test_control_to_be_asked_for(self) -> None:
        script = Script(policy("default")).fly(UP)
        script.ask(TakeControl())
        script.now_ns += 500 * MS
        fresh(script)
        assert self.due(script) == 550 * MS

    def test_the_mode_that_is_waited_for(self) -> None:
        script = Script(policy("default")).take_control(UP)
        script.ask(ReturnHome())
        script.now_ns += 4_500 * MS
        fresh(script)
        assert self.due(script) == 500 * MS
        script.heartbeat(FlightMode.RETURN)
        assert self.due(script) == SECOND
