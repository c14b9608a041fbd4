"""What each mode flies: the task that it begins with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import assert_never

from vehicle_sim.autopilot.bounds import Bounds
from vehicle_sim.autopilot.control.demands import Task
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.interface import Landed
from vehicle_sim.autopilot.manual.stick_tasks import StickFlight
from vehicle_sim.autopilot.manual.sticks import Radio
from vehicle_sim.autopilot.modes import Behaviour, Mode, StickLaw
from vehicle_sim.autopilot.parameters.parameters import Quantity
from vehicle_sim.autopilot.tasks.descent_rate import without_sticks_m_s
from vehicle_sim.autopilot.tasks.follow import FOLLOW, Leader
from vehicle_sim.autopilot.tasks.guided import Guided, SetpointStream
from vehicle_sim.autopilot.tasks.orbit import Orbit, ardupilot_circle, px4_default
from vehicle_sim.autopilot.tasks.tasks import Brake, Hold, Land, Level, Return, TakeOff


@dataclass(slots=True, eq=False, repr=False)
class ModeTasks:
    """Makes tasks.

    `mission` is the one that the vehicle has, given once it is made: it is a task, and may change
    the mode itself.
    """

    _state: FlightState
    _bounds: Bounds
    _radio: Radio
    _stream: SetpointStream
    _leader: Leader
    mission: Task = field(init=False)

    def task_of(self, mode: Mode) -> Task:
        state = self._state
        if mode.law is not None:
            return StickFlight(mode.law, state.parameters, self._radio, self._without_sticks(mode))
        match mode.behaviour:
            case Behaviour.LEVEL:
                return Level()
            case Behaviour.HOLD:
                return Brake() if state.rules.brakes_by_velocity else Hold()
            case Behaviour.GUIDED:
                if state.rules.guided_forgets_setpoints:
                    self._stream.forget()
                return Guided(state.parameters, self._stream)
            case Behaviour.TAKEOFF:
                return self.take_off(state.parameters.si(Quantity.TAKEOFF_UP_M))
            case Behaviour.MISSION:
                return self.mission
            case Behaviour.RETURN:
                tell = self._bounds.tell_return if state.rules.tells_return else None
                return Return(state.parameters, self._bounds.landing_site, tell)
            case Behaviour.LAND:
                return Land(state.parameters)
            case Behaviour.ORBIT:
                return Orbit(px4_default, state.parameters, self._radio)
            case Behaviour.CIRCLE:
                return Orbit(ardupilot_circle(state.parameters), state.parameters)
            case Behaviour.FOLLOW:
                return FOLLOW[state.personality](state.parameters, self._leader)
            case _:
                assert_never(mode.behaviour)

    def _without_sticks(self, mode: Mode) -> Callable[[], Task]:
        """Makes what a manual mode flies while there are no sticks."""
        if mode.behaviour is Behaviour.LEVEL:
            return Level
        if mode.law is StickLaw.POSITION and self._state.rules.sinks_without_sticks:
            return partial(
                Land, self._state.parameters, rate=without_sticks_m_s, landed_word=Landed.IN_AIR
            )
        return Hold

    def take_off(self, up_m: float) -> TakeOff:
        state = self._state
        home_d = state.home_ned[2] if state.home_ned is not None else 0.0
        return TakeOff(home_d - up_m, state.parameters)
