"""Plan and vehicle brought together: where a plan lies on Earth, and the path that it flies."""

from __future__ import annotations

import dataclasses
from typing import Literal

from gcs.gate.airspace.projection import Projection
from gcs.gate.airspace.verifier import Cleared, verifier_for
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.plan.model import AutopilotName, Geodetic, Plan
from gcs.plan.path import FlightPath, Ground, ProblemKind, flight_path
from gcs.plan.place import georeference
from gcs.plan.zones import zone_specs
from gcs.session.telemetry import Telemetry

PROBLEM_CODES = {
    ProblemKind.NO_ORIGIN: Code.NO_ORIGIN,
    ProblemKind.NO_RETURN_HEIGHT: Code.RTL_BLOCKED,
}


def autopilot_name(telemetry: Telemetry) -> AutopilotName:
    """Whose mission protocol it is; a stranger is spoken to as a px4."""
    name: Literal["px4", "ardupilot"] = "px4"
    if telemetry.autopilot.name == "ardupilot":
        name = "ardupilot"
    return name


def on_earth(plan: Plan, telemetry: Telemetry) -> Plan | Refusal:
    """Items in metres from the take-off point become items above home, by its own projection."""
    if telemetry.origin is None or telemetry.home is None or telemetry.home_ned is None:
        return Refusal(Code.NO_ORIGIN, "the vehicle's origin and home are not known yet")
    projection = Projection(telemetry.origin, telemetry.autopilot.name)
    return georeference(
        plan,
        projection.lat_lon,
        (telemetry.home_ned[0], telemetry.home_ned[1]),
        Geodetic(*telemetry.home),
    )


def path_of(
    plan: Plan, telemetry: Telemetry, now_ns: int = 0, age_ns: int | None = None
) -> FlightPath | Refusal:
    """The whole path from where the vehicle is now, local NED; refused where it is not known.

    With `age_ns`, also where its position is older than that at `now_ns`.
    """
    if age_ns is not None and now_ns - telemetry.position_ns > age_ns:
        return Refusal(Code.STALE, "the vehicle's position is too old")
    if telemetry.origin is None or telemetry.home_ned is None or telemetry.pos_ned is None:
        return Refusal(Code.NO_ORIGIN, "the vehicle's origin, home or position is not known yet")
    path = flight_path(
        plan,
        Ground(
            autopilot_name(telemetry),
            telemetry.home_ned,
            telemetry.pos_ned,
            Projection(telemetry.origin, telemetry.autopilot.name).north_east,
            telemetry.origin.alt_amsl_m,
            telemetry.return_up_m,
        ),
    )
    if path.problems:
        problem = path.problems[0]
        return Refusal(PROBLEM_CODES.get(problem.kind, Code.BAD_MISSION), problem.sentence)
    return path


def verify(plan: Plan, path: FlightPath, policy: Policy, telemetry: Telemetry) -> Cleared | Refusal:
    """Every leg and circle against the policy's fence and the plan's own; says which item."""
    zones = zone_specs(plan.fence)
    verifier = verifier_for(
        policy, telemetry.autopilot.name, telemetry.home_ned, telemetry.origin, zones
    )
    answer = verifier.path(path.segments, path.discs, path.floor_free)
    if isinstance(answer, Cleared):
        return answer
    index, refusal = answer
    sentence = f"item {path.item_of(index) + 1}: {refusal.sentence}"
    return dataclasses.replace(refusal, sentence=sentence)
