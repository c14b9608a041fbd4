"""What one thing that happens leads to: for tests that ask the same of every state."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, assert_never

from msgspec.structs import replace

from gcs.gate.effects import CommandKind, Effect, Outcome, SendSetpoint
from gcs.gate.inputs import MissionLoaded
from gcs.gate.machine.gate import Gate
from gcs.gate.policy.policy import Policy
from gcs.gate.requests import (
    Abort,
    Arm,
    Disarm,
    GoTo,
    Hold,
    Land,
    ReturnHome,
    StartMission,
    TakeControl,
    TakeOff,
    TakePhoto,
)
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import UP

Happening = Callable[[Script], object]

GUIDED_STATES = (State.HOVERING, State.MOVING, State.TAKING_PICTURE)
"""Where the vehicle flies to our setpoints."""

MODE_STATES = (State.FLYING_MISSION, State.RETURNING, State.LANDING)
"""Where it flies by itself, at our command."""

FLIGHT = (State.TAKING_OFF, *GUIDED_STATES, *MODE_STATES)
"""Where it flies, and a request can be under way."""


class Reaction(NamedTuple):
    """`ended` is how the request ended that was under way, "" where it goes on."""

    state: State
    control: Control
    sent: list[CommandKind]
    ended: str


def default_policy(**changes: Any) -> Policy:
    return replace(policy("default"), **changes)


def flight(state: State, /, *, autopilot: str = "px4", **changes: Any) -> tuple[Script, int]:
    """A script in `state` with a request under way, and that request's id; every mode that was
    commanded is shown."""
    script = Script(default_policy(**changes), autopilot)
    request_id = under_way(state, script)
    assert script.gate.state is state
    script.forget()
    return script, request_id


def under_way(state: State, script: Script) -> int:
    """Lead `script` to `state` by a request that has not ended; its id."""
    match state:
        case State.GROUNDED:
            script.connect()
            return script.ask(Arm())
        case State.TAKING_OFF:
            request_id = take_off(script)
            script.land_state(LandedState.IN_AIR)
            script.at(0.0, 0.0, 1.0)
            return request_id
        case State.HOVERING:
            script.fly(UP)
            return script.ask(TakeControl())
        case State.MOVING | State.STALE:
            script.take_control(UP)
            request_id = script.ask(GoTo((0.0, 3.0, -UP)))
            script.tick()
            if state is State.STALE:
                script.reports_position = False
                script.wait(script.policy.position_age_s + 0.1)
            return request_id
        case State.TAKING_PICTURE:
            script.take_control(UP)
            return script.ask(TakePhoto())
        case State.FLYING_MISSION:
            script.take_control(UP)
            script.feed(MissionLoaded("square", 5))
            request_id = script.ask(StartMission())
            script.heartbeat(FlightMode.MISSION)
            return request_id
        case State.RETURNING:
            script.take_control(UP)
            request_id = script.ask(ReturnHome())
            script.heartbeat(FlightMode.RETURN)
            return request_id
        case State.LANDING:
            script.take_control(UP)
            request_id = script.ask(Land())
            script.heartbeat(FlightMode.LAND)
            return request_id
        case State.HOLDING:
            script.take_control(UP)
            return script.ask(Hold())
        case State.EXTERNAL:
            assert script.policy.allow_force_disarm
            script.fly(UP)
            script.ask(Disarm(force=True))
            return script.ask(Disarm(force=True))
        case State.NO_VEHICLE:
            script.take_control(UP)
            script.reports_heartbeat = script.reports_position = False
            script.wait(4.0)
            return script.ask(Abort())
        case State.VERIFYING | State.STREAMING:
            raise ValueError(f"nothing leads to {state.name}")
        case _:
            assert_never(state)


def take_off(script: Script, up: float = UP) -> int:
    """A take-off that was commanded, and of which the vehicle shows the mode alone."""
    script.connect()
    script.ask(Arm())
    script.heartbeat(FlightMode.GUIDED if script.autopilot == "ardupilot" else None)
    script.heartbeat(armed=True)
    request_id = script.ask(TakeOff(up))
    script.heartbeat(FlightMode.GUIDED if script.autopilot == "ardupilot" else FlightMode.TAKEOFF)
    return request_id


def reaction(script: Script, request_id: int, happens: Happening) -> Reaction:
    """What `happens` leads to, and what became of the request."""
    script.forget()
    happens(script)
    return Reaction(
        script.gate.state, script.gate.control, script.commands(), ended(script, request_id)
    )


def ended(script: Script, request_id: int) -> str:
    """How a request ended, once; "" where it goes on."""
    outcomes = [o for o in script.all(Outcome) if o.request_id == request_id]
    assert len(outcomes) <= 1
    return "".join(f"{o.kind} {o.code}" if o.code else str(o.kind) for o in outcomes)


def remember(script: Script, **facts: object) -> None:
    """The gate goes on as if it had been told these facts (fields of its memory) before."""
    memory = script.gate.memory
    for name, value in facts.items():
        assert hasattr(memory, name)
        setattr(memory, name, value)
    script.gate = Gate.resumed(script.policy, memory, script.now_ns)


def streams(script: Script) -> bool:
    """Does a setpoint leave with the next tick?"""
    effects: list[Effect] = script.tick()
    return any(isinstance(effect, SendSetpoint) for effect in effects)
