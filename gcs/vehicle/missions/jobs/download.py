"""Download: what is on board, into a file where one is named."""

from __future__ import annotations

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.gate.effects import OutcomeKind
from gcs.gate.refusal import Code
from gcs.plan.errors import PlanError
from gcs.plan.formats.writer import write
from gcs.plan.item_messages import item_of
from gcs.plan.wire import from_wire
from gcs.protocol.mission import MissionDownload
from gcs.session.effects import WriteFile
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.work import TellOperator
from gcs.vehicle.missions.jobs.job import Asked, Job, JobWork, VehicleView
from gcs.vehicle.missions.paths import autopilot_name
from gcs.wire.messages import MissionItemInt


class Download(Job):
    """What is on board, into a file where one is named."""

    def __init__(self, asked: Asked, path: str) -> None:
        super().__init__(asked)
        self._path = path

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        download = MissionDownload(*self.parties(view), self.asked.timing)
        return [self.accept(), *self.begin(download, view, now_ns)]

    def done(
        self, items: tuple[MissionItemInt, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        autopilot = autopilot_name(view.telemetry)
        try:
            plan = from_wire(tuple(item_of(message) for message in items), autopilot)
            data = write(self._path, plan, autopilot).data if self._path else b""
        except PlanError as error:
            return self.end(OutcomeKind.ABORTED, Code.BAD_MISSION, str(error))
        if self._path and not plan.items:
            text = f"no mission is on board: {self._path} was not written"
            return self.end(OutcomeKind.ABORTED, Code.NO_MISSION, text)
        if self._path:
            self.stop_transfer()
            return [WriteFile(self.asked.request_id, self._path, data)]
        text = f"{len(plan.items)} items are on board"
        return self.end(OutcomeKind.COMPLETE, None, text)

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        if not isinstance(news, FileWritten):
            return []
        if not news.error:
            return self.end(OutcomeKind.COMPLETE, None, f"written to {news.path}")
        text = f"{news.path}: {news.error}"
        trouble = TellOperator(self.asked.request_id, ipc.Trouble(text, "", ExitCode.BAD_FILE))
        return [trouble, *self.end(OutcomeKind.ABORTED, Code.BAD_MISSION, text)]
