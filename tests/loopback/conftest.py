"""A share of all flights is recorded, and audited when its test is over."""

from __future__ import annotations

from collections.abc import Iterator
from zlib import crc32

import pytest

from gcs.audit.audit import audit
from gcs.audit.messages import Tape
from gcs.record.writer import Recorder
from tests.loopback.flight import Flight
from tests.loopback.looks import START_NS

AUDITED_OF = 6
"""One test in so many, by its name; the flights of the others are not recorded."""


@pytest.fixture(autouse=True)
def audited(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Whatever a flight was: the audit of its record finds no difference."""
    if crc32(request.node.nodeid.encode()) % AUDITED_OF:
        yield
        return
    tapes: list[Tape] = []

    def new_recorder() -> Recorder:
        tapes.append(Tape())
        return Recorder.without_file(tapes[-1], START_NS)

    monkeypatch.setattr(Flight, "new_recorder", staticmethod(new_recorder))
    yield
    for tape in tapes:
        result = audit(tape.take(), tape.attachments, "test", "")
        assert result.good, (result.notes, result.first[:5])
