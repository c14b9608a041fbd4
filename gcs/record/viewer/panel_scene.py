"""What the 3D and the map panel show: camera, grid, and how each topic is drawn.

The values are those that `layout.json` names.  What it publishes there is for a live view, where a
click in the panel is a goal (`gcs/live/clicked_goals.py`).
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from math import cos, floor, log2, log10, radians
from typing import Any, Literal

from gcs.record.viewer.extent import Extent

FOLLOW_DISTANCE_M = 30.0
CHASE_DISTANCE_M = 14.0
DISTANCE_PER_RADIUS = 2.6
"""With an opening of 45 degrees a ball of radius 1 fills the height of the view."""
AXIS_PER_RADIUS = 0.1
"""Where the camera stays a vehicle is a speck: its axes show where it is."""
ANY_ZOOM = 18
PANEL_PIXELS = 300.0
EQUATOR_M_PER_PIXEL = 156_543.034
"""Of a web map at zoom 0 (tiles of 256 pixels)."""

_GRADIENTS = (
    ("#38bdf8ff", "#e0f2feff"),
    ("#d946efff", "#f5d0feff"),
    ("#fb923cff", "#fed7aaff"),
    ("#a3e635ff", "#ecfccbff"),
)
"""No green, red and yellow, which are fence, no-fly zones and mission."""
_COLORS = ("#0ea5e9", "#d946ef", "#f97316", "#65a30d")


@dataclass(frozen=True, slots=True)
class Body:
    """A vehicle as the 3D panel knows it: its number and the frame x forward, z up."""

    sysid: int
    frame: str

    @property
    def frd(self) -> str:
        """The frame x forward, z down."""
        return self.frame.replace("base_link", "base_link_frd")


def scene(
    bodies: Sequence[Body],
    topics: Collection[str],
    extent: Extent | None,
    camera: Literal["fit", "chase"],
) -> dict[str, Any] | None:
    """None where the record has nothing to draw.

    fit: on `extent`, and follow where there is none; follow, chase: the camera goes with the first
    vehicle and keeps its direction (`follow-pose` would roll the horizon, and only Foxglove has
    `follow-heading`).
    """
    fits = camera == "fit" and extent is not None
    width_m = min(1.0, max(0.04, 0.006 * extent.radius_m)) if fits and extent else 0.06
    drawn = {
        topic: {"visible": True, **settings}
        for topic, settings in _topics(bodies, width_m).items()
        if topic in topics
    }
    if not drawn:
        return None
    frames = {"frame:local_ned": {"visible": False}, "frame:map": {"visible": True}}
    for body in bodies:
        for hidden in (body.frd, f"map_{body.sysid}", f"local_ned_{body.sysid}"):
            frames[f"frame:{hidden}"] = {"visible": False}
        frames[f"frame:{body.frame}"] = {"visible": camera == "fit"}
    centre, distance_m = (0.0, 0.0, 0.0), FOLLOW_DISTANCE_M
    if camera == "chase":
        distance_m = CHASE_DISTANCE_M
    elif extent is not None:
        centre, distance_m = extent.centre_enu, DISTANCE_PER_RADIUS * extent.radius_m
    return {
        "distance": round(distance_m, 1),
        "phi": 65 if camera == "chase" else 58,
        "centre": [round(metres, 2) for metres in centre],
        "far": max(5000, round(20 * distance_m)),
        "follow_mode": "follow-none" if fits else "follow-position",
        "follow_frame": "map" if fits else bodies[0].frame,
        "axis": round(max(1.0, AXIS_PER_RADIUS * extent.radius_m), 1) if fits and extent else 1,
        "frames": frames,
        "drawn": drawn,
        **_grid(extent),
    }


def _topics(bodies: Sequence[Body], line_width_m: float) -> dict[str, dict[str, Any]]:
    shown: dict[str, dict[str, Any]] = {"/geofence": {}, "/mission": {}, "/gate/goals": {}}
    for number, body in enumerate(bodies):
        base = f"/vehicle/{body.sysid}"
        gradient = [*_GRADIENTS[number % len(_GRADIENTS)]]
        shown[f"{base}/model"] = {}
        shown[f"{base}/path"] = {"type": "line", "lineWidth": line_width_m, "gradient": gradient}
        shown[f"{base}/target"] = {}
        shown[f"{base}/stop"] = {}
        shown[f"{base}/leg"] = {}
        shown[f"{base}/setpoint"] = {"visible": False}
        shown[f"{base}/odometry"] = {"visible": False}
    return shown


def _grid(extent: Extent | None) -> dict[str, Any]:
    """The ground: cells of 1, 2, 5, 10, ... m, about twenty across the flight."""
    across_m = 40.0 if extent is None else 2 * extent.radius_m
    cell_m = cell_size(across_m / 20)
    divisions = round(1.5 * across_m / cell_m / 2) * 2
    east, north, _ = (0.0, 0.0, 0.0) if extent is None else extent.centre_enu
    return {
        "cell": f"Ground ({cell_m:g} m)",
        "size": divisions * cell_m,
        "divisions": divisions,
        "position": [round(east / cell_m) * cell_m, round(north / cell_m) * cell_m, 0],
    }


def cell_size(at_least_m: float) -> float:
    """The next of 1, 2, 5 times a power of ten."""
    power = 10.0 ** floor(log10(at_least_m))
    return next(
        step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= at_least_m * 0.999
    )


def street_map(
    bodies: Sequence[Body], topics: Collection[str], extent: Extent | None
) -> dict[str, Any] | None:
    """The map, fitted to the flight or following the first vehicle; None where none is known."""
    locations = [topic for body in bodies if (topic := f"/vehicle/{body.sysid}/location") in topics]
    if not locations:
        return None
    colors = {topic: _COLORS[number % len(_COLORS)] for number, topic in enumerate(locations)}
    if "/origin" in topics:
        colors["/origin"] = "#ffffff"
    values = {"follow_topic": locations[0], "colors": colors, "zoom": ANY_ZOOM}
    if extent is not None and (centre := extent.centre_deg) is not None:
        lat_deg, lon_deg = centre
        values |= {"follow_topic": "", "zoom": zoom(2 * extent.radius_m, lat_deg)}
        values["more"] = {"center": {"lat": round(lat_deg, 7), "lon": round(lon_deg, 7)}}
    return values


def zoom(across_m: float, lat_deg: float) -> int:
    """The zoom of a web map at which so many metres fit into the panel."""
    at_zero_m = EQUATOR_M_PER_PIXEL * cos(radians(lat_deg)) * PANEL_PIXELS
    return max(2, min(21, floor(log2(at_zero_m / across_m))))
