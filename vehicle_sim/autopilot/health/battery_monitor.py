"""What the autopilot believes of its battery."""

from __future__ import annotations

from vehicle_sim.autopilot.control.battery_charge import charge_by_voltage
from vehicle_sim.autopilot.interface import Power
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.autopilot.parameters.simulated import SimulatedBattery
from vehicle_sim.autopilot.rules import RULES
from vehicle_sim.control_loops.believed import Believed
from vehicle_sim.control_loops.flight import Flight
from vehicle_sim.plant.sensed import Sensed

UNMEASURED = Power(0.0, -0.01, 0.0, -1)
"""As MAVLink says it: current and remaining charge of -1."""


class BatteryMonitor:
    """Voltage, current and charge, by the sensors or by the simulations' own parameters."""

    def __init__(
        self, parameters: Parameters, sensed: Sensed, loops: Flight, believed: Believed
    ) -> None:
        self._parameters = parameters
        self._rules = RULES[parameters.personality]
        self._loops = loops
        self._sensed = sensed
        self._believed = believed
        self._simulated = SimulatedBattery(parameters)

    def update(self, armed: bool, seconds: float) -> None:
        """Time has passed."""
        self._simulated.update(armed, seconds)

    @property
    def volts(self) -> float:
        return self._simulated.volts(self._sensed.battery_v)

    @property
    def power(self) -> Power:
        sensed = self._sensed
        switch = self._rules.battery_monitor
        if switch is not None and self._parameters.get(switch) == 0:
            return UNMEASURED
        return Power(
            self.volts,
            sensed.battery_a,
            sensed.battery_used_mah,
            int(100.0 * self.charge_seen + 0.5),
        )

    @property
    def charge_seen(self) -> float:
        """0..1: PX4, unless it is told a capacity, goes by the voltage; ArduCopter counts."""
        f = self._loops
        simulated = self._simulated.charge(0.25 * (f.u1 + f.u2 + f.u3 + f.u4))
        if simulated is not None:
            return simulated
        capacity_mah = self._parameters.get(self._rules.battery_capacity)
        if capacity_mah <= 0.0:
            by_voltage = self._rules.charge_by_voltage
            return charge_by_voltage(self._sensed, self._believed) if by_voltage else 0.0
        return max(0.0, 1.0 - self._sensed.battery_used_mah / capacity_mah)
