"""Adopt: the mission on board, which this station did not bring, is read, verified and started.

It was there before, or another station has put it there.  It is read whole and verified like any
other, and what it carries is judged as a client's; from then on it is known as ours.  Then the gate
decides on its start.
"""

from __future__ import annotations

from gcs.bridge.setup_policy.mission_items import refused_items
from gcs.gate.inputs import MissionLoaded
from gcs.gate.refusal import Code, Refusal
from gcs.plan.errors import PlanError
from gcs.plan.verify import Verification
from gcs.plan.wire import WireItem
from gcs.protocol.mission import MissionDownload
from gcs.session.work import GateInput
from gcs.vehicle.missions.jobs.job import (
    Asked,
    JobWork,
    OnBoardChanged,
    OnBoardRefused,
    VehicleView,
)
from gcs.vehicle.missions.jobs.prepared import PreparedJob
from gcs.vehicle.missions.jobs.starting import StartingJob
from gcs.vehicle.missions.paths import cleared, first_item
from gcs.vehicle.missions.plans import on_board, prepare_items

SOURCE = "the mission on board"
SMALL_ITEMS = 50


class Adopt(PreparedJob, StartingJob):
    """The mission on board, read and verified; then the gate decides on its start."""

    waits_for_home = False
    """Nothing is started half a minute after it was asked for."""

    def __init__(self, asked: Asked) -> None:
        super().__init__(asked, SOURCE)
        self._received: tuple[WireItem, ...] = ()
        self._countable = 0
        """Items of it that the vehicle counts: all but home."""

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        download = MissionDownload(*self.parties(view), self.asked.timing)
        return self.begin(download, view, now_ns)

    def progress_of(self) -> str:
        return "reading what is on board"

    def read_back(
        self, received: tuple[WireItem, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        self.stop_transfer()
        self._received = received
        self._countable = len(received) - first_item(view.telemetry)
        if self._countable <= 0:
            return self.ask_gate()  # which knows of none
        refused = refused_items(received, first_item(view.telemetry), view.policy.bridge)
        if refused:
            return self.refuse_for_all(refused[0], refused[1:])
        steps = prepare_items(SOURCE, self._received, view.telemetry)
        return self.prepare_with(steps, len(received) <= SMALL_ITEMS, view, now_ns)

    def bad_plan(self, error: PlanError) -> list[JobWork]:
        refusal = Refusal(Code.BAD_MISSION, str(error))
        return [OnBoardRefused(self._countable, refusal.sentence), *self.refuse(refusal)]

    def verify_anew(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        return self.verify(self.prepared.plan, view, now_ns)

    def verified(self, found: Verification, view: VehicleView, now_ns: int) -> list[JobWork]:
        answer = cleared(found)
        if isinstance(answer, Refusal):
            kept = OnBoardRefused(self._countable, answer.sentence)
            return [kept, *self.refuse_path(found, answer)]
        self.note_path(found.path)
        plan = self.prepared.plan
        points = tuple(dict.fromkeys(end for leg in found.path.segments for end in leg))
        return [
            OnBoardChanged(on_board(plan, self._received), points),
            GateInput(MissionLoaded(plan.name, len(plan.items))),
            *self.begin_at(None, self._received, view, now_ns),
        ]
