"""Small plan files for the session's tests, at the home of `wire`."""

from __future__ import annotations

import json

from tests.unit.plan import samples
from tests.unit.station.wire import HOME_DEG

LAT, LON = HOME_DEG


def plan(*items: object) -> bytes:
    """A .plan of these items, without fence."""
    return json.dumps(samples.plan_document(*items)).encode()  # type: ignore[arg-type]


BOX = json.dumps(samples.box()).encode()
"""Take off, two waypoints within 20 m, land."""
WEST = round(LON - 0.0005, 7)
GUARDED = json.dumps(
    samples.box()
    | {
        "geoFence": {
            "version": 2,
            "polygons": [
                {
                    "inclusion": True,
                    "version": 1,
                    "polygon": [
                        [LAT + 0.0005, LON + 0.0005],
                        [LAT + 0.0005, WEST],
                        [LAT - 0.0005, WEST],
                        [LAT - 0.0005, LON + 0.0005],
                    ],
                }
            ],
            "circles": [
                {
                    "inclusion": False,
                    "version": 1,
                    "circle": {"center": [LAT - 0.0003, LON], "radius": 5.0},
                }
            ],
        },
        "rallyPoints": {
            "version": 2,
            "points": [[LAT + 0.0001, LON, 5.0], [LAT, LON + 0.0002, 8.0]],
        },
    }
).encode()
"""`BOX`, a yard to stay in, a mast to stay out of, and two rally points."""
FAR = plan(samples.waypoint(1, LAT, LON, 10, command=22), samples.waypoint(2, LAT + 0.01, LON, 10))
"""1.1 km north: outside of the default fence."""
