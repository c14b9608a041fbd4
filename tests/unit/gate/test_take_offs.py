"""A take-off: what is commanded, how far up it is, and whether it has left the ground."""

from __future__ import annotations

import pytest

from gcs.gate.effects import CommandKind, SendCommand
from gcs.gate.requests import Hold, Land, TakeOff
from gcs.gate.states import FlightMode, LandedState, State
from tests.unit.gate.reactions import HELD, Reaction, ended, reaction, remember, state_of, take_off
from tests.unit.gate.script import Script, policy


class TestCommandAndHeight:
    def test_the_command_that_waited_for_its_mode_has_the_height(self) -> None:
        script = Script(policy("default"), "ardupilot").connect()
        script.heartbeat(FlightMode.HOLD, armed=True)
        request_id = script.ask(TakeOff(3.0))
        script.heartbeat(FlightMode.GUIDED)
        sent = script.all(SendCommand)
        assert [s.kind for s in sent] == [CommandKind.GUIDED, CommandKind.TAKE_OFF]
        assert (sent[-1].request_id, sent[-1].up_m) == (request_id, 3.0)

    def test_the_ground_is_as_far_down_as_where_it_stands(self) -> None:
        """Ten metres east of home, on the ground: it stands, and an abort disarms it."""
        script = Script(policy("default"))
        script.pos_ned = (0.0, 10.0, 0.0)
        take_off(script)
        script.ask(Hold())
        assert script.gate.state is State.GROUNDED
        assert script.commands()[-2:] == [CommandKind.HOLD, CommandKind.DISARM]

    @pytest.mark.parametrize("up", [5.5, 5.75, 5.9375])
    def test_a_climb_that_ended_less_than_a_metre_above_is_told_as_above(self, up: float) -> None:
        script = Script(policy("default"))
        request_id = take_off(script, 5.0)
        script.land_state(LandedState.TAKEOFF)
        script.v_ned = (0.0, 0.0, -1.0)
        script.at(0.0, 0.0, up, (0.0, 0.0, 1.0))
        script.land_state(LandedState.IN_AIR)
        script.v_ned = (0.0, 0.0, 0.0)
        script.heartbeat(FlightMode.HOLD)
        script.tick()
        assert "m above the height asked for" in script.outcome(request_id).sentence


class TestWhetherItStands:
    def test_a_climb_that_is_still_reported_to_stand_is_not_disarmed(self) -> None:
        """Its landed state lags for longer than our take-off may come late."""
        script = Script(policy("default"))
        request_id = take_off(script, 5.0)
        script.at(0.0, 0.0, 3.0, (0.0, 0.0, 1.0))
        script.wait(11.0)
        assert state_of(script) is State.TAKING_OFF
        assert reaction(script, request_id, lambda s: s.ask(Hold())) == Reaction(
            *HELD, "aborted OPERATOR"
        )

    def test_a_take_off_comes_late_until_its_time_and_not_at_it(self) -> None:
        """From then on what is reported to stand is believed to, wherever it is."""
        script = Script(policy("default")).connect()
        script.heartbeat(armed=True)
        script.land_state(LandedState.ON_GROUND)
        script.pos_ned = (0.0, 0.0, -1.0)
        script.tick()
        remember(script, takeoff_until_ns=script.now_ns)
        script.land_state(LandedState.ON_GROUND)
        assert ended(script, script.ask(Land())) == "complete"
        assert script.commands() == []
