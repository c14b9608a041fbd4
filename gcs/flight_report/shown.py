"""What is shown of a vehicle as it was told: samples of plots, build, parameters, mission."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, radians
from typing import TypeAlias

from gcs.flight_report.facts import (
    Acceleration,
    Build,
    Fix,
    Parameter,
    PlanItem,
    Pose,
    Sample,
)
from gcs.flight_report.flight import ParameterSeen, VehicleFlight
from gcs.frames import Vec3

EARTH_M = 6_371_000.0
MAX_PLAN = 2_000

Told: TypeAlias = Sample | Acceleration | Build | Parameter | Fix | PlanItem


@dataclass(frozen=True, slots=True)
class _Anchor:
    """A place that is known both on the earth and in the record's local frame."""

    fix: Fix
    enu: Vec3

    def enu_of(self, item: PlanItem) -> Vec3:
        """On a plane about the anchor: a few kilometres away it is some decimetres off."""
        fix = self.fix
        east_m = radians(item.lon_deg - fix.lon_deg) * EARTH_M * cos(radians(fix.lat_deg))
        north_m = radians(item.lat_deg - fix.lat_deg) * EARTH_M
        up_m = item.alt_m - (fix.alt_rel_m if item.above_home else fix.alt_amsl_m)
        return (self.enu[0] + east_m, self.enu[1] + north_m, self.enu[2] + up_m)


@dataclass(slots=True)
class Shown:
    flight: VehicleFlight
    _anchor: _Anchor | None = None
    _plan: dict[int, PlanItem] = field(default_factory=dict)
    _has_attitude: bool = False

    def take(self, fact: Told, t_s: float, here: Vec3 | None, *, in_air: bool) -> None:
        flight = self.flight
        match fact:
            case Sample(plot, values, first, leads):
                self._has_attitude |= plot == "attitude" and leads
                flight.plots.sampled[plot].take(t_s, first, values, leads)
            case Acceleration(xyz):
                if in_air:
                    flight.spectrum.add(t_s, xyz)
                else:
                    flight.spectrum.rest()
            case Build(firmware, hardware):
                flight.build = Build(
                    firmware or flight.build.firmware, hardware or flight.build.hardware
                )
            case Parameter(name, value, default):
                flight.parameters.setdefault(name, ParameterSeen()).told(t_s, value, default)
            case Fix():
                if self._anchor is None and here is not None:
                    self._anchor = _Anchor(fact, here)
            case PlanItem(seq=seq):
                if len(self._plan) < MAX_PLAN:
                    self._plan[seq] = fact

    def pose(self, fact: Pose, t_s: float) -> None:
        sampled = self.flight.plots.sampled
        sampled["place"].take(t_s, 0, fact.pos_enu, leads=True)
        if not self._has_attitude:
            angles = (fact.roll_deg, fact.pitch_deg, fact.yaw_deg)
            sampled["attitude"].take(t_s, 0, angles, leads=True)

    def finish(self) -> None:
        if self._anchor is not None:
            self.flight.plan = [self._anchor.enu_of(item) for _, item in sorted(self._plan.items())]
