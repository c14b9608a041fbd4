from __future__ import annotations
from typing import Final
from vehicle_sim.autopilot.modes import Personality
KNOWN: Final[dict[Personality, dict[str, str]]] = {"px4": {}, "ardupilot": {}}
