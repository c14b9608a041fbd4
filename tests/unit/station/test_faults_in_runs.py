"""One frame of several that came together raises: the others are handled as if they came alone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final, TypeAlias

import msgspec
import pytest
from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.bridge import Bridge
from gcs.config import StationConfig
from gcs.report import FrameItem, FramesItem, InputItem
from gcs.session.effects import Effect, Record, Transmit
from gcs.session.inputs import ClientCame, Datagram
from gcs.station.frame_intake import FramesRaisedError
from gcs.station.vehicles import Vehicles
from gcs.vehicle.record_items import FaultKept
from gcs.wire.frame import Frame, plain_frames
from tests.unit.station import wire
from tests.unit.station.station import Script

CLIENT = 1
"""The first link after the one of the vehicle."""


Methods: TypeAlias = Sequence[tuple[type, str]]


def run_of(script: Script, *messages: Any) -> Datagram:
    """Messages of the vehicle that came together, a datagram each."""
    data = b"".join([script.sender.frame(message) for message in messages])
    frames = tuple(plain_frames(data))
    assert len(frames) == len(messages)
    return Datagram(0, data, frames)


def here(script: Script, north_m: float) -> Any:
    script.now_ns += wire.MS_NS
    return wire.position(script.now_ns // wire.MS_NS, (north_m, 0.0, 0.0))


LOOKED_AT: Final = ((Vehicles, "frame"), (Vehicles, "counted"))
"""Where a frame that somebody interprets comes by, alone or among others of its autopilot."""
PASSES: Final = ((Vehicles, "passes"), (Vehicles, "in_turn"))


def raises_at(monkeypatch: pytest.MonkeyPatch, methods: Methods, raw: bytes) -> None:
    """These methods fail whenever that frame is among those that they are given."""
    for of, name in methods:
        monkeypatch.setattr(of, name, failing(getattr(of, name), raw))


def failing(real: Callable[..., Any], raw: bytes) -> Callable[..., Any]:
    def fails(self: Any, *given: Any) -> Any:
        for each in given:
            frames = [each] if isinstance(each, Frame) else each
            if isinstance(frames, list | tuple) and any(
                isinstance(f, Frame) and f.raw == raw for f in frames
            ):
                raise ZeroDivisionError("planted")
        return real(self, *given)

    return fails


def raised_by(script: Script, given: Datagram) -> FramesRaisedError:
    with pytest.raises(FramesRaisedError) as caught:
        script.session.handle(given, script.now_ns)
    return caught.value


def recorded(effects: list[Effect]) -> list[bytes]:
    """Frames on the record, in order."""
    found: list[bytes] = []
    for effect in effects:
        if isinstance(effect, Record) and isinstance(effect.item, FrameItem):
            found.append(effect.item.raw)
        if isinstance(effect, Record) and isinstance(effect.item, FramesItem):
            found += effect.item.raws
    return found


def north_m(script: Script) -> float:
    telemetry = script.session.telemetry
    assert telemetry is not None
    assert telemetry.pos_ned is not None
    return telemetry.pos_ned[0]


def test_what_came_after_a_frame_that_raises_is_heard(monkeypatch: pytest.MonkeyPatch) -> None:
    script = Script().met()
    given = run_of(script, here(script, 1.0), wire.heartbeat(), here(script, 2.0))
    first, bad, last = (frame.raw for frame in given.frames)
    raises_at(monkeypatch, LOOKED_AT, bad)
    raised = raised_by(script, given)
    assert recorded(list(raised.effects)) == [first, last]
    assert north_m(script) == 2.0
    ((dropped, error),) = raised.dropped
    assert (dropped, str(error)) == (Datagram(0, bad), "planted")


def test_each_frame_that_raises_is_a_fault_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """As the record has it, an audit gives it to a session once more, and it raises there."""
    script = Script().met()
    given = run_of(script, wire.heartbeat(), here(script, 1.0))
    bad = given.frames[0].raw
    raises_at(monkeypatch, LOOKED_AT, bad)
    ((dropped, error),) = raised_by(script, given).dropped
    effects = script.session.fault(dropped, f"ZeroDivisionError: {error}", script.now_ns)
    items = [effect.item for effect in effects if isinstance(effect, Record)]
    (item,) = (item for item in items if isinstance(item, InputItem))
    kept = msgspec.json.decode(item.data, type=FaultKept)
    assert not kept.handled
    assert msgspec.json.decode(kept.input, type=Datagram) == Datagram(0, bad)
    with pytest.raises(ZeroDivisionError):
        script.session.handle(dropped, script.now_ns)


@pytest.mark.parametrize("methods", [PASSES, ((Bridge, "from_vehicle"),)])
def test_frames_that_only_pass_through_do_so_without_one_that_raises(
    monkeypatch: pytest.MonkeyPatch, methods: Methods
) -> None:
    script = Script(config=StationConfig(clients=["test"])).met()
    script.feed(ClientCame(CLIENT, "udp 1", stream=False))
    messages = [mavlink.MAVLink_vfr_hud_message(speed, 0.0, 0, 0, 0.0, 0.0) for speed in (1, 2, 3)]
    given = run_of(script, *messages)
    first, bad, last = (frame.raw for frame in given.frames)
    raises_at(monkeypatch, methods, bad)
    raised = raised_by(script, given)
    effects = list(raised.effects)
    assert recorded(effects) == [first, last]
    assert [dropped for dropped, _ in raised.dropped] == [Datagram(0, bad)]
    to_client = b"".join(e.data for e in effects if isinstance(e, Transmit) and e.link == CLIENT)
    assert first in to_client
    assert last in to_client
    assert to_client.count(first) == to_client.count(last) == 1


def test_a_frame_that_came_alone_raises_what_it_raised(monkeypatch: pytest.MonkeyPatch) -> None:
    script = Script().met()
    given = run_of(script, wire.heartbeat())
    raises_at(monkeypatch, LOOKED_AT, given.data)
    with pytest.raises(ZeroDivisionError):
        script.session.handle(given, script.now_ns)
