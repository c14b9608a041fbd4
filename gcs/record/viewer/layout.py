"""`gcs log layout`: what a Foxglove viewer should show, in the classic `configById` format.

A layout cannot travel inside an MCAP, and without one a viewer shows next to nothing.  A panel is
made only where the record has what it shows, so no panel comes up with an alert.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Literal, TypeAlias

from gcs.mcap_file.reader import Progress
from gcs.record.viewer.extent import Extent, survey
from gcs.record.viewer.panel_config import Config, Json
from gcs.record.viewer.panel_scene import Body
from gcs.record.viewer.panels import Line, Panels

Purpose: TypeAlias = Literal["one", "fleet", "lab"]
PURPOSES: tuple[Purpose, ...] = ("one", "fleet", "lab")

_LEAVES = (
    *("tf", "model", "path", "setpoint", "target", "stop", "odometry"),
    *("location", "state", "fsa", "phase"),
)
_COMMON = (
    *("/tf_static", "/origin", "/geofence", "/geofence/geojson", "/mission"),
    *("/gate/decision", "/gate/requests", "/gate/goals", "/gate/fence"),
    *("/log", "/events", "/session/input"),
)


def any_flight(vehicles: int = 1) -> frozenset[str]:
    """Topics of an ordinary flight of vehicles 1, 2, ..., for a layout made before the flight."""
    numbers = range(1, vehicles + 1)
    return frozenset(
        [*_COMMON, *(f"/vehicle/{number}/{leaf}" for number in numbers for leaf in _LEAVES)]
    )


ANY_FLIGHT = any_flight()
_ANY_FLEET = 3
_CAGE = Extent((-5.0, -5.0, 0.0), (5.0, 5.0, 2.0))
"""The lab's (`gcs/gate/policy/lab.toml`)."""


def layout_for(
    path: Path | None,
    purpose: Purpose = "one",
    progress: Progress | None = None,
) -> Config:
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
) -> Config:
    """The layout for a record with these topics, ready for `json.dumps`.

    `extent` is what the camera, the grid and the map fit; without it the camera follows.
    `suffixed` are the vehicles whose frames carry their number; without it all but the first.
    """
    panels = Panels(frozenset(topics))
    numbers = _vehicles(topics)
    suffixed = suffixed or numbers[1:]
    bodies = [Body(n, f"base_link_{n}" if n in suffixed else "base_link") for n in numbers]
    match purpose:
        case "one":
            tree = _one(panels, bodies[:1], extent)
        case "fleet":
            tree = _fleet(panels, bodies, extent)
        case "lab":
            tree = _lab(panels, bodies[:1])
    return {
        "configById": panels.configs,
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 1},
        "layout": tree or "",
    }


def _one(panels: Panels, bodies: Sequence[Body], extent: Extent | None) -> Json:
    base = f"/vehicle/{bodies[0].sysid}"
    flight = panels.scene(
        "3D!main", "Flight", bodies, extent, "follow" if extent is None else "fit"
    )
    chase = panels.scene("3D!chase", "Chase", bodies, extent, "chase")
    left = _split("column", 64, flight, _split("row", 50, chase, panels.map(bodies, extent)))
    plots = _column(
        panels.plot("Plot!height", "Height above the local origin [m]", _heights(base)),
        panels.plot("Plot!speed", "Speed [m/s]", _speeds(base)),
        panels.plot("Plot!attitude", "Attitude [deg]", _angles(base)),
    )
    battery = panels.plot(
        "Plot!battery",
        "Battery",
        [Line(f"{base}/state.battery_pct", "left [%]"), Line(f"{base}/state.battery_v", "volts")],
    )
    now = _column(
        panels.indicator(_gate_path(panels, base, "state")), _gauge(panels, base), battery
    )
    last = panels.messages("RawMessages!decision", "Last decision", "/gate/decision")
    beside = _column(_conditions(panels, base), last)
    words = _column(_requests(panels), _split("row", 60, panels.log(), beside))
    right = _split("column", 52, _split("row", 36, now, plots), words)
    return _split("column", 80, _split("row", 58, left, right), _states(panels, bodies))


