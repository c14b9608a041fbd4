"""Faults, asked for from outside or by the simulations' own parameters."""

from __future__ import annotations

from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.manual.sticks import Radio
from vehicle_sim.autopilot.parameters.simulated import Simulated
from vehicle_sim.engine.step import Blocks
from vehicle_sim.engine.truth import inject, put_home
from vehicle_sim.plant.faults import ClockJump, ModelFault, RcLost


class FaultInjection:
    """All faults but a reboot, which concerns every part."""

    def __init__(self, state: FlightState, blocks: Blocks, radio: Radio) -> None:
        self._state = state
        self._blocks = blocks
        self._radio = radio
        self.present: list[ModelFault | RcLost | ClockJump] = []
        """What was injected and not ended; one that came in the place of another has replaced
        it."""
        self.restart()

    def restart(self) -> None:
        """As after power-up: the clock is right again."""
        self.present = [each for each in self.present if not isinstance(each, ClockJump)]
        self._simulated = Simulated(self._state.parameters, self._state.ground.lat_deg)

    @property
    def allowed(self) -> bool:
        """Whether INJECT_FAILURE is taken."""
        switch = self._state.rules.failures_allowed_by
        return switch is None or self._state.parameters.get(switch) == 1

    def update(self) -> None:
        """What parameters that have changed bring about."""
        for fault in self._simulated.news():
            self.inject(fault)

    def put_home(self) -> None:
        """Who stands is a simulator's vehicle again on its home ground; who flies stays there."""
        put_home(self._blocks)

    def inject(self, fault: ModelFault | RcLost | ClockJump) -> None:
        self._note(fault)
        match fault:
            case RcLost(lost):
                self._radio.deaf = lost
            case ClockJump(by_ns):
                self._state.clock_off_ns += by_ns
            case _:
                inject(fault, self._blocks)

    def _note(self, fault: ModelFault | RcLost | ClockJump) -> None:
        """A state replaces the one before; jumps of the clock add up, and each is ended by the
        opposite one."""
        sound = fault.ended()
        if isinstance(fault, ClockJump):
            if sound in self.present:
                self.present.remove(sound)
            elif fault.by_ns:
                self.present.append(fault)
            return
        self.present = [each for each in self.present if each.ended() != sound]
        if fault != sound:
            self.present.append(fault)
