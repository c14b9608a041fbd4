"""Missions in the session: read, checked, verified whole, uploaded, read back, then flown.

    asked -> READING -> (verdict) -> UPLOADING -> READING_BACK -> on board
    asked -> DOWNLOADING -> WRITING -> done            asked -> CLEARING -> done
    start asked -> READING_BACK -> (verdict) -> the gate

A mission leaves only if every leg of it clears the fence; what the vehicle then holds is read
back and compared in meaning.  Before it is started that is done again, as another station may
have put another mission in its place, and the path is verified anew from where the vehicle is
then.  One job at a time; a second is refused BUSY.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from gcs import ipc
from gcs.config import LinkConfig
from gcs.gate import effects, inputs, requests
from gcs.gate.airspace.verifier import Cleared
from gcs.gate.effects import Level, OutcomeKind, Ruling
from gcs.gate.refusal import Code, Refusal
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
from gcs.protocol.transfer import SPEC_TIMING, Timing
from gcs.record.items import AttachmentItem, MissionItem
from gcs.session.gatekeeper import Gatekeeper
from gcs.session.outbox import Outbox
from gcs.session.paths import autopilot_name, path_of, verify
from gcs.session.plans import OnBoard, item_of, message_of, on_board, prepare
from gcs.session.ports import FileRead, FileWritten, ReadFile, WriteFile
from gcs.wire.ids import MissionState, MissionType
from gcs.wire.messages import MissionCurrent, MissionItemInt, MissionItemReached

MISSION_WORDS = frozenset({"mission_upload", "mission_download", "mission_clear", "mission_start"})
NODE = "mission"
EXIT_BAD_FILE = 4
JOB_NS = 60_000_000_000
ITEM_NS = 1_000_000_000
"""How long a job may take: a minute, and a second an item."""

Transfer: TypeAlias = MissionUpload | MissionDownload | MissionClear


@dataclass(slots=True)
class _Job:
    """The one transfer under way, from its request to its ending."""

    request_id: int
    client_id: int
    word: str
    path: str
    plan: Plan | None = None
    sent: tuple[WireItem, ...] = ()
    transfer: Transfer | None = None
    deadline_ns: int | None = None
    """A vehicle that keeps asking for the same item must not keep a job open for ever."""


class MissionDesk:
    """Takes the `mission_*` requests; everything that moves still goes through the gate."""

    def __init__(self, config: LinkConfig, keeper: Gatekeeper, out: Outbox) -> None:
        self._own = Address(config.sysid, config.compid)
        self._timing = Timing(
            round(SPEC_TIMING.wait_ns * config.speedup),
            round(SPEC_TIMING.item_wait_ns * config.speedup),
        )
        self._keeper = keeper
        self._out = out
        self._job: _Job | None = None
        self._on_board: OnBoard | None = None
        self._left = False
        self._was_active = False
        """Whether the vehicle was seen flying the mission that was started last."""

    @property
    def deadline_ns(self) -> int | None:
        """When a transfer's wait is over."""
        transfer = self._job.transfer if self._job else None
        return transfer.deadline_ns if transfer else None

    def forget(self, now_ns: int) -> None:
        """The vehicle restarted or was away: nothing is known of what it has on board."""
        if self._on_board is not None:
            self._on_board = None
            self._keeper.give(inputs.MissionLoaded("", 0), now_ns)

    # ------------------------------------------------------------------------------ input

    def ask(self, ask: ipc.Ask, now_ns: int) -> None:
        """One of `MISSION_WORDS`."""
        request_id = self._keeper.requests.open(ask.id, ask.word)
        refusal = self._cannot(ask)
        if refusal is not None:
            self._told_refused(request_id, ask.word, refusal, now_ns)
            return
        job = _Job(request_id, ask.id, ask.word, ask.path)
        match ask.word:
            case "mission_upload":
                self._job = job
                self._out.put(ReadFile(request_id, ask.path))
            case "mission_download":
                self._accept(job)
                self._begin(job, MissionDownload(*self._parties(), self._timing), now_ns)
            case "mission_clear":
                self._accept(job)
                self._begin(job, MissionClear(*self._parties(), self._timing), now_ns)
            case _:
                self._start(job, now_ns)

    def _start(self, job: _Job, now_ns: int) -> None:
        """What cannot be flown at all the gate refuses at once; else look at what is on board."""
        on_board, now = self._on_board, self._keeper.gate
        if on_board is None or now.state not in (State.HOVERING, State.GROUNDED):
            self._keeper.request(job.request_id, requests.StartMission(), now_ns)
            return
        job.plan, job.sent = on_board.plan, on_board.sent
        self._begin(job, MissionDownload(*self._parties(), self._timing), now_ns)

    def file(self, news: FileRead | FileWritten, now_ns: int) -> None:
        """The answer to a ReadFile or WriteFile of ours."""
        job = self._job
        if job is None or news.token != job.request_id:
            return
        match news:
            case FileRead(_, path, None, error):
                self._bad_file(job, f"{path}: {error}", "", now_ns)
            case FileRead(_, path, bytes() as data, _):
                self._read(job, path, data, now_ns)
            case FileWritten(_, path, ""):
                self._end(job, OutcomeKind.COMPLETE, None, f"written to {path}", now_ns)
            case FileWritten(_, path, error):
                text = f"{path}: {error}"
                self._out.emit(ipc.Trouble(text, "", EXIT_BAD_FILE))
                self._end(job, OutcomeKind.ABORTED, Code.BAD_MISSION, text, now_ns)

    def heard(self, heard: Heard, now_ns: int) -> None:
        """A message of the vehicle: for the transfer under way, or about progress in flight."""
        match heard.message:
            case MissionCurrent(seq=seq, mission_state=state):
                self._was_active |= state == MissionState.ACTIVE
                over = state == MissionState.COMPLETE and self._was_active
                self._progress(seq, over, now_ns)
            case MissionItemReached(seq=seq):
                self._reached(seq, now_ns)
        job = self._job
        if job is not None and job.transfer is not None:
            self._follow(job, job.transfer.handle(heard, now_ns), now_ns)

    def wake(self, now_ns: int) -> None:
        job = self._job
        if job is not None and job.transfer is not None:
            overdue = job.deadline_ns is not None and now_ns >= job.deadline_ns
            given = Cancel() if overdue else Wake()
            self._follow(job, job.transfer.handle(given, now_ns), now_ns)

    def leave(self, now_ns: int) -> None:
        """The session ends: what is under way ends with it, and is told so."""
        self._left = True
        job = self._job
        if job is None:
            return
        sentence = "the station left before it was done"
        if job.word == "mission_start" or (job.word == "mission_upload" and job.plan is None):
            self._refuse(job, Refusal(Code.OPERATOR_LOST, sentence), now_ns)
        else:
            self._end(job, OutcomeKind.ABORTED, Code.OPERATOR_LOST, sentence, now_ns)

    # ------------------------------------------------------------------------- judgements

    def _cannot(self, ask: ipc.Ask) -> Refusal | None:
        """What refuses any job before it begins."""
        state = self._keeper.gate.state
        if self._left:
            return Refusal(Code.OPERATOR_LOST, "the station is leaving")
        if self._keeper.seen is None or state is State.NO_VEHICLE:
            return Refusal(Code.NO_VEHICLE, "no vehicle is heard")
        if self._job is not None:
            return Refusal(Code.BUSY, f"{self._job.word} is still under way")
        if ask.word == "mission_upload" and not ask.path:
            return Refusal(Code.BAD_MISSION, "which file?")
        if ask.word in ("mission_upload", "mission_clear"):
            if state is State.STALE:
                return Refusal(Code.STALE, "the vehicle's position is too old")
            if state is State.FLYING_MISSION:
                return Refusal(Code.BUSY, "the mission on board is being flown")
        return None

    def _refusal_of(self, plan: Plan, now_ns: int) -> Refusal | Cleared:
        """The whole path, from where the vehicle is now."""
        seen, policy = self._keeper.seen, self._keeper.policy
        assert seen is not None
        path = path_of(plan, seen, now_ns, round(policy.position_age_s * 1e9))
        return path if isinstance(path, Refusal) else verify(plan, path, policy, seen)

    def _read(self, job: _Job, path: str, data: bytes, now_ns: int) -> None:
        """From bytes to a verified plan on its way, or to the reason why not."""
        seen = self._keeper.seen
        assert seen is not None
        try:
            prepared = prepare(path, data, seen)
        except PlanError as error:
            self._bad_file(job, str(error), error.hint, now_ns)
            return
        if isinstance(prepared, Refusal):
            self._refuse(job, prepared, now_ns)
            return
        for level, text in prepared.remarks:
            self._out.say(level, NODE, f"{path}: {text}", now_ns)
        answer = self._refusal_of(prepared.plan, now_ns)
        if isinstance(answer, Refusal):
            self._refuse(job, answer, now_ns)
            return
        job.plan, job.sent = prepared.plan, prepared.sent
        self._out.record(AttachmentItem(path, "application/octet-stream", data))
        self._accept(job, answer.evidence)
        self._keeper.give(inputs.MissionLoaded("", 0), now_ns)
        self._on_board = None
        items = tuple(message_of(item) for item in job.sent)
        self._begin(job, MissionUpload(*self._parties(), items, self._timing), now_ns)

    # --------------------------------------------------------------------------- transfer

    def _parties(self) -> tuple[Address, Address, MissionType]:
        seen = self._keeper.seen
        assert seen is not None
        return self._own, Address(seen.sysid, seen.compid), MissionType.MISSION

    def _begin(self, job: _Job, transfer: Transfer, now_ns: int) -> None:
        self._job = job
        job.transfer = transfer
        job.deadline_ns = now_ns + JOB_NS + ITEM_NS * len(job.sent)
        self._follow(job, transfer.start(now_ns), now_ns)

    def _follow(self, job: _Job, effects: list[TransferEffect], now_ns: int) -> None:
        for effect in effects:
            match effect:
                case Send(message):
                    self._keeper.send(message)
                case TransferProgress(done, total):
                    what = "reading back" if job.sent and self._fetching(job) else job.word
                    self._out.emit(ipc.ProgressEvent(job.client_id, what, done, total, "items"))
                case TransferDone(_, items):
                    self._done(job, items, now_ns)
                case TransferFailed(_, result, text):
                    self._failed(job, result, text, now_ns)

    @staticmethod
    def _fetching(job: _Job) -> bool:
        return isinstance(job.transfer, MissionDownload)

    def _done(self, job: _Job, items: tuple[MissionItemInt, ...], now_ns: int) -> None:
        match job.transfer:
            case MissionUpload():
                self._begin(job, MissionDownload(*self._parties(), self._timing), now_ns)
            case MissionDownload() if job.word == "mission_upload":
                self._compare(job, tuple(item_of(message) for message in items), now_ns)
            case MissionDownload() if job.word == "mission_start":
                self._fly(job, tuple(item_of(message) for message in items), now_ns)
            case MissionDownload():
                self._downloaded(job, tuple(item_of(message) for message in items), now_ns)
            case _:
                self._on_board = None
                self._keeper.give(inputs.MissionLoaded("", 0), now_ns)
                self._end(job, OutcomeKind.COMPLETE, None, "no mission is on board", now_ns)

    def _failed(self, job: _Job, result: int | None, text: str, now_ns: int) -> None:
        """Where only the last ack went missing, what is on board settles it."""
        if isinstance(job.transfer, MissionUpload) and job.transfer.all_given:
            self._out.say(Level.WARNING, NODE, f"upload: {text}: reading back", now_ns)
            self._begin(job, MissionDownload(*self._parties(), self._timing), now_ns)
            return
        code = Code.NO_ANSWER if result is None else Code.VEHICLE_REFUSED
        if job.word == "mission_start":
            self._refuse(job, Refusal(code, f"what is on board could not be read: {text}"), now_ns)
            return
        self._end(job, OutcomeKind.ABORTED, code, text, now_ns)

    def _fly(self, job: _Job, received: tuple[WireItem, ...], now_ns: int) -> None:
        """It is still the mission that was verified, and its path still clears: the gate's turn."""
        seen, plan = self._keeper.seen, job.plan
        assert seen is not None
        assert plan is not None
        differences = compare.same_meaning(job.sent, received, autopilot_name(seen))
        if differences:
            self.forget(now_ns)
            text = f"another mission is on board than was verified: {differences[0]}"
            self._refuse(job, Refusal(Code.BAD_MISSION, text), now_ns)
            return
        answer = self._refusal_of(plan, now_ns)
        if isinstance(answer, Refusal):
            self._refuse(job, answer, now_ns)
            return
        self._job = None
        self._was_active = False
        self._keeper.request(job.request_id, requests.StartMission(), now_ns)

    def _compare(self, job: _Job, received: tuple[WireItem, ...], now_ns: int) -> None:
        """Believe what the vehicle holds, not what was sent."""
        seen, plan = self._keeper.seen, job.plan
        assert seen is not None
        assert plan is not None
        differences = compare.same_meaning(job.sent, received, autopilot_name(seen))
        if differences:
            text = f"read back, it is another mission: {differences[0]}"
            self._end(job, OutcomeKind.ABORTED, Code.VEHICLE_REFUSED, text, now_ns)
            return
        self._on_board = on_board(plan, job.sent)
        seen.mission_total = len(job.sent)
        path = path_of(plan, seen)
        if not isinstance(path, Refusal):
            points = tuple(dict.fromkeys(end for leg in path.segments for end in leg))
            self._out.record(MissionItem(plan.name, points))
        self._keeper.give(inputs.MissionLoaded(plan.name, len(plan.items)), now_ns)
        text = f"{len(plan.items)} items are on board, read back equal"
        self._end(job, OutcomeKind.COMPLETE, None, text, now_ns)

    def _downloaded(self, job: _Job, received: tuple[WireItem, ...], now_ns: int) -> None:
        seen = self._keeper.seen
        assert seen is not None
        try:
            plan = from_wire(received, autopilot_name(seen))
            data = write(job.path, plan, autopilot_name(seen)).data if job.path else b""
        except PlanError as error:
            self._end(job, OutcomeKind.ABORTED, Code.BAD_MISSION, str(error), now_ns)
            return
        if job.path:
            job.transfer = None
            self._out.put(WriteFile(job.request_id, job.path, data))
        else:
            self._end(
                job, OutcomeKind.COMPLETE, None, f"{len(plan.items)} items are on board", now_ns
            )

    def _reached(self, seq: int, now_ns: int) -> None:
        seen, on_board = self._keeper.seen, self._on_board
        if seen is None or on_board is None:
            return
        last = on_board.last_seq is not None and seq >= on_board.last_seq
        if last and on_board.loops:
            # It may be over now; whether it is, the vehicle's mode tells.
            seq = (seen.mission_total or 1) - 1
        self._progress(seq, last and not on_board.loops, now_ns)

    def _progress(self, seq: int, finished: bool, now_ns: int) -> None:
        seen, on_board = self._keeper.seen, self._on_board
        if seen is not None and on_board is not None:
            over = finished and on_board.last_seq is not None
            self._keeper.give(inputs.MissionSeen(seq, seen.mission_total or 0, over), now_ns)

    # ------------------------------------------------------------------- verdict, ending

    def _accept(self, job: _Job, evidence: tuple[tuple[str, float], ...] = ()) -> None:
        self._keeper.verdict(job.request_id, Ruling.ACCEPTED, None, evidence)

    def _refuse(self, job: _Job, refusal: Refusal, now_ns: int) -> None:
        self._job = None
        self._told_refused(job.request_id, job.word, refusal, now_ns)

    def _told_refused(self, request_id: int, word: str, refusal: Refusal, now_ns: int) -> None:
        self._keeper.verdict(request_id, Ruling.REFUSED, refusal)
        text = f"{word}: refused {refusal.code.value}: {refusal.sentence}"
        self._out.say(Level.WARNING, NODE, text, now_ns)

    def _bad_file(self, job: _Job, text: str, hint: str, now_ns: int) -> None:
        self._out.emit(ipc.Trouble(text, hint, EXIT_BAD_FILE))
        self._refuse(job, Refusal(Code.BAD_MISSION, text), now_ns)

    def _end(
        self, job: _Job, ended: OutcomeKind, code: Code | None, sentence: str, now_ns: int
    ) -> None:
        self._job = None
        self._keeper.ending(effects.Outcome(job.request_id, ended, code, sentence))
        level = Level.INFO if ended is OutcomeKind.COMPLETE else Level.WARNING
        self._out.say(level, NODE, f"{job.word}: {ended.value}: {sentence}", now_ns)
