"""Small plan files, made in memory."""

from __future__ import annotations

import json
from typing import Any

import pytest

from gcs.plan.errors import PlanError
from gcs.plan.formats.reader import read
from gcs.plan.model import AutopilotName, Plan

WHO: tuple[AutopilotName, ...] = ("px4", "ardupilot")
HOME = (47.397742, 8.545594, 488.0)


def simple(number: int, command: int, frame: int, params: list[float | None]) -> dict[str, Any]:
    return {
        "type": "SimpleItem",
        "doJumpId": number,
        "command": command,
        "frame": frame,
        "params": params,
        "autoContinue": True,
    }


def waypoint(number: int, lat: float, lon: float, alt: float, command: int = 16) -> dict[str, Any]:
    return simple(number, command, 3, [0, 0, 0, None, lat, lon, alt])


def plan_document(*items: dict[str, Any]) -> dict[str, Any]:
    return {
        "fileType": "Plan",
        "version": 1,
        "groundStation": "a test",
        "mission": {
            "version": 2,
            "firmwareType": 12,
            "vehicleType": 2,
            "cruiseSpeed": 15,
            "hoverSpeed": 5,
            "plannedHomePosition": list(HOME),
            "items": list(items),
        },
        "geoFence": {"version": 2, "polygons": [], "circles": []},
        "rallyPoints": {"version": 2, "points": []},
    }


def box() -> dict[str, Any]:
    """Take off, two waypoints, land."""
    return plan_document(
        waypoint(1, 47.3977420, 8.5455940, 10, command=22),
        waypoint(2, 47.3978420, 8.5455940, 10),
        waypoint(3, 47.3978420, 8.5457940, 12),
        waypoint(4, 47.3977420, 8.5455940, 0, command=21),
    )


def survey() -> dict[str, Any]:
    """Take off, a survey of two flattened waypoints, return."""
    return plan_document(
        waypoint(1, 47.3977420, 8.5455940, 10, command=22),
        {
            "type": "ComplexItem",
            "complexItemType": "survey",
            "version": 5,
            "polygon": [[47.3978, 8.5456], [47.3979, 8.5456], [47.3979, 8.5457]],
            "TransectStyleComplexItem": {
                "version": 1,
                "Items": [waypoint(2, 47.3978, 8.5456, 20), waypoint(3, 47.3979, 8.5457, 20)],
            },
        },
        simple(4, 20, 2, [0, 0, 0, 0, 0, 0, 0]),
    )


def read_json(document: object, autopilot: AutopilotName | None = None) -> Plan:
    return read("a.plan", json.dumps(document).encode(), autopilot)


def read_text(text: str, autopilot: AutopilotName | None = None, name: str = "a.txt") -> Plan:
    return read(name, text.encode(), autopilot)


def refused(document: object) -> PlanError:
    """The error that a .plan document is refused with."""
    with pytest.raises(PlanError) as caught:
        read_json(document)
    return caught.value


def wpl(*rows: str) -> str:
    """Rows with blanks for tabs."""
    return "QGC WPL 110\n" + "".join("\t".join(row.split()) + "\n" for row in rows)


LOCAL = """\
schema = 1
name = "test"
frame = "home"
speed_m_s = 2.0

[[waypoint]]
north_m = 1.0
east_m = 2.0
up_m = 1.5
hold_s = 1.0
picture = true

[[waypoint]]
north_m = -1.0
east_m = 0.0
up_m = 1.0

[fence]
north_m = [-5, 5]
east_m = [-5, 5]
up_m = [0, 2]

[[fence.exclude]]
radius_m = 1.0
north_m = 3.0
east_m = 3.0
"""
