"""A plan file, or a mission that a MAVLink client has sent whole, brought on board and read back.

Of a client's mission the verified plan leaves, written out anew: whatever the client's items said
beside it (such as which of them is the current one) is not sent.
"""

from __future__ import annotations

from collections.abc import Sequence

from gcs import ipc
from gcs.bridge.client_plan import ClientPlan
from gcs.bridge.setup_policy.mission_items import refused_items
from gcs.gate.effects import Level
from gcs.gate.refusal import Code, Refusal
from gcs.plan.errors import PlanError
from gcs.plan.formats.writer import write
from gcs.report import AttachmentItem
from gcs.session.effects import ReadFile, Record
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.work import TellOperator
from gcs.vehicle.missions.jobs.bring_on_board import BringMission
from gcs.vehicle.missions.jobs.job import Asked, JobWork, VehicleView
from gcs.vehicle.missions.jobs.prepared import MOST_FINDINGS
from gcs.vehicle.missions.paths import autopilot_name, first_item
from gcs.vehicle.missions.plans import prepare, prepare_items
from gcs.wire.ids import MissionType

SMALL_BYTES = 20_000
"""A file that is no larger is read, checked and placed in one turn."""

SMALL_ITEMS = 50
"""So many are checked and placed in one turn."""


class Upload(BringMission):
    """A plan file, verified whole, brought on board and read back: all of it, or its fence or rally
    points alone."""

    def __init__(self, asked: Asked, path: str, kind: MissionType = MissionType.MISSION) -> None:
        super().__init__(asked, path)
        self._path = path
        self._kind = kind
        self._data = b""

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        return [ReadFile(self.asked.request_id, self._path)]

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        if not isinstance(news, FileRead):
            return []
        if news.data is None:
            return self.bad_file(f"{news.path}: {news.error}")
        self._data = news.data
        steps = prepare(news.path, news.data, view.telemetry, self._kind)
        return self.prepare_with(steps, len(news.data) <= SMALL_BYTES, view, now_ns)

    def bad_plan(self, error: PlanError) -> list[JobWork]:
        return self.bad_file(str(error), error.hint)

    def kept(self) -> list[JobWork]:
        return [Record(AttachmentItem.of_file(self._path, self._data))]


class ClientUpload(BringMission):
    """A client's mission, verified whole, brought on board and read back."""

    def __init__(self, asked: Asked, plan: ClientPlan) -> None:
        super().__init__(asked, plan.source)
        self._plan = plan
        self._as_file = b""

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        items = self._plan.items
        bridge = view.policy.bridge
        if refused := refused_items(items, first_item(view.telemetry), bridge):
            return self.refuse_for_all(refused[0], refused[1:])
        steps = prepare_items(self.source, items, view.telemetry)
        return self.prepare_with(steps, len(items) <= SMALL_ITEMS, view, now_ns)

    def learnt(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        try:
            written = write(self._name, self.prepared.plan, autopilot_name(view.telemetry))
            self._as_file = written.data
        except PlanError as error:
            return self.bad_plan(error)
        return super().learnt(view, now_ns)

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        return []

    def bad_plan(self, error: PlanError) -> list[JobWork]:
        return self.refuse(Refusal(Code.BAD_MISSION, str(error)))

    def found(self, refusal: Refusal) -> list[JobWork]:
        """The client reads each finding, too."""
        told = TellOperator(
            self.asked.request_id, ipc.Trouble(f"{refusal.code.value}: {refusal.sentence}")
        )
        return [*super().found(refusal), told]

    def warned(self, warnings: Sequence[str]) -> list[JobWork]:
        """The client reads them too, and those of the check before."""
        remarks = [text for level, text in self.prepared.remarks if level is Level.WARNING]
        told = [
            TellOperator(self.asked.request_id, ipc.Trouble(f"warning: {text}"))
            for text in (*remarks, *warnings)[:MOST_FINDINGS]
        ]
        return [*super().warned(warnings), *told]

    def kept(self) -> list[JobWork]:
        return [Record(AttachmentItem.of_file(self._name, self._as_file))]

    @property
    def _name(self) -> str:
        """What the record calls it."""
        return f"client_mission_{self.asked.request_id}.waypoints"
