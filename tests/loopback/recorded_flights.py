"""Flights that are recorded without knowing it, and the audit of what was recorded."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import pytest

from gcs.audit.audit import audit
from gcs.audit.messages import Tape
from gcs.record.writer import Recorder
from tests.loopback.flight import Flight
from tests.loopback.observed import START_NS


@dataclass(frozen=True)
class RecordedFlight:
    """A flight and what it was given to be recorded with."""

    flight: Flight
    recorder: Recorder
    tape: Tape

    @property
    def whole(self) -> bool:
        """Whether all of the flight is on the tape, up to where its recording was ended.

        A test that gives its flight another recorder has part of it there, or nothing, and looks at
        that record itself.  A flight that was never begun has recorded nothing.
        """
        own = self.flight.recorder not in (self.recorder, None)
        return bool(self.flight.records) and not own

    def audit(self) -> None:
        """Fails where a fresh session does not do the same."""
        if self.whole:
            result = audit(self.tape.take(), self.tape.attachments, "test", "")
            assert result.good, (result.notes, result.first[:5])


@contextmanager
def flights_recorded() -> Iterator[list[RecordedFlight]]:
    """All flights that begin meanwhile, but those for which a test makes recorders itself."""
    recorded: list[RecordedFlight] = []

    def new_recorder(flight: Flight) -> Recorder:
        tape = Tape()
        recorder = Recorder.without_file(tape, START_NS)
        recorded.append(RecordedFlight(flight, recorder, tape))
        return recorder

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Flight, "new_recorder", new_recorder)
        yield recorded
