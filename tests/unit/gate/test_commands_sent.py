"""What a command carries, and after which mode it is sent."""

from __future__ import annotations

import pytest

from gcs.gate.effects import CommandKind, SendCommand
from gcs.gate.requests import (
    Arm,
    Disarm,
    Hold,
    Land,
    ReturnHome,
    TakeControl,
    TakeOff,
    TakePhoto,
)
from gcs.gate.states import Control, FlightMode, State
from tests.unit.gate.reactions import (
    default_policy,
    flight,
)
from tests.unit.gate.script import SECOND, Script, policy
from tests.unit.gate.situations import UP, lead_to


class TestCommands:
    def sent(self, script: Script) -> SendCommand:
        return script.all(SendCommand)[-1]

    def test_a_hold_is_tried_for_a_second_and_others_for_five(self) -> None:
        script = Script(policy("default")).take_control(UP)
        script.ask(Hold())
        assert self.sent(script).deadline_ns == script.now_ns + SECOND
        script.ask(Land())
        assert self.sent(script).deadline_ns == script.now_ns + 5 * SECOND

    def test_the_gates_own_are_nobodys(self) -> None:
        script = Script(policy("default")).fly(UP)
        script.ask(TakeControl())
        script.wait(6.2)
        assert (self.sent(script).kind, self.sent(script).request_id) == (CommandKind.HOLD, 0)

    def test_those_that_are_asked_for_carry_the_request(self) -> None:
        script = Script(policy("default")).take_control(UP)
        request_id = script.ask(Land())
        assert self.sent(script).request_id == request_id
        assert self.sent(script).up_m == 0.0

    def test_a_hold_that_is_repeated_waits_for_one_answer(self) -> None:
        script, hold = flight(State.HOLDING)
        script.wait(2.1)
        assert script.gate.memory.outstanding == ((hold, CommandKind.HOLD),)

    @pytest.mark.parametrize(
        ("wanted", "permitted"),
        [(Hold(), False), (Land(), True), (ReturnHome(), True), (TakePhoto(), False)],
    )
    def test_what_moves_the_vehicle_carries_a_permit(
        self, wanted: Hold | Land | ReturnHome | TakePhoto, permitted: bool
    ) -> None:
        script = Script(policy("default")).take_control(UP)
        script.ask(wanted)
        assert (self.sent(script).permit is not None) is permitted

    @pytest.mark.parametrize("force", [False, True])
    def test_a_disarm_carries_none(self, force: bool) -> None:
        script = Script(default_policy(allow_force_disarm=True))
        if force:
            script.fly(UP)
            script.ask(Disarm(force=True))
            script.ask(Disarm(force=True))
        else:
            lead_to(State.GROUNDED, script)
            script.ask(Disarm())
        assert self.sent(script).permit is None

    @pytest.mark.parametrize("mode", list(FlightMode))
    def test_px4_arms_in_no_mode_in_which_it_would_fly_at_once(self, mode: FlightMode) -> None:
        """scenarios_px4.json, D2_calibration_wrong_state: NAV_TAKEOFF ACCEPTED disarmed; C6: mode
        MISSION disarmed, then arm: flown."""
        script = Script(policy("default"))
        script.mode = mode
        script.connect()
        script.ask(Arm())
        waits = mode in (
            FlightMode.GUIDED,
            FlightMode.LAND,
            FlightMode.RETURN,
            FlightMode.MISSION,
            FlightMode.TAKEOFF,
        )
        assert script.commands() == [CommandKind.HOLD if waits else CommandKind.ARM]

    @pytest.mark.parametrize("mode", list(FlightMode))
    def test_ardupilot_arms_in_guided_alone(self, mode: FlightMode) -> None:
        script = Script(policy("default"), "ardupilot")
        script.mode = FlightMode.OTHER
        script.connect()
        script.heartbeat(mode)
        script.ask(Arm())
        waits = mode is not FlightMode.GUIDED
        assert script.commands() == [CommandKind.GUIDED if waits else CommandKind.ARM]

    @pytest.mark.parametrize("mode", list(FlightMode))
    def test_another_autopilot_in_any(self, mode: FlightMode) -> None:
        script = Script(policy("default"), "somebody")
        script.mode = mode
        script.connect()
        script.ask(Arm())
        assert script.commands() == [CommandKind.ARM]

    @pytest.mark.parametrize("autopilot", ["px4", "ardupilot", "somebody"])
    def test_a_climb_counts_from_where_it_stands(self, autopilot: str) -> None:
        script = Script(policy("default"), autopilot)
        script.pos_ned = (3.0, 4.0, -7.0)
        script.connect()
        script.heartbeat(FlightMode.GUIDED, armed=True)
        request_id = script.ask(TakeOff(5.0))
        assert script.gate.memory.top_ned == (3.0, 4.0, -12.0)
        assert not script.gate.memory.lifted
        assert script.gate.control is Control.OURS
        assert not script.ended(request_id)
