"""Verification of a whole mission: every leg, every circle, and the way home from each leg.

The gate's verifier judges; this module walks the plan and asks it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from gcs.frames import Vec3
from gcs.gate.airspace.verifier import Verifier
from gcs.gate.refusal import Code, Refusal
from gcs.plan.model import Plan
from gcs.plan.path import FlightPath, Ground, LegKind, ProblemKind, flight_path

_CODES = {
    ProblemKind.NO_ORIGIN: Code.NO_ORIGIN,
    ProblemKind.NO_RETURN_HEIGHT: Code.RTL_BLOCKED,
}
"""Of problems that the plan is not to blame for; all others are a BAD_MISSION."""


@dataclass(frozen=True, slots=True)
class LegVerdict:
    """One leg (`radius_m` 0), or one circle about `to_ned`.  `refusal` None: cleared.

    `item` counts into `Plan.items`; local NED, metres.
    """

    item: int
    kind: str
    from_ned: Vec3
    to_ned: Vec3
    radius_m: float
    refusal: Refusal | None


@dataclass(frozen=True, slots=True)
class BlockedReturn:
    """From the end of this item the vehicle's own return would leave the fence.

    `item` counts into `Plan.items`.
    """

    item: int
    refusal: Refusal


@dataclass(frozen=True, slots=True)
class Verification:
    """What was found: a verdict for every leg and circle, and the returns that are blocked."""

    path: FlightPath
    verdicts: tuple[LegVerdict, ...]
    blocked_returns: tuple[BlockedReturn, ...]

    @property
    def refusal(self) -> Refusal | None:
        """The first reason not to fly it, which names its item; None where all is cleared."""
        for problem in self.path.problems:
            return Refusal(_CODES.get(problem.kind, Code.BAD_MISSION), problem.sentence)
        for verdict in self.verdicts:
            if verdict.refusal is not None:
                sentence = f"item {verdict.item + 1}: {verdict.refusal.sentence}"
                return replace(verdict.refusal, sentence=sentence)
        return None

    @property
    def evidence(self) -> tuple[tuple[str, float], ...]:
        """The numbers of a cleared mission; items count from 1."""
        numbers = (("legs", float(len(self.path.legs))), ("length_m", self.path.length_m))
        if not self.blocked_returns:
            return numbers
        first = self.blocked_returns[0].item + 1.0
        blocked = float(len(self.blocked_returns))
        return (*numbers, ("returns_blocked", blocked), ("return_blocked_after_item", first))

    @property
    def return_warning(self) -> tuple[str, str] | None:
        """After which items a return is blocked, and by what the first one; None where none is."""
        if not self.blocked_returns:
            return None
        items = ", ".join(str(blocked.item + 1) for blocked in self.blocked_returns)
        where = f"the vehicle's own failsafe return cannot be gated; after item {items}"
        return where, self.blocked_returns[0].refusal.sentence


def verify(plan: Plan, ground: Ground, verifier: Verifier) -> Verification:
    """The one verifier of whole missions, for a plan file and for an upload alike.

    `ground` and `verifier` must agree about home, origin and autopilot; the zones of the plan's
    own fence are the caller's to hand to the verifier (`zone_specs`).
    """
    path = flight_path(plan, ground)
    legs = [
        LegVerdict(
            leg.item,
            leg.kind.value,
            leg.from_ned,
            leg.to_ned,
            0.0,
            verifier.mission_leg(leg.from_ned, leg.to_ned, floor_applies=leg.floor_applies),
        )
        for leg in path.legs
    ]
    circles = [
        LegVerdict(
            circle.item,
            "circle",
            circle.centre_ned,
            circle.centre_ned,
            circle.radius_m,
            verifier.mission_circle(circle.centre_ned, circle.radius_m),
        )
        for circle in path.circles
    ]
    return Verification(path, (*legs, *circles), _blocked_returns(path, ground, verifier))


def _blocked_returns(
    path: FlightPath, ground: Ground, verifier: Verifier
) -> tuple[BlockedReturn, ...]:
    """Where the vehicle's failsafe return, which no ground station can stop, leaves the fence.

    Nothing is found while the vehicle's return height is not known.
    """
    if ground.return_up_m is None:
        return ()
    blocked: dict[int, BlockedReturn] = {}
    for leg in path.legs:
        if leg.kind is LegKind.DESCENT or leg.item in blocked:
            continue
        refusal = verifier.return_refusal(leg.to_ned, ground.home_ned, ground.return_up_m)
        if refusal is not None:
            blocked[leg.item] = BlockedReturn(leg.item, refusal)
    return tuple(blocked.values())
