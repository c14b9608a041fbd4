"""Plan and vehicle brought together: where a plan lies on Earth, and the path that it flies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from gcs.gate.airspace.projection import Projection
from gcs.gate.airspace.verifier import verifier_for
from gcs.gate.machine.sentences import position_too_old
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import LandedState
from gcs.plan.legs import FlightSettings, Ground, LandingPlace
from gcs.plan.model import AutopilotName, Geodetic, Plan
from gcs.plan.place import georeference
from gcs.plan.verify import Verification, Verifying, bad_landings
from gcs.plan.zones import zone_specs
from gcs.vehicle.talk.telemetry import Telemetry


def autopilot_name(telemetry: Telemetry) -> AutopilotName:
    """Whose mission protocol it is; a stranger is spoken to as a px4."""
    name: Literal["px4", "ardupilot"] = "px4"
    if telemetry.autopilot.name == "ardupilot":
        name = "ardupilot"
    return name


def first_item(telemetry: Telemetry) -> int:
    """The first item that is flown; ardupilot keeps home as item 0."""
    return 1 if autopilot_name(telemetry) == "ardupilot" else 0


def is_placed(telemetry: Telemetry) -> bool:
    """Whether it is known where the vehicle's local frame and its home are on Earth."""
    known = (telemetry.origin, telemetry.home, telemetry.home_ned)
    return all(each is not None for each in known)


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


@dataclass(frozen=True, slots=True)
class ClearedMission:
    """A mission that may be flown; `warnings` are for the operator before it is."""

    evidence: tuple[tuple[str, float], ...]
    warnings: tuple[str, ...]


def verifying(
    plan: Plan,
    policy: Policy,
    telemetry: Telemetry,
    settings: FlightSettings,
    return_up_m: float | None,
    rally: tuple[LandingPlace, ...],
    now_ns: int,
    begin_item: int = 0,
) -> Verifying | Refusal:
    """The whole mission, or all that may follow from `begin_item` on, from where the vehicle is
    now, against the policy's fence and its own."""
    age_ns = now_ns - telemetry.position_ns
    if age_ns > round(policy.position_age_s * 1e9):
        return position_too_old(age_ns, policy)
    if telemetry.origin is None or telemetry.home_ned is None or telemetry.pos_ned is None:
        return Refusal(Code.NO_ORIGIN, "the vehicle's origin, home or position is not known yet")
    ground = Ground(
        autopilot_name(telemetry),
        telemetry.home_ned,
        telemetry.pos_ned,
        Projection(telemetry.origin, telemetry.autopilot.name).north_east,
        telemetry.origin.alt_amsl_m,
        return_up_m,
        settings,
        rally,
        on_ground=telemetry.landed is LandedState.ON_GROUND,
        begin_item=begin_item,
        battery_pct=telemetry.charge.left_pct(now_ns),
    )
    verifier = verifier_for(
        policy,
        telemetry.autopilot.name,
        telemetry.home_ned,
        telemetry.origin,
        zone_specs(plan.fence),
    )
    return Verifying(plan, ground, verifier)


def bad_rally_points(
    landings: tuple[LandingPlace, ...], policy: Policy, telemetry: Telemetry
) -> tuple[Refusal, ...]:
    """Those where the vehicle must not land by the policy's fence, as a mission with them is
    judged; all of them where nobody knows yet where they lie."""
    home_ned, origin = telemetry.home_ned, telemetry.origin
    if origin is None or home_ned is None:
        return (Refusal(Code.NO_ORIGIN, "the vehicle's origin and home are not known yet"),)
    name = autopilot_name(telemetry)
    ground = Ground(name, home_ned, home_ned, return_up_m=telemetry.return_up_m, rally=landings)
    verifier = verifier_for(policy, telemetry.autopilot.name, home_ned, origin)
    return bad_landings(ground, verifier)


def cleared(found: Verification) -> ClearedMission | Refusal:
    """What was found, as an answer to the operator."""
    if found.refusal is not None:
        return found.refusal
    warning = found.return_warning
    return ClearedMission(found.evidence, (": ".join(warning),) if warning else ())
