"""The panels of a Foxglove layout, each made only where the record has what it shows.

Every panel has its title twice: Foxglove reads `foxglovePanelTitle`, Lichtblick
`lichtblickPanelTitle`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Literal

from gcs.record.viewer.extent import Extent
from gcs.record.viewer.panel_config import Config, Json
from gcs.record.viewer.panel_scene import Body, scene, street_map

LEVEL_INFO = 2

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


@dataclass(frozen=True, slots=True)
class Line:
    """A line of a plot: the path of its values, its name, and whether its points are joined.

    Points that are not joined are for what comes in stretches: a line would run across the gaps.
    """

    path: str
    label: str
    joined: bool = True


@dataclass(slots=True)
class Panels:
    """Panels made so far; each method answers the panel's id, or None where there is no data."""

    topics: Collection[str]
    configs: dict[str, Json] = field(default_factory=dict)

    def add(self, name: str, title: str, config: Config) -> str:
        self.configs[name] = {
            **config,
            "foxglovePanelTitle": title,
            "lichtblickPanelTitle": title,
        }
        return name

    def has(self, path: str) -> bool:
        """Whether the topic of a message path (topic.field.field) is there."""
        return path.split(".")[0] in self.topics

    def scene(
        self,
        name: str,
        title: str,
        bodies: Sequence[Body],
        extent: Extent | None,
        camera: Literal["fit", "follow", "chase"],
    ) -> str | None:
        config = scene(bodies, self.topics, extent, camera)
        return None if config is None else self.add(name, title, config)

    def map(self, bodies: Sequence[Body], extent: Extent | None) -> str | None:
        found = [body for body in bodies if f"/vehicle/{body.sysid}/location" in self.topics]
        return (
            self.add("map!main", "Map", street_map(found, self.topics, extent)) if found else None
        )

    def plot(self, name: str, title: str, lines: Iterable[Line]) -> str | None:
        paths: list[Json] = [
            {
                "value": line.path,
                "label": line.label,
                "enabled": True,
                "timestampMethod": "receiveTime",
                "showLine": line.joined,
            }
            for line in lines
            if self.has(line.path)
        ]
        if not paths:
            return None
        config: Config = {
            "paths": paths,
            "showXAxisLabels": True,
            "showYAxisLabels": True,
            "showLegend": True,
            "legendDisplay": "floating",
            "showPlotValuesInLegend": True,
            "isSynced": True,
            "xAxisVal": "timestamp",
            "sidebarDimension": 240,
        }
        return self.add(name, title, config)

    def states(self, name: str, title: str, bars: Iterable[tuple[str, str]]) -> str | None:
        paths: list[Json] = [
            {"value": path, "label": label, "enabled": True, "timestampMethod": "receiveTime"}
            for path, label in bars
            if self.has(path)
        ]
        return self.add(name, title, {"isSynced": True, "paths": paths}) if paths else None

    def indicator(self, path: str) -> str | None:
        if not self.has(path):
            return None
        rules: list[Json] = [
            {"operator": "=", "rawValue": state, "color": color, "label": state}
            for state, color in _STATE_COLORS.items()
        ]
        config: Config = {
            "path": path,
            "style": "background",
            "fallbackColor": "#3b82f6",
            "fallbackLabel": "?",
            "rules": rules,
        }
        return self.add("Indicator!fsa", "State", config)

    def gauge(self, path: str) -> str | None:
        if not self.has(path):
            return None
        config: Config = {
            "path": path,
            "minValue": 0,
            "maxValue": 100,
            "colorMap": "red-yellow-green",
            "colorMode": "colormap",
            "gradient": ["#0000ff", "#ff00ff"],
            "reverse": False,
        }
        return self.add("Gauge!battery", "Battery [%]", config)

    def messages(self, name: str, title: str, path: str) -> str | None:
        """A topic's last message, or one value of it as a number."""
        if not self.has(path):
            return None
        config: Config = {
            "diffEnabled": False,
            "diffMethod": "custom",
            "diffTopicPath": "",
            "showFullMessageForDiff": False,
            "topicPath": path,
        }
        return self.add(name, title, config)

    def table(self, name: str, title: str, path: str) -> str | None:
        """A list of objects, a row each."""
        return self.add(name, title, {"topicPath": path}) if self.has(path) else None

    def log(self) -> str | None:
        if "/log" not in self.topics:
            return None
        config: Config = {"searchTerms": [], "minLogLevel": LEVEL_INFO, "topicToRender": "/log"}
        return self.add("RosOut!log", "Log", config)
