"""What a pilot wants to know of a flight and no message says: how long, how far, how much longer.

From snapshots alone, on their clock.  What cannot be known yet is None.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Final, NamedTuple

from gcs import ipc
from gcs.gate.geometry import Circle, Polygon
from gcs.gate.states import LandedState

SAMPLE_NS: Final = 1_000_000_000
SAMPLES: Final = 900
"""A quarter of an hour, one a second."""
USE_NS: Final = 120_000_000_000
"""The use of the battery is that of the last two minutes."""
LEAST_USE_NS: Final = 20_000_000_000
LEAST_USE_PCT: Final = 0.5
"""The charge is told in whole per cent: less than this says nothing yet."""


class Sample(NamedTuple):
    """What the graphs show, and the battery's use is reckoned from."""

    time_ns: int
    up_m: float | None
    speed_m_s: float | None
    battery_pct: float | None
    in_air: bool


@dataclass(slots=True)
class FlightNumbers:
    samples: deque[Sample] = field(default_factory=lambda: deque(maxlen=SAMPLES))
    air_since_ns: int | None = None
    flown_ns: int = 0
    """Of the flight that is over."""

    def seen(self, seen: ipc.Snapshot) -> None:
        in_air = bool(seen.armed) and seen.landed not in _GROUND
        if in_air and self.air_since_ns is None:
            self.air_since_ns = seen.time_ns
        elif self.air_since_ns is not None:
            self.flown_ns = seen.time_ns - self.air_since_ns
            if not in_air and seen.landed == LandedState.ON_GROUND.name:
                self.air_since_ns = None
        if seen.pos_enu is None and seen.battery_pct is None:
            return
        if not self.samples or seen.time_ns - self.samples[-1].time_ns >= SAMPLE_NS:
            up_m = None if seen.pos_enu is None else seen.pos_enu[2]
            speed_m_s = None if seen.v_enu is None else math.hypot(*seen.v_enu)
            self.samples.append(Sample(seen.time_ns, up_m, speed_m_s, seen.battery_pct, in_air))

    def before(self, told: ipc.History) -> None:
        """What was before this screen was there."""
        points = [
            Sample(each.time_ns, each.pos_enu[2], each.speed_m_s, each.battery_pct, each.in_air)
            for each in told.trail
        ]
        until_ns = self.samples[0].time_ns if self.samples else math.inf
        older = [each for each in points if each.time_ns < until_ns]
        self.samples = deque([*older, *self.samples], maxlen=SAMPLES)
        self.air_since_ns = told.in_air_since_ns

    def minutes_left(self, down_to_pct: float) -> float | None:
        """Until the charge is down to this, at the use of the last two minutes in the air."""
        if not self.samples or self.samples[-1].battery_pct is None or self.air_since_ns is None:
            return None
        last = self.samples[-1]
        charge_pct = self.samples[-1].battery_pct
        since = [
            (each.time_ns, each.battery_pct)
            for each in self.samples
            if each.in_air and each.battery_pct is not None
            if each.time_ns >= max(last.time_ns - USE_NS, self.air_since_ns)
        ]
        if charge_pct is None or not since:
            return None
        used_pct, took_ns = since[0][1] - charge_pct, last.time_ns - since[0][0]
        if took_ns < LEAST_USE_NS or used_pct < LEAST_USE_PCT:
            return None
        return max(0.0, (charge_pct - down_to_pct) / used_pct * took_ns / 60e9)


_GROUND: Final = ("", LandedState.UNDEFINED.name, LandedState.ON_GROUND.name)


def home_m(seen: ipc.Snapshot) -> float | None:
    """Over ground."""
    if seen.pos_enu is None or seen.home_enu is None:
        return None
    return math.dist(seen.pos_enu[:2], seen.home_enu[:2])


def off_goal_m(seen: ipc.Snapshot) -> float | None:
    """How far from where it is to hover: what a wind does to it."""
    if seen.state != "HOVERING" or seen.pos_enu is None or seen.active_goal_enu is None:
        return None
    return math.dist(seen.pos_enu, seen.active_goal_enu)


def fence_m(zones: Sequence[ipc.FenceShape], pos_enu: ipc.Vec3 | None) -> float | None:
    """To the nearest side or ceiling that may not be crossed; negative beyond it.

    A floor is mostly the ground, which is always near."""
    if pos_enu is None or not zones:
        return None
    return min(_clearance_m(zone, pos_enu) for zone in zones)


def _clearance_m(zone: ipc.FenceShape, pos_enu: ipc.Vec3) -> float:
    """In a zone to stay out of, any way out is good."""
    inside_m = [_side_m(zone, pos_enu[:2])]
    if zone.ceiling_up_m is not None:
        inside_m.append(zone.ceiling_up_m - pos_enu[2])
    if not zone.inclusion and zone.floor_up_m is not None:
        inside_m.append(pos_enu[2] - zone.floor_up_m)
    return min(inside_m) if zone.inclusion else -min(inside_m)


def _side_m(zone: ipc.FenceShape, at_en: tuple[float, float]) -> float:
    if zone.centre_en is not None:
        return Circle(zone.centre_en, zone.radius_m).clearance(at_en)
    return _polygon(tuple(zone.corners_en)).clearance(at_en)


@lru_cache(maxsize=256)
def _polygon(corners_en: tuple[tuple[float, float], ...]) -> Polygon:
    return Polygon(corners_en)
