"""What is shown of a vehicle as it was told: samples of plots, build, parameters, mission."""

from __future__ import annotations

from dataclasses import dataclass, field
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
from gcs.flight_report.flight import Anchor, ParameterSeen, VehicleFlight
from gcs.frames import Vec3

MAX_PLAN = 2_000

Told: TypeAlias = Sample | Acceleration | Build | Parameter | Fix | PlanItem


@dataclass(slots=True)
class Shown:
    flight: VehicleFlight
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
                if flight.anchor is None and here is not None:
                    flight.anchor = Anchor(fact, here)
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
        anchor = self.flight.anchor
        if anchor is not None:
            self.flight.plan = [anchor.enu_of(item) for _, item in sorted(self._plan.items())]
