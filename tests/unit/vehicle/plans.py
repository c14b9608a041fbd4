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
FAR = plan(samples.waypoint(1, LAT, LON, 10, command=22), samples.waypoint(2, LAT + 0.01, LON, 10))
"""1.1 km north: outside of the default fence."""
