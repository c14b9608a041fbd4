"""A bug of ours must not cost a vehicle: the last resort of the link."""

from __future__ import annotations

from collections.abc import Callable

import msgspec
import pytest

from gcs import ipc
from gcs.config import StationConfig
from gcs.exit_codes import ExitCode
from gcs.gate.policy.parse import DEFAULT
from gcs.report import InputItem
from gcs.session import inputs
from gcs.session.effects import Effect, Emit, Finish, Record
from gcs.session.setup import Setup
from gcs.station.session import MAX_FAULTS, Session
from gcs.vehicle.record_items import FaultKept
from gcs.wire.codec import FrameWriter
from gcs.wire.messages import Heartbeat
from tests.unit.station import wire
from tests.unit.station.station import Script

HEARTBEAT = Heartbeat(
    custom_mode=0, type=2, autopilot=12, base_mode=128, system_status=4, mavlink_version=3
)


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


def fault_kept(effects: list[Effect]) -> FaultKept:
    items = [effect.item for effect in effects if isinstance(effect, Record)]
    (item,) = (item for item in items if isinstance(item, InputItem))
    return msgspec.json.decode(item.data, type=FaultKept)


def test_an_input_that_raised_is_recorded_whole_with_what_came_of_it(session: Session) -> None:
    """Nothing else is recorded of it, since what was under way is dropped."""
    session.handle(inputs.LinkEvent(0, "open"), 1)
    bad = inputs.Datagram(7, FrameWriter(1, 1).write(HEARTBEAT))  # there is no link 7 to ask it on
    with pytest.raises(KeyError):
        session.handle(bad, 2)
    kept = fault_kept(session.fault(bad, "KeyError: 7", 2))
    assert (kept.report, kept.handled, kept.kind, kept.at_ns) == (
        "KeyError: 7",
        False,
        "Datagram",
        2,
    )
    assert msgspec.json.decode(kept.input, type=inputs.Datagram) == bad


def test_a_fault_after_an_input_was_handled_says_so(session: Session) -> None:
    line = inputs.OperatorLine(2, ipc.Ask(1, "land"))
    session.handle(line, 1)
    kept = fault_kept(session.fault(line, "OSError: link", 1))
    assert (kept.handled, kept.kind) == (True, "OperatorLine")
    assert msgspec.json.decode(kept.input, type=inputs.OperatorLine) == line


def test_an_input_that_has_no_json_is_left_out_and_the_fault_is_told(session: Session) -> None:
    kept = fault_kept(session.fault(inputs.SimLine("\ud800"), "UnicodeEncodeError: no", 1))
    assert (kept.kind, bytes(kept.input)) == ("SimLine", b"null")


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
        told = [e.event for e in effects if isinstance(e, Emit) and e.operator == 2]
        assert isinstance(told[-1], ipc.Bye), "its connection ends"


def test_fault_upon_fault_ends_the_session(session: Session) -> None:
    for _ in range(MAX_FAULTS):
        assert not finished(session.fault(inputs.Datagram(0, b"?"), "ValueError: bad", 1))
    assert finished(session.fault(inputs.Datagram(0, b"?"), "ValueError: bad", 1))
