"""Upload: a plan file, verified whole, brought on board and read back."""

from __future__ import annotations

from gcs.plan.errors import PlanError
from gcs.report import AttachmentItem
from gcs.session.effects import ReadFile, Record
from gcs.session.inputs import FileRead, FileWritten
from gcs.vehicle.missions.jobs.bring_on_board import BringMission
from gcs.vehicle.missions.jobs.job import Asked, JobWork, VehicleView
from gcs.vehicle.missions.plans import prepare

SMALL_BYTES = 20_000
"""A file that is no larger is read, checked and placed in one turn."""


class Upload(BringMission):
    """A plan file, verified whole, brought on board and read back."""

    def __init__(self, asked: Asked, path: str) -> None:
        super().__init__(asked, path)
        self._path = path
        self._data = b""

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        return [ReadFile(self.asked.request_id, self._path)]

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        if not isinstance(news, FileRead):
            return []
        if news.data is None:
            return self.bad_file(f"{news.path}: {news.error}")
        self._data = news.data
        steps = prepare(news.path, news.data, view.telemetry)
        return self.prepare_with(steps, len(news.data) <= SMALL_BYTES, view, now_ns)

    def bad_plan(self, error: PlanError) -> list[JobWork]:
        return self.bad_file(str(error), error.hint)

    def kept(self) -> list[JobWork]:
        return [Record(AttachmentItem.of_file(self._path, self._data))]
