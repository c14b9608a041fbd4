"""Bringing a mission on board: prepared, verified whole, uploaded, read back and compared.

A mission leaves only if all of it clears the fence; what the vehicle then holds is read back and
compared in meaning.  The plan's own fence and rally points leave before it, as a PX4 judges a
mission by the fence that it has; a plan without them leaves those on board as they are.

Where the plan comes from is the subclass's: a file (`upload.py`), or a client
(`upload.py`).
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence

from gcs.gate.effects import Level, OutcomeKind
from gcs.gate.inputs import MissionLoaded
from gcs.gate.refusal import Code, Refusal
from gcs.plan.legs import FlightPath
from gcs.plan.verify import Verification
from gcs.report import MissionItem
from gcs.session.effects import Record
from gcs.session.work import GateInput, Log
from gcs.vehicle.missions import plans
from gcs.vehicle.missions.jobs.job import (
    LEFT,
    NODE,
    STOPPED,
    Asked,
    JobWork,
    OnBoardChanged,
    VehicleView,
)
from gcs.vehicle.missions.jobs.prepared import PreparedJob
from gcs.vehicle.missions.jobs.transfers import BringingJob
from gcs.vehicle.missions.paths import cleared
from gcs.wire.ids import MissionType


class BringMission(PreparedJob, BringingJob):
    """A mission verified whole, brought on board and read back; `prepare_with` begins."""

    def __init__(self, asked: Asked, source: str) -> None:
        super().__init__(asked, source)
        self._flown: FlightPath | None = None
        """The path, once it has cleared and the request is accepted."""

    @abstractmethod
    def kept(self) -> list[JobWork]:
        """The plan as it came, for the record."""

    def warned(self, warnings: Sequence[str]) -> list[JobWork]:
        """It clears, and there is this to know about it: lines of the log."""
        return [Log(Level.WARNING, NODE, f"{self.source}: {text}") for text in warnings]

    def verified(self, found: Verification, view: VehicleView, now_ns: int) -> list[JobWork]:
        """The verdict; a mission that clears is on its way."""
        answer = cleared(found)
        if isinstance(answer, Refusal):
            return self.refuse_path(found, answer)
        work = self.warned(answer.warnings)
        self._flown = found.path
        work += [
            *self.kept(),
            self.accept(answer.evidence),
            GateInput(MissionLoaded("", 0)),
            OnBoardChanged(None),
        ]
        prepared = self.prepared
        parts = [
            (MissionType.FENCE, prepared.fence),
            (MissionType.RALLY, prepared.rally),
            (MissionType.MISSION, prepared.sent),
        ]
        return work + self.bring([part for part in parts if part[1]], view, now_ns)

    def on_board(self) -> list[JobWork]:
        assert self._flown is not None
        prepared = self.prepared
        plan = prepared.plan
        points = tuple(dict.fromkeys(end for leg in self._flown.segments for end in leg))
        work: list[JobWork] = [
            OnBoardChanged(plans.on_board(plan, prepared.sent)),
            Record(MissionItem(plan.name, points)),
            GateInput(MissionLoaded(plan.name, len(plan.items))),
        ]
        parts = [f"{len(plan.items)} items"]
        if prepared.fence:
            parts.append(f"a fence of {len(plan.fence.zones)} zones")
        if prepared.rally:
            parts.append(f"{len(prepared.rally)} rally points")
        text = f"{', '.join(parts)} are on board, read back equal{prepared.not_sent}"
        return work + self.end(OutcomeKind.COMPLETE, None, text)

    def leave(self) -> list[JobWork]:
        if self._flown is None:  # it has no verdict yet
            return self.refuse(Refusal(Code.OPERATOR_LOST, LEFT))
        return super().leave()

    def stop(self) -> list[JobWork]:
        if self._flown is None:
            return self.refuse(Refusal(Code.OPERATOR, STOPPED))
        return super().stop()
