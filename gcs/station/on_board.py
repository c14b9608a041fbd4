"""What a vehicle has on board: its mission, and the fence that was uploaded."""

from __future__ import annotations

from typing import Final

from gcs import ipc
from gcs.frames import enu_from_ned
from gcs.gate.airspace.projection import Projection
from gcs.gate.airspace.zones import build_zones
from gcs.gate.refusal import Refusal
from gcs.plan import commands
from gcs.plan.errors import PlanError
from gcs.plan.formats.fence_items import split_fence
from gcs.plan.model import Frame, Geographic, Item
from gcs.plan.wire import items_from_wire
from gcs.plan.zones import zone_specs
from gcs.session import announcements
from gcs.vehicle.missions.missions import Missions
from gcs.vehicle.missions.uploaded_fence import SOURCE, FenceOnBoard
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.vehicle.vehicle import Vehicle

PATH_POINTS: Final = 1_000
"""Of a longer path every second, third ... point is told."""
_DATUMS: Final = {Frame.HOME: "home", Frame.AMSL: "sea", Frame.TERRAIN: "ground"}


class OnBoard:
    """Worked out where something has changed; looked at ten times a second."""

    def __init__(self) -> None:
        self._mission_from: tuple[object, ...] = ()
        self._mission = ipc.MissionPath([])
        self._fence_from: tuple[object, ...] = ()
        self._fence = ipc.VehicleFence([])

    def news(self, vehicle: Vehicle) -> list[ipc.Event]:
        """What is another than before."""
        if vehicle.telemetry is None:
            return []
        missions, fence = vehicle.missions, vehicle.fence
        before = self.all
        facts = (missions.plan, missions.path_ned, missions.told and missions.unverified)
        if facts != self._mission_from:
            self._mission_from, self._mission = facts, mission_on_board(missions)
        about = (fence.items, vehicle.telemetry.origin, vehicle.telemetry.home_ned)
        if fence.items is not None and about != self._fence_from:
            self._fence_from, self._fence = about, fence_on_board(fence, vehicle.telemetry)
        return [each for each in self.all if each not in before]

    @property
    def all(self) -> tuple[ipc.MissionPath, ipc.VehicleFence]:
        """Also where there is none."""
        return (self._mission, self._fence)

    def told(self) -> list[ipc.Event]:
        """For one that has just joined."""
        nothing = (ipc.MissionPath([]), ipc.VehicleFence([]))
        return [each for each in self.all if each not in nothing]


def mission_on_board(missions: Missions) -> ipc.MissionPath:
    """As it was verified, and what is wrong with what is on board."""
    path_ned, plan = missions.path_ned, missions.plan
    every = 1 + len(path_ned) // PATH_POINTS
    kept = [*path_ned[::every], *path_ned[-1:]] if every > 1 else path_ned
    items = []
    if plan is not None:
        first = len(plan.sent) - len(plan.plan.items)  # ArduPilot's item 0 is home
        items = [_item(seq, each) for seq, each in enumerate(plan.plan.items, first)]
    unverified = missions.unverified if missions.told else ""
    return ipc.MissionPath([enu_from_ned(point) for point in kept], items, unverified)


def _item(seq: int, item: Item) -> ipc.MissionItem:
    name = commands.name(item.command)
    if not isinstance(item.place, Geographic) or item.frame not in _DATUMS:
        return ipc.MissionItem(seq, name)
    return ipc.MissionItem(seq, name, round(item.place.alt_m, 2), _DATUMS[item.frame])


def fence_on_board(fence: FenceOnBoard, telemetry: Telemetry) -> ipc.VehicleFence:
    """Its zones in the local frame; none where they cannot be read or placed."""
    if telemetry.origin is None or not fence.items:
        return ipc.VehicleFence([])
    try:
        _, held, _ = split_fence(SOURCE, items_from_wire(fence.items, SOURCE))
    except PlanError:
        return ipc.VehicleFence([])
    projection = Projection(telemetry.origin, telemetry.autopilot.name)
    placed = build_zones(zone_specs(held), telemetry.home_ned, projection)
    return ipc.VehicleFence([] if isinstance(placed, Refusal) else announcements.shapes(placed))
