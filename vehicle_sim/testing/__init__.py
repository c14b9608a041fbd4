"""Vehicles for tests: the pytest plugin's parts, for those who use no pytest.

Loaded on first use: this package is imported by every pytest run, for the plugin in it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from vehicle_sim.autopilot.interface import Truth
    from vehicle_sim.testing.process import Simulator, SimulatorError, SimVehicle

__all__ = ["SimVehicle", "Simulator", "SimulatorError", "Truth"]


def __getattr__(name: str) -> object:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from vehicle_sim.testing import process

    return getattr(process, name)
