"""A brake in a return or a landing: its floor is lifted, the ground is not."""

from __future__ import annotations

from gcs.gate.airspace.projection import Origin
from gcs.gate.airspace.verifier import verifier_for
from gcs.gate.effects import CommandKind
from gcs.gate.inputs import MissionLoaded
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.requests import StartMission
from gcs.gate.states import FlightMode, LandedState, State
from tests.unit.gate.script import Script


def test_no_brake_points_below_the_ground() -> None:
    verifier = verifier_for(DEFAULT, "px4", (0.0, 0.0, 0.0), Origin(47.0, 8.0, 400.0))
    breach = verifier.predicted_stop((0.0, 130.0, 1.0), (0.0, 20.0, 0.0), floor_applies=False)
    assert breach is not None
    assert breach.brake_pos_ned is not None
    assert breach.brake_pos_ned[2] <= 0.0


class TestAMissionThatLiftsOff:
    """PX4 takes a climb of half a metre to be over at once: it is in the air, and no higher yet."""

    def begun(self) -> Script:
        script = Script(DEFAULT).connect()
        script.heartbeat(armed=True)
        script.land_state(LandedState.ON_GROUND)
        script.feed(MissionLoaded("first step", 3))
        script.ask(StartMission())
        script.heartbeat(FlightMode.MISSION)
        script.land_state(LandedState.IN_AIR)
        script.forget()
        return script

    def test_the_floor_is_not_for_what_has_not_climbed(self) -> None:
        script = self.begun()
        script.at(0.0, 0.0, -0.1)
        assert script.gate.state is State.FLYING_MISSION
        assert script.commands() == []

    def test_it_is_for_what_has(self) -> None:
        script = self.begun()
        script.at(0.0, 0.0, 3.0)
        script.at(0.0, 0.0, 2.0, (0.0, 0.0, -8.0))
        assert script.gate.state is State.HOLDING
        assert script.commands() == [CommandKind.HOLD]
