"""What the tests of the audit share: a record as a list of messages, changed and sealed anew."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from zlib import crc32

from gcs.audit.audit import AuditResult, audit
from gcs.audit.files import SessionFiles
from gcs.audit.messages import INPUT_TOPIC, Attachments, Stored

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
