"""Plan -> a file of a format: the one that is named, or that the file's suffix asks for."""

from __future__ import annotations

from typing import Final, Literal, TypeAlias, assert_never

from gcs.plan.errors import PlanError
from gcs.plan.formats.csv_writer import write_csv
from gcs.plan.formats.gpx_writer import write_gpx
from gcs.plan.formats.kml_writer import write_kml
from gcs.plan.formats.local_toml_writer import write_local
from gcs.plan.formats.losses import Written
from gcs.plan.formats.qgc_plan_writer import write_plan
from gcs.plan.formats.wpl_writer import write_wpl
from gcs.plan.model import AutopilotName, Plan

Format: TypeAlias = Literal["plan", "wpl", "toml", "csv", "kml", "gpx"]
FORMATS: Final[dict[Format, tuple[str, ...]]] = {
    "plan": (".plan",),
    "wpl": (".waypoints", ".txt", ".wpl"),
    "toml": (".toml",),
    "csv": (".csv",),
    "kml": (".kml",),
    "gpx": (".gpx",),
}
"""The suffixes of each."""
SUFFIXES: Final = (".plan", ".waypoints", ".txt", ".csv")
"""Of the formats that keep all of a mission on board."""


def format_of(path_text: str) -> Format:
    """By the suffix.  Raises PlanError."""
    for name, suffixes in FORMATS.items():
        if path_text.lower().endswith(suffixes):
            return name
    what = "the suffix names no format that can be written"
    known = ", ".join(suffix for suffixes in FORMATS.values() for suffix in suffixes)
    raise PlanError(path_text, "", "file", what, f"one of {known}")


def write(
    path_text: str, plan: Plan, autopilot: AutopilotName, kind: Format | None = None
) -> Written:
    """Raises PlanError where the format cannot hold the plan at all."""
    kind = kind or format_of(path_text)
    match kind:
        case "plan":
            return write_plan(plan)
        case "wpl":
            return write_wpl(plan, autopilot)
        case "toml":
            return write_local(plan)
        case "csv":
            return write_csv(plan)
        case "kml":
            return write_kml(plan)
        case "gpx":
            return write_gpx(plan)
        case _:
            assert_never(kind)
