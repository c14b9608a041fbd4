"""How near a flight came to leaving its fence, by where the vehicle really was.

The fence is that of the policy, and of the mission's own file, placed about where the vehicle
really stood at its start: what the station believed has no part in it.  A path is taken as straight
from one look to the next, `LOOK_NS` later, which is wrong by at most a * LOOK^2 / 8: 6 mm at 5
m/s^2.  Floors are left out, as whoever takes off and lands passes them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from gcs.campaign.simulators import Truth
from gcs.frames import Vec3
from gcs.gate.airspace.clearance import Motion, inclusion_measures
from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.airspace.zones import Zone, build_zones
from gcs.gate.geometry import Circle
from gcs.gate.policy.policy import Policy
from gcs.gate.policy.zonespec import ZoneSpec
from gcs.gate.refusal import Refusal

LOOK_NS = 100_000_000
NEAR_GROUND_M = 0.5
START_NED: Vec3 = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Nearest:
    """The least clearance of a flight, negative outside: from what, and when."""

    clear_m: float = math.inf
    of: str = ""
    at_s: float = 0.0


def zones_about(
    home: Vec3, policy: Policy, autopilot: str, own: Sequence[ZoneSpec] = ()
) -> tuple[Zone, ...]:
    """The fence, and the policy's height and distance as zones of their own.

    Raises ValueError where a zone cannot stand there.
    """
    origin = Origin(*home)
    built = build_zones((*policy.fence, *own), START_NED, Projection(origin, autopilot))
    if isinstance(built, Refusal):
        raise ValueError(built.sentence)
    around = Circle((0.0, 0.0), policy.max_distance_m)
    return (*built, Zone("policy", True, around, ceiling_up_m=policy.max_up_m))


class Looks:
    """What the vehicle really did; a look every `LOOK_NS`."""

    def __init__(self, zones: Sequence[Zone], start_ns: int) -> None:
        self._zones = zones
        self._start_ns = start_ns
        self._before: Truth | None = None
        self.nearest = Nearest()
        self.flew = False
        self.armed_s: float | None = None
        self.down_s: float | None = None
        """When it was last seen to come down."""
        self.max_up_m = self.max_distance_m = self.max_speed_m_s = 0.0
        self.touchdown_m_s = 0.0
        """The fastest that it sank nearer than `NEAR_GROUND_M` to the ground."""

    def look(self, truth: Truth, now_ns: int) -> None:
        before, self._before = self._before, truth
        t_s = (now_ns - self._start_ns) / 1e9
        north, east, down = truth.pos_ned
        if truth.armed and self.armed_s is None:
            self.armed_s = t_s
        if before is None:
            return
        if not truth.landed:
            self.flew, self.down_s = True, None
            self.max_up_m = max(self.max_up_m, -down)
            self.max_distance_m = max(self.max_distance_m, math.hypot(north, east))
            self.max_speed_m_s = max(self.max_speed_m_s, math.hypot(*truth.v_ned))
            if -down < NEAR_GROUND_M:
                self.touchdown_m_s = max(self.touchdown_m_s, truth.v_ned[2])
            self._measure(Motion.between(before.pos_ned, truth.pos_ned), t_s)
        elif not before.landed:
            self.down_s = t_s

    def _measure(self, motion: Motion, t_s: float) -> None:
        for zone in self._zones:
            for clear_m, of in _clearances(zone, motion):
                if clear_m < self.nearest.clear_m:
                    self.nearest = Nearest(clear_m, of, t_s)


def _clearances(zone: Zone, motion: Motion) -> list[tuple[float, str]]:
    if zone.inclusion:
        measures = inclusion_measures(zone, motion, floor_applies=False)
        return [(each.least_m, f"{each.face.value} {zone.title}") for each in measures]
    m = motion
    beside_m = zone.shape.outer_clearance(m.a_en, m.b_en)
    below_m = zone.floor_up_m - max(m.a_up_m, m.b_up_m)
    above_m = min(m.a_up_m, m.b_up_m) - zone.ceiling_up_m
    return [(max(beside_m, below_m, above_m), f"inside {zone.title}")]
