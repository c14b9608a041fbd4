"""A bug of ours must not cost a vehicle: the last resort of the link."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from gcs import ipc
from gcs.config import StationConfig
from gcs.exit_codes import ExitCode
from gcs.gate.policy.parse import DEFAULT
from gcs.report import InputItem
from gcs.session import inputs
from gcs.session.effects import Effect, Emit, Finish, Record
from gcs.session.session import MAX_FAULTS, Session
from gcs.session.setup import Setup
from tests.unit.session import wire
from tests.unit.session.station import Script


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


def test_a_fault_on_the_clock_tells_a_vehicle_that_we_fly_to_hold() -> None:
    script = Script().hovering()
    effects = script.session.fault(inputs.Wake(), "ValueError: bad", script.now_ns)
    (hold,) = wire.sent(effects)
    assert (hold.get_type(), hold.command) == ("COMMAND_LONG", 176)  # DO_SET_MODE
    assert (hold.param2, hold.param3) == (4, 3)  # px4's AUTO.LOITER
    assert effects.index(finished(effects)[0]) == len(effects) - 1


@pytest.mark.parametrize("situation", [Script.met, Script.flying])
def test_a_vehicle_that_we_do_not_fly_is_left_alone(
    situation: Callable[[Script], Script],
) -> None:
    script = situation(Script())
    effects = script.session.fault(inputs.Wake(), "ValueError: bad", script.now_ns)
    assert wire.sent(effects) == []
    assert finished(effects)


def test_after_a_fault_that_ends_nothing_the_flight_goes_on() -> None:
    script = Script().hovering()
    script.session.fault(inputs.Datagram(0, b"?"), "ValueError: bad", script.now_ns)
    script.forget()
    script.run(1.0)
    assert len(script.sent("SET_POSITION_TARGET_LOCAL_NED")) == 20


def test_no_words_of_an_operator_who_joined_end_the_station(session: Session) -> None:
    for _ in range(2 * MAX_FAULTS):
        line = inputs.OperatorLine(2, ipc.Ask(1, "land"))
        effects = session.fault(line, "ValueError: bad", 1)
        assert not finished(effects)
        told = [e.event for e in effects if isinstance(e, Emit) and e.client == 2]
        assert isinstance(told[-1], ipc.Bye), "its connection ends"


def test_fault_upon_fault_ends_the_session(session: Session) -> None:
    for _ in range(MAX_FAULTS):
        assert not finished(session.fault(inputs.Datagram(0, b"?"), "ValueError: bad", 1))
    assert finished(session.fault(inputs.Datagram(0, b"?"), "ValueError: bad", 1))
