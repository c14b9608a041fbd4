"""What only passes through: not decoded, recorded frame by frame, sent on as it came."""

from __future__ import annotations

import random
from collections.abc import Iterable

import pytest

from gcs.config import StationConfig
from gcs.report import Direction
from gcs.session.effects import Effect, Transmit
from gcs.session.inputs import ClientCame, Datagram
from gcs.station import frame_intake
from gcs.station.links import MAX_DATAGRAM, datagrams
from gcs.vehicle import received_frames
from gcs.vehicle.interpreted_messages import INTERPRETED
from gcs.wire.codec import FrameWriter
from gcs.wire.dialect import MESSAGES, MESSAGES_BY_NAME
from gcs.wire.frame import plain_frames
from gcs.wire.messages import CLASSES, LocalPositionNed
from tests.shares import one_in
from tests.unit.station import told, wire
from tests.unit.station.station import Script

UNTARGETED = ("HIGHRES_IMU", "VFR_HUD", "ATTITUDE_QUATERNION", "SERVO_OUTPUT_RAW")
CLIENTS = (1, 2)


def frame(writer: FrameWriter, name: str, payload: bytes | None = None) -> bytes:
    definition = MESSAGES_BY_NAME[name]
    if payload is None:
        payload = random.Random(definition.msgid).randbytes(definition.max_len)
    return writer.write_payload(definition.msgid, payload)


def bridged() -> Script:
    """A vehicle is heard, and two clients, 255/190 and 254/190."""
    script = Script(config=StationConfig(clients=["test"]))
    script.hear(wire.heartbeat())
    for link, sysid in zip(CLIENTS, (255, 254), strict=True):
        script.feed(ClientCame(link, f"udp 127.0.0.1:{link}", False))
        script.feed(Datagram(link, wire.Sender(sysid, 190).frame(beat_of_a_client())))
    return script


def beat_of_a_client() -> wire.Message:
    return wire.heartbeat(wire.NO_AUTOPILOT, type_=wire.GCS)


def sent(effects: Iterable[Effect]) -> list[tuple[int, bytes]]:
    return [(each.link, each.data) for each in effects if isinstance(each, Transmit)]


def test_a_datagram_goes_to_every_client_whole_and_before_it_is_recorded() -> None:
    script = bridged()
    writer = FrameWriter(1, 1)
    raws = [frame(writer, name) for name in UNTARGETED * 2]
    effects = script.feed(Datagram(0, b"".join(raws)))
    assert sent(effects) == [(1, b"".join(raws)), (2, b"".join(raws))]
    assert [type(each) for each in effects[:2]] == [Transmit, Transmit]
    kept = told.recorded(effects, "FrameItem")
    assert [(x.link, x.direction, x.raw) for x in kept] == [
        (0, Direction.RECEIVED, raw) for raw in raws
    ]


def test_a_frame_for_one_client_goes_to_that_one_alone() -> None:
    script = bridged()
    writer = FrameWriter(1, 1)
    ack = frame(writer, "COMMAND_ACK", bytes((144, 1, 0, 0, 0, 0, 0, 0, 254, 190)))
    before, after = frame(writer, "VFR_HUD"), frame(writer, "HIGHRES_IMU")
    effects = script.feed(Datagram(0, before + ack + after))
    assert sent(effects) == [(1, before + after), (2, before + ack + after)]


def test_garbage_is_not_sent_on() -> None:
    script = bridged()
    raw = frame(FrameWriter(1, 1), "VFR_HUD")
    effects = script.feed(Datagram(0, b"noise" + raw))
    assert sent(effects) == [(1, raw), (2, raw)]
    assert [x.reason for x in told.recorded(effects, "GarbageItem")] == ["text"]


def test_long_reads_of_a_stream_are_cut_between_frames() -> None:
    raws = [bytes((number,)) * 280 for number in range(12)]
    made = datagrams(raws)
    assert b"".join(made) == b"".join(raws)
    assert [len(each) for each in made] == [MAX_DATAGRAM, MAX_DATAGRAM, 2 * 280]
    assert datagrams([b"x" * 3000]) == [b"x" * 3000]
    assert datagrams([]) == []


