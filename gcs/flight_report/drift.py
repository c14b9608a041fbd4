"""How far the vehicle had drifted from where it was to be before something went wrong, the wind."""

from __future__ import annotations

from math import atan2, degrees, hypot

from gcs.flight_report.findings.finding import Finding
from gcs.flight_report.flight import VehicleFlight
from gcs.flight_report.series import Series

BEFORE_S = 10.0
LEAST_M = 1.0
"""Less is how positions wander."""
CALM_M_S = 1.0
_WINDS = ("north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west")


def drift_before(vehicle: VehicleFlight, trouble: Finding) -> str:
    """One sentence; empty where it stayed in its place, or where nothing is known of it."""
    sampled = vehicle.plots.sampled
    error = _error(sampled["place"].series, trouble.t_s)
    if error is None or hypot(*error) < LEAST_M:
        return ""
    away_m, way_deg = hypot(*error), degrees(atan2(*error))
    words = (
        f"In the {BEFORE_S:g} s before it drifted {away_m:.1f} m to the {direction(way_deg)} "
        "of where it was to be"
    )
    blows = [
        (speed, come_from)
        for t_s, (speed, come_from) in sampled["wind"].series.rows()
        if t_s <= trouble.t_s + 1.0 and speed is not None and come_from is not None
    ]
    if blows and blows[-1][0] >= CALM_M_S:
        words += f", in a wind of {blows[-1][0]:.0f} m/s from the {direction(blows[-1][1])}"
    return f"{words}."


def direction(degrees_from_north: float) -> str:
    """ "north-east"."""
    return _WINDS[round(degrees_from_north / 45.0) % 8]


def _error(place: Series, t_s: float) -> tuple[float, float] | None:
    """East and north of where it was to be, at `t_s`; None where it was still on its way there."""
    error: tuple[float, float] | None = None
    goal: tuple[float, float] | None = None
    arrived = False
    for at_s, (east, north, _, goal_east, goal_north, _) in place.rows():
        if not t_s - BEFORE_S <= at_s <= t_s or east is None or north is None:
            continue
        if goal_east is None or goal_north is None:
            continue
        if goal is None or hypot(goal_east - goal[0], goal_north - goal[1]) > LEAST_M / 2:
            goal, arrived = (goal_east, goal_north), False
        error = east - goal_east, north - goal_north
        arrived |= hypot(*error) < LEAST_M
    return error if arrived else None
