"""What PX4 and ArduCopter do differently, one field for each rule.

A rule stands here when the same code flies both and only a value, an answer or a yes or no is
different.  Where whole procedures differ there is a class for each, and the rule names the class.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import Personality


@dataclass(frozen=True, slots=True)
class AutopilotRules:
    """`not_now` is the answer to what its own checks refuse."""

    not_now: Result


RULES: Final[dict[Personality, AutopilotRules]] = {
    "px4": AutopilotRules(not_now=Result.TEMPORARILY_REJECTED),
    "ardupilot": AutopilotRules(not_now=Result.FAILED),
}
