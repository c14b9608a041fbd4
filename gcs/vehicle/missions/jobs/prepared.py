"""A job that has a plan to prepare before it verifies it: read, linted, placed, in steps."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import ClassVar

from gcs.gate.effects import Level
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import State
from gcs.plan.errors import PlanError
from gcs.plan.verify import Verification
from gcs.session.work import Log
from gcs.steps import Steps
from gcs.vehicle.missions.jobs.job import NODE, Asked, JobWork, VehicleView
from gcs.vehicle.missions.jobs.verified import VerifiedJob
from gcs.vehicle.missions.paths import is_placed
from gcs.vehicle.missions.plans import Prepared

MOST_FINDINGS = 20
"""Findings of one mission that are told one by one."""
PLACED_WITHIN_NS = 30_000_000_000
"""So long the vehicle's origin and home are waited for: on a link that loses frames each may have
to be asked for some times, every two seconds."""
LOOK_AGAIN_NS = 100_000_000


class PreparedJob(VerifiedJob):
    """`prepare_with`, then what shapes the flight is learnt and the path verified: `verified`.

    Where the vehicle's origin or home is not known yet, they are waited for first: no plan can be
    placed without them, whoever asks for it.

    `source` is what the log calls the plan.
    """

    waits_for_home: ClassVar[bool] = True

    def __init__(self, asked: Asked, source: str) -> None:
        super().__init__(asked)
        self.source = source
        self._preparing: Steps[Prepared | Refusal] | None = None
        self._at_once = True
        self._prepare_ns = 0
        self._placed_by_ns = 0
        """Until then the origin and home are waited for; 0: they are not."""
        self._prepared_plan: Prepared | None = None

    @abstractmethod
    def bad_plan(self, error: PlanError) -> list[JobWork]:
        """It cannot be read, or not be flown: the refusal."""

    def found(self, refusal: Refusal) -> list[JobWork]:
        """A leg, region, circle, rally point or return that does not clear: a line of the log."""
        text = f"{self.source}: {refusal.code.value}: {refusal.sentence}"
        return [Log(Level.WARNING, NODE, text)]

    @property
    def prepared(self) -> Prepared:
        """The plan, once it is prepared."""
        assert self._prepared_plan is not None
        return self._prepared_plan

    def prepare_with(
        self, steps: Steps[Prepared | Refusal], at_once: bool, view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """Go through `steps`, all in one turn or one between two ticks."""
        self._preparing, self._at_once = steps, at_once
        if is_placed(view.telemetry) or not self.waits_for_home:
            return self._prepare_on(view, now_ns)
        self._placed_by_ns = now_ns + self.asked.times.real_ns(PLACED_WITHIN_NS)
        waits = "waiting for the vehicle's origin and home"
        log = Log(Level.INFO, NODE, f"{self.source}: {waits}")
        return [log, *self._prepare_on(view, now_ns)]

    @property
    def deadline_ns(self) -> int | None:
        return super().deadline_ns if self._preparing is None else self._prepare_ns

    def wake(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        if self._preparing is not None:
            return self._prepare_on(view, now_ns) if now_ns >= self._prepare_ns else []
        return super().wake(view, now_ns)

    def _prepare_on(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        """A step more on the way to a plan that can be verified, or to why not."""
        assert self._preparing is not None
        if self._placed_by_ns:
            stale = view.state is State.STALE
            if now_ns < self._placed_by_ns and (stale or not is_placed(view.telemetry)):
                self._prepare_ns = now_ns + self.asked.times.real_ns(LOOK_AGAIN_NS)
                return []
            self._placed_by_ns = 0
            if stale:
                return self.refuse(Refusal(Code.STALE, "the vehicle's position is too old"))
        self._prepare_ns = self.after_pause_ns(now_ns)
        try:
            next(self._preparing)
            while self._at_once:
                next(self._preparing)
        except StopIteration as over:
            self._preparing = None
            return self._prepared(over.value, view, now_ns)
        except PlanError as error:
            self._preparing = None
            return self.bad_plan(error)
        return []

    def _prepared(
        self, prepared: Prepared | Refusal, view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        if isinstance(prepared, Refusal):
            return self.refuse(prepared)
        self._prepared_plan = prepared
        work: list[JobWork] = [
            Log(level, NODE, f"{self.source}: {text}") for level, text in prepared.remarks
        ]
        return work + self.placed(view, now_ns)

    def placed(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        """The plan is `prepared`: what shapes its flight is learnt next."""
        return self.learn(view, now_ns)

    def learnt(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        return self.verify(self.prepared.plan, view, now_ns)

    def refuse_path(self, found: Verification, first: Refusal) -> list[JobWork]:
        """Refused for `first`; what else does not clear is told before it."""
        return self.refuse_for_all(first, found.refusals[1:])

    def refuse_for_all(self, first: Refusal, others: Sequence[Refusal]) -> list[JobWork]:
        """Refused for `first`; the others are told before it, each sentence once."""
        named = {each.sentence: each for each in others if each.sentence != first.sentence}
        told = [work for each in list(named.values())[:MOST_FINDINGS] for work in self.found(each)]
        return [*told, *self.refuse(first)]
