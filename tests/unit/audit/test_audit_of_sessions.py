"""Records of short sessions: streams, exceptions, files, parts of a record; each audited."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import cast, get_args

import msgspec
import pytest
from mcap.reader import NonSeekingReader
from mcap.writer import Writer

import gcs as gcs_package
from gcs import ipc
from gcs.audit import replay
from gcs.audit.files import sessions
from gcs.audit.inputs import start_of
from gcs.audit.messages import Stored, Tape
from gcs.audit.turns import NoStartError
from gcs.config import StationConfig
from gcs.gate.policy.parse import DEFAULT
from gcs.mcap_file.writer import Backend, FoxgloveBackend, McapBackend
from gcs.policy_file import load_policy
from gcs.record import writer
from gcs.record.writer import Recorder
from gcs.session.effects import Effect
from gcs.session.inputs import (
    TAGS,
    Datagram,
    FileRead,
    FileWritten,
    Input,
    LinkEvent,
    OperatorJoined,
    OperatorLine,
    SimLine,
)
from gcs.session.setup import Setup
from gcs.session.work import Work
from gcs.shell.environment import environment
from gcs.station.session import Session
from gcs.station.vehicles import Vehicles
from gcs.wire.codec import FrameWriter
from gcs.wire.frame import Frame, plain_frames
from gcs.wire.messages import Heartbeat
from tests.audits import RecordedSession, audited, kind_of, read, resealed, with_data
from tests.unit.cli.command_line import gcs
from tests.unit.record.disks import Disk
from tests.unit.record.flights import opened

START_NS = 1_767_225_600_000_000_000
BEAT = Heartbeat(
    custom_mode=0, type=2, autopilot=12, base_mode=128, system_status=4, mavlink_version=3
)


def set_up(name: str = "") -> Setup:
    """Link 0 carries datagrams, link 1 a stream."""
    links = ("datagrams", "a stream")
    log_path = f"logs/{name}.mcap" if name else ""
    return Setup(StationConfig(), "test", DEFAULT, "", links, log_path, frozenset({1}))


def on_tape(setup: Setup | None = None) -> tuple[RecordedSession, Tape]:
    tape = Tape()
    recorder = Recorder.without_file(tape, START_NS)
    return RecordedSession(recorder, setup or set_up(), START_NS), tape


def close(session: RecordedSession, tape: Tape) -> list[Stored]:
    session.recorder.end(session.now_ns)
    return list(tape.take())


@pytest.fixture
def beats() -> FrameWriter:
    return FrameWriter(1, 1)


# ---------------------------------------------------------------------------------- inputs


def test_a_stream_is_cut_as_it_came(beats: FrameWriter) -> None:
    session, tape = on_tape()
    first, second, third = (beats.write(BEAT) for _ in range(3))
    session.feed(Datagram(1, first[:4]))
    session.feed(Datagram(1, first[4:] + b"noise" + second[:7]))
    session.feed(Datagram(0, third))
    session.feed(Datagram(1, second[7:]))
    session.feed(Datagram(1, b""))
    session.feed(Datagram(1, third[:9]))
    result = audited(close(session, tape), tape.attachments)
    assert (result.first, result.good) == ([], True)
    assert result.inputs["datagrams"] == 6
    assert (result.compared["frame received"], result.compared["garbage"]) == (3, 1)


def test_an_exception_while_an_input_was_handled_happens_again(beats: FrameWriter) -> None:
    session, tape = on_tape()
    session.feed(LinkEvent(0, "open"))
    session.feed(Datagram(7, beats.write(BEAT)))  # a link that is not there cannot be asked on
    session.feed(LinkEvent(0, "still open"))
    messages = close(session, tape)
    assert [kind_of(m) for m in messages].count("Fault") == 1
    result = audited(messages, tape.attachments)
    assert (result.first, result.good) == ([], True)
    assert result.inputs["exceptions"] == 1


def test_a_frame_that_raised_within_a_run_raises_again_and_the_rest_is_as_it_was(
    beats: FrameWriter, monkeypatch: pytest.MonkeyPatch
) -> None:
    raws = [beats.write(BEAT) for _ in range(3)]
    real = Vehicles.frame

    def failing(self: Vehicles, link: int, frame: Frame, now_ns: int) -> list[Work]:
        if frame.raw == raws[1]:
            raise ZeroDivisionError("planted")
        return real(self, link, frame, now_ns)

    monkeypatch.setattr(Vehicles, "frame", failing)
    session, tape = on_tape()
    data = b"".join(raws)
    session.feed(Datagram(0, data, tuple(plain_frames(data))))
    session.feed(LinkEvent(0, "open"))
    result = audited(close(session, tape), tape.attachments)
    assert (result.first, result.good) == ([], True)
    assert (result.inputs["datagrams"], result.inputs["exceptions"]) == (1, 1)
    assert result.compared["frame received"] == 2


def test_an_exception_that_does_not_happen_again_is_a_difference(beats: FrameWriter) -> None:
    session, tape = on_tape()
    session.feed(LinkEvent(0, "open"))
    session.feed(Datagram(7, beats.write(BEAT)))
    messages = [
        with_data(m, m.data.replace(b'"link":7', b'"link":0')) if kind_of(m) == "Fault" else m
        for m in close(session, tape)
    ]
    difference = audited(resealed(messages), tape.attachments).first[0]
    assert difference.recorded == "KeyError: 7"
    assert difference.reproduced == "no exception"


def test_an_exception_while_effects_were_performed_is_told_again() -> None:
    session, tape = on_tape()
    session.feed(OperatorJoined(2, "a test"))
    line = OperatorLine(2, ipc.Ask(1, "land"))
    session.feed(line)
    session.fault(line, "Traceback\nOSError: the link is gone")
    session.feed(LinkEvent(0, "open"))
    result = audited(close(session, tape), tape.attachments)
    assert (result.first, result.good) == ([], True)


class Clumsy(Session):
    """Another version of the session, with a bug."""

    def handle(self, given: Input, now_ns: int) -> list[Effect]:
        if isinstance(given, SimLine):
            raise ZeroDivisionError("planted")
        return super().handle(given, now_ns)


def test_an_exception_that_was_not_recorded_is_a_difference(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    session, tape = on_tape()
    session.feed(LinkEvent(0, "open"))
    session.feed(SimLine("INFO sim: x"))
    messages = close(session, tape)
    monkeypatch.setattr(replay, "Session", Clumsy)
    first = audited(messages, tape.attachments).first[0]
    assert (first.recorded, first.reproduced) == ("no exception", "ZeroDivisionError: planted")
    assert first.after == "the simulator printed 'INFO sim: x'"


def test_without_a_set_up_nothing_can_be_audited() -> None:
    session, tape = on_tape()
    session.feed(LinkEvent(0, "open"))
    messages = [message for message in close(session, tape) if kind_of(message) != "Setup"]
    with pytest.raises(NoStartError, match="it holds no set-up of a session"):
        audited(messages, tape.attachments)


def test_the_same_file_read_twice_is_attached_once_and_found_both_times() -> None:
    session, tape = on_tape()
    session.feed(FileRead(1, "plans/a.plan", b"one"))
    session.feed(FileRead(2, "plans/a.plan", b"one"))
    session.feed(FileRead(3, "plans/a.plan", b"two"))
    session.feed(FileWritten(4, "b.plan", "disk full"))
    messages = close(session, tape)
    # Two plans, the policy, and the metadata of the set-up.
    assert sorted(len(contents) for contents in tape.attachments.values()) == [1, 1, 1, 1]
    result = audited(messages, tape.attachments)
    # Nobody had asked for any of them.
    assert [d.kind for d in result.first] == ["course"] * 4
    assert result.first[0].recorded == "plans/a.plan was to be read"


def test_lines_of_a_simulator_keep_their_letters() -> None:
    session, tape = on_tape()
    session.feed(SimLine("WARNING sim: Überschlag — 100 % \ufffd"))
    assert audited(close(session, tape), tape.attachments).good


def test_every_shipped_policy_is_read_back_as_it_was(beats: FrameWriter) -> None:
    for name in ("default", "lab"):
        policy, text = load_policy(name)
        session, tape = on_tape(
            Setup(StationConfig(speedup=3.0), "test", policy, text, ("a", "b"), "", frozenset({1}))
        )
        session.feed(Datagram(0, beats.write(BEAT)))
        session.wait(2.0)
        assert audited(close(session, tape), tape.attachments).good


def test_a_policy_of_another_version_has_this_ones_defaults() -> None:
    session, tape = on_tape()
    session.feed(LinkEvent(0, "open"))
    messages = close(session, tape)
    said = json.loads(messages[0].data)
    policy = said["data"]["setup"]["policy"]
    del policy["margin_h_m"], policy["takeoff"]["max_up_m"]
    policy["key_of_another_version"] = 1
    messages[0] = with_data(messages[0], msgspec.json.encode(said))
    result = audited(resealed(messages), tape.attachments)
    assert [(d.kind, d.after) for d in result.first] == [("input", "link 0: open")]


def test_a_policy_from_before_headings_were_waited_for_waits_for_none() -> None:
    session, tape = on_tape()
    session.feed(LinkEvent(0, "open"))
    said = json.loads(close(session, tape)[0].data)["data"]
    assert start_of(msgspec.json.encode(said)).setup.policy == DEFAULT
    del said["setup"]["policy"]["arrival"]["yaw_deg"]
    assert start_of(msgspec.json.encode(said)).setup.policy.arrival.yaw_deg is None


# ----------------------------------------------------------------------------------- parts


@pytest.fixture
def two_parts(tmp_path: Path, beats: FrameWriter) -> list[Path]:
    """A disk is full for six seconds."""
    disk = Disk(1 << 30)
    recorder = opened(tmp_path, "x", opener=disk.open, sealed=True)
    session = RecordedSession(recorder, set_up(recorder.path.stem), START_NS)
    session.feed(Datagram(0, beats.write(BEAT)))
    session.wait(3.0)
    disk.free = 0
    session.wait(2.0)
    disk.free = 1 << 30
    session.wait(9.0)
    recorder.close(session.now_ns)
    assert [path.name for path in recorder.parts] == [
        "20260101-000000_x.mcap",
        "20260101-000000_x_part2.mcap",
    ]
    return recorder.parts


def test_after_a_hole_in_the_record_nothing_can_be_audited(two_parts: list[Path]) -> None:
    messages, attachments = read(*two_parts)
    result = audited(messages, attachments)
    assert (result.differences, result.whole, result.good) == (0, False, False)
    (note,) = result.notes
    assert "messages are in no file between" in note
    assert 2.0 < result.seconds < 3.5


def test_the_part_before_the_hole_is_audited_by_itself(two_parts: list[Path]) -> None:
    first = gcs("log", "audit", two_parts[0])
    assert (first.exit_code, "note: the record breaks off" in first.output) == (1, True)


def test_a_part_alone_is_refused_with_the_name_of_the_others(two_parts: list[Path]) -> None:
    ended = gcs("log", "audit", two_parts[1])
    assert ended.exit_code == 4
    assert "it is part 2 of 20260101-000000_x, not its beginning" in ended.output
    assert "hint: name all files of 20260101-000000_x in one command" in ended.output


def test_files_that_follow_one_another_without_a_hole_are_one_record(
    tmp_path: Path, beats: FrameWriter
) -> None:
    recorder = opened(tmp_path, "x", sealed=True)
    session = RecordedSession(recorder, set_up(recorder.path.stem), START_NS)
    session.feed(Datagram(0, beats.write(BEAT)))
    session.wait(1.2)
    recorder._finish()
    recorder._start_next_part(session.now_ns)
    session.wait(1.2)
    recorder.close(session.now_ns)
    assert len(recorder.parts) == 2
    (found,) = sessions(reversed(recorder.parts))
    assert found.paths == recorder.parts
    result = audited(found.messages(), found.attachments())
    assert found.misnumbered == 0
    assert (result.first, result.notes, result.good) == ([], [], True)
    assert result.seconds > 2.0


def test_sessions_are_told_apart(tmp_path: Path) -> None:
    paths = []
    for name in ("a", "b"):
        recorder = opened(tmp_path, name, sealed=True)
        session = RecordedSession(recorder, set_up(recorder.path.stem), START_NS)
        session.feed(LinkEvent(0, "open"))
        recorder.close(session.now_ns)
        paths.append(recorder.path)
    copy = tmp_path / "copy.mcap"
    copy.write_bytes(paths[0].read_bytes())
    assert [each.paths for each in sessions([*paths, copy])] == [[p] for p in (*paths, copy)]
    ended = gcs("log", "audit", *paths, "--json")
    lines = [json.loads(line) for line in ended.output.splitlines()]
    assert [line["paths"] for line in lines] == [[str(path)] for path in paths]


# ------------------------------------------------------------------------- who alters a record


def _rewritten(source: Path, target: Path, **to: object) -> Path:
    """The record once more, whole and closed: up to `until_ns`, its metadata `metadata`, each
    message's number times `sequence` and moved by `shift`, its publish time by `publish_ns`."""
    until_ns = cast("int", to.get("until_ns", 1 << 62))
    with source.open("rb") as old, target.open("wb") as new:
        writer = Writer(new)
        writer.start()
        reader = NonSeekingReader(old)
        channels: dict[int, int] = {}
        for metadata in reader.iter_metadata():
            values = {**metadata.metadata, **cast("dict[str, str]", to.get("metadata", {}))}
            writer.add_metadata(metadata.name, values)
        old.seek(0)
        for attachment in NonSeekingReader(old).iter_attachments():
            writer.add_attachment(
                attachment.create_time,
                attachment.log_time,
                attachment.name,
                attachment.media_type,
                attachment.data,
            )
        old.seek(0)
        for schema, channel, message in NonSeekingReader(old).iter_messages(log_time_order=False):
            if message.log_time > until_ns:
                break
            if channel.id not in channels:
                number = 0
                if schema is not None:
                    number = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.id] = writer.register_channel(
                    channel.topic, channel.message_encoding, number, channel.metadata
                )
            writer.add_message(
                channels[channel.id],
                message.log_time,
                message.data,
                message.publish_time + cast("int", to.get("publish_ns", 0)),
                message.sequence * cast("int", to.get("sequence", 1))
                + cast("int", to.get("shift", 0)),
            )
        writer.finish()  # type: ignore[no-untyped-call]  # mcap leaves it bare
    return target


