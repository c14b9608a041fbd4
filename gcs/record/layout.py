"""`gcs log layout`: what a Foxglove viewer should show, in the classic `configById` format.

A layout cannot travel inside an MCAP, and without one a viewer shows next to nothing.  A panel is
made only where the record has what it shows, so no panel comes up with an alert.
"""

from __future__ import annotations

from collections.abc import Collection

from gcs.record.panels import Config, Json, Panels

ANY_FLIGHT = frozenset(
    {
        "/tf_static",
        "/geofence",
        "/geofence/geojson",
        "/mission",
        "/gate/decision",
        "/log",
        "/session/input",
        *(
            f"/vehicle/1/{leaf}"
            for leaf in ("tf", "model", "path", "setpoint", "location", "state", "fsa")
        ),
        "/mavlink/1/1/HEARTBEAT",
        "/mavlink/1/1/EXTENDED_SYS_STATE",
    }
)
"""Topics of an ordinary flight of vehicle 1, for a layout that is made before the flight."""


def layout(topics: Collection[str]) -> Config:
    """The layout for a record with these topics, ready for `json.dumps`."""
    panels = Panels(frozenset(topics))
    vehicle = _vehicle(topics)
    base, raw = f"/vehicle/{vehicle}", f"/mavlink/{vehicle}/1"
    overview = panels.scene("3D!main", "Flight", vehicle, follow=False)
    chase = panels.scene("3D!chase", "Chase", vehicle, follow=True)
    states = panels.states(
        "StateTransitions!fsa",
        "States",
        [
            (f"{base}/fsa.state", "gate"),
            (f"{base}/fsa.control", "control"),
            (f"{base}/fsa.severity", "severity"),
            ("/gate/decision.outcome", "decision"),
            (f"{base}/state.mode", "mode"),
            (f"{raw}/EXTENDED_SYS_STATE.landed_state", "landed"),
        ],
    )
    height = panels.plot(
        "Plot!height",
        "Height above the local origin",
        [
            (f"{base}/state.up_m", "up [m]"),
            (f"{base}/setpoint.pose.position.z", "setpoint up [m]"),
        ],
    )
    speed = panels.plot(
        "Plot!speed",
        "Speed",
        [
            (f"{base}/state.groundspeed_mps", "ground [m/s]"),
            (f"{base}/state.climb_mps", "climb [m/s]"),
        ],
    )
    left = _split(
        "column",
        66,
        _split("row", 66, overview, _split("column", 55, panels.map(vehicle), chase)),
        _split(
            "row",
            80,
            states,
            _split(
                "column",
                50,
                panels.indicator(f"{base}/fsa.state"),
                panels.gauge(f"{base}/state.battery_pct"),
            ),
        ),
    )
    right = _split(
        "column",
        55,
        _split("column", 50, height, speed),
        _split(
            "row",
            55,
            panels.log(),
            panels.messages("RawMessages!decision", "Last decision", "/gate/decision")
            or panels.messages("RawMessages!heartbeat", "Heartbeat", f"{raw}/HEARTBEAT"),
        ),
    )
    return {
        "configById": panels.configs,
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 1},
        "layout": _split("row", 58, left, right) or "",
    }


def _vehicle(topics: Collection[str]) -> int:
    """The lowest vehicle number among the topics, 1 if there is none."""
    numbers = [t.split("/")[2] for t in topics if t.startswith("/vehicle/")]
    return min((int(number) for number in numbers if number.isdecimal()), default=1)


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
