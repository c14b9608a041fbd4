"""A plan, a policy and a place to take off from -> findings and verdicts, without a vehicle."""

from __future__ import annotations

from dataclasses import dataclass, replace

from gcs.exit_codes import ExitCode
from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.airspace.verifier import check_start, verifier_for
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Refusal
from gcs.operator.errors import ExitError
from gcs.plan.errors import Finding, Level
from gcs.plan.flight_time import FlightTime, flight_time
from gcs.plan.legs import Ground, LandingPlace
from gcs.plan.lint import lint, worst
from gcs.plan.model import AutopilotName, Geodetic, Plan
from gcs.plan.place import georeference
from gcs.plan.settings import USUAL
from gcs.plan.verify import Verification, bad_landings, verify
from gcs.plan.zones import zone_specs
from gcs.policy_file import PolicyFileError, load_policy

HOMES: dict[AutopilotName, Geodetic] = {
    "px4": Geodetic(47.397742, 8.545594, 488.0),
    "ardupilot": Geodetic(-35.363262, 149.165237, 584.0),
}
"""Where the simulated vehicles stand."""

RETURN_UP_M: dict[AutopilotName, float] = {"px4": 30.0, "ardupilot": 15.0}
"""The autopilots' own return heights, above home, while no vehicle has told another."""


@dataclass(frozen=True, slots=True)
class Checked:
    """`verification` is None where there is nothing to fly, or it has errors: neither is put to
    the fence.  `home` is None only where nobody gave one and nothing flies.  `flight` is how long
    it is in the air, with a vehicle as it is delivered.
    """

    plan: Plan
    autopilot: AutopilotName
    policy: Policy
    home: Geodetic | None
    findings: tuple[Finding, ...]
    verification: Verification | None
    start_refusal: Refusal | None
    flight: FlightTime | None = None
    bad_landings: tuple[Refusal, ...] = ()
    """Rally points where the policy lets nobody land, of a plan that flies nowhere."""

    @property
    def exit_code(self) -> ExitCode:
        if worst(list(self.findings)) is Level.ERROR:
            return ExitCode.BAD_FILE
        flown = self.verification
        refused = flown is not None and flown.refusal is not None
        if self.start_refusal is not None or refused or self.bad_landings:
            return ExitCode.REFUSED_BY_GATE
        return ExitCode.DONE


def check_plan(
    plan: Plan, autopilot: AutopilotName | None, policy_name: str, home: Geodetic | None
) -> Checked:
    """Raises ExitError with BAD_FILE if the policy is wrong."""
    autopilot = autopilot or plan.firmware or "px4"
    try:
        policy, _ = load_policy(policy_name)
    except PolicyFileError as error:
        raise ExitError(ExitCode.BAD_FILE, str(error), error.hint) from None
    at_home, notes = choose_home(plan, autopilot, home)
    findings = (*notes, *lint(plan, autopilot, at_home))
    nothing = Checked(plan, autopilot, policy, at_home, findings, None, None)
    if at_home is None or not (plan.items or plan.rally) or worst(list(findings)) is Level.ERROR:
        return nothing
    laid = lay_out(plan, autopilot, at_home)
    placed, ground = laid.placed, laid.ground
    origin, home_ned = laid.projection.origin, ground.home_ned
    verifier = verifier_for(policy, autopilot, home_ned, origin, zone_specs(placed.fence))
    if not plan.items:
        return replace(nothing, bad_landings=bad_landings(ground, verifier))
    verification = verify(placed, ground, verifier)
    start = check_start(verifier, home_ned)
    time = flight_time(placed, ground)
    return Checked(plan, autopilot, policy, at_home, findings, verification, start, time)


@dataclass(frozen=True, slots=True)
class Layout:
    """A plan on Earth, and the ground that it takes off from: home is the local origin."""

    placed: Plan
    projection: Projection
    ground: Ground


def lay_out(plan: Plan, autopilot: AutopilotName, home: Geodetic) -> Layout:
    """With a vehicle as it is delivered, on the ground with a full battery."""
    origin = Origin(home.lat_deg, home.lon_deg, home.alt_amsl_m or 0.0)
    projection = Projection(origin, autopilot)
    placed = georeference(plan, projection.lat_lon, home=home)
    ground = Ground(
        autopilot,
        home_ned=(0.0, 0.0, 0.0),
        start_ned=(0.0, 0.0, 0.0),
        north_east_of=projection.north_east,
        origin_alt_amsl_m=origin.alt_amsl_m,
        return_up_m=RETURN_UP_M[autopilot],
        settings=USUAL[autopilot],
        rally=_landings(placed, projection, autopilot),
        on_ground=True,
        battery_pct=100.0,
    )
    return Layout(placed, projection, ground)


def _landings(
    plan: Plan, projection: Projection, autopilot: AutopilotName
) -> tuple[LandingPlace, ...]:
    """The plan's rally points; home is the local origin here."""
    found = []
    for number, point in enumerate(plan.rally, start=1):
        north_m, east_m = projection.north_east(point.lat_deg, point.lon_deg)
        up_m = point.alt_above_home_m
        ground_down_m, over_up_m = (-up_m, 0.0) if autopilot == "px4" else (0.0, up_m)
        ground_ned = (north_m, east_m, ground_down_m)
        found.append(LandingPlace(f"rally point {number}", ground_ned, over_up_m))
    return tuple(found)


def choose_home(
    plan: Plan, autopilot: AutopilotName, given: Geodetic | None
) -> tuple[Geodetic | None, tuple[Finding, ...]]:
    """As typed, else the file's, else for a mission the simulated vehicle's, which is told."""
    if given is not None:
        return given, ()
    if not plan.items:
        return plan.home, ()
    usual = HOMES[autopilot]
    if plan.home is None:
        what = f"the file has none; taken is {usual.lat_deg}, {usual.lon_deg}, {usual.alt_amsl_m} m"
        hint = "give --home LAT,LON,ALT"
        return usual, (Finding(Level.NOTE, "", "home", what, hint),)
    if plan.home.alt_amsl_m is None:
        what = f"the file gives it no height; taken is {usual.alt_amsl_m} m AMSL"
        home = Geodetic(plan.home.lat_deg, plan.home.lon_deg, usual.alt_amsl_m)
        return home, (Finding(Level.NOTE, "", "home", what, "give --home LAT,LON,ALT"),)
    return plan.home, ()
