"""How a flight gets into each state, and what tests set and ask there that no input does."""

from __future__ import annotations

from dataclasses import replace as replace_zones
from typing import assert_never

from msgspec.structs import replace

from gcs.frames import Vec3, ned_from_enu
from gcs.gate.airspace.verifier import Verifier, verifier_for
from gcs.gate.airspace.zones import Zone
from gcs.gate.effects import Effect, Outcome, SendSetpoint
from gcs.gate.geometry import Circle
from gcs.gate.inputs import MissionLoaded, PositionSeen
from gcs.gate.machine.gate import Gate
from gcs.gate.machine.memory import Memory
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
from gcs.gate.states import FlightMode, LandedState, State
from tests.unit.gate.script import Script, policy

UP = 1.5
"""High enough for the default policy's floor, low enough for the lab's ceiling."""

GUIDED_STATES = (State.HOVERING, State.MOVING, State.TAKING_PICTURE)
"""Where the vehicle flies to our setpoints."""

FLIGHT = (
    State.TAKING_OFF,
    *GUIDED_STATES,
    State.FLYING_MISSION,
    State.RETURNING,
    State.LANDING,
)
"""Where it flies, and a request can be under way."""

AIRBORNE = (*FLIGHT, State.HOLDING, State.EXTERNAL)
"""Reported in the air."""

HEARD = (State.GROUNDED, *AIRBORNE)
"""Heard, with a fresh position."""

VERIFIED = (State.TAKING_OFF, *GUIDED_STATES, State.FLYING_MISSION)
"""Where it flies to, or is held at, what was verified."""

STATES = (State.NO_VEHICLE, State.STALE, State.GROUNDED, *AIRBORNE)
"""All that can be asked of the gate between two ticks."""


STILL: Vec3 = (0.0, 0.0, 0.0)


def default_policy(**changes: object) -> Policy:
    return replace(policy("default"), **changes)


def flight(state: State, **changes: object) -> tuple[Script, int]:
    """A script in `state` with a request under way, and that request's id; every mode that was
    commanded is shown.  `changes` are to the default policy."""
    if state is State.EXTERNAL:
        changes["allow_force_disarm"] = True
    script = Script(default_policy(**changes))
    request_id = under_way(state, script)
    assert state_of(script) is state
    script.forget()
    return script, request_id


def stale(state: State) -> tuple[Script, int]:
    """As `flight`, with a position that has just become too old."""
    script, request_id = flight(state)
    script.reports_position = False
    script.wait(1.1)
    assert state_of(script) is State.STALE
    return script, request_id


def state_of(script: Script) -> State:
    """The gate's state, anew each time it is asked."""
    return script.gate.state


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


def lead_to(state: State, script: Script) -> None:
    """Leave `script` in `state`, armed where a vehicle can be, with what was asked for shown."""
    match state:
        case State.NO_VEHICLE:
            pass
        case State.GROUNDED | State.TAKING_OFF:
            script.connect()
            script.ask(Arm())
            script.heartbeat(armed=True)
            if state is State.TAKING_OFF:
                script.ask(TakeOff(UP))
        case State.HOVERING:
            script.take_control(UP)
        case State.HOLDING:
            script.take_control(UP)
            script.ask(Abort())
            script.heartbeat(FlightMode.HOLD)
        case State.EXTERNAL:
            script.fly(UP)
        case _:
            under_way(state, script)


def take_off(script: Script, up: float = UP) -> int:
    """A take-off that was commanded, and of which the vehicle shows the mode alone."""
    script.connect()
    script.ask(Arm())
    script.heartbeat(FlightMode.GUIDED if script.autopilot == "ardupilot" else None)
    script.heartbeat(armed=True)
    request_id = script.ask(TakeOff(up))
    script.heartbeat(FlightMode.GUIDED if script.autopilot == "ardupilot" else FlightMode.TAKEOFF)
    return request_id


def ended(script: Script, request_id: int) -> str:
    """How a request ended, once; "" where it goes on."""
    outcomes = [o for o in script.all(Outcome) if o.request_id == request_id]
    assert len(outcomes) <= 1
    return "".join(f"{o.kind} {o.code}" if o.code else str(o.kind) for o in outcomes)


def remember(script: Script, **facts: object) -> None:
    """The gate goes on as if it had been told these facts (fields of its memory) before."""
    memory = with_facts(script.gate.memory, **facts)
    script.gate = Gate.resumed(script.policy, memory, script.now_ns)


def with_facts(memory: Memory, **facts: object) -> Memory:
    """A copy of `memory` with these fields instead."""
    copied = memory.copy()
    for name, value in facts.items():
        assert hasattr(copied, name)
        setattr(copied, name, value)
    return copied


def sample(script: Script, east: float, *, reset: bool = False) -> PositionSeen:
    """The vehicle stands so far east, this instant."""
    boot_ms = script.now_ns // 1_000_000
    return PositionSeen(ned_from_enu((east, 0.0, UP)), STILL, boot_ms, reset)


def elsewhere(script: Script) -> Verifier:
    """A fence that holds no place where the vehicle is."""
    verifier = verifier_for(script.policy, script.autopilot, (0.0, 0.0, 0.0), None)
    yard = Zone("elsewhere", True, Circle((900.0, 0.0), 20.0), 0.0, 30.0)
    return replace_zones(verifier, zones=(*verifier.zones, yard))


def streams(script: Script) -> bool:
    """Does a setpoint leave with the next tick?"""
    effects: list[Effect] = script.tick()
    return any(isinstance(effect, SendSetpoint) for effect in effects)
