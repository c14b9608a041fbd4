"""A bug of ours must not cost a vehicle: the last resort of the link."""

from __future__ import annotations

import pytest

from gcs.config import StationConfig
from gcs.exit_codes import ExitCode
from gcs.gate.policy.parse import DEFAULT
from gcs.report import InputItem
from gcs.session import inputs
from gcs.session.effects import Effect, Emit, Finish, Record
from gcs.session.session import MAX_FAULTS, Session
from gcs.session.setup import Setup


@pytest.fixture
def session() -> Session:
    return Session(Setup(StationConfig(), "test", DEFAULT, "", ("a link",), ""), now_ns=0)


def finished(effects: list[Effect]) -> list[Finish]:
    return [effect for effect in effects if isinstance(effect, Finish)]


def test_bytes_that_we_cannot_take_are_dropped_said_and_recorded(session: Session) -> None:
    effects = session.fault(inputs.Datagram(0, b"?"), "Traceback\nValueError: bad", 1)
    assert not finished(effects)
    items = [effect.item for effect in effects if isinstance(effect, Record)]
    assert [item.kind for item in items if isinstance(item, InputItem)] == ["Fault"]
    said = [effect.event for effect in effects if isinstance(effect, Emit)]
    assert "ValueError: bad" in repr(said)
    assert session.handle(inputs.Wake(), 2)


def test_a_fault_on_the_clock_ends_the_session(session: Session) -> None:
    (finish,) = finished(session.fault(inputs.Wake(), "ValueError: bad", 1))
    assert finish.exit_code == ExitCode.BUG


def test_fault_upon_fault_ends_the_session(session: Session) -> None:
    for _ in range(MAX_FAULTS):
        assert not finished(session.fault(inputs.Datagram(0, b"?"), "ValueError: bad", 1))
    assert finished(session.fault(inputs.Datagram(0, b"?"), "ValueError: bad", 1))
