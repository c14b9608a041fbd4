"""The panels of a Foxglove layout, each made only where the record has what it shows."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, field
from typing import TypeAlias

Json: TypeAlias = "str | int | float | bool | list[Json] | dict[str, Json] | None"
Config: TypeAlias = dict[str, Json]

_BACKGROUND = "#1d2430"
_STATE_COLORS = {
    "HOVERING": "#22c55e",
    "MOVING": "#3b82f6",
    "VERIFYING": "#06b6d4",
    "STREAMING": "#6366f1",
    "TAKING_OFF": "#14b8a6",
    "TAKING_PICTURE": "#ec4899",
    "FLYING_MISSION": "#8b5cf6",
    "RETURNING": "#f97316",
    "LANDING": "#a855f7",
    "HOLDING": "#eab308",
    "STALE": "#ef4444",
    "NO_VEHICLE": "#6b7280",
    "GROUNDED": "#9ca3af",
    "EXTERNAL": "#f59e0b",
}


@dataclass(slots=True)
class Panels:
    """Panels made so far; each method answers the panel's id, or None where there is no data."""

    topics: Collection[str]
    configs: dict[str, Json] = field(default_factory=dict)

    def add(self, name: str, config: Config) -> str:
        self.configs[name] = config
        return name

    def has(self, path: str) -> bool:
        """Whether the topic of a message path (topic.field.field) is there."""
        return path.split(".")[0] in self.topics

    def scene(self, name: str, title: str, vehicle: int, follow: bool) -> str | None:
        base = f"/vehicle/{vehicle}"
        shown: dict[str, Config] = {
            f"{base}/model": {},
            f"{base}/path": {"type": "line", "lineWidth": 0.06},
            f"{base}/setpoint": {"type": "axis", "axisScale": 0.6},
            "/mission": {},
            "/geofence": {},
        }
        topics: Config = {
            topic: {"visible": True, **settings}
            for topic, settings in shown.items()
            if topic in self.topics
        }
        if not topics:
            return None
        camera: Config = {
            "distance": 8 if follow else 45,
            "perspective": True,
            "phi": 65 if follow else 55,
            "thetaOffset": 60 if follow else 30,
            "target": [0, 0, 0],
            "targetOffset": [0, 0, 0 if follow else 3],
            "targetOrientation": [0, 0, 0, 1],
            "fovy": 45,
            "near": 0.1,
            "far": 5000,
        }
        return self.add(
            name,
            {
                "cameraState": camera,
                "followMode": "follow-pose" if follow else "follow-none",
                "followTf": "base_link" if follow else "map",
                "scene": {
                    "backgroundColor": _BACKGROUND,
                    "transforms": {
                        "axisScale": 1,
                        "showLabel": False,
                        "lineWidth": 0,
                        "labelSize": 0.1,
                        "enablePreloading": True,
                        "maxPreloadMessages": 50000,
                    },
                },
                "transforms": {
                    "frame:local_ned": {"visible": False},
                    "frame:base_link_frd": {"visible": False},
                    "frame:map": {"visible": True},
                    "frame:base_link": {"visible": not follow},
                },
                "topics": topics,
                "layers": {"grid": _grid()},
                "foxglovePanelTitle": title,
            },
        )

    def map(self, vehicle: int) -> str | None:
        location = f"/vehicle/{vehicle}/location"
        if location not in self.topics:
            return None
        return self.add(
            "map!main",
            {
                "customTileUrl": "",
                "disabledTopics": [],
                "followTopic": location,
                "layer": "map",
                "topicColors": {location: "#22cc66"},
                "zoomLevel": 18,
                "maxNativeZoom": 18,
            },
        )

    def plot(self, name: str, title: str, lines: Iterable[tuple[str, str]]) -> str | None:
        paths = self._paths(lines)
        if not paths:
            return None
        return self.add(
            name,
            {
                "paths": paths,
                "showXAxisLabels": True,
                "showYAxisLabels": True,
                "showLegend": True,
                "legendDisplay": "left",
                "showPlotValuesInLegend": True,
                "isSynced": True,
                "xAxisVal": "timestamp",
                "sidebarDimension": 150,
                "foxglovePanelTitle": title,
            },
        )

    def states(self, name: str, title: str, bars: Iterable[tuple[str, str]]) -> str | None:
        paths = self._paths(bars)
        if not paths:
            return None
        return self.add(name, {"isSynced": True, "paths": paths, "foxglovePanelTitle": title})

    def indicator(self, path: str) -> str | None:
        if not self.has(path):
            return None
        rules: list[Json] = [
            {"operator": "=", "rawValue": state, "color": color, "label": state}
            for state, color in _STATE_COLORS.items()
        ]
        return self.add(
            "Indicator!fsa",
            {
                "path": path,
                "style": "background",
                "fallbackColor": "#3b82f6",
                "fallbackLabel": "?",
                "rules": rules,
            },
        )

    def gauge(self, path: str) -> str | None:
        if not self.has(path):
            return None
        return self.add(
            "Gauge!battery",
            {
                "path": path,
                "minValue": 0,
                "maxValue": 100,
                "colorMap": "red-yellow-green",
                "colorMode": "colormap",
                "gradient": ["#0000ff", "#ff00ff"],
                "reverse": False,
                "foxglovePanelTitle": "Battery [%]",
            },
        )

    def messages(self, name: str, title: str, topic: str) -> str | None:
        if topic not in self.topics:
            return None
        return self.add(
            name,
            {
                "diffEnabled": False,
                "diffMethod": "custom",
                "diffTopicPath": "",
                "showFullMessageForDiff": False,
                "topicPath": topic,
                "foxglovePanelTitle": title,
            },
        )

    def log(self) -> str | None:
        if "/log" not in self.topics:
            return None
        return self.add(
            "RosOut!log", {"searchTerms": [], "minLogLevel": 1, "topicToRender": "/log"}
        )

    def _paths(self, paths: Iterable[tuple[str, str]]) -> list[Json]:
        return [
            {
                "value": path,
                "label": label,
                "enabled": True,
                "timestampMethod": "receiveTime",
            }
            for path, label in paths
            if self.has(path)
        ]


def _grid() -> Config:
    return {
        "visible": True,
        "frameLocked": True,
        "label": "Ground (1 m)",
        "instanceId": "grid",
        "layerId": "foxglove.Grid",
        "frameId": "map",
        "size": 40,
        "divisions": 40,
        "lineWidth": 1,
        "color": "#3b82f650",
        "position": [0, 0, 0],
        "rotation": [0, 0, 0],
        "order": 1,
    }
