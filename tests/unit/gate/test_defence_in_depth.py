"""Conditions that another one ensures already: each holds by itself too.

The gate's memory is set by hand here to what no flight leads to.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from gcs.gate.condition import Condition, Severity
from gcs.gate.inputs import (
    MissionLoaded,
    MissionSeen,
    Requested,
    Tick,
    VerifierChanged,
)
from gcs.gate.machine import progress
from gcs.gate.machine.events import Event
from gcs.gate.machine.memory import Memory, Task
from gcs.gate.machine.turn import Turn
from gcs.gate.refusal import Code
from gcs.gate.requests import GoTo, Request, Resume, StartMission, TakeControl, TakePhoto
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.reactions import (
    HELD,
    Happening,
    Reaction,
    default_policy,
    flight,
    reaction,
    remember,
    state_of,
)
from tests.unit.gate.script import SECOND, Script, policy
from tests.unit.gate.situations import UP, lead_to

GOAL = GoTo((0.0, 4.0, -UP))
SEVERE = ((Condition.BATTERY_LOW, "low"),)


def rules() -> dict[str, object]:
    """BATTERY_LOW demands HOLD; the owner of a goal may replace it."""
    severities = {**policy("default").severities, Condition.BATTERY_LOW: Severity.HOLD}
    return {"severities": severities, "retarget": "replace"}


def under_our_control(state: State) -> Script:
    script = Script(default_policy(**rules()))
    lead_to(state, script)
    script.feed(MissionLoaded("square", 4))
    return script


@pytest.mark.parametrize(
    ("state", "wanted"),
    [
        (State.HOVERING, GOAL),
        (State.HOVERING, TakeControl()),
        (State.HOVERING, Resume()),
        (State.HOVERING, TakePhoto()),
        (State.HOVERING, StartMission()),
        (State.MOVING, GOAL),
    ],
)
def test_without_an_operator_nothing_is_granted_even_where_we_still_fly(
    state: State, wanted: Request
) -> None:
    """A lost operator is a hold: we hover or fly no more."""
    script = under_our_control(state)
    remember(script, operator_lost=True)
    assert script.refusal(script.ask(wanted)) is Code.OPERATOR_LOST
    assert state_of(script) is state


@pytest.mark.parametrize(
    ("state", "wanted"),
    [(State.HOVERING, GOAL), (State.HOVERING, StartMission()), (State.MOVING, GOAL)],
)
def test_while_it_is_severe_nothing_is_granted_even_where_we_still_fly(
    state: State, wanted: Request
) -> None:
    """A severity of HOLD is a hold as well."""
    script = under_our_control(state)
    remember(script, conditions=SEVERE)
    assert script.refusal(script.ask(wanted)) is Code.SEVERITY
    assert state_of(script) is state


class TestControlIsRegainedOnlyWhereNothingIsSevere:
    def test_not_at_the_top_of_a_climb(self) -> None:
        script, request_id = flight(State.TAKING_OFF, **rules())
        remember(script, conditions=SEVERE)
        script.pos_ned = (0.0, 0.0, -UP)
        assert reaction(script, request_id, lambda s: s.tick()) == Reaction(
            *HELD, "aborted TOO_CLOSE"
        )

    @pytest.mark.parametrize(
        "happens",
        [
            lambda s: s.heartbeat(FlightMode.HOLD),
            lambda s: s.feed(MissionSeen(4, 5, True)),
        ],
        ids=["hold mode", "finished"],
    )
    def test_not_at_the_end_of_a_mission(self, happens: Happening) -> None:
        script, request_id = flight(State.FLYING_MISSION, **rules())
        script.feed(MissionSeen(4, 5, False))
        remember(script, conditions=SEVERE)
        assert reaction(script, request_id, happens) == Reaction(*HELD, "complete")


class TestHolding:
    """A request other than for the hold is not under way there."""

    def holding(self) -> tuple[Script, int]:
        """A hold that is not awaited any more, and a picture that is under way all the same."""
        script, request_id = flight(State.HOLDING)
        task = Task(Requested(request_id, "keyboard", TakePhoto()), Event.PHOTO)
        remember(script, hold_again_ns=None, asked_mode=None, task=task)
        return script, request_id

    @pytest.mark.parametrize(
        ("mode", "after"),
        [
            (FlightMode.TAKEOFF, State.EXTERNAL),
            (FlightMode.MISSION, State.EXTERNAL),
            (FlightMode.OTHER, State.EXTERNAL),
            (FlightMode.GUIDED, State.EXTERNAL),
            (FlightMode.RETURN, State.RETURNING),
            (FlightMode.LAND, State.LANDING),
        ],
    )
    def test_a_pilots_mode_takes_over_whatever_is_under_way(
        self, mode: FlightMode, after: State
    ) -> None:
        script, request_id = self.holding()
        remember(script, mode=FlightMode.HOLD, guided_until_ns=0)
        assert reaction(script, request_id, lambda s: s.heartbeat(mode)) == Reaction(
            after, Control.NONE, [], "taken over MODE_CHANGED"
        )

    def test_so_does_the_ground(self) -> None:
        script, request_id = self.holding()
        found = reaction(script, request_id, lambda s: s.land_state(LandedState.ON_GROUND))
        assert found == Reaction(State.GROUNDED, Control.NONE, [], "taken over NOT_FLYING")


def test_a_pilots_hold_takes_over_whatever_is_under_way_in_a_hover() -> None:
    script, request_id = flight(State.HOVERING)
    remember(script, control=Control.OURS, mode=FlightMode.GUIDED)
    found = reaction(script, request_id, lambda s: s.heartbeat(FlightMode.HOLD))
    assert found == Reaction(State.EXTERNAL, Control.NONE, [], "taken over MODE_CHANGED")


def test_control_is_being_taken_whether_or_not_a_request_asks_for_it() -> None:
    script, _ = flight(State.HOVERING)
    remember(script, task=None)
    assert script.refusal(script.ask(TakePhoto())) is Code.CONTROL_PENDING


def test_without_a_fence_no_stop_is_predicted() -> None:
    """Between a fence that is switched and the new one."""
    script = under_our_control(State.HOVERING)
    remember(script, verifier=None)
    assert reaction(script, 0, lambda s: s.position()) == Reaction(
        State.HOVERING, Control.OURS, [], ""
    )


def test_the_same_fence_told_again_judges_nothing_anew() -> None:
    script, request_id = flight(State.MOVING)
    remember(script, pos_ned=(170.0, 0.0, -UP))
    verifier = script.gate.memory.verifier
    assert verifier is not None
    found = reaction(script, request_id, lambda s: s.feed(VerifierChanged(verifier)))
    assert found == Reaction(State.MOVING, Control.OURS, [], "")


def test_nothing_is_known_of_a_climb_whose_position_is_too_old() -> None:
    script, _ = flight(State.TAKING_OFF)
    memory = script.gate.memory
    memory.pos_ned = (0.0, 0.0, -30.0)
    assert progress.climbs_too_high(Turn(script.policy, memory, script.now_ns))
    old = Turn(script.policy, memory, script.now_ns + 2 * SECOND)
    assert not progress.climbs_too_high(old)


def test_a_vehicle_that_was_lost_has_reported_as_little_as_one_never_heard() -> None:
    script, _ = flight(State.TAKING_OFF)
    script.now_ns += 4 * SECOND
    script.feed(Tick(0))
    assert state_of(script) is State.NO_VEHICLE
    lost, new = script.gate.memory, Memory("px4")
    assert not new.heard_before
    assert lost == replace(
        new,
        heard_before=True,
        boot_ms=lost.boot_ms,
        home_ned=lost.home_ned,
        return_up_m=lost.return_up_m,
        return_places=lost.return_places,
        climb_ends_within_m=lost.climb_ends_within_m,
        lost_in_flight=True,
        verifier=lost.verifier,
        asked_until_ns=lost.asked_until_ns,
        takeoff_until_ns=lost.takeoff_until_ns,
        top_ned=lost.top_ned,
    )


class TestAtTheBeginningOfTheClock:
    """At its first instant no command of ours has been sent, and none comes late."""

    def seen(self, *, armed: bool) -> Script:
        script = Script(policy("default"), start_ns=0)
        script.heartbeat(armed=armed)
        script.position()
        return script

    def test_guided_is_somebody_elses(self) -> None:
        script = self.seen(armed=True)
        assert state_of(script) is State.EXTERNAL
        assert reaction(script, 0, lambda s: s.heartbeat(FlightMode.GUIDED)) == Reaction(
            State.EXTERNAL, Control.NONE, [], ""
        )

    def test_so_is_a_take_off(self) -> None:
        script = self.seen(armed=False)
        assert state_of(script) is State.GROUNDED
        assert reaction(script, 0, lambda s: s.land_state(LandedState.IN_AIR)) == Reaction(
            State.EXTERNAL, Control.NONE, [], ""
        )
