"""What each request gets in each state, and what becomes of the request that was under way."""

from __future__ import annotations

from typing import Any

import pytest

from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import CommandKind, Outcome, Ruling, SwitchedFence
from gcs.gate.inputs import (
    ConditionChanged,
    HomeSeen,
    MissionLoaded,
    OperatorLost,
    PhotoSeen,
    ReturnHeightSeen,
    VerifierChanged,
)
from gcs.gate.refusal import Code
from gcs.gate.requests import (
    Abort,
    Arm,
    Disarm,
    GoTo,
    Hold,
    Land,
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
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.reactions import (
    FLIGHT,
    GUIDED_STATES,
    MODE_STATES,
    Reaction,
    default_policy,
    ended,
    flight,
    reaction,
    remember,
    streams,
    take_off,
)
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import UP, lead_to

GOAL = GoTo((0.0, 4.0, -UP))
STATES = [s for s in State if s not in (State.VERIFYING, State.STREAMING)]
AIRBORNE = [*FLIGHT, State.HOLDING, State.EXTERNAL]
"""Reported in the air."""

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
"""What wants an operator who is there."""

# Refused while another request is under way.  DONE: accepted, complete at once, and it goes on.
DONE = "DONE"
REFUSED = {
    State.NO_VEHICLE: dict.fromkeys(MOTION, "NO_VEHICLE"),
    State.STALE: {**dict.fromkeys(MOTION, "STALE"), "return": "RTL_BLOCKED"},
    State.GROUNDED: {
        "goto": "NOT_FLYING",
        "control": DONE,
        "resume": "NOT_FLYING",
        "arm": "BUSY",
        "take off": "BUSY",
        "return": DONE,
        "photo": "NOT_FLYING",
        "mission": "BUSY",
    },
    State.TAKING_OFF: dict.fromkeys(MOTION, "BUSY"),
    State.HOVERING: dict.fromkeys(MOTION, "CONTROL_PENDING"),
    State.MOVING: {**dict.fromkeys(MOTION, "BUSY"), "control": DONE},
    State.TAKING_PICTURE: {**dict.fromkeys(MOTION, "BUSY"), "control": DONE},
    State.FLYING_MISSION: {**dict.fromkeys(MOTION, "BUSY"), "control": DONE},
    State.RETURNING: dict.fromkeys(MOTION, "BUSY"),
    State.LANDING: dict.fromkeys(MOTION, "BUSY"),
    State.HOLDING: dict.fromkeys(MOTION, "HOLDING"),
    State.EXTERNAL: dict.fromkeys(MOTION, "NOT_IN_CONTROL"),
}
for _state in STATES:
    REFUSED[_state]["other mode"] = "POLICY"
    REFUSED[_state]["fence switch"] = "POLICY"
    if _state in AIRBORNE:
        REFUSED[_state] |= {"arm": "ALREADY_FLYING", "take off": "ALREADY_FLYING"}
        del REFUSED[_state]["return"]
for _state, _wanted in (
    (State.NO_VEHICLE, "fence switch"),
    (State.HOLDING, "resume"),
    (State.EXTERNAL, "resume"),
    (State.EXTERNAL, "control"),
):
    del REFUSED[_state][_wanted]
REFUSED[State.NO_VEHICLE]["other mode"] = "NO_VEHICLE"

CASES = [(state, name, code) for state in STATES for name, code in REFUSED[state].items()]


def busy(state: State, **changes: Any) -> tuple[Script, int]:
    if state is State.EXTERNAL:
        changes["allow_force_disarm"] = True
    return flight(state, **changes)


@pytest.mark.parametrize(
    ("state", "name", "code"), [(s, n, c) for s, n, c in CASES if c not in (DONE, "RTL_BLOCKED")]
)
def test_what_cannot_be_done_now_is_refused_and_changes_nothing(
    state: State, name: str, code: str
) -> None:
    script, request_id = busy(state)
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
    script, request_id = busy(state)
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
    script, _ = busy(state)
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
    assert script.gate.state is (State.LANDING if landing else State.RETURNING)
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


class TestHoldAndAbort:
    @pytest.mark.parametrize("wanted", [Hold(), Abort()], ids=["hold", "abort"])
    @pytest.mark.parametrize("state", AIRBORNE)
    def test_in_the_air_it_holds_at_once_and_ends_what_was_under_way(
        self, state: State, wanted: Request
    ) -> None:
        script, request_id = busy(state)
        assert reaction(script, request_id, lambda s: s.ask(wanted)) == Reaction(
            State.HOLDING, Control.OURS, [CommandKind.HOLD], "aborted OPERATOR"
        )
        asked = script._next_id
        assert script.verdict(asked).ruling is Ruling.ACCEPTED
        assert ended(script, asked) == ""
        script.heartbeat(FlightMode.HOLD)
        assert ended(script, asked) == "complete"
        assert reaction(script, asked, lambda s: s.wait(3.0)).sent == []

    @pytest.mark.parametrize("wanted", [Hold(), Abort()], ids=["hold", "abort"])
    def test_a_take_off_that_stands_may_come_yet_so_it_is_held_and_disarmed(
        self, wanted: Request
    ) -> None:
        script = Script(policy("default"))
        request_id = take_off(script)
        assert reaction(script, request_id, lambda s: s.ask(wanted)) == Reaction(
            State.GROUNDED,
            Control.NONE,
            [CommandKind.HOLD, CommandKind.DISARM],
            "aborted OPERATOR",
        )
        script.forget()
        script.wait(1.1)
        assert script.commands() == [CommandKind.HOLD]

    @pytest.mark.parametrize("wanted", [Hold(), Abort()], ids=["hold", "abort"])
    @pytest.mark.parametrize("state", [State.MOVING, State.FLYING_MISSION])
    def test_where_the_position_is_too_old_it_holds_and_streams_no_more(
        self, state: State, wanted: Request
    ) -> None:
        script, request_id = busy(state)
        script.reports_position = False
        script.wait(1.1)
        assert script.gate.state.name == "STALE"
        assert reaction(script, request_id, lambda s: s.ask(wanted)) == Reaction(
            State.STALE, Control.OURS, [CommandKind.HOLD], "aborted OPERATOR"
        )
        assert not streams(script)
        script.reports_position = True
        script.tick()
        assert script.gate.state is State.HOLDING

    def test_abort_of_a_vehicle_that_is_not_heard_is_sent_until_its_time_is_over(self) -> None:
        script, request_id = busy(State.NO_VEHICLE)
        assert reaction(script, request_id, lambda s: s.ask(Abort())) == Reaction(
            State.NO_VEHICLE, Control.NONE, [CommandKind.HOLD], "aborted OPERATOR"
        )
        assert reaction(script, script._next_id, lambda s: s.wait(3.0)) == Reaction(
            State.NO_VEHICLE, Control.NONE, [CommandKind.HOLD] * 3, ""
        )
        script.wait(2.1)
        assert ended(script, script._next_id).startswith("timed out")

    @pytest.mark.parametrize("wanted", [Hold(), Abort(), Land(), Disarm()])
    def test_nothing_is_asked_of_nobody(self, wanted: Request) -> None:
        script = Script(policy("default"))
        assert script.refusal(script.ask(wanted)) is Code.NO_VEHICLE
        assert not script.commands()

    @pytest.mark.parametrize("wanted", [Hold(), Land(), Disarm(), Disarm(force=True)])
    def test_nor_of_somebody_who_is_lost(self, wanted: Request) -> None:
        script, request_id = busy(State.NO_VEHICLE)
        assert script.refusal(script.ask(wanted)) is Code.NO_VEHICLE
        assert not script.commands()
        assert not script.ended(request_id)


class TestOnTheGround:
    def armed(self) -> Script:
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        script.forget()
        return script

    def complete(self, script: Script, wanted: Request) -> bool:
        asked = script.ask(wanted)
        assert script.verdict(asked).ruling is Ruling.ACCEPTED
        return ended(script, asked) == "complete" and not script.commands()

    @pytest.mark.parametrize(
        "wanted",
        [Disarm(), Disarm(force=True), Abort(), Hold(), Land(), ReturnHome(), TakeControl()],
    )
    def test_disarmed_there_is_nothing_left_to_do(self, wanted: Request) -> None:
        assert self.complete(Script(policy("default")).connect(), wanted)

    @pytest.mark.parametrize("wanted", [Hold(), Land(), ReturnHome(), Arm()])
    def test_armed_it_stands_all_the_same(self, wanted: Request) -> None:
        script = self.armed()
        assert self.complete(script, wanted)
        assert script.gate.state is State.GROUNDED

    @pytest.mark.parametrize(
        ("wanted", "how"),
        [
            (Disarm(), "superseded SUPERSEDED"),
            (Disarm(force=True), "superseded SUPERSEDED"),
            (Abort(), "aborted OPERATOR"),
        ],
    )
    def test_what_is_being_armed_is_disarmed(self, wanted: Request, how: str) -> None:
        script, arm = flight(State.GROUNDED)
        assert reaction(script, arm, lambda s: s.ask(wanted)) == Reaction(
            State.GROUNDED, Control.NONE, [CommandKind.DISARM], how
        )

    @pytest.mark.parametrize("wanted", [Disarm(), Disarm(force=True), Abort()])
    def test_a_disarm_is_complete_when_the_heartbeat_shows_it(self, wanted: Request) -> None:
        script = self.armed()
        asked = script.ask(wanted)
        assert script.commands() == [CommandKind.DISARM]
        script.answer(CommandKind.DISARM, 0)
        assert not script.ended(asked)
        script.heartbeat(armed=False)
        assert ended(script, asked) == "complete"

    def test_a_second_arm_while_the_first_is_under_way_is_refused(self) -> None:
        script, _ = flight(State.GROUNDED)
        assert script.refusal(script.ask(Arm())) is Code.BUSY

    def unknown(self) -> Script:
        """Armed, and no report for long whether it stands."""
        script = self.armed()
        script.reports_landed = False
        script.wait(4.0)
        script.forget()
        return script

    @pytest.mark.parametrize(
        ("wanted", "after", "command"),
        [
            (Hold(), State.HOLDING, CommandKind.HOLD),
            (Abort(), State.HOLDING, CommandKind.HOLD),
            (Land(), State.LANDING, CommandKind.LAND),
            (ReturnHome(), State.RETURNING, CommandKind.RETURN),
        ],
    )
    def test_armed_and_not_known_to_stand_it_is_asked_to_come_down(
        self, wanted: Request, after: State, command: CommandKind
    ) -> None:
        script = self.unknown()
        asked = script.ask(wanted)
        assert reaction(script, asked, lambda s: None).ended == ""
        assert (script.gate.state, script.gate.control) == (after, Control.OURS)
        script.forget()
        assert script.gate.memory.outstanding == ((asked, command),)

    @pytest.mark.parametrize("wanted", [Hold(), Abort()])
    def test_so_it_is_held_with_a_disarm_under_way(self, wanted: Request) -> None:
        script = self.unknown()
        disarm = script.ask(Disarm())
        assert reaction(script, disarm, lambda s: s.ask(wanted)) == Reaction(
            State.HOLDING, Control.OURS, [CommandKind.HOLD], "aborted OPERATOR"
        )

    def late(self) -> tuple[Script, int]:
        """A take-off was given up and may come yet; a disarm was asked for since."""
        script = Script(policy("default"))
        take_off(script)
        script.answer(CommandKind.TAKE_OFF, None)
        assert script.gate.state is State.GROUNDED
        return script, script.ask(Disarm())

    def test_hold_is_commanded_where_a_take_off_may_come_yet(self) -> None:
        script, disarm = self.late()
        assert reaction(script, disarm, lambda s: s.ask(Hold())) == Reaction(
            State.GROUNDED, Control.NONE, [CommandKind.HOLD], "aborted OPERATOR"
        )
        assert reaction(script, script._next_id, lambda s: s.wait(1.1)).sent == [CommandKind.HOLD]

    def test_abort_holds_and_disarms_there(self) -> None:
        script, disarm = self.late()
        assert reaction(script, disarm, lambda s: s.ask(Abort())) == Reaction(
            State.GROUNDED,
            Control.NONE,
            [CommandKind.HOLD, CommandKind.DISARM],
            "aborted OPERATOR",
        )

    def test_landing_is_commanded_where_a_take_off_may_come_yet(self) -> None:
        script, disarm = self.late()
        assert reaction(script, disarm, lambda s: s.ask(Land())) == Reaction(
            State.LANDING, Control.OURS, [CommandKind.LAND], "superseded SUPERSEDED"
        )

    @pytest.mark.parametrize(
        ("blocked", "after", "sent"),
        [
            ("hold", State.HOLDING, [CommandKind.HOLD]),
            ("land", State.LANDING, [CommandKind.LAND]),
            ("forward", State.RETURNING, [CommandKind.RETURN]),
        ],
    )
    def test_a_blocked_return_of_what_may_fly_is_treated_as_in_flight(
        self, blocked: str, after: State, sent: list[CommandKind]
    ) -> None:
        script = Script(default_policy(rtl_blocked=blocked))
        take_off(script)
        script.answer(CommandKind.TAKE_OFF, None)
        disarm = script.ask(Disarm())
        script.feed(ReturnHeightSeen(80.0))
        how = "superseded SUPERSEDED" if blocked == "forward" else "aborted OPERATOR"
        assert reaction(script, disarm, lambda s: s.ask(ReturnHome())) == Reaction(
            after, Control.OURS, sent, how
        )
        ruling = script.verdict(script._next_id).ruling
        assert ruling is (Ruling.ACCEPTED if blocked == "forward" else Ruling.REFUSED)


class TestStandingWithAnOldPosition:
    def script(self) -> Script:
        """Armed on the ground, and the position has become too old."""
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        script.reports_position = False
        script.wait(1.2)
        assert script.gate.state is State.STALE
        script.forget()
        return script

    @pytest.mark.parametrize("wanted", [Hold(), Land(), ReturnHome()])
    def test_there_is_nothing_left_to_do(self, wanted: Request) -> None:
        script = self.script()
        asked = script.ask(wanted)
        assert ended(script, asked) == "complete"
        assert not script.commands()

    @pytest.mark.parametrize("wanted", [Disarm(), Abort()])
    def test_it_is_disarmed(self, wanted: Request) -> None:
        script = self.script()
        asked = script.ask(wanted)
        assert reaction(script, asked, lambda s: None) == Reaction(
            State.STALE, Control.NONE, [], ""
        )
        assert script.gate.memory.outstanding == ((asked, CommandKind.DISARM),)
        script.heartbeat(armed=False)
        assert ended(script, asked) == "complete"

    @pytest.mark.parametrize("wanted", [Disarm(), Abort()])
    def test_disarmed_there_is_nothing_left_to_do(self, wanted: Request) -> None:
        script = self.script()
        script.heartbeat(armed=False)
        asked = script.ask(wanted)
        assert ended(script, asked) == "complete"
        assert not script.commands()

    def test_a_forced_disarm_on_the_ground_is_a_disarm(self) -> None:
        script = self.script()
        asked = script.ask(Disarm(force=True))
        assert script.commands() == [CommandKind.DISARM]
        assert script.gate.state is State.GROUNDED
        script.heartbeat(armed=False)
        assert ended(script, asked) == "complete"

    def arming(self) -> tuple[Script, int]:
        """As above, and arming is under way."""
        script, arm = flight(State.GROUNDED)
        script.reports_position = False
        script.wait(1.2)
        assert script.gate.state is State.STALE
        return script, arm

    @pytest.mark.parametrize(
        ("wanted", "how"), [(Disarm(), "superseded SUPERSEDED"), (Abort(), "aborted OPERATOR")]
    )
    def test_what_is_being_armed_is_disarmed(self, wanted: Request, how: str) -> None:
        script, arm = self.arming()
        assert reaction(script, arm, lambda s: s.ask(wanted)) == Reaction(
            State.STALE, Control.NONE, [CommandKind.DISARM], how
        )

    def taking_off(self) -> tuple[Script, int]:
        """A take-off that stands, with a position too old."""
        script = Script(policy("default"))
        request_id = take_off(script)
        script.reports_position = False
        script.wait(1.2)
        assert script.gate.state is State.STALE
        return script, request_id

    def test_abort_of_a_take_off_that_stands_holds_and_disarms(self) -> None:
        script, request_id = self.taking_off()
        assert reaction(script, request_id, lambda s: s.ask(Abort())) == Reaction(
            State.STALE,
            Control.NONE,
            [CommandKind.HOLD, CommandKind.DISARM],
            "aborted OPERATOR",
        )
        script.reports_position = True
        script.tick()
        assert script.gate.state is State.GROUNDED

    def test_disarm_forgets_the_take_off(self) -> None:
        script, request_id = self.taking_off()
        assert reaction(script, request_id, lambda s: s.ask(Disarm())) == Reaction(
            State.STALE, Control.NONE, [CommandKind.DISARM], "superseded SUPERSEDED"
        )
        script.reports_position = True
        script.tick()
        assert script.gate.state is State.GROUNDED

    def test_the_hold_of_an_abort_that_disarms_completes_nothing(self) -> None:
        script, _ = self.taking_off()
        abort = script.ask(Abort())
        script.heartbeat(FlightMode.HOLD)
        assert not script.ended(abort)
        assert reaction(script, abort, lambda s: s.wait(1.5)).sent == []
        script.heartbeat(armed=False)
        assert ended(script, abort) == "complete"

    def test_hold_of_a_take_off_that_stands_is_a_hold(self) -> None:
        script, request_id = self.taking_off()
        assert reaction(script, request_id, lambda s: s.ask(Hold())) == Reaction(
            State.STALE, Control.OURS, [CommandKind.HOLD], "aborted OPERATOR"
        )

    def test_landing_of_a_take_off_that_stands_is_commanded(self) -> None:
        script, request_id = self.taking_off()
        assert reaction(script, request_id, lambda s: s.ask(Land())) == Reaction(
            State.LANDING, Control.OURS, [CommandKind.LAND], "superseded SUPERSEDED"
        )

    def test_a_return_of_a_take_off_that_stands_is_blocked_and_held(self) -> None:
        script, request_id = self.taking_off()
        assert reaction(script, request_id, lambda s: s.ask(ReturnHome())) == Reaction(
            State.STALE, Control.OURS, [CommandKind.HOLD], "aborted OPERATOR"
        )
        assert script.refusal(script._next_id) is Code.RTL_BLOCKED


class TestDisarmedInTheAir:
    """Reported in the air by one message and disarmed by another, with no position yet."""

    def script(self) -> Script:
        script = Script(policy("default"))
        script.heartbeat(armed=False)
        script.land_state(LandedState.IN_AIR)
        assert script.gate.state is State.STALE
        return script

    def test_it_is_not_known_to_stand_so_it_is_not_disarmed(self) -> None:
        script = self.script()
        assert script.refusal(script.ask(Disarm())) is Code.IN_AIR

    def test_abort_commands_hold(self) -> None:
        script = self.script()
        abort = script.ask(Abort())
        assert script.commands() == [CommandKind.HOLD]
        assert not script.ended(abort)


class TestLand:
    @pytest.mark.parametrize("state", [*AIRBORNE, State.STALE])
    def test_it_is_commanded_and_takes_the_place_of_what_was_under_way(self, state: State) -> None:
        script, request_id = busy(state)
        assert reaction(script, request_id, lambda s: s.ask(Land())) == Reaction(
            State.LANDING, Control.OURS, [CommandKind.LAND], "superseded SUPERSEDED"
        )
        assert not streams(script)


BLOCKED = [state for state in AIRBORNE if state is not State.LANDING]


class TestReturn:
    @pytest.mark.parametrize("state", AIRBORNE)
    def test_a_clear_one_is_commanded_and_takes_the_place_of_what_was_under_way(
        self, state: State
    ) -> None:
        script, request_id = busy(state)
        assert reaction(script, request_id, lambda s: s.ask(ReturnHome())) == Reaction(
            State.RETURNING, Control.OURS, [CommandKind.RETURN], "superseded SUPERSEDED"
        )
        assert not streams(script)

    def blocked(self, state: State, rtl_blocked: str) -> tuple[Script, int]:
        script, request_id = busy(state, rtl_blocked=rtl_blocked)
        script.feed(ReturnHeightSeen(80.0))
        return script, request_id

    @pytest.mark.parametrize("state", BLOCKED)
    def test_a_blocked_one_holds_at_once(self, state: State) -> None:
        script, request_id = self.blocked(state, "hold")
        assert reaction(script, request_id, lambda s: s.ask(ReturnHome())) == Reaction(
            State.HOLDING, Control.OURS, [CommandKind.HOLD], "aborted OPERATOR"
        )
        assert script.refusal(script._next_id) is Code.RTL_BLOCKED

    @pytest.mark.parametrize("state", BLOCKED)
    def test_or_lands_where_the_policy_says_so(self, state: State) -> None:
        script, request_id = self.blocked(state, "land")
        assert reaction(script, request_id, lambda s: s.ask(ReturnHome())) == Reaction(
            State.LANDING, Control.OURS, [CommandKind.LAND], "aborted OPERATOR"
        )
        assert script.refusal(script._next_id) is Code.RTL_BLOCKED

    @pytest.mark.parametrize("state", AIRBORNE)
    def test_or_is_forwarded_where_the_policy_says_so(self, state: State) -> None:
        script, request_id = self.blocked(state, "forward")
        assert reaction(script, request_id, lambda s: s.ask(ReturnHome())) == Reaction(
            State.RETURNING, Control.OURS, [CommandKind.RETURN], "superseded SUPERSEDED"
        )
        assert script.verdict(script._next_id).ruling is Ruling.ACCEPTED

    @pytest.mark.parametrize("rtl_blocked", ["hold", "land"])
    def test_a_landing_goes_on_where_the_return_is_blocked(self, rtl_blocked: str) -> None:
        script, request_id = self.blocked(State.LANDING, rtl_blocked)
        assert reaction(script, request_id, lambda s: s.ask(ReturnHome())) == Reaction(
            State.LANDING, Control.OURS, [], ""
        )
        assert script.refusal(script._next_id) is Code.RTL_BLOCKED

    @pytest.mark.parametrize("state", [State.MOVING, State.FLYING_MISSION])
    def test_with_a_position_too_old_it_is_blocked_and_holds(self, state: State) -> None:
        script, request_id = busy(state)
        script.reports_position = False
        script.wait(1.1)
        assert reaction(script, request_id, lambda s: s.ask(ReturnHome())) == Reaction(
            State.STALE, Control.OURS, [CommandKind.HOLD], "aborted OPERATOR"
        )
        assert script.refusal(script._next_id) is Code.RTL_BLOCKED
        assert not streams(script)
        script.reports_position = True
        script.tick()
        assert script.gate.state is State.HOLDING


class TestDisarmInTheAir:
    @pytest.mark.parametrize("state", [*AIRBORNE, State.STALE])
    def test_it_is_refused(self, state: State) -> None:
        script, request_id = busy(state)
        for force in (False, True):
            before = script.gate.memory
            asked = script.ask(Disarm(force=force))
            permitted = state is State.EXTERNAL
            if force and permitted:
                continue
            assert script.refusal(asked) is (Code.POLICY if force else Code.IN_AIR)
            assert script.gate.memory == before
        assert not script.ended(request_id) or state is State.EXTERNAL

    @pytest.mark.parametrize("state", [*AIRBORNE, State.STALE])
    def test_forced_it_needs_the_policy_and_a_second_request(self, state: State) -> None:
        script, request_id = busy(state, allow_force_disarm=True)
        if state is State.EXTERNAL:
            script.wait(6.0)
        control = script.gate.control
        first = reaction(script, request_id, lambda s: s.ask(Disarm(force=True)))
        assert first[1:3] == (control, [])
        assert script.refusal(script._next_id) is Code.IN_AIR
        second = reaction(script, request_id, lambda s: s.ask(Disarm(force=True)))
        assert second[:3] == (State.EXTERNAL, Control.NONE, [CommandKind.FORCE_DISARM])
        if state is not State.EXTERNAL:
            assert second.ended == "superseded SUPERSEDED"
        assert not streams(script)
        script.position()
        if state is not State.STALE:
            assert script.gate.state is State.EXTERNAL

    @pytest.mark.parametrize("state", AIRBORNE)
    def test_without_an_operator_no_motor_is_stopped_in_the_air(self, state: State) -> None:
        script, _ = busy(state, allow_force_disarm=True)
        if state is State.EXTERNAL:
            script.wait(6.0)
        script.ask(Disarm(force=True))
        script.feed(OperatorLost("quit"))
        assert script.refusal(script.ask(Disarm(force=True))) is Code.OPERATOR_LOST

    @pytest.mark.parametrize("force", [False, True])
    def test_on_the_ground_a_take_off_is_disarmed(self, force: bool) -> None:
        script = Script(policy("default"))
        request_id = take_off(script)
        assert reaction(script, request_id, lambda s: s.ask(Disarm(force=force))) == Reaction(
            State.GROUNDED, Control.NONE, [CommandKind.DISARM], "superseded SUPERSEDED"
        )

    def test_without_an_operator_it_is_disarmed_on_the_ground_all_the_same(self) -> None:
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        script.feed(OperatorLost("quit"))
        for force in (False, True):
            assert script.verdict(script.ask(Disarm(force=force))).ruling is Ruling.ACCEPTED


class TestChecks:
    """What has to be so before a request is accepted, one thing missing at a time."""

    WRONG = ConditionChanged(Condition.BATTERY_LOW, True, "low")

    def ground(self, **changes: Any) -> Script:
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
        script.at(170.0, 0.0, UP)
        assert script.refusal(script.ask(wanted)) is Code.OUTSIDE_FENCE
        script.reports_landed = False
        script.wait(4.0)
        assert script.refusal(script.ask(wanted)) is Code.NOT_FLYING
        assert script.gate.state is State.EXTERNAL

    def test_resuming_needs_nothing_severe_and_a_clear_place_and_a_vehicle_that_flies(self) -> None:
        script = self.ground()
        script.land_state(LandedState.IN_AIR)
        script.ask(Hold())
        script.heartbeat(FlightMode.HOLD)
        assert script.gate.state is State.HOLDING
        script.feed(self.WRONG)
        assert script.refusal(script.ask(Resume())) is Code.SEVERITY
        script.feed(ConditionChanged(Condition.BATTERY_LOW, False))
        script.at(170.0, 0.0, UP)
        assert script.refusal(script.ask(Resume())) is Code.OUTSIDE_FENCE
        script.reports_landed = False
        script.wait(4.0)
        assert script.refusal(script.ask(Resume())) is Code.NOT_FLYING
        assert script.gate.state is State.HOLDING

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
        assert script.gate.state is State.HOVERING


class TestGranted:
    @pytest.mark.parametrize("wanted", [TakeControl(), Resume()], ids=["control", "resume"])
    def test_control_that_is_ours_is_complete_at_once(self, wanted: Request) -> None:
        script = Script(policy("default"))
        lead_to(State.HOVERING, script)
        before = script.gate.memory
        asked = script.ask(wanted)
        assert ended(script, asked) == "complete"
        assert script.gate.memory == before

    @pytest.mark.parametrize(
        ("state", "wanted"),
        [
            (State.EXTERNAL, TakeControl()),
            (State.EXTERNAL, Resume()),
            (State.HOLDING, Resume()),
        ],
    )
    def test_control_is_taken_at_the_present_place(self, state: State, wanted: Request) -> None:
        script, request_id = busy(state)
        assert reaction(script, request_id, lambda s: s.ask(wanted)) == Reaction(
            State.HOVERING, Control.TAKING, [], "superseded SUPERSEDED"
        )
        assert script.gate.hold_goal_ned == (0.0, 0.0, -UP)
        assert streams(script)

    def test_a_picture_is_asked_for_and_the_place_is_streamed(self) -> None:
        script = Script(policy("default"))
        lead_to(State.HOVERING, script)
        asked = script.ask(TakePhoto())
        assert reaction(script, asked, lambda s: None) == Reaction(
            State.TAKING_PICTURE, Control.OURS, [], ""
        )
        assert script.gate.memory.outstanding == ((asked, CommandKind.PHOTO),)
        assert streams(script)
        script.feed(PhotoSeen(1, ok=True))
        assert ended(script, asked) == "complete"
        assert script.gate.state is State.HOVERING

    @pytest.mark.parametrize("state", [State.GROUNDED, State.HOVERING])
    def test_a_mission_is_started_and_nothing_is_streamed(self, state: State) -> None:
        script = Script(policy("default"))
        lead_to(state, script)
        script.feed(MissionLoaded("square", 4))
        asked = script.ask(StartMission())
        assert (script.gate.state, script.gate.control) == (State.FLYING_MISSION, Control.OURS)
        assert script.gate.memory.outstanding == ((asked, CommandKind.START_MISSION),)
        assert not streams(script)

    @pytest.mark.parametrize("state", STATES)
    def test_the_fence_is_switched_where_the_policy_lets_it(self, state: State) -> None:
        script, request_id = busy(state, fence_switchable=True)
        asked = script.ask(SwitchFence(on=True))
        assert ended(script, asked) == "complete"
        assert script.all(SwitchedFence) == [SwitchedFence(on=True)]
        if state is State.FLYING_MISSION:
            assert ended(script, request_id) == "aborted BAD_MISSION"  # verified by another fence
            return
        assert script.gate.state is state
        assert not script.commands()
        assert not script.ended(request_id)

    def test_a_newer_goal_takes_the_place_of_one_that_waits_for_its_tick(self) -> None:
        script = Script(policy("default"))
        lead_to(State.HOVERING, script)
        first, second = script.ask(GoTo((5.0, 0.0, -UP))), script.ask(GOAL)
        assert script.verdict(first).ruling is Ruling.SUPERSEDED
        script.tick()
        assert script.gate.active_goal_ned == GOAL.goal_ned
        assert script.verdict(second).ruling is Ruling.ACCEPTED
        assert not script.ended(first)

    def test_the_owner_of_a_goal_may_replace_it_where_the_policy_says_so(self) -> None:
        script, request_id = flight(State.MOVING, retarget="replace")
        assert script.refusal(script.ask(GOAL, source="somebody else")) is Code.BUSY
        script.ask(GOAL)
        assert not script.ended(request_id)
        assert reaction(script, request_id, lambda s: s.tick()) == Reaction(
            State.MOVING, Control.OURS, [], "superseded SUPERSEDED"
        )
        assert script.gate.active_goal_ned == GOAL.goal_ned

    def test_one_that_does_not_clear_leaves_the_goal_that_flies(self) -> None:
        script, request_id = flight(State.MOVING, retarget="replace")
        goal_ned = script.gate.active_goal_ned
        asked = script.ask(GoTo((0.0, 500.0, -UP)))
        assert reaction(script, request_id, lambda s: s.tick()) == Reaction(
            State.MOVING, Control.OURS, [], ""
        )
        assert script.refusal(asked) is Code.OUTSIDE_FENCE
        assert script.gate.active_goal_ned == goal_ned

    def test_a_goal_that_does_not_clear_leaves_the_hover(self) -> None:
        script = Script(policy("default"))
        lead_to(State.HOVERING, script)
        asked = script.ask(GoTo((0.0, 500.0, -UP)))
        assert reaction(script, asked, lambda s: s.tick()) == Reaction(
            State.HOVERING, Control.OURS, [], ""
        )
        assert script.refusal(asked) is Code.OUTSIDE_FENCE
        assert streams(script)


def test_every_accepted_request_has_one_outcome_and_every_refused_none() -> None:
    script, request_id = flight(State.MOVING)
    refused = script.ask(TakePhoto())
    accepted = script.ask(Hold())
    script.heartbeat(FlightMode.HOLD)
    ids = [outcome.request_id for outcome in script.all(Outcome)]
    assert ids == [request_id, accepted]
    assert refused not in ids


def test_states_named_here_are_all_that_can_be_reached() -> None:
    assert {*AIRBORNE, State.NO_VEHICLE, State.STALE, State.GROUNDED} == set(STATES)
    assert {State.TAKING_OFF, *GUIDED_STATES, *MODE_STATES} == set(FLIGHT)


def test_home_and_fence_told_again_on_the_ground_change_nothing() -> None:
    script, request_id = flight(State.GROUNDED)
    verifier = script.gate.memory.verifier
    assert verifier is not None
    assert reaction(script, request_id, lambda s: s.feed(VerifierChanged(verifier))).ended == ""
    assert reaction(script, request_id, lambda s: s.feed(HomeSeen((0.0, 5.0, 0.0)))).ended == ""
