"""Bringing a mission on board: prepared, verified whole, uploaded, read back and compared.

A mission leaves only if all of it clears the fence; what the vehicle then holds is read back and
compared in meaning.  The plan's own fence and rally points leave before it, as a PX4 judges a
mission by the fence that it has; a plan without them leaves those on board as they are.  A plan
without a mission leaves the one on board as it is.

Where the plan comes from is the subclass's: a file (`upload.py`), or a client
(`upload.py`).
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import replace

from gcs.gate.effects import Level, OutcomeKind
from gcs.gate.inputs import MissionLoaded
from gcs.gate.refusal import Code, Refusal
from gcs.plan.legs import FlightPath
from gcs.plan.model import Fence
from gcs.plan.parts import are, held
from gcs.plan.verify import Verification
from gcs.session.work import GateInput, Log
from gcs.vehicle.missions.jobs.facts import landings_on_board
from gcs.vehicle.missions.jobs.job import (
    LEFT,
    NODE,
    STOPPED,
    Asked,
    JobWork,
    OnBoardChanged,
    VehicleView,
    may_not_fence,
)
from gcs.vehicle.missions.jobs.prepared import PreparedJob
from gcs.vehicle.missions.jobs.transfers import BringingJob
from gcs.vehicle.missions.paths import bad_rally_points, cleared
from gcs.vehicle.missions.plans import on_board
from gcs.wire.ids import MissionType


class BringMission(PreparedJob, BringingJob):
    """A mission verified whole, brought on board and read back; `prepare_with` begins."""

    def __init__(self, asked: Asked, source: str) -> None:
        super().__init__(asked, source)
        self._flown: FlightPath | None = None
        """The path of a mission, once it has cleared."""
        self._accepted = False

    @abstractmethod
    def kept(self) -> list[JobWork]:
        """The plan as it came, for the record."""

    def warned(self, warnings: Sequence[str]) -> list[JobWork]:
        """It clears, and there is this to know about it: lines of the log."""
        return [Log(Level.WARNING, NODE, f"{self.source}: {text}") for text in warnings]

    def placed(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        prepared = self.prepared
        if prepared.fence and (kept := may_not_fence(view, prepared.fence)):
            return self.refuse(kept)
        if prepared.sent:
            return super().placed(view, now_ns)
        landings = landings_on_board(prepared.rally, view.telemetry)
        bad = bad_rally_points(landings, view.policy, view.telemetry) if landings else ()
        if bad:
            return self.refuse_for_all(bad[0], bad[1:])
        return [*self.kept(), *self._bring_parts((), view, now_ns)]

    def verified(self, found: Verification, view: VehicleView, now_ns: int) -> list[JobWork]:
        """The verdict; a mission that clears is on its way."""
        answer = cleared(found)
        if isinstance(answer, Refusal):
            return self.refuse_path(found, answer)
        work = self.warned(answer.warnings)
        self._flown = found.path
        work += [*self.kept(), *self._bring_parts(answer.evidence, view, now_ns)]
        return work

    def _bring_parts(
        self, evidence: tuple[tuple[str, float], ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """Accepted: the fence, the rally points, then the mission; none of them twice in the air,
        where the fence is on board already."""
        self._accepted = True
        prepared = self.prepared
        work: list[JobWork] = [self.accept(evidence)]
        if prepared.sent:
            work += [GateInput(MissionLoaded("", 0)), OnBoardChanged(None)]
        stays = view.in_air and bool(view.fence)  # `may_not_fence`: it is this very one
        plans = [
            (MissionType.FENCE, () if stays else prepared.fence),
            (MissionType.RALLY, prepared.rally),
            (MissionType.MISSION, prepared.sent),
        ]
        left = [plan for plan in plans if plan[1]]
        return work + (self.bring(left, view, now_ns) if left else self.on_board(view, now_ns))

    def on_board(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        prepared = self.prepared
        plan = prepared.plan
        work: list[JobWork] = []
        if self._flown is not None:
            points = tuple(dict.fromkeys(end for leg in self._flown.segments for end in leg))
            work += [
                OnBoardChanged(on_board(plan, prepared.sent), points),
                GateInput(MissionLoaded(plan.name, len(plan.items))),
            ]
        sent = plan if prepared.fence else replace(plan, fence=Fence())
        text = f"{are(held(sent))} on board, read back equal{prepared.not_sent}"
        return work + self.end(OutcomeKind.COMPLETE, None, text)

    def leave(self) -> list[JobWork]:
        if not self._accepted:  # it has no verdict yet
            return self.refuse(Refusal(Code.OPERATOR_LOST, LEFT))
        return super().leave()

    def stop(self) -> list[JobWork]:
        if not self._accepted:
            return self.refuse(Refusal(Code.OPERATOR, STOPPED))
        return super().stop()
