"""A whole mission before the verifier: every leg, every circle, and the way home from each.

The verdict is the verifier's alone; this walks the plan and puts the questions.
"""

from __future__ import annotations

from dataclasses import dataclass

from gcs.frames import Vec3
from gcs.gate.airspace.verifier import Verifier
from gcs.gate.refusal import Code, Refusal
from gcs.plan.model import Plan
from gcs.plan.path import FlightPath, Ground, LegKind, Problem, ProblemKind, flight_path


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
    """From the end of this item the vehicle's own return would leave the fence."""

    item: int
    refusal: Refusal


@dataclass(frozen=True, slots=True)
class Verification:
    path: FlightPath
    verdicts: tuple[LegVerdict, ...]
    blocked_returns: tuple[BlockedReturn, ...]

    @property
    def refusal(self) -> tuple[int, Refusal] | None:
        """The first reason not to fly it, with its item; None where all of it is cleared."""
        for problem in self.path.problems:
            return problem.item, _as_refusal(problem)
        for verdict in self.verdicts:
            if verdict.refusal is not None:
                return verdict.item, verdict.refusal
        return None


def verify(plan: Plan, ground: Ground, verifier: Verifier) -> Verification:
    """`ground` and `verifier` must agree about home, origin and autopilot."""
    path = flight_path(plan, ground)
    legs = [
        LegVerdict(
            leg.item,
            leg.kind.value,
            leg.from_ned,
            leg.to_ned,
            0.0,
            _ask(verifier, [(leg.from_ned, leg.to_ned)], [], floor_applies=leg.floor_applies),
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
            _ask(verifier, [], [(circle.centre_ned, circle.radius_m)], floor_applies=True),
        )
        for circle in path.circles
    ]
    return Verification(path, (*legs, *circles), _blocked_returns(path, ground, verifier))


def _ask(
    verifier: Verifier,
    legs: list[tuple[Vec3, Vec3]],
    circles: list[tuple[Vec3, float]],
    *,
    floor_applies: bool,
) -> Refusal | None:
    answer = verifier.path(legs, circles, frozenset() if floor_applies else frozenset({0}))
    return answer[1] if isinstance(answer, tuple) else None


def _blocked_returns(
    path: FlightPath, ground: Ground, verifier: Verifier
) -> tuple[BlockedReturn, ...]:
    """Of the vehicle's failsafe return, which no ground station can hold back."""
    if ground.return_up_m is None:
        return ()
    blocked: dict[int, BlockedReturn] = {}
    for leg in path.legs:
        if leg.kind is LegKind.DESCENT or leg.item in blocked:
            continue
        answer = verifier.return_path(leg.to_ned, ground.home_ned, ground.return_up_m)
        if isinstance(answer, Refusal):
            blocked[leg.item] = BlockedReturn(leg.item, answer)
    return tuple(blocked.values())


def _as_refusal(problem: Problem) -> Refusal:
    unknown = problem.kind is ProblemKind.NO_ORIGIN
    return Refusal(Code.NO_ORIGIN if unknown else Code.BAD_MISSION, problem.sentence)
