"""What the jobs share: one request about what the vehicle keeps, its verdict and its ending."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

from gcs import ipc
from gcs.gate.effects import Level, Outcome, OutcomeKind, Ruling
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import LandedState
from gcs.protocol.effects import Address, Heard, Wake
from gcs.protocol.transfers.ftp import ANSWER_NS, FileRead
from gcs.session.speedup_waits import Times
from gcs.session.work import GiveVerdict, Log, TellOperator, Work
from gcs.vehicle.talk.telemetry import Telemetry

NODE = "vehicle"
AN_EVENT = 50
"""Parameters or files in one event."""


@dataclass(frozen=True, slots=True)
class Asked:
    """Whose request a job is, and between whom it runs."""

    request_id: int
    ask: ipc.Ask
    own: Address
    times: Times
    telemetry: Telemetry
    policy: Policy

    @property
    def target(self) -> Address:
        return Address(self.telemetry.sysid, self.telemetry.compid)

    @property
    def stands(self) -> bool:
        """The vehicle is disarmed, and not known to be in the air."""
        landed = self.telemetry.landed in (LandedState.UNDEFINED, LandedState.ON_GROUND)
        return self.telemetry.armed is False and landed

    def file(self, path: str, start: int = 0) -> FileRead:
        """A reader of one of the vehicle's files."""
        answer_ns = self.times.real_ns(ANSWER_NS)
        return FileRead(self.own, self.target, path, start, answer_ns)


class Job(ABC):
    """One request, from its start to its refusal or ending (`over`)."""

    def __init__(self, asked: Asked) -> None:
        self.asked = asked
        self.over = False
        self.accepted = False
        """The verdict was given, and the ending not yet."""

    @property
    @abstractmethod
    def deadline_ns(self) -> int | None:
        """When its present wait is over."""

    @abstractmethod
    def start(self, now_ns: int) -> list[Work]:
        """The first step."""

    @abstractmethod
    def handle(self, event: Heard | Wake, now_ns: int) -> list[Work]:
        """A message of the vehicle, or the deadline has passed."""

    def stopped(self) -> list[Work]:
        """What the vehicle is told where the job ends before its time."""
        return []

    # ------------------------------------------------------------------- verdict, outcome

    def accept(self) -> Work:
        self.accepted = True
        return GiveVerdict(self.asked.request_id, Ruling.ACCEPTED)

    def refuse(self, refusal: Refusal) -> list[Work]:
        self.over = True
        return refused(self.asked.request_id, self.asked.ask.word, refusal)

    def complete(self, sentence: str, *, logged: bool = False) -> list[Work]:
        """`logged`: it has changed something, and everybody is told."""
        self.over = True
        outcome = Outcome(self.asked.request_id, OutcomeKind.COMPLETE, None, sentence)
        return [outcome, Log(Level.INFO, NODE, sentence)] if logged else [outcome]

    def abort(self, code: Code, sentence: str) -> list[Work]:
        self.over = True
        text = f"{self.asked.ask.word}: {OutcomeKind.ABORTED.value}: {sentence}"
        return [
            Outcome(self.asked.request_id, OutcomeKind.ABORTED, code, sentence),
            Log(Level.WARNING, NODE, text),
        ]

    def tell(self, event: ipc.Event) -> Work:
        return TellOperator(self.asked.request_id, event)

    def progress(self, done: int, total: int, unit: str) -> Work:
        what = self.asked.ask.word.replace("_", " ")
        return self.tell(ipc.ProgressEvent(self.asked.ask.id, what, done, total, unit))


def refused(request_id: int, word: str, refusal: Refusal) -> list[Work]:
    """The verdict, and a line for the log."""
    text = f"{word}: refused {refusal.code.value}: {refusal.sentence}"
    return [
        GiveVerdict(request_id, Ruling.REFUSED, refusal),
        Log(Level.WARNING, NODE, text),
    ]
