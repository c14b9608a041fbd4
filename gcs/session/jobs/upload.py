"""Upload: a plan file, verified whole, brought on board and read back.

A mission leaves only if every leg of it clears the fence; what the vehicle then holds is read
back and compared in meaning.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from gcs.gate.effects import Level, OutcomeKind
from gcs.gate.inputs import MissionLoaded
from gcs.gate.refusal import Code, Refusal
from gcs.plan import compare
from gcs.plan.errors import PlanError
from gcs.plan.model import Plan
from gcs.plan.wire import WireItem
from gcs.protocol.mission import MissionDownload, MissionUpload
from gcs.report import AttachmentItem, MissionItem
from gcs.session.effects import ReadFile, Record
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.jobs.job import (
    LEFT,
    NODE,
    Asked,
    Job,
    JobWork,
    OnBoardChanged,
    VehicleView,
)
from gcs.session.paths import autopilot_name, path_of, verify
from gcs.session.plans import item_of, message_of, on_board, prepare
from gcs.session.work import Log, ToGate
from gcs.wire.messages import MissionItemInt

RETURN_HEIGHT_WAIT_NS = 15_000_000_000
"""How long a plan waits for the vehicle's return height, which a lossy link may lose many times."""
LOOK_NS = 50_000_000


@dataclass(frozen=True, slots=True)
class _Waiting:
    """A plan that was read before the return height was known; how long it waits for that."""

    path: str
    data: bytes
    until_ns: int
    look_ns: int


class Upload(Job):
    """A plan file, verified whole, brought on board and read back."""

    def __init__(self, asked: Asked, path: str) -> None:
        super().__init__(asked)
        self._path = path
        self._waiting: _Waiting | None = None
        self._plan: Plan | None = None
        self._sent: tuple[WireItem, ...] = ()

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        return [ReadFile(self.asked.request_id, self._path)]

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        if not isinstance(news, FileRead):
            return []
        if news.data is None:
            return self.bad_file(f"{news.path}: {news.error}")
        return self._prepare(news.path, news.data, view, now_ns)

    @property
    def deadline_ns(self) -> int | None:
        return self._waiting.look_ns if self._waiting else super().deadline_ns

    def wake(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        waiting = self._waiting
        if waiting is None:
            return super().wake(view, now_ns)
        if view.telemetry.return_told or now_ns >= waiting.until_ns:
            return self._prepare(waiting.path, waiting.data, view, now_ns)
        self._waiting = replace(waiting, look_ns=now_ns + LOOK_NS)
        return []

    def _waits(self, path: str, data: bytes, view: VehicleView, now_ns: int) -> bool:
        """Whether a return that could not be verified waits for the return height, and is to."""
        before, self._waiting = self._waiting, None
        if before is not None or view.telemetry.return_told:
            return False
        until_ns = now_ns + self.asked.times.real_ns(RETURN_HEIGHT_WAIT_NS)
        self._waiting = _Waiting(path, data, until_ns, now_ns + LOOK_NS)
        return True

    def _prepare(self, path: str, data: bytes, view: VehicleView, now_ns: int) -> list[JobWork]:
        """From bytes to a verified plan on its way, or to the reason why not."""
        try:
            prepared = prepare(path, data, view.telemetry)
        except PlanError as error:
            return self.bad_file(str(error), error.hint)
        if isinstance(prepared, Refusal):
            return self.refuse(prepared)
        work: list[JobWork] = [
            Log(level, NODE, f"{path}: {text}") for level, text in prepared.remarks
        ]
        answer = verify(prepared.plan, view.policy, view.telemetry, now_ns)
        if isinstance(answer, Refusal):
            blocked = answer.code is Code.RTL_BLOCKED
            if blocked and self._waits(path, data, view, now_ns):
                return []
            return work + self.refuse(answer)
        work += [Log(Level.WARNING, NODE, f"{path}: {text}") for text in answer.warnings]
        self._plan, self._sent = prepared.plan, prepared.sent
        work += [
            Record(AttachmentItem(path, "application/octet-stream", data)),
            self.accept(answer.evidence),
            ToGate(MissionLoaded("", 0)),
            OnBoardChanged(None),
        ]
        items = tuple(message_of(item) for item in self._sent)
        upload = MissionUpload(*self.parties(view), items, self.asked.timing)
        return work + self.begin(upload, len(items), view, now_ns)

    def progress_of(self) -> str:
        reads_back = isinstance(self._transfer, MissionDownload)
        return "reading back" if reads_back else self.asked.word

    def done(
        self, items: tuple[MissionItemInt, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        if isinstance(self._transfer, MissionUpload):
            return self._read_back(view, now_ns)
        return self._compare(tuple(item_of(message) for message in items), view)

    def failed(
        self, result: int | None, text: str, view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """Where only the last ack went missing, what is on board settles it."""
        if isinstance(self._transfer, MissionUpload) and self._transfer.all_given:
            log = Log(Level.WARNING, NODE, f"upload: {text}: reading back")
            return [log, *self._read_back(view, now_ns)]
        return super().failed(result, text, view, now_ns)

    def _read_back(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        download = MissionDownload(*self.parties(view), self.asked.timing)
        return self.begin(download, len(self._sent), view, now_ns)

    def _compare(self, received: tuple[WireItem, ...], view: VehicleView) -> list[JobWork]:
        """Believe what the vehicle holds, not what was sent."""
        plan = self._plan
        assert plan is not None
        differences = compare.same_meaning(self._sent, received, autopilot_name(view.telemetry))
        if differences:
            text = f"read back, it is another mission: {differences[0]}"
            return self.end(OutcomeKind.ABORTED, Code.VEHICLE_REFUSED, text)
        work: list[JobWork] = [OnBoardChanged(on_board(plan, self._sent))]
        path = path_of(plan, view.telemetry)
        if not isinstance(path, Refusal):
            points = tuple(dict.fromkeys(end for leg in path.segments for end in leg))
            work.append(Record(MissionItem(plan.name, points)))
        work.append(ToGate(MissionLoaded(plan.name, len(plan.items))))
        text = f"{len(plan.items)} items are on board, read back equal"
        return work + self.end(OutcomeKind.COMPLETE, None, text)

    def leave(self) -> list[JobWork]:
        if self._plan is None:  # it has no verdict yet
            return self.refuse(Refusal(Code.OPERATOR_LOST, LEFT))
        return super().leave()
