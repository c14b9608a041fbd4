"""A fresh session and a recorder without a file: the recorded inputs in, messages out."""

from __future__ import annotations

import traceback
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from gcs.audit.inputs import CannotReadError, input_of_fault
from gcs.audit.keys import RecordedKey, keys_of
from gcs.audit.messages import Attachments, Stored, Tape
from gcs.audit.turns import Given, RecorderTurn, Unreadable
from gcs.record.writer import Recorder
from gcs.session.effects import AskRule, Effect, Finish, ReadFile, Record, WriteFile
from gcs.session.inputs import FileRead, FileWritten, Input, RuleSaid
from gcs.station.session import Session
from gcs.vehicle.record_items import FaultKept, Start


@dataclass(frozen=True, slots=True)
class Surprise:
    """What happened otherwise than recorded, beside the messages; both in words."""

    recorded: str
    reproduced: str


class Replay:
    """Does again what a session did.  `surprises` are those of the last turn."""

    def __init__(self, start: Start) -> None:
        self._tape = Tape()
        self._recorder = Recorder.without_file(self._tape, start.start_ns)
        self._key = RecordedKey()
        keys = keys_of(start.setup.config, self._key)
        self.policy = start.setup.policy
        self._session = Session(start.setup, start.start_ns, keys)
        self._asked: list[tuple[type, int, str]] = []
        self.rule_asked: dict[int, AskRule] = {}
        """Questions for the operator's own rule that have no answer yet, by request."""
        self._finished = False
        self.surprises: list[Surprise] = []

    @property
    def attachments(self) -> Attachments:
        return self._tape.attachments

    def turn(self, given: Given, now_ns: int, forged: Collection[bytes] = ()) -> Sequence[Stored]:
        """All messages that are recorded of `given` and of what it leads to.

        `forged`: those frames in it that were recorded as signed with another key.
        """
        self.surprises = []
        self._key.forged = forged
        match given:
            case RecorderTurn.TICK:
                self._recorder.repeat(now_ns)
            case RecorderTurn.END:
                self._recorder.end(now_ns)
            case Unreadable(why):
                self._surprise("an input that cannot be read", why)
            case FaultKept():
                self._fault(given)
            case _:
                self._input(given, now_ns)
        return self._tape.take()

    def _surprise(self, recorded: str, reproduced: str) -> None:
        self.surprises.append(Surprise(recorded, reproduced))

    def _input(self, given: Input, now_ns: int) -> None:
        if self._finished:
            self._surprise("the session went on", "the session has ended")
        if isinstance(given, FileRead | FileWritten):
            self._answered(given)
        elif isinstance(given, RuleSaid) and given.request_id not in self.rule_asked:
            asked_of = f"the own rule was asked about request {given.request_id}"
            self._surprise(asked_of, "it was not")
        try:
            effects = self._session.handle(given, now_ns)
        except Exception:  # noqa: BLE001 - as in the loop: what raised there may raise here
            report = traceback.format_exc()
            self._surprise("no exception", report.splitlines()[-1])
            effects = self._session.fault(given, report, now_ns)
        self._perform(effects, now_ns)

    def _answered(self, answer: FileRead | FileWritten) -> None:
        """Only what was asked for is answered."""
        asked = (type(answer), answer.token, answer.path)
        if asked in self._asked:
            self._asked.remove(asked)
        else:
            verb = "read" if isinstance(answer, FileRead) else "written"
            self._surprise(f"{answer.path} was to be {verb}", "it was not")

    def _fault(self, kept: FaultKept) -> None:
        """An input that raised must raise again, in the same words."""
        try:
            given = input_of_fault(kept)
        except CannotReadError as error:
            self._surprise("an input that raised", str(error))
            return
        recorded = kept.report.splitlines()[-1] if kept.report else ""
        if not kept.handled:
            reproduced = "no exception"
            try:
                self._session.handle(given, kept.at_ns)
            except Exception:  # noqa: BLE001 - the one that was recorded
                reproduced = traceback.format_exc().splitlines()[-1]
            if reproduced != recorded:
                self._surprise(recorded, reproduced)
        self._perform(self._session.fault(given, kept.report, kept.at_ns), kept.at_ns)

    def _perform(self, effects: Sequence[Effect], now_ns: int) -> None:
        for effect in effects:
            match effect:
                case Record(item):
                    self._recorder.write(item, now_ns)
                case ReadFile(token, path):
                    self._asked.append((FileRead, token, path))
                case WriteFile(token, path):
                    self._asked.append((FileWritten, token, path))
                case AskRule(request_id):
                    self.rule_asked[request_id] = effect
                case Finish():
                    self._finished = True
                case _:
                    pass  # what is sent is recorded; what operators are told is made of that