def _fleet(panels: Panels, bodies: Sequence[Body], extent: Extent | None) -> Json:
    flight = panels.scene(
        "3D!main", "Flight", bodies, extent, "follow" if extent is None else "fit"
    )
    left = _split("column", 68, flight, panels.map(bodies, extent))
    plots = _column(
        panels.plot(
            "Plot!height",
            "Height above each local origin [m]",
            [Line(f"/vehicle/{b.sysid}/state.up_m", f"vehicle {b.sysid}") for b in bodies],
        ),
        panels.plot(
            "Plot!speed",
            "Ground speed [m/s]",
            [
                Line(f"/vehicle/{b.sysid}/state.groundspeed_mps", f"vehicle {b.sysid}")
                for b in bodies
            ],
        ),
        panels.plot(
            "Plot!battery",
            "Battery [%]",
            [Line(f"/vehicle/{b.sysid}/state.battery_pct", f"vehicle {b.sysid}") for b in bodies],
        ),
    )
    right = _split("column", 55, plots, _column(_requests(panels), panels.log()))
    states = panels.states(
        "StateTransitions!phase",
        "States",
        [(f"/vehicle/{b.sysid}/phase.state", f"vehicle {b.sysid}") for b in bodies],
    )
    return _split("column", 78, _split("row", 60, left, right), states)


def _lab(panels: Panels, bodies: Sequence[Body]) -> Json:
    """The cage of 10 x 10 x 2 m, and where the vehicle is in it beside where it was sent."""
    base = f"/vehicle/{bodies[0].sysid}"
    cage = panels.scene("3D!main", "Cage", bodies, _CAGE, "fit")
    axes = [("east", "x"), ("north", "y"), ("up", "z")]
    plots = _column(
        *(
            panels.plot(
                f"Plot!{name}",
                f"{name.capitalize()} [m]",
                [
                    Line(f"{base}/state.{name}_m", "is"),
                    Line(f"{base}/setpoint.pose.position.{axis}", "setpoint", joined=False),
                ],
            )
            for name, axis in axes
        )
    )
    words = _column(
        panels.indicator(_gate_path(panels, base, "state")), _requests(panels), panels.log()
    )
    right = _split("row", 50, plots, words)
    return _split("column", 80, _split("row", 50, cage, right), _states(panels, bodies))


def _heights(base: str) -> list[Line]:
    setpoint = Line(f"{base}/setpoint.pose.position.z", "setpoint", joined=False)
    return [Line(f"{base}/state.up_m", "up"), setpoint]


def _speeds(base: str) -> list[Line]:
    return [
        Line(f"{base}/state.groundspeed_mps", "ground"),
        Line(f"{base}/state.climb_mps", "climb"),
    ]


def _angles(base: str) -> list[Line]:
    return [Line(f"{base}/state.{name}_deg", name) for name in ("roll", "pitch", "yaw")]


def _gauge(panels: Panels, base: str) -> Json:
    """A gauge has no number of its own."""
    number = panels.messages("RawMessages!battery", "Battery [%]", f"{base}/state.battery_pct")
    return _split("row", 60, panels.gauge(f"{base}/state.battery_pct"), number)


def _requests(panels: Panels) -> Json:
    return panels.table("Table!requests", "Requests", "/gate/requests.rows")


def _conditions(panels: Panels, base: str) -> Json:
    return panels.table("Table!conditions", "What is wrong", f"{base}/fsa.conditions")


def _states(panels: Panels, bodies: Sequence[Body]) -> Json:
    base = f"/vehicle/{bodies[0].sysid}"
    mode = f"{base}/phase.mode" if panels.has(f"{base}/phase") else f"{base}/state.mode"
    rows = [
        (_gate_path(panels, base, "state"), "gate"),
        (mode, "flight mode"),
        (_gate_path(panels, base, "severity"), "severity"),
    ]
    return panels.states("StateTransitions!phase", "States", rows)


def _gate_path(panels: Panels, base: str, name: str) -> str:
    """As it stood for a while; in a record of before there was such a topic, as it was."""
    leaf = "phase" if panels.has(f"{base}/phase") else "fsa"
    return f"{base}/{leaf}.{name}"


def _vehicles(topics: Collection[str]) -> list[int]:
    """The vehicles that are seen; those that were only expected where there is no other."""
    numbers: dict[int, set[str]] = {}
    for topic in topics:
        match topic.split("/"):
            case ["", "vehicle", number, leaf] if number.isdecimal():
                numbers.setdefault(int(number), set()).add(leaf)
    seen = [n for n, leaves in numbers.items() if leaves & {"tf", "state", "location", "path"}]
    return sorted(seen or numbers) or [1]


def _column(*panes: Json) -> Json:
    """One above the other, of the same height."""
    there = [pane for pane in panes if pane is not None]
    if len(there) < 2:
        return there[0] if there else None
    return _split("column", round(100 / len(there)), there[0], _column(*there[1:]))


def _split(direction: str, percent: int, first: Json, second: Json) -> Json:
    """Two panes, or the one that there is."""
    if first is None or second is None:
        return first if second is None else second
    return {
        "direction": direction,
        "splitPercentage": percent,
        "first": first,
        "second": second,
    }
