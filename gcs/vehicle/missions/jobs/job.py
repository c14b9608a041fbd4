"""What all jobs share: one request about missions, its transfer, its verdict and its outcome.

Upload    READING -> LEARNING -> VERIFYING -> (verdict) -> UPLOADING -> READING BACK -> on board;
          the last two for the fence and the rally points of the plan first
Start     LEARNING -> READING BACK -> VERIFYING -> AT THE FIRST ITEM -> (verdict: the gate's)
Download  (verdict) -> DOWNLOADING, each kind of plan -> WRITING -> done
Clear     (verdict) -> CLEARING -> done
PutFence  (verdict) -> UPLOADING -> READING BACK -> SETTING, each parameter -> done
SetCurrent  (verdict) -> TOLD -> done
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TypeAlias

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.frames import Vec3
from gcs.gate.effects import Level, Outcome, OutcomeKind, Ruling
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import State
from gcs.plan import compare
from gcs.plan.wire import WireItem
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
from gcs.protocol.mission_rewind import MissionRewind
from gcs.protocol.transfers.transfer import Timing
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.speedup_waits import Times
from gcs.session.work import GiveVerdict, Log, TellOperator, Work
from gcs.vehicle.missions.paths import autopilot_name
from gcs.vehicle.missions.plans import OnBoard
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import MissionType
from gcs.wire.messages import MissionItemInt

NODE = "mission"
STALLED_NS = 60_000_000_000
"""A transfer that gets no further for so long has failed, whatever is heard meanwhile."""

Transfer: TypeAlias = MissionUpload | MissionDownload | MissionClear | MissionRewind


@dataclass(frozen=True, slots=True)
class VehicleView:
    """What a job needs to know of the vehicle at this moment; it changes nothing of it."""

    telemetry: Telemetry
    state: State
    policy: Policy
    fence: tuple[WireItem, ...] | None = None
    """What is on board, as it was read last; None: it is not known."""
    rally: tuple[WireItem, ...] | None = None

    @property
    def in_air(self) -> bool:
        """It flies, or it may."""
        return self.state is not State.GROUNDED and self.telemetry.armed is not False


@dataclass(frozen=True, slots=True)
class OnBoardChanged:
    """The mission that we know to be on board is now this one, or none."""

    on_board: OnBoard | None
    path_ned: tuple[Vec3, ...] = ()


@dataclass(frozen=True, slots=True)
class OnBoardRefused:
    """A mission that this station did not bring was read, and does not clear: `why`.

    `items` as MISSION_CURRENT counts them, without home.
    """

    items: int
    why: str


@dataclass(frozen=True, slots=True)
class BeginsAt:
    """In the air the next start of the mission begins at this item; None: at the first."""

    seq: int | None


@dataclass(frozen=True, slots=True)
class PathVerified:
    """What the next start of the mission flies, from where the vehicle is."""

    legs_ned: tuple[tuple[Vec3, Vec3], ...]


@dataclass(frozen=True, slots=True)
class Asked:
    """Whose request a job is, and between whom its transfers run."""

    request_id: int
    client_id: int
    word: str
    own: Address
    timing: Timing
    times: Times


JobWork: TypeAlias = Work | OnBoardChanged | OnBoardRefused | BeginsAt | PathVerified


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
        return self.end(OutcomeKind.ABORTED, code_of(result), text)

    def leave(self) -> list[JobWork]:
        """The session ends: what is under way ends with it, and is told so."""
        return self.end(OutcomeKind.ABORTED, Code.OPERATOR_LOST, LEFT)

    def stop(self) -> list[JobWork]:
        """An operator stops it."""
        return self.end(OutcomeKind.ABORTED, Code.OPERATOR, STOPPED)

    def heard(self, heard: Heard, view: VehicleView, now_ns: int) -> list[JobWork]:
        if self._transfer is None:
            return []
        return self._follow(self._transfer.handle(heard, now_ns), view, now_ns)

    def wake(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        if self._transfer is None:
            return []
        given: Cancel | Wake = Wake()
        if now_ns >= self._transfer_ends_ns:
            given = Cancel(f"{self.progress_of()} took too long")
        return self._follow(self._transfer.handle(given, now_ns), view, now_ns)

    # --------------------------------------------------------------------------- transfer

    def begin(self, transfer: Transfer, view: VehicleView, now_ns: int) -> list[JobWork]:
        """Start a transfer, in place of the one before."""
        self._transfer = transfer
        self._transfer_ends_ns = now_ns + self.asked.times.real_ns(STALLED_NS)
        return self._follow(transfer.start(now_ns), view, now_ns)

    def stop_transfer(self) -> None:
        self._transfer = None

    def parties(
        self, view: VehicleView, kind: MissionType = MissionType.MISSION
    ) -> tuple[Address, Address, MissionType]:
        """Us, the vehicle, and what it is about: the mission, the fence or the rally points."""
        telemetry = view.telemetry
        return self.asked.own, Address(telemetry.sysid, telemetry.compid), kind

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
                    self._transfer_ends_ns = now_ns + self.asked.times.real_ns(STALLED_NS)
                    client_id, what = self.asked.client_id, self.progress_of()
                    progress = ipc.ProgressEvent(client_id, what, done, total, "items")
                    work.append(TellOperator(self.asked.request_id, progress))
                case TransferDone(_, items):
                    work += self.done(items, view, now_ns)
                case TransferFailed(_, result, text):
                    work += self.failed(result, text, view, now_ns)
        return work

    # ------------------------------------------------------------------- verdict, outcome

    def accept(self, evidence: tuple[tuple[str, float], ...] = ()) -> GiveVerdict:
        return GiveVerdict(self.asked.request_id, Ruling.ACCEPTED, None, evidence)

    def refuse(self, refusal: Refusal) -> list[JobWork]:
        self.over = True
        return [*refused(self.asked.request_id, self.asked.word, refusal)]

    def bad_file(self, text: str, hint: str = "") -> list[JobWork]:
        trouble = TellOperator(self.asked.request_id, ipc.Trouble(text, hint, ExitCode.BAD_FILE))
        return [trouble, *self.refuse(Refusal(Code.BAD_MISSION, text))]

    def end(self, kind: OutcomeKind, code: Code | None, sentence: str) -> list[JobWork]:
        self.over = True
        level = Level.INFO if kind is OutcomeKind.COMPLETE else Level.WARNING
        return [
            Outcome(self.asked.request_id, kind, code, sentence),
            Log(level, NODE, f"{self.asked.word}: {kind.value}: {sentence}"),
        ]


def may_not_fence(view: VehicleView, becomes: tuple[WireItem, ...]) -> Refusal | None:
    """Why the vehicle's fence must not become this one: in the air it is what is left when the link
    is down.  None on the ground, and where the vehicle has none or this very one."""
    if not view.in_air or view.fence == ():
        return None
    if view.fence is not None and not compare.same_meaning(
        becomes, view.fence, autopilot_name(view.telemetry)
    ):
        return None
    text = "the vehicle's own fence is neither cleared nor replaced in the air: land first"
    return Refusal(Code.IN_AIR, text)


LEFT = "the station left before it was done"
STOPPED = "stopped by an operator"


def refused(request_id: int, word: str, refusal: Refusal) -> tuple[Work, ...]:
    """The verdict, and a line for the log."""
    text = f"{word}: refused {refusal.code.value}: {refusal.sentence}"
    return GiveVerdict(request_id, Ruling.REFUSED, refusal), Log(Level.WARNING, NODE, text)


def code_of(result: int | None) -> Code:
    return Code.NO_ANSWER if result is None else Code.VEHICLE_REFUSED
