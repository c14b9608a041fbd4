"""Fence and rally items at places that are given in metres from home."""

from __future__ import annotations

from tests.unit.autopilot.flight import HOMES, Flight
from vehicle_sim.autopilot.fence.zones import Vec2
from vehicle_sim.autopilot.geo import projection
from vehicle_sim.autopilot.interface import PlanItem
from vehicle_sim.autopilot.modes import Personality


def point(
    personality: Personality, seq: int, command: int, ne: Vec2, p1: float = 0.0, up_m: float = 0.0
) -> PlanItem:
    """In MAV_FRAME_GLOBAL_RELATIVE_ALT_INT."""
    where = projection(personality, HOMES[personality]).to_geodetic((ne[0], ne[1], 0.0))
    x, y = round(where.lat_deg * 1e7), round(where.lon_deg * 1e7)
    return PlanItem(seq, 6, command, p1, 0.0, 0.0, 0.0, x, y, up_m, 1)


def box(personality: Personality, half_m: float, command: int = 5001) -> tuple[PlanItem, ...]:
    """A square about home."""
    corners = [(half_m, half_m), (half_m, -half_m), (-half_m, -half_m), (-half_m, half_m)]
    return tuple(
        point(personality, seq, command, corner, 4.0) for seq, corner in enumerate(corners)
    )


def fenced(flight: Flight, items: tuple[PlanItem, ...]) -> Flight:
    """With the fence uploaded, and on."""
    assert flight.vehicle.check_fence(items) is None
    flight.vehicle.load_fence(items)
    if flight.personality == "ardupilot":
        flight.vehicle.parameters.set("FENCE_ENABLE", 1)
    return flight


def said(flight: Flight, part: str) -> bool:
    return any(part in text for text in flight.texts())
