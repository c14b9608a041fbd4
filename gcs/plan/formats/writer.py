"""Plan -> the format that a file's suffix asks for."""

from __future__ import annotations

from gcs.plan.errors import PlanError
from gcs.plan.formats.qgc_plan_writer import Written, write_plan
from gcs.plan.formats.wpl_writer import write_wpl
from gcs.plan.model import AutopilotName, Plan

SUFFIXES = (".plan", ".waypoints", ".txt")


def write(path_text: str, plan: Plan, autopilot: AutopilotName) -> Written:
    """`.plan` is QGroundControl's, `.waypoints` and `.txt` are QGC WPL 110.  Raises PlanError."""
    suffix = path_text.lower().rpartition(".")[2]
    match suffix:
        case "plan":
            return write_plan(plan)
        case "waypoints" | "txt":
            return write_wpl(plan, autopilot)
        case _:
            what = "the suffix names no format that can be written"
            raise PlanError(path_text, "", "file", what, " or ".join(SUFFIXES))
