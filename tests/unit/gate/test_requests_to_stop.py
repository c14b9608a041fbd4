"""Hold, abort, land and disarm in each state: on the ground, in the air, and where nobody knows."""

from __future__ import annotations

import pytest

from gcs.gate.effects import CommandKind, Ruling
from gcs.gate.inputs import (
    ReturnHeightSeen,
)
from gcs.gate.refusal import Code
from gcs.gate.requests import (
    Abort,
    Arm,
    Disarm,
    Hold,
    Land,
    Request,
    ReturnHome,
)
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.reactions import (
    AIRBORNE,
    Reaction,
    default_policy,
    ended,
    flight,
    follows_setpoints,
    reaction,
    state_of,
    streams,
    take_off,
)
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import lead_to


class TestHoldAndAbort:
    @pytest.mark.parametrize("wanted", [Hold(), Abort()], ids=["hold", "abort"])
    @pytest.mark.parametrize("state", AIRBORNE)
    def test_in_the_air_it_holds_at_once_and_ends_what_was_under_way(
        self, state: State, wanted: Request
    ) -> None:
        script, request_id = flight(state)
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
        script, request_id = flight(state)
        script.reports_position = False
        script.wait(1.1)
        assert state_of(script) is State.STALE
        assert reaction(script, request_id, lambda s: s.ask(wanted)) == Reaction(
            State.STALE, Control.OURS, [CommandKind.HOLD], "aborted OPERATOR"
        )
        assert not streams(script)
        script.reports_position = True
        script.tick()
        assert state_of(script) is State.HOLDING

    def test_abort_of_a_vehicle_that_is_not_heard_is_sent_until_its_time_is_over(self) -> None:
        script, request_id = flight(State.NO_VEHICLE)
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

    @pytest.mark.parametrize("wanted", [Disarm(), Disarm(force=True), ReturnHome()])
    def test_nor_of_somebody_who_is_lost(self, wanted: Request) -> None:
        script, request_id = flight(State.NO_VEHICLE)
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
        [Disarm(), Disarm(force=True), Abort(), Land(), ReturnHome()],
    )
    def test_disarmed_there_is_nothing_left_to_do(self, wanted: Request) -> None:
        assert self.complete(Script(policy("default")).connect(), wanted)

    @pytest.mark.parametrize("wanted", [Land(), ReturnHome(), Arm()])
    def test_armed_it_stands_all_the_same(self, wanted: Request) -> None:
        script = self.armed()
        assert self.complete(script, wanted)
        assert state_of(script) is State.GROUNDED

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
        assert (state_of(script), script.gate.control) == (after, Control.OURS)
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
        script.answer(CommandKind.TAKE_OFF, 2)
        assert state_of(script) is State.GROUNDED
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
        script.answer(CommandKind.TAKE_OFF, 2)
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
        assert state_of(script) is State.STALE
        script.forget()
        return script

    @pytest.mark.parametrize("wanted", [Land(), ReturnHome()])
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
        assert state_of(script) is State.GROUNDED
        script.heartbeat(armed=False)
        assert ended(script, asked) == "complete"

    def arming(self) -> tuple[Script, int]:
        """As above, and arming is under way."""
        script, arm = flight(State.GROUNDED)
        script.reports_position = False
        script.wait(1.2)
        assert state_of(script) is State.STALE
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
        assert state_of(script) is State.STALE
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
        assert state_of(script) is State.GROUNDED

    def test_disarm_forgets_the_take_off(self) -> None:
        script, request_id = self.taking_off()
        assert reaction(script, request_id, lambda s: s.ask(Disarm())) == Reaction(
            State.STALE, Control.NONE, [CommandKind.DISARM], "superseded SUPERSEDED"
        )
        script.reports_position = True
        script.tick()
        assert state_of(script) is State.GROUNDED

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
        assert state_of(script) is State.STALE
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
        script, request_id = flight(state)
        followed = follows_setpoints(script)
        assert reaction(script, request_id, lambda s: s.ask(Land())) == Reaction(
            State.LANDING, Control.OURS, [CommandKind.LAND], "superseded SUPERSEDED"
        )
        assert streams(script) is followed, "held in its place until it shows the mode"
        script.heartbeat(FlightMode.LAND)
        assert not streams(script)
