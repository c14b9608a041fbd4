"""Adopt: the mission on board, which this station did not bring, is read, verified and started.

It was there before, or another station has put it there.  It is read whole and verified like any
other; from then on it is known as ours.  Then the gate decides on its start.
"""

from __future__ import annotations

from gcs.gate.inputs import MissionLoaded
from gcs.gate.refusal import Code, Refusal
from gcs.plan.errors import PlanError
from gcs.plan.verify import Verification
from gcs.plan.wire import WireItem
from gcs.protocol.mission import MissionDownload
from gcs.report import MissionItem
from gcs.session.effects import Record
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.jobs.job import Asked, JobWork, OnBoardChanged, VehicleView, code_of
from gcs.session.jobs.prepared import PreparedJob
from gcs.session.jobs.start import LEFT, STOPPED
from gcs.session.jobs.verified import first_item
from gcs.session.paths import cleared
from gcs.session.plans import item_of, on_board, prepare_items
from gcs.session.work import ToGate
from gcs.wire.messages import MissionItemInt

SOURCE = "the mission on board"
SMALL_ITEMS = 50


class Adopt(PreparedJob):
    """The mission on board, read and verified; then the gate decides on its start."""

    def __init__(self, asked: Asked) -> None:
        super().__init__(asked, SOURCE)
        self._received: tuple[WireItem, ...] = ()

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        download = MissionDownload(*self.parties(view), self.asked.timing)
        return self.begin(download, 0, view, now_ns)

    def progress_of(self) -> str:
        return "reading what is on board"

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        return []

    def done(
        self, items: tuple[MissionItemInt, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        if self.rewinding:
            return self.ask_gate()
        self.stop_transfer()
        self._received = tuple(item_of(message) for message in items)
        if len(self._received) <= first_item(view.telemetry):
            return self.ask_gate()  # which knows of none
        steps = prepare_items(SOURCE, self._received, view.telemetry)
        return self.prepare_with(steps, len(items) <= SMALL_ITEMS, view, now_ns)

    def bad_plan(self, error: PlanError) -> list[JobWork]:
        return self.refuse(Refusal(Code.BAD_MISSION, str(error)))

    def verified(self, found: Verification, view: VehicleView, now_ns: int) -> list[JobWork]:
        answer = cleared(found)
        if isinstance(answer, Refusal):
            return self.refuse_path(found, answer)
        plan = self.prepared.plan
        points = tuple(dict.fromkeys(end for leg in found.path.segments for end in leg))
        return [
            OnBoardChanged(on_board(plan, self._received)),
            Record(MissionItem(plan.name, points)),
            ToGate(MissionLoaded(plan.name, len(plan.items))),
            *self.begin_at_first(self._received, view, now_ns),
        ]

    def failed(
        self, result: int | None, text: str, view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        sentence = text if self.rewinding else f"what is on board could not be read: {text}"
        return self.refuse(Refusal(code_of(result), sentence))

    def leave(self) -> list[JobWork]:
        """Its operator, or the station, goes before the verdict."""
        return self.refuse(Refusal(Code.OPERATOR_LOST, LEFT))

    def stop(self) -> list[JobWork]:
        """It has no verdict yet, so it is refused."""
        return self.refuse(Refusal(Code.OPERATOR, STOPPED))
