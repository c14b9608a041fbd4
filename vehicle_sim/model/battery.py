"""A lithium-polymer battery: charge counted, voltage from the charge and the sag."""

from __future__ import annotations

from vehicle_sim.model.airframe import BatteryPack

# Open-circuit voltage of one cell over its remaining charge, straight between the points: the
# usual shape of a LiPo discharge curve.
_CHARGE = (0.0, 0.05, 0.10, 0.20, 0.40, 0.60, 0.80, 1.0)
_VOLTS = (3.00, 3.45, 3.60, 3.70, 3.78, 3.88, 4.02, 4.20)
_FULL_CELL_V = _VOLTS[-1]


class Battery:
    """State: `consumed_mah`, and the `voltage_v` and `current_a` of the last update."""

    __slots__ = ("_pack", "consumed_mah", "current_a", "voltage_v")

    def __init__(self, pack: BatteryPack) -> None:
        self._pack = pack
        self.consumed_mah = 0.0
        self.current_a = pack.idle_current_a
        self.voltage_v = self._open_circuit_v() - self.current_a * pack.resistance_ohm

    @property
    def remaining(self) -> float:
        """Charge left, 0..1."""
        left = 1.0 - self.consumed_mah / self._pack.capacity_mah
        return max(0.0, left)

    @property
    def strength(self) -> float:
        """Voltage over the full battery's: what full throttle reaches of the full speed."""
        return self.voltage_v / (self._pack.cells * _FULL_CELL_V)

    def draw(self, s1: float, s2: float, s3: float, s4: float, dt_s: float) -> None:
        """Motors at speed fractions `s` for `dt_s`; a propeller's power goes with the cube."""
        pack = self._pack
        cubes = s1 * s1 * s1 + s2 * s2 * s2 + s3 * s3 * s3 + s4 * s4 * s4
        self.current_a = pack.idle_current_a + pack.motor_current_max_a * cubes
        self.consumed_mah += self.current_a * dt_s / 3.6
        voltage = self._open_circuit_v() - self.current_a * pack.resistance_ohm
        self.voltage_v = max(0.0, voltage)

    def _open_circuit_v(self) -> float:
        charge = self.remaining
        i = 1
        while charge > _CHARGE[i]:
            i += 1
        part = (charge - _CHARGE[i - 1]) / (_CHARGE[i] - _CHARGE[i - 1])
        return self._pack.cells * (_VOLTS[i - 1] + part * (_VOLTS[i] - _VOLTS[i - 1]))
