"""`gcs log layout`: what a Foxglove viewer should show, in the classic `configById` format.

A layout cannot travel inside an MCAP, and without one a viewer shows next to nothing.  The
template `layout.json` beside this file has what each kind of panel is configured with, and for
each purpose the panels and how they share the window.  Here it is filled in:

    a panel         name, title, and the path of a value, or lines of [path, label]; a third word
                    `points` = not joined, for what comes in stretches: a line would run across gaps
    {first} {each}  topics of the first vehicle; the same line again for every vehicle
    a|b             b in a record that has no topic a
    $name           a value, of the path, the lines, `panel_scene.py`, or beside the title

A panel is made only where the record has what it shows, so no panel comes up with an alert.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable, Mapping, Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any, Literal, TypeAlias

from gcs.mcap_file.reader import Progress
from gcs.record.viewer.extent import Extent, survey
from gcs.record.viewer.panel_scene import Body, scene, street_map

Purpose: TypeAlias = Literal["one", "fleet", "lab", "live"]
PURPOSES: tuple[Purpose, ...] = ("one", "fleet", "lab")
"""Of records; `live` is filled in by `live_layout.py`."""

_LEAVES = (
    *("tf", "model", "path", "setpoint", "target", "stop", "leg", "odometry"),
    *("location", "state", "fsa", "phase"),
)
_COMMON = (
    *("/tf_static", "/origin", "/geofence", "/geofence/geojson", "/mission"),
    *("/gate/decision", "/gate/requests", "/gate/goals", "/gate/fence"),
    *("/log", "/events", "/session/input"),
)


def any_flight(vehicles: int = 1) -> frozenset[str]:
    """Topics of an ordinary flight of vehicles 1, 2, ..., for a layout made before the flight."""
    return any_flight_of(range(1, vehicles + 1))


def any_flight_of(numbers: Iterable[int]) -> frozenset[str]:
    """The same of the vehicles with these numbers."""
    return frozenset(
        [*_COMMON, *(f"/vehicle/{number}/{leaf}" for number in numbers for leaf in _LEAVES)]
    )


ANY_FLIGHT = any_flight()
_ANY_FLEET = 3
_CAGE = Extent((-5.0, -5.0, 0.0), (5.0, 5.0, 2.0))
"""The lab's (`gcs/gate/policy/lab.toml`)."""


def layout_for(
    path: Path | None, purpose: Purpose = "one", progress: Progress | None = None
) -> dict[str, Any]:
    """The layout for a record, fitted to it; without one, for any flight.

    Raises BadRecordError and OSError.
    """
    if path is None:
        return layout(any_flight(_ANY_FLEET if purpose == "fleet" else 1), purpose)
    found = survey(path, progress)
    return layout(found.topics, purpose, found.extent, found.suffixed)


def layout(
    topics: Collection[str],
    purpose: Purpose = "one",
    extent: Extent | None = None,
    suffixed: Collection[int] = (),
) -> dict[str, Any]:
    """The layout for a record with these topics, ready for `json.dumps`.

    `extent` is what the camera, the grid and the map fit; without it the camera follows.
    `suffixed` are the vehicles whose frames carry their number; without it all but the first.
    """
    template = _template()
    kept: Purpose | Literal["imported"] = purpose
    if purpose == "one" and "/gate/decision" not in topics:
        kept = "imported"  # another program's log, in which nothing was decided
    numbers = _vehicles(topics)
    suffixed = suffixed or numbers[1:]
    bodies = [Body(n, f"base_link_{n}" if n in suffixed else "base_link") for n in numbers]
    if purpose not in ("fleet", "live"):
        del bodies[1:]
    if purpose == "lab":
        extent = _CAGE
    filler = _Filler(frozenset(topics), bodies, extent)
    panels: dict[str, Any] = {}
    for name, title, *shown in template[kept]["panels"]:
        kind = name.split("!")[0]
        values = filler.values(kind, shown)
        if values is not None:
            config = _filled(template["kinds"][kind], values)
            more = values.get("more", {})
            both = {"foxglovePanelTitle": title, "lichtblickPanelTitle": title}
            panels[name] = {**config, **more, **both}
    return {
        "configById": panels,
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 1},
        "layout": _tree(template[kept]["tree"], panels) or "",
    }


