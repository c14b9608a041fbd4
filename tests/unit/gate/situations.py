"""How a flight gets into each state, told by what the operator asks and the vehicle reports."""

from __future__ import annotations

from typing import assert_never

from gcs.gate.inputs import MissionLoaded
from gcs.gate.requests import Abort, Arm, Land, ReturnHome, StartMission, TakeOff, TakePhoto
from gcs.gate.states import FlightMode, State
from tests.unit.gate.script import Script

UP = 1.5
"""High enough for the default policy's floor, low enough for the lab's ceiling."""


def lead_to(state: State, script: Script) -> None:
    """Leave `script` in `state`, armed where a vehicle can be."""
    match state:
        case State.NO_VEHICLE:
            pass
        case State.STALE:
            script.take_control(UP)
            script.reports_position = False
            script.wait(script.policy.position_age_s + 0.1)
        case State.GROUNDED | State.TAKING_OFF:
            script.connect()
            script.ask(Arm())
            script.heartbeat(armed=True)
            if state is State.TAKING_OFF:
                script.ask(TakeOff(UP))
        case State.HOVERING:
            script.take_control(UP)
        case State.MOVING:
            script.take_control(UP)
            script.goto(3.0, 0.0, UP)
            script.tick()
        case State.TAKING_PICTURE:
            script.take_control(UP)
            script.ask(TakePhoto())
        case State.FLYING_MISSION:
            script.take_control(UP)
            script.feed(MissionLoaded("square", 5))
            script.ask(StartMission())
            script.heartbeat(FlightMode.MISSION)
        case State.RETURNING:
            script.take_control(UP)
            script.ask(ReturnHome())
            script.heartbeat(FlightMode.RETURN)
        case State.LANDING:
            script.take_control(UP)
            script.ask(Land())
            script.heartbeat(FlightMode.LAND)
        case State.HOLDING:
            script.take_control(UP)
            script.ask(Abort())
            script.heartbeat(FlightMode.HOLD)
        case State.EXTERNAL:
            script.fly(UP)
        case State.VERIFYING | State.STREAMING:
            raise ValueError(f"nothing leads to {state.name}")
        case _:
            assert_never(state)
