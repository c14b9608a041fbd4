"""Whether the vehicles of one session come too close to each other.

Looked at with every position of one that flies, against all others that fly: as a condition of
both.  And with every goal, take-off, orbit and mission start, before the gate sees it: its way is
compared with what the others fly (`ways.py`), whenever each is there.  Who is nearer already may
fly where it comes no nearer; from the ground, as near as the other's take-off place is.

Each position is in its own vehicle's frame, so it goes through latitude and longitude where the
frames differ.  A vehicle without an origin or a fresh position is compared with nobody: that it
lacks them is a condition of its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Final

from gcs.frames import Vec3
from gcs.gate.airspace.separation import (
    Leg,
    Track,
    between_legs_m,
    closest_approach,
    is_too_close,
    legs_near,
)
from gcs.gate.condition import Condition
from gcs.gate.policy.policy import SeparationLimits
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import BeginStream, GoTo, Request, StartMission, TakeOff
from gcs.session.work import ForOwner, Work, condition
from gcs.station.fleet.neighbours import into_frame_of
from gcs.station.vehicles import Vehicles
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.vehicle.vehicle import Vehicle
from gcs.vehicle.ways import legs_asked, legs_of

LESS_M: Final = 0.1
"""Vehicles that are too close already may fly where they come no nearer than that."""
SWAYS_M: Final = 0.5
"""One that hovers over its take-off place may be beside it by so much."""
COMPARED: Final[dict[type, str]] = {
    GoTo: "the leg",
    TakeOff: "the climb",
    BeginStream: "the orbit",
    StartMission: "the mission",
}
"""The requests whose ways are compared with what the others fly."""


class Separation:
    """Between every two vehicles, each by its slot."""

    def __init__(self, limits: SeparationLimits) -> None:
        self._limits = limits
        self._close: dict[int, set[int]] = {}
        """Of every vehicle: those that it is too close to."""

    def moved(self, vehicles: Vehicles, slot: int, now_ns: int) -> list[Work]:
        """The vehicle in that slot has told its position."""
        work: list[Work] = []
        for other in range(len(vehicles)):
            if other != slot:
                work += self._pair(vehicles, slot, other, now_ns)
        return work

    def why_not(
        self, vehicles: Vehicles, slot: int, request_id: int, request: Request, now_ns: int
    ) -> Refusal | None:
        """Why the vehicle in that slot may not fly what is asked for: its way comes too close to
        another vehicle's.  What cannot be flown at all the gate refuses, and says why."""
        if type(request) not in COMPARED or len(vehicles) < 2:
            return None
        vehicle = vehicles.of_owner(slot)
        here = vehicle.placed(now_ns)
        if here is None or here.pos_ned is None:
            return None
        way = legs_asked(vehicle, request_id, request, here.pos_ned)
        for number, other in enumerate(vehicles):
            there = None if number == slot else other.flying(now_ns)
            moved = None if there is None else into_frame_of(here, there)
            if not way or there is None or there.pos_ned is None or moved is None:
                continue
            legs = [(moved(a), moved(b)) for a, b in legs_of(other, there.pos_ned)]
            wrong_m = (here.health.accuracy_h_m or 0.0) + (there.health.accuracy_h_m or 0.0)
            if vehicle.flying(now_ns) is None:
                now_m = _stood_apart_m(here.pos_ned, there, moved) - SWAYS_M
            else:
                now_m = _least_m([(here.pos_ned, here.pos_ned)], legs) - LESS_M
            keep_m = min(self._limits.least_m, now_m - wrong_m)
            least_m = max(0.0, _least_m(*legs_near(way, legs, keep_m + wrong_m)) - wrong_m)
            if least_m < keep_m:
                return self._refusal(COMPARED[type(request)], other, least_m)
        return None

    def _refusal(self, what: str, other: Vehicle, least_m: float) -> Refusal:
        sentence = (
            f"{what} comes as near as {least_m:.1f} m to where vehicle {other.sysid} flies "
            f"({self._limits.least_m:g} m are to be kept)"
        )
        numbers = (
            ("other_vehicle", float(other.sysid)),
            ("least_m", least_m),
            ("to_keep_m", self._limits.least_m),
        )
        return Refusal(Code.OTHER_VEHICLE, sentence, numbers)

    def _pair(self, vehicles: Vehicles, slot: int, other: int, now_ns: int) -> list[Work]:
        was = other in self._close.setdefault(slot, set())
        text = self._too_close(vehicles.of_owner(slot), vehicles.of_owner(other), was, now_ns)
        if was == bool(text):
            return []
        work: list[Work] = []
        for mine, others in ((slot, other), (other, slot)):
            close = self._close.setdefault(mine, set())
            before = bool(close)
            close ^= {others}
            if before != bool(close):
                name = f"vehicle {vehicles.of_owner(others).sysid}: " if text else ""
                changed = condition(Condition.TOO_CLOSE, bool(close), name + text)
                work.append(ForOwner(mine, (changed,)))
        return work

    def _too_close(self, one: Vehicle, other: Vehicle, was: bool, now_ns: int) -> str:
        """In words how close they come; empty where it is far enough, or one does not fly."""
        here, there = one.flying(now_ns), other.flying(now_ns)
        if here is None or there is None:
            return ""
        assert there.pos_ned is not None
        moved = into_frame_of(here, there)
        if moved is None or here.pos_ned is None:
            return ""
        seen_from_here = moved(there.pos_ned)
        limits = self._limits
        approach = closest_approach(
            _track(here, here.pos_ned, now_ns),
            _track(there, seen_from_here, now_ns),
            limits.within_s,
        )
        if not is_too_close(approach, limits, was=was):
            return ""
        return (
            f"{approach.least_m:.1f} m away in {approach.in_s:.1f} s, if both fly on "
            f"({limits.least_m:g} m are to be kept)"
        )


def _least_m(way: Iterable[Leg], legs: Iterable[Leg]) -> float:
    """Between the nearest two; infinite where there are none."""
    legs = list(legs)
    return min((between_legs_m(*mine, *leg) for mine in way for leg in legs), default=math.inf)


def _stood_apart_m(pos_ned: Vec3, there: Telemetry, moved: Callable[[Vec3], Vec3]) -> float:
    """From where one stands to where the other took off, beside each other."""
    if there.home_ned is None:
        return math.inf
    return math.dist(pos_ned[:2], moved(there.home_ned)[:2])


def _track(telemetry: Telemetry, pos_ned: Vec3, now_ns: int) -> Track:
    return Track(
        pos_ned,
        telemetry.v_ned,
        age_s=(now_ns - telemetry.position_ns) / 1e9,
        error_m=telemetry.health.accuracy_h_m or 0.0,
    )
