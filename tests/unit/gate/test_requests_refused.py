"""What is refused in each state, what is so already, and what is asked for in vain.

A request that cannot be granted now is refused at once, and refused means gone: nothing changes.
"""

from __future__ import annotations

import pytest

from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import Ruling
from gcs.gate.inputs import (
    ConditionChanged,
    MissionLoaded,
    OperatorLost,
)
from gcs.gate.refusal import Code
from gcs.gate.requests import (
    Arm,
    GoTo,
    Hold,
    Request,
    Resume,
    ReturnHome,
    SetMode,
    StartMission,
    SwitchFence,
    TakeControl,
    TakeOff,
    TakePhoto,
)
from gcs.gate.states import FlightMode, LandedState, State
from tests.unit.gate.reactions import (
    STATES,
    Reaction,
    default_policy,
    ended,
    flight,
    reaction,
    remember,
    state_of,
)
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import UP, lead_to

GOAL = GoTo((0.0, 4.0, -UP))

MOTION: dict[str, Request] = {
    "goto": GOAL,
    "control": TakeControl(),
    "resume": Resume(),
    "arm": Arm(),
    "take off": TakeOff(2.0),
    "return": ReturnHome(),
    "photo": TakePhoto(),
    "mission": StartMission(),
    "other mode": SetMode("ACRO", FlightMode.OTHER),
    "fence switch": SwitchFence(on=True),
}
"""What needs an operator."""


def each(code: str, *names: str) -> dict[str, str]:
    return dict.fromkeys(names, code)


ALWAYS = {**each("UNSUPPORTED", "other mode"), **each("POLICY", "fence switch")}
IN_FLIGHT = each("ALREADY_FLYING", "arm", "take off")
BUSY = each("BUSY", "goto", "resume", "photo", "mission")
DONE = "DONE"
"""Accepted, complete at once, and what is under way goes on."""

REFUSED: dict[State, dict[str, str]] = {
    State.NO_VEHICLE: each("NO_VEHICLE", *(name for name in MOTION if name != "fence switch")),
    State.STALE: {
        **each("STALE", "goto", "control", "resume", "arm", "take off", "photo", "mission"),
        **ALWAYS,
    },
    State.GROUNDED: {
        **each("NOT_FLYING", "goto", "control", "resume", "photo"),
        **each("BUSY", "arm", "take off", "mission"),
        **each(DONE, "return"),
        **ALWAYS,
    },
    State.TAKING_OFF: {**BUSY, **IN_FLIGHT, "control": "BUSY", **ALWAYS},
    State.HOVERING: {
        **each("CONTROL_PENDING", "control", "resume", "photo", "mission"),
        **IN_FLIGHT,
        **ALWAYS,
    },
    State.MOVING: {**BUSY, **IN_FLIGHT, "control": DONE, **ALWAYS},
    State.TAKING_PICTURE: {**BUSY, **IN_FLIGHT, "control": DONE, **ALWAYS},
    State.FLYING_MISSION: {**BUSY, **IN_FLIGHT, "control": DONE, **ALWAYS},
    State.RETURNING: {**BUSY, **IN_FLIGHT, "control": "BUSY", **ALWAYS},
    State.LANDING: {**BUSY, **IN_FLIGHT, "control": "BUSY", **ALWAYS},
    State.HOLDING: {
        **each("HOLDING", "goto", "control", "photo", "mission"),
        **IN_FLIGHT,
        **ALWAYS,
    },
    State.EXTERNAL: {**each("NOT_IN_CONTROL", "goto", "photo", "mission"), **IN_FLIGHT, **ALWAYS},
}
"""With another request under way."""

CASES = [(state, name, code) for state in STATES for name, code in REFUSED[state].items()]


@pytest.mark.parametrize(("state", "name", "code"), [(s, n, c) for s, n, c in CASES if c != DONE])
def test_what_cannot_be_done_now_is_refused_and_changes_nothing(
    state: State, name: str, code: str
) -> None:
    script, request_id = flight(state)
    control = script.gate.control
    before = script.gate.memory
    refused = script.ask(MOTION[name])
    assert script.refusal(refused) == code
    assert script.gate.memory == before
    assert reaction(script, request_id, lambda s: None) == Reaction(state, control, [], "")
    assert not script.ended(refused)


