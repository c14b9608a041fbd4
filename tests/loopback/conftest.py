"""A share of all flights is recorded, and audited when its test is over."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import nullcontext
from zlib import crc32

import pytest

from gcs.audit.audit import audit
from gcs.audit.messages import Tape
from gcs.record.writer import Recorder
from tests.loopback.copies import each_flies_itself
from tests.loopback.flight import Flight
from tests.loopback.observed import START_NS

AUDITED_OF = 6
"""One test in so many, by its name; the flights of the others are not recorded."""


@pytest.fixture(autouse=True)
def _altered_programs_fly_themselves(request: pytest.FixtureRequest) -> Iterator[None]:
    with each_flies_itself() if "monkeypatch" in request.fixturenames else nullcontext():
        yield


@pytest.fixture(autouse=True)
def audited(request: pytest.FixtureRequest) -> Iterator[None]:
    """Whatever a flight was: the audit of its record finds no difference."""
    if crc32(request.node.nodeid.encode()) % AUDITED_OF:
        yield
        return
    tapes: list[Tape] = []

    def new_recorder() -> Recorder:
        tapes.append(Tape())
        return Recorder.without_file(tapes[-1], START_NS)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Flight, "new_recorder", staticmethod(new_recorder))
        yield
    for tape in tapes:
        result = audit(tape.take(), tape.attachments, "test", "")
        assert result.good, (result.notes, result.first[:5])
