"""Flight scripts: a gate, a clock that the test turns, and a vehicle that says what it is told to.

Positions are the operator's (east, north, up); the gate hears NED.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import TypeVar

import gcs.gate
from gcs.frames import Vec3, enu_from_ned, ned_from_enu
from gcs.gate.airspace.verifier import verifier_for
from gcs.gate.effects import (
    CommandKind,
    Effect,
    Outcome,
    SendCommand,
    SendSetpoint,
    SwitchedFence,
    Transition,
    Verdict,
)
from gcs.gate.inputs import (
    ClimbEndSeen,
    CommandEnded,
    HeartbeatSeen,
    HomeSeen,
    Input,
    LandedSeen,
    PositionSeen,
    Requested,
    ReturnHeightSeen,
    ReturnPlacesSeen,
    Tick,
    VerifierChanged,
)
from gcs.gate.machine.gate import Gate
from gcs.gate.machine.table import TABLE, Table
from gcs.gate.policy.parse import parse_policy
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code
from gcs.gate.requests import GoTo, Request, TakeControl
from gcs.gate.states import FlightMode, LandedState, State

MS = 1_000_000
SECOND = 1_000 * MS
TICK = 50 * MS

E = TypeVar("E")


@cache
def policy(name: str) -> Policy:
    """One of the shipped policies."""
    path = Path(gcs.gate.__file__).parent / "policy" / f"{name}.toml"
    return parse_policy(path.read_text(encoding="utf-8"), str(path))


class Script:
    """Every input goes through `feed`; every effect stays in `said` with the time it came."""

    def __init__(
        self, rules: Policy, autopilot: str = "px4", start_ns: int = SECOND, table: Table = TABLE
    ) -> None:
        self.policy = rules
        self.now_ns = start_ns
        self.gate = Gate(rules, autopilot, start_ns, table)
        self.autopilot = autopilot
        self.effects: list[tuple[int, Effect]] = []
        self.armed = False
        self.mode = FlightMode.HOLD
        self.landed = LandedState.ON_GROUND
        self.pos_ned: Vec3 = (0.0, 0.0, 0.0)
        self.v_ned: Vec3 = (0.0, 0.0, 0.0)
        self.yaw_rad: float | None = None  # it tells no heading
        self.flown = False
        self.reports_position = True
        self.reports_heartbeat = True
        self.reports_landed = True
        self.asked = 0  # the id of the last request
        self._ticks = 0

    # ----------------------------------------------------------------------------- inputs

    def feed(self, given: Input) -> list[Effect]:
        effects = self.gate.handle(given, self.now_ns)
        self.effects += [(self.now_ns, effect) for effect in effects]
        for effect in effects:
            if isinstance(effect, SwitchedFence):
                self.place(fence_on=effect.on)
        return effects

    def place(self, *, fence_on: bool = True) -> None:
        """Home, and with it the fence, become known."""
        verifier = verifier_for(
            self.policy, self.autopilot, (0.0, 0.0, 0.0), None, fence_on=fence_on
        )
        self.feed(HomeSeen((0.0, 0.0, 0.0)))
        self.feed(ReturnHeightSeen(1.5))
        self.feed(ReturnPlacesSeen(()))
        self.feed(ClimbEndSeen(0.8 if self.autopilot == "px4" else 0.0))
        self.feed(VerifierChanged(verifier))

    def ask(self, request: Request, source: str = "keyboard") -> int:
        self.asked += 1
        self.feed(Requested(self.asked, source, request))
        return self.asked

    def goto(self, east: float, north: float, up: float) -> int:
        return self.ask(GoTo(ned_from_enu((east, north, up))))

    def heartbeat(self, mode: FlightMode | None = None, *, armed: bool | None = None) -> None:
        self.mode = self.mode if mode is None else mode
        self.armed = self.armed if armed is None else armed
        self.feed(HeartbeatSeen(self.armed, self.mode, self.mode.value))

    def land_state(self, landed: LandedState) -> None:
        self.landed = landed
        self.feed(LandedSeen(landed))

    def at(self, east: float, north: float, up: float, v_enu: Vec3 = (0.0, 0.0, 0.0)) -> None:
        """The vehicle reports itself there, having flown there at 20 m/s if it was elsewhere."""
        goal_ned = ned_from_enu((east, north, up))
        while self.flown and (left_m := math.dist(self.pos_ned, goal_ned)) > 0.45:
            part = min(1.0, 1.0 / left_m) if left_m > 1.0 else 1.0 - 0.4 / left_m
            north_m, east_m, down_m = (
                a + (b - a) * part for a, b in zip(self.pos_ned, goal_ned, strict=True)
            )
            self.pos_ned = (north_m, east_m, down_m)
            self.tick()
        self.pos_ned, self.v_ned = goal_ned, ned_from_enu(v_enu)
        self.position()

    def position(self) -> None:
        stamp_ms, yaw_rad = self.now_ns // MS, self.yaw_rad
        self.feed(PositionSeen(self.pos_ned, self.v_ned, stamp_ms, yaw_rad=yaw_rad))

    def answer(self, kind: CommandKind, result: int | None, text: str = "") -> None:
        """The vehicle answers the last command of that kind."""
        last = [sent for sent in self.all(SendCommand) if sent.kind is kind][-1]
        self.feed(CommandEnded(last.request_id, kind, result, text))

    def tick(self, ticks: int = 1) -> list[Effect]:
        """Next ticks of the grid, each after what the vehicle reports by itself."""
        effects: list[Effect] = []
        for _ in range(ticks):
            self._ticks += 1
            self.now_ns += TICK
            if self.reports_heartbeat and self._ticks % 20 == 0:
                self.heartbeat()
                if self.reports_landed:
                    self.feed(LandedSeen(self.landed))
            if self.reports_position:
                self.position()
            effects += self.feed(Tick(0))
        return effects

    def wait(self, seconds: float) -> list[Effect]:
        return self.tick(round(seconds * 20))

    # ------------------------------------------------------------------------- situations

    def connect(self) -> Script:
        """Heard, with home, on the ground, disarmed."""
        self.heartbeat()
        self.land_state(self.landed)
        self.position()
        self.place()
        self.tick()
        self.flown = True
        return self

    def fly(self, up: float = 0.5) -> Script:
        """Hovering at (0, 0, `up`), flown by somebody else."""
        self.armed, self.landed = True, LandedState.IN_AIR
        self.at(0.0, 0.0, up)
        return self.connect()

    def take_control(self, up: float = 0.5) -> Script:
        """Hovering there under our control."""
        self.fly(up)
        self.ask(TakeControl())
        self.wait(self.policy.control.stream_s + 0.1)
        self.heartbeat(FlightMode.GUIDED)
        self.tick()
        assert self.gate.state is State.HOVERING
        return self

    # ----------------------------------------------------------------------------- effects

    def all(self, kind: type[E]) -> list[E]:
        return [effect for _, effect in self.effects if isinstance(effect, kind)]

    def verdict(self, request_id: int) -> Verdict:
        """The one verdict; a missing or second one fails the test."""
        (verdict,) = [v for v in self.all(Verdict) if v.request_id == request_id]
        return verdict

    def refusal(self, request_id: int) -> Code:
        refusal = self.verdict(request_id).refusal
        assert refusal is not None
        return refusal.code

    def outcome(self, request_id: int) -> Outcome:
        (outcome,) = [e for e in self.all(Outcome) if e.request_id == request_id]
        return outcome

    def ended(self, request_id: int) -> bool:
        return any(e.request_id == request_id for e in self.all(Outcome))

    def commands(self) -> list[CommandKind]:
        return [sent.kind for sent in self.all(SendCommand)]

    def states(self) -> list[State]:
        return [transition.after for transition in self.all(Transition)]

    def setpoints(self) -> Iterator[tuple[int, Vec3]]:
        """Time and place (E N U) of every setpoint that left."""
        for now_ns, effect in self.effects:
            if isinstance(effect, SendSetpoint) and effect.permit.pos_ned is not None:
                yield now_ns, enu_from_ned(effect.permit.pos_ned)

    def forget(self) -> None:
        """Look only at what comes from here on."""
        self.effects.clear()
