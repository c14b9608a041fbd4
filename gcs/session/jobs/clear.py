"""Clear: the mission on board is taken off."""

from __future__ import annotations

from gcs.gate.effects import OutcomeKind
from gcs.gate.inputs import MissionLoaded
from gcs.protocol.mission import MissionClear
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.jobs.job import (
    Job,
    JobWork,
    OnBoardChanged,
    VehicleView,
)
from gcs.session.work import ToGate
from gcs.wire.messages import MissionItemInt


class Clear(Job):
    """The mission on board taken off."""

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        clear = MissionClear(*self.parties(view), self.asked.timing)
        return [self.accept(), *self.begin(clear, 0, view, now_ns)]

    def done(
        self, items: tuple[MissionItemInt, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        gone: list[JobWork] = [OnBoardChanged(None), ToGate(MissionLoaded("", 0))]
        return gone + self.end(OutcomeKind.COMPLETE, None, "no mission is on board")

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        return []
