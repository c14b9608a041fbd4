"""A job that needs a verified mission: it learns what shapes the flight, and verifies in steps."""

from __future__ import annotations

from abc import abstractmethod

from gcs.gate.refusal import Refusal
from gcs.plan.legs import LandingPlace
from gcs.plan.model import Plan
from gcs.plan.verify import Verification, Verifying
from gcs.plan.wire_fence import rally_to_wire
from gcs.protocol.effects import Heard, Wake
from gcs.vehicle.missions.jobs.facts import Facts, Learning, landings_on_board
from gcs.vehicle.missions.jobs.job import Asked, Job, JobWork, VehicleView
from gcs.vehicle.missions.paths import verifying

PAUSE_NS = 2_000_000
"""Between two steps of some milliseconds: positions and ticks are handled in time meanwhile."""


class VerifiedJob(Job):
    """`learn`, then `learnt`; `verify`, then `verified`.  The ticks go on between the steps."""

    def __init__(self, asked: Asked) -> None:
        super().__init__(asked)
        self._learning: Learning | None = None
        self._verifying: Verifying | None = None
        self._step_ns = 0
        self.facts: Facts | None = None

    @property
    def deadline_ns(self) -> int | None:
        """Soon, while there is something to verify."""
        if self._verifying is not None:
            return self._step_ns
        return self._learning.deadline_ns if self._learning else super().deadline_ns

    @abstractmethod
    def learnt(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        """`facts` are known."""

    @abstractmethod
    def verified(self, found: Verification, view: VehicleView, now_ns: int) -> list[JobWork]:
        """The verification is done."""

    def learn(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        """Ask the vehicle for what shapes its flight."""
        asked = self.asked
        judged = view.policy.battery.endurance_s is not None
        self._learning = Learning(
            asked.own, view.telemetry, asked.timing, asked.times, flight_time=judged
        )
        return [*self._learning.start(now_ns), *self._learn_on(view, now_ns)]

    def verify(
        self, plan: Plan, view: VehicleView, now_ns: int, begin_item: int = 0
    ) -> list[JobWork]:
        """The whole mission, or what follows from `begin_item` on, with the plan's own rally points
        or those on board."""
        assert self.facts is not None
        begun = verifying(
            plan,
            view.policy,
            view.telemetry,
            self.facts.settings,
            self.facts.return_up_m,
            self._rally(plan, view),
            now_ns,
            begin_item,
        )
        if isinstance(begun, Refusal):
            return self.refuse(begun)
        self._verifying = begun
        return self._verify_on(view, now_ns)

    def heard(self, heard: Heard, view: VehicleView, now_ns: int) -> list[JobWork]:
        if self._learning is None:
            return super().heard(heard, view, now_ns)
        sends = self._learning.handle(heard, now_ns)
        return [*sends, *self._learn_on(view, now_ns)]

    def wake(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        if self._verifying is not None:
            return self._verify_on(view, now_ns) if now_ns >= self._step_ns else []
        if self._learning is not None:
            sends = self._learning.handle(Wake(), now_ns)
            return [*sends, *self._learn_on(view, now_ns)]
        return super().wake(view, now_ns)

    def after_pause_ns(self, now_ns: int) -> int:
        """When the next step of something long is due."""
        return now_ns + self.asked.times.real_ns(PAUSE_NS)

    def _learn_on(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        learning = self._learning
        if learning is None or not learning.over:
            return []
        self._learning = None
        if learning.refusal is not None:
            return self.refuse(learning.refusal)
        self.facts = learning.facts
        return self.learnt(view, now_ns)

    def _verify_on(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        assert self._verifying is not None
        self._step_ns = self.after_pause_ns(now_ns)
        self._verifying.step()
        found = self._verifying.result
        if found is None:
            return []
        self._verifying = None
        return self.verified(found, view, now_ns)

    def _rally(self, plan: Plan, view: VehicleView) -> tuple[LandingPlace, ...]:
        assert self.facts is not None
        if plan.rally:
            return landings_on_board(rally_to_wire(plan.rally), view.telemetry)
        return landings_on_board(self.facts.rally, view.telemetry, "rally point on board")
