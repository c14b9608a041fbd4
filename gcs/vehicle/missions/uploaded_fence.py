"""The fence that was uploaded to a vehicle: read (`plan_on_board.py`), and told in short.

Its circle and height are parameters, which `settings.py` reads; this is about the zones of the
mission protocol (MISSION_TYPE_FENCE), whoever has put them on board.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, TypeAlias

from gcs.frames import Vec3
from gcs.gate.airspace.projection import Origin, Projection
from gcs.plan.errors import PlanError
from gcs.plan.formats.fence_items import split_fence
from gcs.plan.model import Circle, LatLon, Zone
from gcs.plan.wire import WireItem, items_from_wire
from gcs.protocol.effects import Address
from gcs.session.speedup_waits import Times
from gcs.vehicle.missions.plan_on_board import PlanOnBoard
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import MissionType

SOURCE: Final = "its fence on board"


@dataclass(frozen=True, slots=True)
class UploadedFence:
    """What is known of it; without any zone, there is none, or it is not known."""

    stay_in: int = 0
    """How many zones the vehicle must not leave."""
    stay_out: int = 0
    """How many it must not enter."""
    reach_m: float | None = None
    """The farthest from home that any of the first kind lets the vehicle be; None: there is none,
    or the place of home is not known."""
    unreadable: str = ""
    """Why it is not known."""

    def keeps_within(self, most_m: float) -> bool:
        """Of home."""
        return self.reach_m is not None and self.reach_m <= most_m

    def words(self, policy_m: float, most_m: float, unused: str) -> str:
        """For people, beside how far from home the policy lets it fly, and what is taken for that;
        `unused` is why the vehicle does not use it.  Empty where there is nothing to say."""
        if self.unreadable:
            return f"not known ({self.unreadable})"
        if not self.stay_in and not self.stay_out:
            return ""
        zones = f"{self.stay_in} to stay in, {self.stay_out} to stay out of"
        if unused:
            return f"{zones}, not in use ({unused})"
        if not self.stay_in:
            return zones
        if self.reach_m is None:
            return f"{zones}, where home is not known"
        far = f"{zones}, up to {self.reach_m:.0f} m from home"
        return far if self.keeps_within(most_m) else f"{far}, the policy's is {policy_m:g} m"


NO_FENCE: Final = UploadedFence()
_Facts: TypeAlias = tuple[tuple[WireItem, ...], Origin | None, Vec3 | None]
"""What it is worked out from."""


class FenceOnBoard(PlanOnBoard):
    """Reads the uploaded fence of one vehicle."""

    def __init__(self, own: Address, times: Times) -> None:
        super().__init__(own, times, MissionType.FENCE)
        self._known_from: _Facts | None = None
        self._known = NO_FENCE

    def seen(self, telemetry: Telemetry) -> UploadedFence:
        """What is known of it now."""
        items = self.items
        if items is None:
            return UploadedFence(unreadable=self.failure)
        facts = (items, telemetry.origin, telemetry.home_ned)
        if facts != self._known_from:
            self._known_from, self._known = facts, uploaded_fence(items, telemetry)
        return self._known


def uploaded_fence(items: tuple[WireItem, ...], telemetry: Telemetry) -> UploadedFence:
    """The items that the vehicle has sent, in short."""
    try:
        _, fence, _ = split_fence(SOURCE, items_from_wire(items, SOURCE))
    except PlanError as error:
        return UploadedFence(unreadable=str(error))
    inside = [zone for zone in fence.zones if zone.inclusion]
    outside = len(fence.zones) - len(inside)
    reaches_m = [reach for zone in inside for reach in _reaches_m(zone, telemetry)]
    return UploadedFence(len(inside), outside, max(reaches_m, default=None))


def _reaches_m(zone: Zone, telemetry: Telemetry) -> Iterator[float]:
    """Distances from home of a zone's corners, or of the far side of a circle."""
    if telemetry.origin is None or telemetry.home_ned is None:
        return
    projection = Projection(telemetry.origin, telemetry.autopilot.name)
    home_north_m, home_east_m, _ = telemetry.home_ned
    shape = zone.shape
    places = (shape.centre,) if isinstance(shape, Circle) else shape.corners
    more_m = shape.radius_m if isinstance(shape, Circle) else 0.0
    for place in places:
        if isinstance(place, LatLon):
            north_m, east_m = projection.north_east(*place)
            yield math.hypot(north_m - home_north_m, east_m - home_east_m) + more_m