@pytest.fixture
def flown(tmp_path: Path, beats: FrameWriter) -> Path:
    """By this version, here: of another one only what happened is compared."""
    recorder = opened(tmp_path, "y", sealed=True)
    own = replace(
        set_up(recorder.path.stem), version=gcs_package.__version__, environment=environment()
    )
    session = RecordedSession(recorder, own, START_NS)
    for _ in range(4):
        session.feed(Datagram(0, beats.write(BEAT)))
        session.wait(1.0)
    recorder.close(session.now_ns)
    return recorder.path


@pytest.mark.parametrize(
    ("to", "told"),
    [
        ({"until_ns": START_NS + 2_000_000_000}, "the record has no end"),
        ({"metadata": {"policy": "another"}}, "metadata mavgate: another content"),
        ({"sequence": 2}, "another number or publish time"),
        ({"shift": 1}, "another number or publish time"),
        ({"shift": -1}, "another number or publish time"),
        ({"publish_ns": 1}, "another number or publish time"),
    ],
)
def test_what_is_cut_off_or_altered_beside_the_messages_is_found(
    flown: Path, tmp_path: Path, to: dict[str, object], told: str
) -> None:
    same = gcs("log", "audit", _rewritten(flown, tmp_path / "same.mcap"))
    assert same.exit_code == 0, same.output
    found = gcs("log", "audit", _rewritten(flown, tmp_path / "other.mcap", **to))
    assert found.exit_code == 1
    assert told in found.output


