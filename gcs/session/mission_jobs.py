"""What can be asked about missions, one class each: upload, start, download, clear.

    Upload    READING -> (verdict) -> UPLOADING -> READING BACK -> on board
    Start     READING BACK -> (verdict: the gate's)
    Download  (verdict) -> DOWNLOADING -> WRITING -> done
    Clear     (verdict) -> CLEARING -> done

A mission leaves only if every leg of it clears the fence; what the vehicle then holds is read
back and compared in meaning.  Before it is started that is done again, as another station may
have put another mission in its place, and the path is verified anew from where the vehicle is
then.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TypeAlias

from gcs import ipc
from gcs.gate.airspace.verifier import Cleared
from gcs.gate.effects import Level, Outcome, OutcomeKind, Ruling
from gcs.gate.inputs import MissionLoaded
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import StartMission
from gcs.gate.states import State
from gcs.plan import compare
from gcs.plan.errors import PlanError
from gcs.plan.model import Plan
from gcs.plan.wire import WireItem, from_wire
from gcs.plan.writer import write
from gcs.protocol.effects import (
    Address,
    Cancel,
    Heard,
    Send,
    TransferDone,
    TransferEffect,
    TransferFailed,
    TransferProgress,
    Wake,
)
from gcs.protocol.mission import MissionClear, MissionDownload, MissionUpload
from gcs.protocol.transfer import Timing
from gcs.record.items import AttachmentItem, MissionItem
from gcs.session.effects import Emit, ReadFile, Record, WriteFile
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.paths import autopilot_name, path_of, verify
from gcs.session.plans import OnBoard, item_of, message_of, on_board, prepare
from gcs.session.telemetry import Telemetry
from gcs.session.work import AskGate, Decide, Log, ToGate, Work
from gcs.wire.ids import MissionType
from gcs.wire.messages import MissionItemInt

NODE = "mission"
EXIT_BAD_FILE = 4
JOB_NS = 60_000_000_000
ITEM_NS = 1_000_000_000
"""How long a transfer may take: a minute, and a second an item."""

Transfer: TypeAlias = MissionUpload | MissionDownload | MissionClear


@dataclass(frozen=True, slots=True)
class VehicleView:
    """What a job needs to know of the vehicle at this moment; it changes nothing of it."""

    telemetry: Telemetry
    state: State
    policy: Policy


@dataclass(frozen=True, slots=True)
class OnBoardChanged:
    """The mission that we know to be on board is now this one, or none."""

    on_board: OnBoard | None


@dataclass(frozen=True, slots=True)
class Asked:
    """Whose request a job is, and between whom its transfers run."""

    request_id: int
    client_id: int
    word: str
    own: Address
    timing: Timing


JobWork: TypeAlias = Work | OnBoardChanged


class Job(ABC):
    """One request about missions, from its start to its refusal or outcome (`over`)."""

    def __init__(self, asked: Asked) -> None:
        self.asked = asked
        self.over = False
        self._transfer: Transfer | None = None
        self._transfer_ends_ns = 0
        """A vehicle that keeps asking for the same item must not keep a job open for ever."""

    @property
    def deadline_ns(self) -> int | None:
        """When the transfer's present wait is over."""
        return self._transfer.deadline_ns if self._transfer else None

    @abstractmethod
    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        """The first step."""

    @abstractmethod
    def done(
        self, items: tuple[MissionItemInt, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """The transfer under way has ended well, with the items that came."""

    @abstractmethod
    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        """The answer to a ReadFile or WriteFile of this job."""

    def failed(
        self, result: int | None, text: str, view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """The transfer under way has failed: MAV_MISSION_RESULT, or None for no answer."""
        return self.end(OutcomeKind.ABORTED, _code_of(result), text)

    def leave(self) -> list[JobWork]:
        """The session ends: what is under way ends with it, and is told so."""
        return self.end(OutcomeKind.ABORTED, Code.OPERATOR_LOST, LEFT)

    def heard(self, heard: Heard, view: VehicleView, now_ns: int) -> list[JobWork]:
        if self._transfer is None:
            return []
        return self._follow(self._transfer.handle(heard, now_ns), view, now_ns)

    def wake(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        if self._transfer is None:
            return []
        given = Cancel() if now_ns >= self._transfer_ends_ns else Wake()
        return self._follow(self._transfer.handle(given, now_ns), view, now_ns)

    # --------------------------------------------------------------------------- transfer

    def begin(
        self, transfer: Transfer, items: int, view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """Start a transfer of about `items` items, in place of the one before."""
        self._transfer = transfer
        self._transfer_ends_ns = now_ns + JOB_NS + ITEM_NS * items
        return self._follow(transfer.start(now_ns), view, now_ns)

    def stop_transfer(self) -> None:
        self._transfer = None

    def parties(self, view: VehicleView) -> tuple[Address, Address, MissionType]:
        """Us, the vehicle, and that it is about the mission (not fence, not rally points)."""
        telemetry = view.telemetry
        return self.asked.own, Address(telemetry.sysid, telemetry.compid), MissionType.MISSION

    def progress_of(self) -> str:
        """What the transfer under way is called on the screen."""
        return self.asked.word

    def _follow(
        self, effects: list[TransferEffect], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        work: list[JobWork] = []
        for effect in effects:
            match effect:
                case Send():
                    work.append(effect)
                case TransferProgress(done, total):
                    client_id, what = self.asked.client_id, self.progress_of()
                    work.append(Emit(ipc.ProgressEvent(client_id, what, done, total, "items")))
                case TransferDone(_, items):
                    work += self.done(items, view, now_ns)
                case TransferFailed(_, result, text):
                    work += self.failed(result, text, view, now_ns)
        return work

    # ------------------------------------------------------------------- verdict, outcome

    def accept(self, evidence: tuple[tuple[str, float], ...] = ()) -> Decide:
        return Decide(self.asked.request_id, Ruling.ACCEPTED, None, evidence)

    def refuse(self, refusal: Refusal) -> list[JobWork]:
        self.over = True
        return [*refused(self.asked.request_id, self.asked.word, refusal)]

    def bad_file(self, text: str, hint: str = "") -> list[JobWork]:
        trouble = Emit(ipc.Trouble(text, hint, EXIT_BAD_FILE))
        return [trouble, *self.refuse(Refusal(Code.BAD_MISSION, text))]

    def end(self, kind: OutcomeKind, code: Code | None, sentence: str) -> list[JobWork]:
        self.over = True
        level = Level.INFO if kind is OutcomeKind.COMPLETE else Level.WARNING
        return [
            Outcome(self.asked.request_id, kind, code, sentence),
            Log(level, NODE, f"{self.asked.word}: {kind.value}: {sentence}"),
        ]


class Upload(Job):
    """A plan file, verified whole, brought on board and read back."""

    def __init__(self, asked: Asked, path: str) -> None:
        super().__init__(asked)
        self._path = path
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
        answer = verify_whole(prepared.plan, view, now_ns)
        if isinstance(answer, Refusal):
            return work + self.refuse(answer)
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


class Start(Job):
    """The mission on board, read back and verified once more; then the gate decides."""

    def __init__(self, asked: Asked, on_board: OnBoard) -> None:
        super().__init__(asked)
        self._on_board = on_board

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        download = MissionDownload(*self.parties(view), self.asked.timing)
        return self.begin(download, len(self._on_board.sent), view, now_ns)

    def progress_of(self) -> str:
        return "reading back"

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        return []

    def done(
        self, items: tuple[MissionItemInt, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """It is still the mission that was verified, and its path still clears: the gate's turn."""
        plan, sent = self._on_board.plan, self._on_board.sent
        received = tuple(item_of(message) for message in items)
        differences = compare.same_meaning(sent, received, autopilot_name(view.telemetry))
        if differences:
            text = f"another mission is on board than was verified: {differences[0]}"
            forget: list[JobWork] = [OnBoardChanged(None), ToGate(MissionLoaded("", 0))]
            return forget + self.refuse(Refusal(Code.BAD_MISSION, text))
        answer = verify_whole(plan, view, now_ns)
        if isinstance(answer, Refusal):
            return self.refuse(answer)
        self.over = True
        return [AskGate(self.asked.request_id, StartMission())]

    def failed(
        self, result: int | None, text: str, view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        sentence = f"what is on board could not be read: {text}"
        return self.refuse(Refusal(_code_of(result), sentence))

    def leave(self) -> list[JobWork]:
        return self.refuse(Refusal(Code.OPERATOR_LOST, LEFT))


class Download(Job):
    """What is on board, into a file where one is named."""

    def __init__(self, asked: Asked, path: str) -> None:
        super().__init__(asked)
        self._path = path

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        download = MissionDownload(*self.parties(view), self.asked.timing)
        return [self.accept(), *self.begin(download, 0, view, now_ns)]

    def done(
        self, items: tuple[MissionItemInt, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        autopilot = autopilot_name(view.telemetry)
        try:
            plan = from_wire(tuple(item_of(message) for message in items), autopilot)
            data = write(self._path, plan, autopilot).data if self._path else b""
        except PlanError as error:
            return self.end(OutcomeKind.ABORTED, Code.BAD_MISSION, str(error))
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
        trouble = Emit(ipc.Trouble(text, "", EXIT_BAD_FILE))
        return [trouble, *self.end(OutcomeKind.ABORTED, Code.BAD_MISSION, text)]


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


LEFT = "the station left before it was done"


def refused(request_id: int, word: str, refusal: Refusal) -> tuple[Work, ...]:
    """The verdict, and a line for the log."""
    text = f"{word}: refused {refusal.code.value}: {refusal.sentence}"
    return Decide(request_id, Ruling.REFUSED, refusal), Log(Level.WARNING, NODE, text)


def verify_whole(plan: Plan, view: VehicleView, now_ns: int) -> Cleared | Refusal:
    """The whole path of `plan`, from where the vehicle is now."""
    age_ns = round(view.policy.position_age_s * 1e9)
    path = path_of(plan, view.telemetry, now_ns, age_ns)
    if isinstance(path, Refusal):
        return path
    return verify(plan, path, view.policy, view.telemetry)


def _code_of(result: int | None) -> Code:
    return Code.NO_ANSWER if result is None else Code.VEHICLE_REFUSED
