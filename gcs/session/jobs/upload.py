"""Upload: a plan file, verified whole, brought on board and read back.

A mission leaves only if all of it clears the fence; what the vehicle then holds is read back and
compared in meaning.  The plan's own fence and rally points leave before it, as a PX4 judges a
mission by the fence that it has; a plan without them leaves those on board as they are.
"""

from __future__ import annotations

from dataclasses import dataclass

from gcs.gate.effects import Level, OutcomeKind
from gcs.gate.inputs import MissionLoaded
from gcs.gate.refusal import Code, Refusal
from gcs.plan import compare
from gcs.plan.errors import PlanError
from gcs.plan.legs import FlightPath
from gcs.plan.verify import Verification
from gcs.plan.wire import WireItem
from gcs.protocol.mission import MissionDownload, MissionUpload
from gcs.report import AttachmentItem, MissionItem
from gcs.session.effects import ReadFile, Record
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.jobs.job import LEFT, NODE, Asked, JobWork, OnBoardChanged, VehicleView
from gcs.session.jobs.verified import VerifiedJob
from gcs.session.paths import autopilot_name, cleared
from gcs.session.plans import Prepared, item_of, message_of, on_board, prepare
from gcs.session.work import Log, ToGate
from gcs.steps import Steps
from gcs.wire.ids import MissionType
from gcs.wire.messages import MissionItemInt

SMALL_BYTES = 20_000
"""A file that is no larger is read, checked and placed in one turn."""
_NAMES = {MissionType.MISSION: "mission", MissionType.FENCE: "fence", MissionType.RALLY: "rally"}


@dataclass(frozen=True, slots=True)
class _Plan:
    """The plan that is on its way."""

    path: str
    data: bytes
    prepared: Prepared


class Upload(VerifiedJob):
    """A plan file, verified whole, brought on board and read back."""

    def __init__(self, asked: Asked, path: str) -> None:
        super().__init__(asked)
        self._path = path
        self._file: FileRead | None = None
        self._preparing: Steps[Prepared | Refusal] | None = None
        self._prepare_ns = 0
        self._plan: _Plan | None = None
        self._flown: FlightPath | None = None
        self._left: list[tuple[MissionType, tuple[WireItem, ...]]] = []
        """What is to be brought on board yet; the first is under way."""

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        return [ReadFile(self.asked.request_id, self._path)]

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        if not isinstance(news, FileRead):
            return []
        if news.data is None:
            return self.bad_file(f"{news.path}: {news.error}")
        self._file = news
        self._preparing = prepare(news.path, news.data, view.telemetry)
        return self._prepare_on(view, now_ns)

    @property
    def deadline_ns(self) -> int | None:
        return super().deadline_ns if self._preparing is None else self._prepare_ns

    def wake(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        if self._preparing is not None:
            return self._prepare_on(view, now_ns) if now_ns >= self._prepare_ns else []
        return super().wake(view, now_ns)

    def _prepare_on(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        """A step more on the way from bytes to a plan that can be verified, or to why not."""
        assert self._preparing is not None
        assert self._file is not None
        self._prepare_ns = self.after_pause_ns(now_ns)
        small = len(self._file.data or b"") <= SMALL_BYTES
        try:
            next(self._preparing)
            while small:
                next(self._preparing)
        except StopIteration as over:
            self._preparing = None
            return self._prepared(over.value, view, now_ns)
        except PlanError as error:
            self._preparing = None
            return self.bad_file(str(error), error.hint)
        return []

    def _prepared(
        self, prepared: Prepared | Refusal, view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        assert self._file is not None
        assert self._file.data is not None
        path, data = self._file.path, self._file.data
        if isinstance(prepared, Refusal):
            return self.refuse(prepared)
        self._plan = _Plan(path, data, prepared)
        work: list[JobWork] = [
            Log(level, NODE, f"{path}: {text}") for level, text in prepared.remarks
        ]
        return work + self.learn(view, now_ns)

    def learnt(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        assert self._plan is not None
        return self.verify(self._plan.prepared.plan, view, now_ns)

    def verified(self, found: Verification, view: VehicleView, now_ns: int) -> list[JobWork]:
        """The verdict; a mission that clears is on its way."""
        assert self._plan is not None
        answer = cleared(found)
        if isinstance(answer, Refusal):
            return self.refuse(answer)
        path, prepared = self._plan.path, self._plan.prepared
        work: list[JobWork] = [
            Log(Level.WARNING, NODE, f"{path}: {text}") for text in answer.warnings
        ]
        self._flown = found.path
        work += [
            Record(AttachmentItem.of_file(path, self._plan.data)),
            self.accept(answer.evidence),
            ToGate(MissionLoaded("", 0)),
            OnBoardChanged(None),
        ]
        self._left = [
            (kind, items)
            for kind, items in (
                (MissionType.FENCE, prepared.fence),
                (MissionType.RALLY, prepared.rally),
                (MissionType.MISSION, prepared.sent),
            )
            if items
        ]
        return work + self._bring(view, now_ns)

    def _bring(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        kind, items = self._left[0]
        messages = tuple(message_of(item) for item in items)
        upload = MissionUpload(*self.parties(view, kind), messages, self.asked.timing)
        return self.begin(upload, len(items), view, now_ns)

    def progress_of(self) -> str:
        reads_back = isinstance(self._transfer, MissionDownload)
        return "reading back" if reads_back else self.asked.word

    def done(
        self, items: tuple[MissionItemInt, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        if isinstance(self._transfer, MissionUpload):
            return self._read_back(view, now_ns)
        return self._compare(tuple(item_of(message) for message in items), view, now_ns)

    def failed(
        self, result: int | None, text: str, view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """Where only the last ack went missing, what is on board settles it."""
        kind, _ = self._left[0]
        if isinstance(self._transfer, MissionUpload) and self._transfer.all_given:
            log = Log(Level.WARNING, NODE, f"upload: {text}: reading back")
            return [log, *self._read_back(view, now_ns)]
        if kind is not MissionType.MISSION:
            text = f"the plan's {_NAMES[kind]} was not brought on board: {text}"
        return super().failed(result, text, view, now_ns)

    def _read_back(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        kind, items = self._left[0]
        download = MissionDownload(*self.parties(view, kind), self.asked.timing)
        return self.begin(download, len(items), view, now_ns)

    def _compare(
        self, received: tuple[WireItem, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """Believe what the vehicle holds, not what was sent."""
        kind, sent = self._left[0]
        differences = compare.same_meaning(sent, received, autopilot_name(view.telemetry))
        if differences:
            text = f"read back, it is another {_NAMES[kind]}: {differences[0]}"
            return self.end(OutcomeKind.ABORTED, Code.VEHICLE_REFUSED, text)
        del self._left[0]
        return self._bring(view, now_ns) if self._left else self._on_board()

    def _on_board(self) -> list[JobWork]:
        assert self._plan is not None
        assert self._flown is not None
        prepared = self._plan.prepared
        plan = prepared.plan
        points = tuple(dict.fromkeys(end for leg in self._flown.segments for end in leg))
        work: list[JobWork] = [
            OnBoardChanged(on_board(plan, prepared.sent)),
            Record(MissionItem(plan.name, points)),
            ToGate(MissionLoaded(plan.name, len(plan.items))),
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