@cache
def _template() -> dict[str, Any]:
    text = (files("gcs.record.viewer") / "layout.json").read_text(encoding="utf-8")
    made: dict[str, Any] = json.loads(text)
    return made


class _Filler:
    """What one record puts into the template."""

    def __init__(
        self, topics: Collection[str], bodies: Sequence[Body], extent: Extent | None
    ) -> None:
        self._topics = topics
        self._bodies = bodies
        self._extent = extent

    def values(self, kind: str, shown: list[Any]) -> dict[str, Any] | None:
        """By their names in the template; None where the record has nothing of it."""
        if kind == "3D":
            return scene(self._bodies, self._topics, self._extent, shown[0])
        if kind == "map":
            return street_map(self._bodies, self._topics, self._extent)
        if isinstance(shown[0], dict):  # a panel that shows nothing of the record
            return shown[0]
        if isinstance(shown[0], str):
            path = self._path(shown[0], self._bodies[0])
            return {"path": path} if self._has(path) else None
        bars, lines = [], []
        for one, label, *points in shown:
            for body in self._bodies if "{each}" in one else self._bodies[:1]:
                path = self._path(one, body)
                if self._has(path):
                    named = label.replace("{n}", str(body.sysid))
                    bar = {"value": path, "label": named, "enabled": True}
                    bar["timestampMethod"] = "receiveTime"
                    bars.append(bar)
                    lines.append({**bar, "showLine": not points})
        return {"bars": bars, "lines": lines} if bars else None

    def _path(self, paths: str, body: Body) -> str:
        """The first of them whose topic is there, or else the last."""
        base = f"/vehicle/{body.sysid}"
        choice = paths.replace("{first}", base).replace("{each}", base).split("|")
        return next(filter(self._has, choice), choice[-1])

    def _has(self, path: str) -> bool:
        """Whether the topic of a message path (topic.field.field) is there."""
        return path.split(".")[0] in self._topics


def _filled(template: Any, values: Mapping[str, Any]) -> Any:
    match template:
        case dict():
            return {key: _filled(inner, values) for key, inner in template.items()}
        case list():
            return [_filled(inner, values) for inner in template]
        case str() if template.startswith("$"):
            return values[template[1:]]
        case _:
            return template


def _vehicles(topics: Collection[str]) -> list[int]:
    """The vehicles that are seen; those that were only expected where there is no other."""
    numbers: dict[int, set[str]] = {}
    for topic in topics:
        match topic.split("/"):
            case ["", "vehicle", number, leaf] if number.isdecimal():
                numbers.setdefault(int(number), set()).add(leaf)
    seen = [n for n, leaves in numbers.items() if leaves & {"tf", "state", "location", "path"}]
    return sorted(seen or numbers) or [1]


def _tree(pane: Any, panels: Collection[str]) -> Any:
    """Panes of `[direction, percent of the first, first, second]`, without those that are not
    there; without a percentage all are of the same size."""
    if isinstance(pane, str):
        return pane if pane in panels else None
    direction, *rest = pane
    percent = rest.pop(0) if isinstance(rest[0], int) else None
    there = [made for inner in rest if (made := _tree(inner, panels)) is not None]
    return _shared(direction, percent, there)


def _shared(direction: str, percent: int | None, there: list[Any]) -> Any:
    if len(there) < 2:
        return there[0] if there else None
    return {
        "direction": direction,
        "splitPercentage": round(100 / len(there)) if percent is None else percent,
        "first": there[0],
        "second": _shared(direction, percent, there[1:]),
    }
