"""The world in which the explorer flies: three places and more in a yard, and its policy.

Positions are (north, east, down) in metres, velocities in metres per second.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from msgspec import structs

from gcs.frames import Vec3
from gcs.gate.airspace.verifier import Verifier, verifier_for
from gcs.gate.airspace.zones import Zone
from gcs.gate.condition import Condition, Severity
from gcs.gate.geometry import Circle
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Arrival, Policy
from gcs.gate.policy.zonespec import CircleSpec

HOME: Final[Vec3] = (0.0, 0.0, 0.0)
STILL: Final[Vec3] = (0.0, 0.0, 0.0)
SPOT: Final[Vec3] = (0.0, 0.0, -5.0)
GOAL: Final[Vec3] = (3.0, 0.0, -5.0)
GOAL_YAW_RAD: Final = 3.0
AWAY_YAW_RAD: Final = -3.0
"""The heading that is asked for at the goal, and another one, on the other side of south."""
EDGE: Final[Vec3] = (18.0, 0.0, -5.0)
DASH: Final[Vec3] = (8.0, 0.0, 0.0)
TOP: Final[Vec3] = (0.0, 0.0, -10.0)
LOW: Final[Vec3] = (0.0, 0.0, -9.25)
ABOVE: Final[Vec3] = (0.0, 0.0, -14.0)
OUTSIDE: Final[Vec3] = (50.0, 0.0, -5.0)
STROLL: Final[Vec3] = (1.0, 0.0, 0.0)
RUSH: Final[Vec3] = (50.0, 0.0, 0.0)
NOWHERE: Final[Vec3] = (float("nan"), 0.0, -5.0)

CONDITIONS: Final[Mapping[Condition, Severity]] = MappingProxyType(
    {
        Condition.TICK_LATE: Severity.CAUTION,
        Condition.BATTERY_LOW: Severity.HOLD,
        Condition.BATTERY_CRITICAL: Severity.RETURN,
        Condition.VEHICLE_FAILSAFE_ACTIVE: Severity.LAND,
        Condition.ORIGIN_MISMATCH: Severity.TERMINATE,
    }
)
"""One condition of each severity is enough: the gate knows conditions by severity alone, but for
the one of a vehicle that is outside (CHANGELOG.md, known gaps)."""

YARD: Final = structs.replace(
    DEFAULT,
    name="yard",
    fence=(
        CircleSpec(
            20.0,
            name="yard",
            frame="local",
            floor_up_m=0.0,
            ceiling_up_m=30.0,
        ),
    ),
    fence_switchable=True,
    arrival=Arrival(radius_m=0.5, max_radius_m=0.5, speed_m_s=None, yaw_deg=5.0, dwell_s=0.0),
    jump_speed_m_s=1e12,
    takeoff=structs.replace(DEFAULT.takeoff, max_up_m=20.0),
    severities={condition: CONDITIONS.get(condition, Severity.CAUTION) for condition in Condition},
    allow_force_disarm=True,
)
"""Every permission that opens a branch of the table is given; the rest is the default."""

ELSEWHERE: Final = Zone("elsewhere", True, Circle((200.0, 0.0), 20.0), 0.0, 30.0)


@dataclass(frozen=True)
class World:
    """What does not change during an exploration.  `return_up_m` and `climb_ends_within_m` are the
    vehicle's own."""

    policy: Policy
    verifier: Verifier
    return_up_m: float
    climb_ends_within_m: float


def world(
    policy: Policy, autopilot: str, return_up_m: float, climb_ends_within_m: float = 0.0
) -> World:
    verifier = verifier_for(policy, autopilot, HOME, None)
    return World(policy, verifier, return_up_m, climb_ends_within_m)
