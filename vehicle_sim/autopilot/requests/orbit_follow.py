"""Circles, and a leader to follow."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.interface import Geodetic, OrbitRequest, Result
from vehicle_sim.autopilot.manual.sticks import Radio
from vehicle_sim.autopilot.tasks.follow import Leader, Sighting
from vehicle_sim.autopilot.tasks.orbit import Nose, Orbit, Round, px4_round
from vehicle_sim.autopilot.transitions import Transitions
from vehicle_sim.numerics.vectors import Vec3

_DEFAULT_ORBIT_M = 1.0
_DEFAULT_ORBIT_M_S = 1.0


@dataclass(slots=True, eq=False, repr=False)
class OrbitFollowRequests:
    """What is flown round, and what is flown after."""

    _state: FlightState
    _transitions: Transitions
    _radio: Radio
    _leader: Leader

    def orbit(self, asked: OrbitRequest) -> Result:
        state = self._state
        if not state.rules.orbit_mode:
            return Result.UNSUPPORTED
        if not state.position_ok:
            return Result.TEMPORARILY_REJECTED
        s = state.look_around()
        task = state.task
        now = task.round if isinstance(task, Orbit) else None
        if now is None:
            now = Round(s.stop_ned, _DEFAULT_ORBIT_M, _DEFAULT_ORBIT_M_S, Nose.TO_CENTRE)
        way = 1.0 if now.speed_m_s >= 0.0 else -1.0
        north, east = now.centre_ned[:2] if asked.centre_ne is None else asked.centre_ne
        down = now.centre_ned[2] if asked.down_m is None else asked.down_m
        nose = now.nose
        if asked.nose is not None and asked.nose in (0, 1, 2, 3, 4):
            nose = Nose(asked.nose)
        wanted = px4_round(
            state.parameters,
            (north, east, down),
            asked.radius_m if asked.radius_m is not None else way * now.radius_m,
            asked.speed_m_s if asked.speed_m_s is not None else abs(now.speed_m_s),
            nose,
        )
        if wanted is None:
            state.say(2, "Orbit radius limit exceeded")
            return Result.DENIED
        if isinstance(task, Orbit):
            task.change(wanted, s)
        else:
            circle = Orbit(lambda s: wanted, state.parameters, self._radio)
            self._transitions.enter_kind("orbit", circle)
        state.request_decision()
        return Result.ACCEPTED

    def hear_leader(
        self, system: int, where: Geodetic, v_ned: Vec3, heading_rad: float | None, wall_ns: int
    ) -> None:
        if self._state.origin is None or not all(map(isfinite, v_ned)):
            return
        pos_ned = self._state.projection.to_local(where)
        self._leader.heard(Sighting(system, pos_ned, v_ned, heading_rad, wall_ns))