@pytest.mark.parametrize("backend", [FoxgloveBackend, McapBackend])
def test_a_record_as_either_library_writes_it_is_numbered_right(
    backend: type[Backend], tmp_path: Path, beats: FrameWriter, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(writer, "best_backend", backend)
    recorder = opened(tmp_path, "z", sealed=True)
    session = RecordedSession(recorder, set_up(recorder.path.stem), START_NS)
    for _ in range(2):
        session.feed(Datagram(0, beats.write(BEAT)))
        session.wait(1.0)
    recorder.close(session.now_ns)
    ended = gcs("log", "audit", recorder.path)
    assert "another number" not in ended.output


def test_a_second_record_behind_the_first_is_found(flown: Path, tmp_path: Path) -> None:
    both = tmp_path / "both.mcap"
    both.write_bytes(flown.read_bytes() * 2)
    found = gcs("log", "audit", both)
    assert (found.exit_code, "bytes stand behind the end" in found.output) == (1, True)


def test_a_record_is_signed_and_nobody_without_the_key_alters_it(
    flown: Path, tmp_path: Path
) -> None:
    key, other = str(tmp_path / "own.key"), str(tmp_path / "other.key")
    for each in (key, other):
        assert gcs("key", "new", each).exit_code == 0
    assert "it has no signature" in gcs("log", "audit", flown, "--key", key).output
    assert gcs("log", "sign", flown, "--key", key).exit_code == 0
    assert gcs("log", "audit", flown, "--key", key).exit_code == 0
    wrong = gcs("log", "audit", flown, "--key", other)
    assert (wrong.exit_code, "with another key" in wrong.output) == (1, True)
    signature = flown.with_name(f"{flown.name}.sig").read_bytes()
    data = bytearray(flown.read_bytes())
    data[len(data) // 2] ^= 1
    flown.write_bytes(data)
    assert "it was altered after it was signed" in gcs("log", "audit", flown, "--key", key).output
    assert Path(key).read_text().strip() not in signature.decode()


def test_every_input_has_a_tag_of_its_own() -> None:
    """So what a record calls an input outlives the names of our classes."""
    assert set(TAGS) == set(get_args(Input))
    assert len(set(TAGS.values())) == len(TAGS)
