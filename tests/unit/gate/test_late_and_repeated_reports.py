"""Reports that come late, once more, or for the first time in the middle of a flight."""

from __future__ import annotations

import pytest

from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import CommandKind
from gcs.gate.inputs import ConditionChanged, VerifierChanged
from gcs.gate.requests import Disarm, Hold, Land, ReturnHome
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.reactions import (
    Reaction,
    default_policy,
    elsewhere,
    ended,
    reaction,
    stale,
    state_of,
)
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import UP


class TestStanding:
    def test_what_flew_again_after_an_outage_and_landed_stands(self) -> None:
        script, _ = stale(State.MOVING)
        script.reports_position = True
        script.tick()
        assert state_of(script) is State.MOVING
        script.ask(Land())
        script.heartbeat(FlightMode.LAND)
        script.land_state(LandedState.ON_GROUND)
        script.heartbeat(armed=False)
        assert state_of(script) is State.GROUNDED
        script.forget()
        assert ended(script, script.ask(Land())) == "complete"
        assert script.commands() == []

    def test_a_mission_mode_without_our_mission_is_somebody_elses_flight(self) -> None:
        script = Script(policy("default")).connect()
        script.heartbeat(FlightMode.MISSION, armed=True)
        assert reaction(script, 0, lambda s: s.land_state(LandedState.IN_AIR)) == Reaction(
            State.EXTERNAL, Control.NONE, [], ""
        )


def test_the_first_position_of_a_return_is_no_jump() -> None:
    script = Script(default_policy(rtl_blocked="forward"))
    script.heartbeat(armed=True)
    script.land_state(LandedState.IN_AIR)
    script.ask(Land())
    request_id = script.ask(ReturnHome())
    assert state_of(script) is State.RETURNING
    assert reaction(script, request_id, lambda s: s.position()) == Reaction(
        State.RETURNING, Control.OURS, [], ""
    )


def test_a_second_reason_as_bad_as_the_first_demands_nothing_anew() -> None:
    """The operator held the return that the first one demanded."""
    bad = {Condition.BATTERY_LOW: Severity.RETURN, Condition.ORIGIN_MISMATCH: Severity.RETURN}
    script = Script(default_policy(severities={**policy("default").severities, **bad}))
    script.take_control(UP)
    script.feed(ConditionChanged(Condition.BATTERY_LOW, True, "low"))
    assert state_of(script) is State.RETURNING
    script.ask(Hold())
    script.heartbeat(FlightMode.HOLD)
    other = ConditionChanged(Condition.ORIGIN_MISMATCH, True, "2.5 m")
    assert reaction(script, 0, lambda s: s.feed(other)) == Reaction(
        State.HOLDING, Control.OURS, [], ""
    )


def test_a_fence_that_moves_in_the_grace_ends_the_stream_with_its_reason() -> None:
    script, request_id = stale(State.MOVING)
    assert reaction(
        script, request_id, lambda s: s.feed(VerifierChanged(elsewhere(s)))
    ) == Reaction(State.STALE, Control.OURS, [CommandKind.HOLD], "aborted OUTSIDE_FENCE")
    assert reaction(script, request_id, lambda s: s.position()) == Reaction(
        State.HOLDING, Control.OURS, [], ""
    )


@pytest.mark.parametrize(("ticks", "granted"), [(100, True), (101, False)])
def test_a_forced_disarm_asked_for_again_within_five_seconds_is_granted(
    ticks: int, granted: bool
) -> None:
    script = Script(default_policy(allow_force_disarm=True)).take_control(UP)
    script.ask(Disarm(force=True))
    script.tick(ticks)
    script.ask(Disarm(force=True))
    assert (CommandKind.FORCE_DISARM in script.commands()) is granted