@pytest.mark.parametrize(("state", "name"), [(s, n) for s, n, c in CASES if c == DONE])
def test_what_is_so_already_is_complete_at_once_and_displaces_nothing(
    state: State, name: str
) -> None:
    script, request_id = flight(state)
    before = script.gate.memory
    asked = script.ask(MOTION[name])
    assert script.verdict(asked).ruling is Ruling.ACCEPTED
    assert ended(script, asked) == "complete"
    assert not script.ended(request_id)
    assert not script.commands()
    assert script.gate.memory == before


@pytest.mark.parametrize("name", sorted(MOTION))
@pytest.mark.parametrize("state", STATES)
def test_without_an_operator_nothing_that_moves_is_wanted_any_more(state: State, name: str) -> None:
    script, _ = flight(state)
    if state is State.EXTERNAL:
        script.heartbeat(FlightMode.OTHER)
    script.feed(OperatorLost("quit"))
    before = script.gate.memory
    assert script.refusal(script.ask(MOTION[name])) is Code.OPERATOR_LOST
    assert script.gate.memory == before


@pytest.mark.parametrize("name", sorted(MOTION))
@pytest.mark.parametrize("landing", [True, False])
def test_nor_is_it_while_the_vehicle_comes_down_without_one(landing: bool, name: str) -> None:
    script = Script(policy("default")).fly(UP)
    script.heartbeat(FlightMode.LAND if landing else FlightMode.RETURN)
    script.feed(OperatorLost("quit"))
    assert state_of(script) is (State.LANDING if landing else State.RETURNING)
    assert script.refusal(script.ask(MOTION[name])) is Code.OPERATOR_LOST


def test_without_an_operator_nothing_that_would_be_granted_is() -> None:
    granted = [
        (State.HOVERING, ["goto", "control", "resume", "photo", "mission", "return"]),
        (State.HOLDING, ["resume", "return"]),
        (State.EXTERNAL, ["resume", "control", "return"]),
        (State.GROUNDED, ["arm", "take off", "mission", "control", "return"]),
    ]
    for state, names in granted:
        for name in names:
            script = Script(policy("default"))
            lead_to(state, script)
            script.feed(MissionLoaded("square", 4))
            script.feed(OperatorLost("quit"))
            assert script.refusal(script.ask(MOTION[name])) is Code.OPERATOR_LOST, (state, name)