PARTS = 4
"""The messages are looked at in so many tests."""


@pytest.mark.parametrize("part", one_in(PARTS, range(PARTS)))
def test_decoding_what_passes_through_would_change_nothing(part: int) -> None:
    passing = sorted(set(MESSAGES) - INTERPRETED)
    for msgid in passing[part::PARTS]:
        decoding_changes_nothing(msgid)


def decoding_changes_nothing(msgid: int) -> None:
    """The same datagrams with every message decoded: the same effects, and the same snapshot."""
    writer, definition = FrameWriter(1, 1), MESSAGES[msgid]
    payloads = [random.Random(seed).randbytes(definition.max_len) for seed in range(3)]
    data = b"".join(writer.write_payload(msgid, payload) for payload in payloads)
    passing = effects_of(data)
    with pytest.MonkeyPatch.context() as patch:
        for module in (frame_intake, received_frames):
            patch.setattr(module, "INTERPRETED", frozenset(MESSAGES))
        assert effects_of(data) == passing, definition.name


def effects_of(data: bytes) -> list[Effect]:
    """And of what is told and recorded in the time after."""
    script = bridged()
    return told.separately([*script.feed(Datagram(0, data)), *script.run(0.3)])


def test_datagrams_that_were_put_together_are_as_one_after_the_other() -> None:
    """Routed, recorded, counted: frames of two components, lost, doubled and late ones, some for
    one client alone, some interpreted."""
    autopilot, camera, other = FrameWriter(1, 1), FrameWriter(1, 100), FrameWriter(7, 1)
    raws = [frame(autopilot, name) for name in UNTARGETED * 3]
    del raws[5]
    raws += [raws[2], frame(camera, "VFR_HUD"), frame(other, "VFR_HUD"), raws[0]]
    raws.insert(3, frame(autopilot, "COMMAND_ACK", bytes((144, 1, 0, 0, 0, 0, 0, 0, 254, 190))))
    raws.insert(7, autopilot.write(LocalPositionNed(1000, 1.0, 2.0, -3.0, 0.0, 0.0, 0.0)))
    single, joined = bridged(), bridged()
    for script in (single, joined):
        script.now_ns += 400 * wire.MS_NS  # the gate is to hear anew that the vehicle lives
    one_by_one = [effect for raw in raws for effect in single.feed(Datagram(0, raw))]
    data = b"".join(raws)
    together = joined.feed(Datagram(0, data, tuple(plain_frames(data))))
    assert told.recorded(together, "FrameItem") == told.recorded(one_by_one, "FrameItem")
    for link in CLIENTS:
        to_link = [
            b"".join(raw for to, raw in sent(e) if to == link) for e in (one_by_one, together)
        ]
        assert to_link[0] == to_link[1]
    assert len(sent(together)) < len(sent(one_by_one))
    assert told.separately(joined.run(2.5)) == told.separately(single.run(2.5))
    assert joined.session.telemetry == single.session.telemetry
    assert joined.session.gate.memory == single.session.gate.memory


def test_a_run_of_frames_is_split_anew_on_a_link_with_a_key_or_of_a_client() -> None:
    script = bridged()
    data = b"".join(frame(FrameWriter(9, 1), name) for name in UNTARGETED)
    as_one = told.separately(script.feed(Datagram(1, data, tuple(plain_frames(data)))))
    assert as_one == told.separately(bridged().feed(Datagram(1, data)))


def test_most_of_the_dialect_passes_through_and_all_that_is_interpreted_has_a_class() -> None:
    assert set(CLASSES) >= INTERPRETED
    assert len(INTERPRETED) < 40 < len(MESSAGES)


def test_the_deadline_is_the_same_after_what_passes_through(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    script = bridged()
    before_ns = script.session.deadline_ns
    effects = script.feed(Datagram(0, frame(FrameWriter(1, 1), "VFR_HUD")))
    assert effects
    assert script.session.deadline_ns == before_ns
    monkeypatch.setattr(script.session, "_deadline_ns", None)
    assert script.session.deadline_ns == before_ns
