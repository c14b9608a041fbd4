"""The speed that the room allows at each place of the leg that is flown, for the record.

It is the gate's own law of pace (`gcs/gate/airspace/pace.py`), asked for places ahead of the
vehicle.  With twenty zones one place takes 1 ms, so a few are looked at each time, once for a leg.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from gcs.frames import Vec3
from gcs.gate.airspace.verifier import Verifier
from gcs.gate.airspace.zones import Zone
from gcs.gate.machine.memory import Memory
from gcs.gate.states import State
from gcs.report import LegItem

MOST_PLACES: Final = 25
LEAST_PLACES: Final = 5
PLACE_EVERY_M: Final = 0.5
"""A leg that is shorter than `MOST_PLACES` of these has fewer."""
PLACES_A_LOOK: Final = 3


class _Key(NamedTuple):
    """What the speeds depend on: where one of these is another one, they are found anew."""

    goal_ned: Vec3
    most_m_s: float
    zones: tuple[Zone, ...]
    fence_on: bool
    home_ned: Vec3 | None


@dataclass(slots=True)
class _Leg:
    key: _Key
    places_ned: tuple[Vec3, ...]
    speeds_m_s: list[float] = field(default_factory=list)


class LegAhead:
    """Of one vehicle."""

    def __init__(self) -> None:
        self._leg: _Leg | None = None

    def look(self, memory: Memory, sysid: int) -> LegItem | None:
        """What there is to record: the whole leg once it is known, nothing on it once it is over.
        To be called a few times a second."""
        goal, pos_ned, verifier = memory.goal, memory.pos_ned, memory.verifier
        if memory.state is not State.MOVING or goal is None or pos_ned is None or verifier is None:
            ended, self._leg = self._leg is not None, None
            return LegItem(sysid, (), ()) if ended else None
        key = _key(goal.pos_ned, goal.speed_m_s, verifier)
        if self._leg is None or self._leg.key != key:
            self._leg = _Leg(key, _places(pos_ned, goal.pos_ned))
        leg, done = self._leg, len(self._leg.speeds_m_s)
        if done == len(leg.places_ned):
            return None
        leg.speeds_m_s += [
            verifier.speed_there(goal.pos_ned, place_ned, goal.speed_m_s)
            for place_ned in leg.places_ned[done : done + PLACES_A_LOOK]
        ]
        if len(leg.speeds_m_s) < len(leg.places_ned):
            return None
        return LegItem(sysid, leg.places_ned, tuple(leg.speeds_m_s))


def _key(goal_ned: Vec3, most_m_s: float, verifier: Verifier) -> _Key:
    return _Key(goal_ned, most_m_s, verifier.zones, verifier.fence_on, verifier.home_ned)


def _places(pos_ned: Vec3, goal_ned: Vec3) -> tuple[Vec3, ...]:
    """From the vehicle to its goal, closer together towards the goal, where speeds fall: by equal
    steps of the speed of a constant deceleration."""
    steps = (
        min(MOST_PLACES, max(LEAST_PLACES, math.ceil(math.dist(pos_ned, goal_ned) / PLACE_EVERY_M)))
        - 1
    )
    return tuple(_between(goal_ned, pos_ned, (step / steps) ** 2) for step in range(steps, -1, -1))


def _between(a_ned: Vec3, b_ned: Vec3, share: float) -> Vec3:
    north, east, down = (a + share * (b - a) for a, b in zip(a_ned, b_ned, strict=True))
    return (north, east, down)
