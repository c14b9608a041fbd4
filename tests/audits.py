"""What the tests of the audit share: a record as a list of messages, changed and sealed anew."""

from __future__ import annotations

import json
import traceback
from collections.abc import Iterable
from pathlib import Path
from zlib import crc32

from gcs.audit.audit import AuditResult, audit
from gcs.audit.files import SessionFiles
from gcs.audit.messages import INPUT_TOPIC, Attachments, Stored
from gcs.record.writer import Recorder
from gcs.session.effects import Effect, Record
from gcs.session.inputs import Input, Wake
from gcs.session.setup import Setup
from gcs.station.frame_intake import FramesRaisedError
from gcs.station.session import Session

VERSION = "test"


def read(*paths: Path) -> tuple[list[Stored], Attachments]:
    """All messages of a session's files, and what is attached."""
    files = SessionFiles(list(paths))
    messages = list(files.messages())
    assert files.damaged == 0
    return messages, files.attachments()


def audited(
    messages: Iterable[Stored], attachments: Attachments, version: str = VERSION
) -> AuditResult:
    """By the version that recorded, where it recorded, unless another one is named."""
    return audit(messages, attachments, version, "")


def kind_of(message: Stored) -> str:
    """Of a message on /session/input; else empty."""
    if message.topic != INPUT_TOPIC:
        return ""
    kind = json.loads(message.data)["kind"]
    assert isinstance(kind, str)
    return kind


def with_data(message: Stored, data: bytes) -> Stored:
    return message._replace(data=data)


def resealed(messages: Iterable[Stored]) -> list[Stored]:
    """The same with counts and checksums that fit: only the replay can tell what was changed."""
    whole: list[Stored] = []
    unsealed: list[bytes] = []
    for message in messages:
        if kind_of(message) in ("RecordTick", "RecordEnd"):
            said = json.loads(message.data)
            said["data"] = {"messages": len(whole), "crc32": crc32(b"".join(unsealed))}
            message = with_data(message, json.dumps(said, separators=(",", ":")).encode())
            unsealed.clear()
        whole.append(message)
        unsealed.append(message.data)
    return whole


class RecordedSession:
    """A session and what is recorded of it, as the loop does it."""

    def __init__(self, recorder: Recorder, setup: Setup, start_ns: int) -> None:
        self.recorder = recorder
        self.now_ns = start_ns
        self.session = Session(setup, start_ns)

    def feed(self, given: Input) -> list[Effect]:
        """One input, a millisecond after the one before."""
        self.now_ns = now_ns = self.recorder.input_ns(self.now_ns + 1_000_000)
        effects: list[Effect] = []
        try:
            effects = self.session.handle(given, now_ns)
        except FramesRaisedError as raised:
            self._record([*raised.effects])
            for frame, error in raised.dropped:
                self.now_ns = self.recorder.input_ns(self.now_ns)
                self.fault(frame, "".join(traceback.format_exception(error)))
        except Exception:  # noqa: BLE001 - as in the loop
            self.fault(given, traceback.format_exc())
        self._record(effects)
        if now_ns >= self.recorder.deadline_ns:
            self.recorder.tick(now_ns)
        return effects

    def fault(self, given: Input, report: str) -> None:
        self._record(self.session.fault(given, report, self.now_ns))

    def wait(self, seconds: float) -> None:
        """Whatever the session wakes for."""
        until_ns = self.now_ns + round(seconds * 1e9)
        while self.session.deadline_ns < until_ns:
            self.now_ns = max(self.now_ns, self.session.deadline_ns)
            self.feed(Wake())

    def _record(self, effects: list[Effect]) -> None:
        for effect in effects:
            if isinstance(effect, Record):
                self.recorder.write(effect.item, self.now_ns)
