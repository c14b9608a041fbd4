"""A dialogue with a station: how long it waits for a vehicle, and for the station itself."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.operator.client import Polled, Readable
from gcs.operator.conversation import TrackedRequest
from gcs.operator.dialogue import START_WAIT_S, Dialogue
from gcs.operator.errors import ExitError
from tests.unit.operator.fake_station import FakeConnection, FakeStation, NoInterrupts


class SlowStart(FakeConnection):
    """A station that takes its time to say its first word, as on a busy machine."""

    def __init__(self, station: FakeStation, start_s: float) -> None:
        super().__init__(station)
        self._start_s = start_s

    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> Polled:
        if self.time_s < self._start_s:
            self.time_s += timeout_s
            return Polled()
        return super().poll(timeout_s, also)


def ignore(event: ipc.Event, request: TrackedRequest | None) -> None:
    pass


def test_the_wait_for_a_vehicle_counts_from_the_first_word_of_the_station() -> None:
    dialogue = Dialogue(SlowStart(FakeStation(), start_s=5.0), NoInterrupts(), ignore)
    assert dialogue.wait_for_vehicle(0.5).vehicle == "1/1 px4 quadrotor"


def test_a_port_in_use_is_told_as_such_however_short_the_time_and_slow_the_machine() -> None:
    dialogue = Dialogue(SlowStart(FakeStation("port in use"), start_s=5.0), NoInterrupts(), ignore)
    with pytest.raises(ExitError, match="address in use") as failed:
        dialogue.wait_for_vehicle(0.5)
    assert failed.value.exit_code == ExitCode.ADDRESS_IN_USE


def test_a_station_that_never_says_a_word_is_a_bug_and_no_missing_vehicle() -> None:
    dialogue = Dialogue(SlowStart(FakeStation(), start_s=1e9), NoInterrupts(), ignore)
    with pytest.raises(ExitError, match="said nothing for 60 s") as failed:
        dialogue.wait_for_vehicle(0.5)
    assert failed.value.exit_code == ExitCode.BUG
    assert START_WAIT_S == 60.0
