"""Verification of a whole mission as it will be flown: every leg, every region beside the legs,
every circle, the rally points, the way to where a return lands from each leg, and whether the
battery lasts.

The gate's verifier judges; this module walks the plan and asks it.  A mission of 2,000 items takes
a good part of a second: `Verifying` does it in steps, between which others may act.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from gcs.enu_text import place
from gcs.frames import Vec3
from gcs.gate.airspace.verifier import Verifier
from gcs.gate.policy.policy import BatteryLimits
from gcs.gate.refusal import Code, Refusal
from gcs.plan.commands import item_label
from gcs.plan.flight_time import DAY_S, FlightTime, TimeWalk
from gcs.plan.flown import returns
from gcs.plan.flown.path import PathWalk
from gcs.plan.legs import FlightPath, Ground, Leg, LegKind, ProblemKind, Region
from gcs.plan.model import Plan

_CODES = {
    ProblemKind.NO_ORIGIN: Code.NO_ORIGIN,
    ProblemKind.NO_RETURN_HEIGHT: Code.RTL_BLOCKED,
}
"""Of problems that the plan is not to blame for; all others are a BAD_MISSION."""


@dataclass(frozen=True, slots=True)
class LegVerdict:
    """One leg or region (`radius_m` 0), or one circle about `to_ned`.  `refusal` None: cleared.

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

    `item` counts into `Plan.items`; `refuses` says whether the mission is refused for it, by the
    policy's choice, or only told of it.
    """

    item: int
    refusal: Refusal
    refuses: bool = False


@dataclass(frozen=True, slots=True)
class Verification:
    """What was found: a verdict for every leg and circle, and the returns that are blocked."""

    path: FlightPath
    verdicts: tuple[LegVerdict, ...]
    blocked_returns: tuple[BlockedReturn, ...]
    bad_landings: tuple[Refusal, ...] = ()
    """Rally points where the vehicle must not land; each names its own."""
    flight: FlightTime | None = None
    """How long it is in the air, where the policy has that judged; None where its path has
    problems."""
    beyond_battery: Refusal | None = None
    """Why its battery does not last for it."""

    @property
    def refusal(self) -> Refusal | None:
        """The first reason not to fly it, which names its item; None where all is cleared."""
        return next(self._reasons(), None)

    @property
    def refusals(self) -> tuple[Refusal, ...]:
        """Every reason not to fly it, the first one of `refusal` before the others."""
        return tuple(self._reasons())

    def _reasons(self) -> Iterator[Refusal]:
        for problem in self.path.problems:
            yield Refusal(_CODES.get(problem.kind, Code.BAD_MISSION), problem.sentence)
        for verdict in self.verdicts:
            if verdict.refusal is not None:
                sentence = f"item {verdict.item + 1}: {verdict.refusal.sentence}"
                yield replace(verdict.refusal, sentence=sentence)
        yield from self.bad_landings
        if self.beyond_battery is not None:
            yield self.beyond_battery
        for blocked in self.blocked_returns:
            if blocked.refuses:
                sentence = (
                    f"item {blocked.item + 1}: a failsafe return from here cannot be stopped: "
                    f"{blocked.refusal.sentence} (the policy's mission.blocked_return)"
                )
                yield replace(blocked.refusal, sentence=sentence)

    @property
    def evidence(self) -> tuple[tuple[str, float], ...]:
        """The numbers of a cleared mission; items count from 1."""
        numbers: tuple[tuple[str, float], ...] = (
            ("legs", float(len(self.path.legs))),
            ("length_m", self.path.length_m),
        )
        if self.flight is not None and self.flight.whole:
            numbers = (*numbers, ("flight_s", self.flight.time_s))
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
    verifying = Verifying(plan, ground, verifier)
    while verifying.result is None:
        verifying.step()
    return verifying.result


def bad_landings(ground: Ground, verifier: Verifier) -> tuple[Refusal, ...]:
    """The rally points of `ground` where the vehicle must not land; each refusal names its own.

    A rally point is inside the fence by the margin, from the height that it is flown to down to the
    ground.  While the return height is not known its own height is asked about.
    """
    found: list[Refusal] = []
    for landing in ground.rally:
        way = returns.way_to(landing, ground, landing.ground_ned)
        refusal = verifier.mission_leg(
            way.over_ned, way.ground_ned, floor_applies=False
        ) or verifier.mission_leg(way.over_ned, way.over_ned, floor_applies=False)
        if refusal is not None:
            found.append(replace(refusal, sentence=f"{landing.name}: {refusal.sentence}"))
    return tuple(found)


STEP_QUESTIONS = 80
"""Questions to the verifier in one step: some milliseconds."""
ITEM_COST = 10
"""How an item of the path is flown takes as long to find out as so many questions."""
TIMED_ITEMS = 20
"""Of so many items the time is counted in the time of one question."""


class Verifying:
    """A verification in steps; `result` is None until it is done."""

    def __init__(self, plan: Plan, ground: Ground, verifier: Verifier) -> None:
        self._ground = ground
        self._verifier = verifier
        exclusions = tuple(zone for zone in verifier.zones if not zone.inclusion)
        self._exclusions = replace(verifier, zones=exclusions) if exclusions else None
        self._verdicts: list[LegVerdict] = []
        self._blocked: dict[int, BlockedReturn] = {}
        self._bad_landings: list[Refusal] = []
        self._plan = plan
        self._walk = PathWalk(plan, ground)
        self._flight: FlightTime | None = None
        self._beyond_battery: Refusal | None = None
        self._questions = self._ask_all()
        self.result: Verification | None = None

    def step(self) -> None:
        """Walk on, or ask a few questions more; the last step has the result."""
        spent = 0
        while spent < STEP_QUESTIONS:
            cost = next(self._questions, None)
            if cost is not None:
                spent += cost
            else:
                self.result = Verification(
                    self._walk.path,
                    tuple(self._verdicts),
                    tuple(self._blocked.values()),
                    tuple(self._bad_landings),
                    self._flight,
                    self._beyond_battery,
                )
                return

    def _ask_all(self) -> Iterator[int]:
        """Yields what each item of the path and each question costs, in questions."""
        for _ in self._walk.steps():
            yield ITEM_COST
        path = self._walk.path
        for leg in path.legs:
            self._verdicts.append(self._leg(leg))
            yield 1
        for region in path.regions:
            self._verdicts.append(self._region(region))
            yield 1
        for circle in path.circles:
            refusal = self._verifier.mission_circle(circle.centre_ned, circle.radius_m)
            at_ned = circle.centre_ned
            self._verdicts.append(
                LegVerdict(circle.item, "circle", at_ned, at_ned, circle.radius_m, refusal)
            )
            yield 1
        self._bad_landings += bad_landings(self._ground, self._verifier)
        yield 1
        if not path.problems:
            yield from self._judge_battery()
        if self._ground.return_up_m is None:
            return
        for leg in path.legs:
            if leg.kind is not LegKind.DESCENT and leg.item not in self._blocked:
                self._judge_return(leg)
                yield 1

    def _judge_battery(self) -> Iterator[int]:
        limits, left_pct = self._verifier.policy.battery, self._ground.battery_pct
        if limits.endurance_s is None:
            return
        walk = TimeWalk(self._plan, self._ground, lasts_s(limits.endurance_s, limits, left_pct))
        for number, _ in enumerate(walk.steps()):
            yield 1 if number % TIMED_ITEMS == 0 else 0
        self._flight = walk.result
        if self._flight is not None:
            self._beyond_battery = battery_refusal(self._flight, self._plan, limits, left_pct)

    def _leg(self, leg: Leg) -> LegVerdict:
        refusal = None
        if leg.take_off:
            refusal = self._verifier.mission_take_off(leg.from_ned, leg.to_ned)
        refusal = refusal or self._verifier.mission_leg(
            leg.from_ned, leg.to_ned, floor_applies=leg.floor_applies
        )
        return LegVerdict(leg.item, leg.kind.value, leg.from_ned, leg.to_ned, 0.0, refusal)

    def _region(self, region: Region) -> LegVerdict:
        to_ned = region.aim_ned
        refusal = self._verifier.mission_region(
            f"{region.kind.value} {place(to_ned)}",
            region.starts,
            region.ends,
            floor_applies=region.floor_applies,
        )
        kind = region.kind.name.lower()
        return LegVerdict(region.item, kind, region.points[0], to_ned, 0.0, refusal)

    def _judge_return(self, leg: Leg) -> None:
        """Whether the vehicle's failsafe return, which no ground station can stop, leaves the
        fence; what refuses the mission is kept before what is only told."""
        ground, choice = self._ground, self._verifier.policy.mission.blocked_return
        for landing in returns.landing_places(ground, (leg.to_ned,)):
            up_m = max(ground.return_up_m or 0.0, landing.over_up_m)
            way = (leg.to_ned, landing.ground_ned, up_m)
            entered = self._exclusions.return_refusal(*way) if self._exclusions else None
            refusal = entered or self._verifier.return_refusal(*way)
            if refusal is None:
                continue
            if landing.name != "home":
                refusal = replace(refusal, sentence=f"to {landing.name}: {refusal.sentence}")
            refuses = choice == "refuse" or (choice != "warn" and entered is not None)
            known = self._blocked.get(leg.item)
            if known is None or (refuses and not known.refuses):
                self._blocked[leg.item] = BlockedReturn(leg.item, refusal, refuses)


# ------------------------------------------------------------------------------ the battery

_NOT_TOLD = (
    "the vehicle has not told how much charge its battery has left, so nobody knows whether it "
    "lasts for this mission (the policy's battery.endurance_s)"
)


def lasts_s(endurance_s: float, limits: BatteryLimits, battery_pct: float | None) -> float:
    """For how long it flies before it is low; a battery of which nothing is told, as a full one."""
    left_pct = 100.0 if battery_pct is None else battery_pct
    return endurance_s * max(0.0, left_pct - limits.low_pct) / 100.0


def battery_refusal(
    flight: FlightTime, plan: Plan, limits: BatteryLimits, battery_pct: float | None
) -> Refusal | None:
    """None where it lasts, or where the policy does not say for how long a full one flies."""
    if limits.endurance_s is None:
        return None
    if battery_pct is None:
        return Refusal(Code.BATTERY_REACH, _NOT_TOLD)
    most_s = lasts_s(limits.endurance_s, limits, battery_pct)
    if flight.whole and flight.time_s <= most_s:
        return None
    sentence = (
        f"{_what(flight, plan)}; the battery is low after {most_s:.0f} s: {battery_pct:.0f} % are "
        f"left of {limits.endurance_s:g} s, and {limits.low_pct:g} % are kept"
    )
    numbers = (
        ("flight_s", flight.time_s),
        ("battery_lasts_s", most_s),
        ("battery_pct", battery_pct),
    )
    return Refusal(Code.BATTERY_REACH, sentence, numbers)


def _what(flight: FlightTime, plan: Plan) -> str:
    time = "a day or more" if flight.time_s >= DAY_S else f"about {flight.time_s:.0f} s"
    if flight.whole:
        return f"the mission, its return and landing included, takes {time}"
    done = f"{_named(plan, flight.item)} is done only after {time}"
    if flight.endless is None:
        return done
    return f"{_named(plan, flight.endless)} repeats for ever, and {done}"


def _named(plan: Plan, index: int) -> str:
    return item_label(index, plan.items[index].command)
