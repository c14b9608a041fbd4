"""The share of flights that is audited: any test may be chosen, and a difference is found."""

from __future__ import annotations

import pytest

from gcs.audit.messages import Tape
from gcs.record.writer import Recorder
from tests.loopback.flight import Flight
from tests.loopback.observed import START_NS
from tests.loopback.recorded_flights import RecordedFlight, flights_recorded


def flown() -> RecordedFlight:
    with flights_recorded() as recorded:
        Flight().run(0.5)
    (each,) = recorded
    return each


def test_a_flight_is_recorded_and_audited() -> None:
    each = flown()
    assert each.whole
    assert len(each.tape.messages) > 20
    each.audit()


def test_a_difference_is_found() -> None:
    each = flown()
    messages = each.tape.messages
    at = next(n for n, message in enumerate(messages) if message.is_frame and message.data[1] == 1)
    del messages[at]
    with pytest.raises(AssertionError, match="Difference"):
        each.audit()


def test_a_flight_that_was_recorded_and_has_no_message_on_its_tape_is_found() -> None:
    each = flown()
    each.tape.take()
    with pytest.raises(Exception, match="no set-up"):
        each.audit()


def test_a_test_may_have_a_recorder_of_its_own_from_any_time_on() -> None:
    with flights_recorded() as recorded:
        flight = Flight()
        flight.run(0.2)
        flight.recorder = Recorder.without_file(Tape(), START_NS)
        flight.run(0.2)
    (each,) = recorded
    assert not each.whole
    each.audit()


def test_a_recording_that_was_ended_is_audited_up_to_there() -> None:
    with flights_recorded() as recorded:
        flight = Flight()
        flight.run(0.2)
        flight.recorder = None
        flight.run(0.2)
    (each,) = recorded
    assert each.whole
    each.audit()


def test_a_flight_that_never_began_is_none() -> None:
    with flights_recorded() as recorded:
        Flight()
    (each,) = recorded
    each.audit()


def test_outside_nothing_is_recorded() -> None:
    with flights_recorded() as recorded:
        pass
    Flight().run(0.1)
    assert not recorded
