"""Vehicles for tests: the pytest plugin's parts, for those who use no pytest."""

from vehicle_sim.autopilot.interface import Truth
from vehicle_sim.testing.process import Simulator, SimulatorError, SimVehicle

__all__ = ["SimVehicle", "Simulator", "SimulatorError", "Truth"]
