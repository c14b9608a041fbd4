"""Whatever MAVLink clients send, the vehicle stays inside, and the record of it is sound.

`make test` and `make thorough` fly a share, `make soak` all; a failure names its seed.
"""

from __future__ import annotations

import pytest

from gcs.audit.audit import audit
from gcs.audit.messages import Tape
from gcs.bridge.catalog import Kind, Row
from gcs.record.writer import Recorder
from tests.loopback import bridge_clients
from tests.loopback.flight import Flight
from tests.loopback.observed import START_NS
from tests.shares import seeds

FLIGHTS = 200
FLIGHTS_IN_EACH_RUN = 6
PILOTS_IN_EACH_RUN = 2
LEANERS_IN_EACH_RUN = 2

flights = pytest.mark.parametrize("seed", seeds(6, FLIGHTS_IN_EACH_RUN, FLIGHTS))


@flights
def test_no_client_gets_the_vehicle_out_of_the_fence(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every one of these flights is recorded and audited, not a share of them."""
    audited(seed, monkeypatch)


@pytest.mark.parametrize("seed", seeds(2, PILOTS_IN_EACH_RUN, FLIGHTS))
@pytest.mark.thorough
def test_no_joystick_gets_the_vehicle_out_of_the_fence(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    audited(seed, monkeypatch, bridge_clients.PILOTS)


@pytest.mark.parametrize(
    "seed",
    [
        pytest.param(seed, marks=[pytest.mark.soak] if number >= LEANERS_IN_EACH_RUN else [])
        for number, seed in enumerate(range(4, 4 + FLIGHTS))
    ],
)
def test_no_attitude_gets_the_vehicle_out_of_the_fence(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    audited(seed, monkeypatch, bridge_clients.LEANERS)


def audited(
    seed: int,
    monkeypatch: pytest.MonkeyPatch,
    acts: tuple[bridge_clients.Act, ...] | None = None,
) -> None:
    """A hostile flight, and the audit of its record."""
    tape = Tape()
    recorder = Recorder.without_file(tape, START_NS)
    monkeypatch.setattr(Flight, "new_recorder", lambda _flight: recorder)
    try:
        flight = bridge_clients.flown(seed, acts=acts)
    except AssertionError as broken:
        raise AssertionError(f"hostile flight {seed}: {broken}") from broken
    assert flight.decisions("refused"), "nothing that was sent was refused"
    result = audit(tape.take(), tape.attachments, "test", "")
    assert result.good, (seed, result.notes, result.first[:5])
    print(f"{seed}: nearest to leaving the fence {-flight.outmost_m:.2f} m; {flight.passed}")


def test_a_frame_that_slips_through_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """Here every message is called harmless where the bridge looks it up."""
    row = Row("ANY", Kind.HARMLESS, "planted")
    monkeypatch.setattr("gcs.bridge.judge.judge.message_row", lambda msgid: row)
    with pytest.raises(AssertionError, match="reaches the vehicle"):
        bridge_clients.flown(0)


def test_a_vehicle_outside_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    flight = bridge_clients.HostileFlight(0)
    flight.connected()
    monkeypatch.setattr(flight, "truth_enu", lambda: (33.0, 0.0, 10.0))
    with pytest.raises(AssertionError, match=r"is 3\.00 m outside"):
        flight.flies(0.2)


def test_a_vehicle_in_the_tower_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    flight = bridge_clients.HostileFlight(0)
    flight.connected()
    monkeypatch.setattr(flight, "truth_enu", lambda: (16.0, 0.0, 10.0))
    with pytest.raises(AssertionError, match="m outside"):
        flight.flies(0.2)
