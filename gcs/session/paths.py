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


def autopilot_name(seen: Telemetry) -> AutopilotName:
    """Whose mission protocol it is; a stranger is spoken to as a px4."""
    name: Literal["px4", "ardupilot"] = "px4"
    if seen.autopilot.name == "ardupilot":
        name = "ardupilot"
    return name


def on_earth(plan: Plan, seen: Telemetry) -> Plan | Refusal:
    """Items in metres from the take-off point become items above home, by its own projection."""
    if seen.origin is None or seen.home is None or seen.home_ned is None:
        return Refusal(Code.NO_ORIGIN, "the vehicle's origin and home are not known yet")
    projection = Projection(seen.origin, seen.autopilot.name)
    return georeference(
        plan, projection.lat_lon, (seen.home_ned[0], seen.home_ned[1]), Geodetic(*seen.home)
    )


def path_of(
    plan: Plan, seen: Telemetry, now_ns: int = 0, age_ns: int | None = None
) -> FlightPath | Refusal:
    """The whole path from where the vehicle is now, local NED; refused where it is not known.

    With `age_ns`, also where its position is older than that at `now_ns`.
    """
    if age_ns is not None and now_ns - seen.position_ns > age_ns:
        return Refusal(Code.STALE, "the vehicle's position is too old")
    if seen.origin is None or seen.home_ned is None or seen.pos_ned is None:
        return Refusal(Code.NO_ORIGIN, "the vehicle's origin, home or position is not known yet")
    path = flight_path(
        plan,
        Ground(
            autopilot_name(seen),
            seen.home_ned,
            seen.pos_ned,
            Projection(seen.origin, seen.autopilot.name).north_east,
            seen.origin.alt_amsl_m,
            seen.return_up_m,
        ),
    )
    if path.problems:
        problem = path.problems[0]
        return Refusal(PROBLEM_CODES.get(problem.kind, Code.BAD_MISSION), problem.sentence)
    return path


def verify(plan: Plan, path: FlightPath, policy: Policy, seen: Telemetry) -> Cleared | Refusal:
    """Every leg and circle against the policy's fence and the plan's own; says which item."""
    both = dataclasses.replace(policy, fence=(*policy.fence, *zone_specs(plan.fence)))
    verifier = verifier_for(both, seen.autopilot.name, seen.home_ned, seen.origin)
    answer = verifier.path(path.segments, path.discs, path.floor_free)
    if isinstance(answer, Cleared):
        return answer
    index, refusal = answer
    sentence = f"item {path.item_of(index) + 1}: {refusal.sentence}"
    return dataclasses.replace(refusal, sentence=sentence)