class TestChecks:
    """What has to be so before a request is accepted, one thing missing at a time."""

    WRONG = ConditionChanged(Condition.BATTERY_LOW, True, "low")

    def ground(self, **changes: object) -> Script:
        severities = {**policy("default").severities, Condition.BATTERY_LOW: Severity.HOLD}
        script = Script(default_policy(severities=severities, **changes))
        lead_to(State.GROUNDED, script)
        script.feed(MissionLoaded("square", 4))
        return script

    @pytest.mark.parametrize("wanted", [TakeOff(2.0), StartMission()], ids=["take off", "mission"])
    def test_take_off_and_mission_need_the_vehicle_armed(self, wanted: Request) -> None:
        script = self.ground()
        script.heartbeat(armed=False)
        assert script.refusal(script.ask(wanted)) is Code.NOT_ARMED

    @pytest.mark.parametrize("wanted", [TakeOff(2.0), StartMission()], ids=["take off", "mission"])
    def test_and_on_the_ground(self, wanted: Request) -> None:
        script = self.ground()
        script.reports_landed = False
        script.wait(4.0)
        assert script.refusal(script.ask(wanted)) is Code.IN_AIR

    @pytest.mark.parametrize("wanted", [TakeOff(2.0), StartMission()], ids=["take off", "mission"])
    def test_and_nothing_severe(self, wanted: Request) -> None:
        script = self.ground()
        script.feed(self.WRONG)
        assert script.refusal(script.ask(wanted)) is Code.SEVERITY

    def test_arming_needs_nothing_severe(self) -> None:
        script = self.ground()
        script.heartbeat(armed=False)
        script.feed(self.WRONG)
        assert script.refusal(script.ask(Arm())) is Code.SEVERITY

    @pytest.mark.parametrize("wanted", [Resume(), TakeControl()], ids=["resume", "control"])
    def test_control_needs_nothing_severe_and_a_clear_place_and_a_vehicle_that_flies(
        self, wanted: Request
    ) -> None:
        script = self.ground()
        lead_to(State.EXTERNAL, script)
        script.feed(self.WRONG)
        assert script.refusal(script.ask(wanted)) is Code.SEVERITY
        script.feed(ConditionChanged(Condition.BATTERY_LOW, False))
        script.at(170.0, 0.0, UP, (2.0, 0.0, 0.0))  # too fast for the way back inside
        assert script.refusal(script.ask(wanted)) is Code.OUTSIDE_FENCE
        script.reports_landed = False
        script.wait(4.0)
        assert script.refusal(script.ask(wanted)) is Code.NOT_FLYING
        assert state_of(script) is State.EXTERNAL

    def test_resuming_needs_nothing_severe_and_a_clear_place_and_a_vehicle_that_flies(self) -> None:
        script = self.ground()
        script.land_state(LandedState.IN_AIR)
        script.ask(Hold())
        script.heartbeat(FlightMode.HOLD)
        assert state_of(script) is State.HOLDING
        script.at(0.0, 0.0, UP)
        script.feed(self.WRONG)
        assert script.refusal(script.ask(Resume())) is Code.SEVERITY
        script.feed(ConditionChanged(Condition.BATTERY_LOW, False))
        script.at(170.0, 0.0, UP, (2.0, 0.0, 0.0))
        assert script.refusal(script.ask(Resume())) is Code.OUTSIDE_FENCE
        script.reports_landed = False
        script.wait(4.0)
        assert script.refusal(script.ask(Resume())) is Code.NOT_FLYING
        assert state_of(script) is State.HOLDING

    @pytest.mark.parametrize("state", [State.GROUNDED, State.HOVERING])
    def test_a_mission_needs_a_fence_and_a_mission(self, state: State) -> None:
        script = Script(default_policy(fence_switchable=True))
        lead_to(state, script)
        assert script.refusal(script.ask(StartMission())) is Code.NO_MISSION
        script.feed(MissionLoaded("square", 4))
        remember(script, verifier=None)  # between a fence switched and the new one told
        assert script.refusal(script.ask(StartMission())) is Code.NO_ORIGIN

    @pytest.mark.parametrize("wanted", [TakePhoto(), StartMission()], ids=["photo", "mission"])
    def test_a_goal_that_waits_for_its_tick_keeps_others_out(self, wanted: Request) -> None:
        script = Script(policy("default"))
        lead_to(State.HOVERING, script)
        script.feed(MissionLoaded("square", 4))
        script.ask(GOAL)
        assert script.refusal(script.ask(wanted)) is Code.BUSY
        assert state_of(script) is State.HOVERING


class TestRecorder:
    FAILED = ConditionChanged(Condition.RECORDER_FAILED, True, "disk full")
    LOW = ConditionChanged(Condition.BATTERY_LOW, True, "low")

    @pytest.mark.parametrize("wanted", [True, False])
    @pytest.mark.parametrize("failed", [True, False])
    def test_arming_needs_it_where_the_policy_does_whatever_else_is_wrong(
        self, wanted: bool, failed: bool
    ) -> None:
        mild = {
            Condition.RECORDER_FAILED: Severity.CAUTION,
            Condition.BATTERY_LOW: Severity.CAUTION,
        }
        severities = {**policy("default").severities, **mild}
        rules = default_policy(arm_requires_recording=wanted, severities=severities)
        script = Script(rules).connect()
        script.feed(self.LOW)
        if failed:
            script.feed(self.FAILED)
        verdict = script.verdict(script.ask(Arm()))
        if wanted and failed:
            assert verdict.refusal is not None
            assert verdict.refusal.code is Code.RECORDER_DOWN
        else:
            assert verdict.ruling is Ruling.ACCEPTED
