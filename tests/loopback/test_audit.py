"""Flights recorded to the disk and audited: nothing differs, and what was altered is found."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from mcap.reader import make_reader

from gcs import ipc
from gcs.audit.audit import AuditResult
from gcs.audit.messages import INPUT_TOPIC, Attachments, Stored
from gcs.audit.turns import Turns
from gcs.record.parts import Rotation
from gcs.record.writer import Recorder
from gcs.session import inputs
from tests.audits import audited, kind_of, read, resealed, with_data
from tests.loopback.flight import MISSIONS, Flight
from tests.loopback.observed import START_NS
from tests.shares import one_in
from tests.unit.cli.command_line import Ended, gcs


@pytest.fixture(scope="module")
def record(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A goal flown, one refused, a mission brought on board, and a second operator who stops."""
    folder = tmp_path_factory.mktemp("logs")
    recorder = Recorder.open(folder, "audit", "20260101-000000", START_NS, sealed=True)
    flight = Flight()
    flight.recorder = recorder
    flight.feed(inputs.LinkEvent(0, "open"))
    flight.feed(inputs.SimLine("INFO sim: a vehicle of our own"))
    flight.hovering(2.0)
    flight.done(flight.goto(3.0, 0.0, 2.0))
    flight.done(flight.goto(500.0, 0.0, 2.0))
    flight.do("mission_upload", path=str(MISSIONS / "demo.toml"))
    flight.feed(inputs.OperatorJoined(2, "a test"))
    flight.feed(inputs.OperatorLine(2, ipc.Subscribe(["ATTITUDE"])))
    flight.goto(0.0, 8.0, 2.0)
    flight.run(1.0)
    flight.feed(inputs.OperatorLine(2, ipc.Ask(1, "abort")))
    flight.run(2.0)
    flight.feed(inputs.RecorderGrew(100_000))
    flight.feed(inputs.DiskLow(100_000_000, 600.0, critical=False))
    flight.feed(inputs.OperatorNoise(2, "gibberish"))
    flight.feed(inputs.Datagram(0, b"GET / HTTP/1.1"))
    flight.feed(inputs.OperatorGone(2, "its connection ended"))
    flight.do("land")
    flight.feed(inputs.SignalCame("SIGTERM"))
    flight.run(4.0)
    assert flight.finish is not None
    assert recorder.close(flight.now_ns)
    return recorder.path


@pytest.fixture(scope="module")
def stored(record: Path) -> tuple[list[Stored], Attachments]:
    return read(record)


def gcs_log_audit(*arguments: str | Path) -> Ended:
    return gcs("log", "audit", *arguments)


# -------------------------------------------------------------------------- nothing differs


def test_every_message_of_the_record_is_reproduced(
    stored: tuple[list[Stored], Attachments],
) -> None:
    messages, attachments = stored
    result = audited(messages, attachments)
    assert (result.first, result.notes, result.good) == ([], [], True)
    seals = sum(kind_of(message) in ("RecordTick", "RecordEnd") for message in messages)
    assert sum(result.compared.values()) == len(messages) - seals
    assert result.compared["decision"] >= 12
    assert result.compared["frame sent"] > 200
    assert result.inputs["operators' lines"] == 10
    assert result.inputs["files"] == 1


def test_the_command_says_so_and_exits_0(record: Path) -> None:
    result = gcs_log_audit(record)
    assert result.exit_code == 0, result.output
    assert "no difference: every decision and every message is reproduced" in result.output
    found = json.loads(gcs_log_audit(record, "--json").output)
    assert (found["good"], found["differences"], found["first"]) == (True, 0, [])


# ----------------------------------------------------------------------- what was altered

Change = Callable[[Stored], Stored | None]


def altered(
    stored: tuple[list[Stored], Attachments], which: Callable[[Stored], bool], change: Change
) -> AuditResult:
    """With one message changed, or left out; the seals fit, as if nobody had touched it."""
    messages, attachments = stored
    at = next(index for index, message in enumerate(messages) if which(message))
    changed = change(messages[at])
    assert changed != messages[at]
    middle = [] if changed is None else [changed]
    return audited(resealed([*messages[:at], *middle, *messages[at + 1 :]]), attachments)


def replaced(old: bytes, new: bytes) -> Change:
    def change(message: Stored) -> Stored:
        assert message.data.count(old) == 1
        assert len(old) == len(new)
        return with_data(message, message.data.replace(old, new))

    return change


def flipped(index: int) -> Change:
    """One byte, counted from the end where `index` is negative."""

    def change(message: Stored) -> Stored:
        data = bytearray(message.data)
        data[index] ^= 1
        return with_data(message, bytes(data))

    return change


def is_kind(kind: str, text: bytes = b"") -> Callable[[Stored], bool]:
    return lambda message: kind_of(message) == kind and text in message.data


def is_received(name: str) -> Callable[[Stored], bool]:
    return lambda message: message.came_in and message.topic.endswith(f"/{name}")


@pytest.mark.parametrize(
    ("which", "change", "expected"),
    [
        (is_kind("OperatorLine", b"[3.0,0.0,2.0]"), replaced(b"3.0", b"4.0"), "decision"),
        (is_kind("OperatorLine", b"[500.0,"), replaced(b"500.0", b"  0.0"), "input"),
        (is_kind("OperatorLine", b"[500.0,"), replaced(b"500.0", b"400.0"), "decision"),
        (is_kind("OperatorLine", b'"abort"'), replaced(b'"client":2', b'"client":1'), "decision"),
        (is_kind("OperatorLine", b'"land"'), replaced(b'"land"', b'"hold"'), "decision"),
        (is_kind("OperatorJoined"), replaced(b"a test", b"a Test"), "log line"),
        (is_kind("LinkEvent"), replaced(b"open", b"Open"), "log line"),
        (is_kind("SimLine"), replaced(b"vehicle", b"Vehicle"), "log line"),
        (is_kind("Wake"), replaced(b"Wake", b"Wade"), "course"),
        (is_kind("FileRead"), replaced(b'"token":5', b'"token":4'), "course"),
        (is_kind("SignalCame"), replaced(b"SIGTERM", b"SIGHUP "), "log line"),
        (is_received("HEARTBEAT"), flipped(13), "frame received"),
        (is_received("LOCAL_POSITION_NED"), flipped(20), "frame received"),
        (is_received("COMMAND_ACK"), flipped(0), "course"),
        (is_received("COMMAND_ACK"), flipped(-1), "frame received"),
    ],
)
def test_one_byte_of_an_input_leads_to_another_course(
    stored: tuple[list[Stored], Attachments],
    which: Callable[[Stored], bool],
    change: Change,
    expected: str,
) -> None:
    result = altered(stored, which, change)
    assert not result.good
    assert expected in [difference.kind for difference in result.first]


@pytest.mark.parametrize("kind", ["LinkEvent", "OperatorLine", "Wake", "FileRead"])
def test_an_input_that_is_left_out_is_missed(
    stored: tuple[list[Stored], Attachments], kind: str
) -> None:
    assert altered(stored, is_kind(kind), lambda _: None).differences


def test_a_frame_that_was_not_sent_is_found(stored: tuple[list[Stored], Attachments]) -> None:
    """A byte of an effect, too: of what is recorded as sent, and of what is not."""
    sent = altered(
        stored,
        lambda m: m.topic.endswith("/SET_POSITION_TARGET_LOCAL_NED"),
        flipped(20),
    )
    (difference,) = sent.first
    assert difference.kind == "frame sent"
    assert difference.recorded.startswith("SET_POSITION_TARGET_LOCAL_NED, damaged")
    assert difference.after == "a tick"


def test_a_decision_that_was_otherwise_is_told_by_what_differs(
    stored: tuple[list[Stored], Attachments],
) -> None:
    result = altered(
        stored,
        lambda m: m.topic == "/gate/decision" and b"OUTSIDE_FENCE" in m.data,
        replaced(b'"refused"', b'"excused"'),
    )
    (difference,) = result.first
    assert (difference.kind, difference.after) == ("decision", "a tick")
    assert difference.recorded.endswith("goto: outcome excused")
    assert difference.reproduced.endswith("goto: outcome refused")


PARTS = 4
"""The kinds of inputs are looked at in so many tests."""


@pytest.mark.parametrize("part", one_in(PARTS, range(PARTS)))
def test_any_byte_of_any_input_is_found_by_its_checksum(
    stored: tuple[list[Stored], Attachments], part: int
) -> None:
    """Also where nothing that is recorded depends on it: noise, messages that mean nothing here."""
    messages, attachments = stored
    first: dict[tuple[str, str], int] = {}
    for index, message in enumerate(messages):
        if message.came_in or message.topic == INPUT_TOPIC:
            first.setdefault((message.topic, kind_of(message)), index)
    del first[INPUT_TOPIC, "Setup"]  # of which a byte changed may be that nothing can be read
    assert len(first) > 25
    for place, index in list(first.items())[part::PARTS]:
        changed = flipped(len(messages[index].data) * 2 // 3)(messages[index])
        assert changed is not None
        turns = Turns([*messages[:index], changed, *messages[index + 1 :]], attachments)
        for _ in turns:
            pass
        assert turns.altered or turns.missing, place


def test_an_attached_file_that_was_altered_is_found(
    stored: tuple[list[Stored], Attachments],
) -> None:
    messages, attachments = stored
    (name,) = (name for name in attachments if name.startswith("read-"))
    data = bytearray(attachments[name][0])
    data[10] ^= 1
    result = audited(messages, {**attachments, name: [bytes(data)]})
    assert any("is not attached, or was altered" in d.reproduced for d in result.first)


def test_a_byte_changed_on_the_disk_is_found(record: Path, tmp_path: Path) -> None:
    with open(record, "rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    chunks = summary.chunk_indexes
    chunk = chunks[len(chunks) // 2]
    damaged = tmp_path / "damaged.mcap"
    data = bytearray(record.read_bytes())
    data[chunk.chunk_start_offset + chunk.chunk_length // 2] ^= 1  # in what was recorded
    damaged.write_bytes(data)
    result = gcs_log_audit(damaged)
    assert result.exit_code == 1
    assert "differences" in result.output


# ------------------------------------------------------------------------- parts of a record


@pytest.mark.parametrize("share", [0.2, 0.5, 0.7])
def test_a_killed_file_is_audited_as_far_as_its_inputs_go(
    record: Path, tmp_path: Path, share: float
) -> None:
    data = record.read_bytes()
    killed = tmp_path / "killed.mcap"
    killed.write_bytes(data[: int(len(data) * share)])
    result = gcs_log_audit(killed)
    assert result.exit_code == 1, result.output
    assert "note: the record breaks off" in result.output
    assert "no difference in what is there, but the record has no end" in result.output


@pytest.mark.parametrize("first", one_in(4, range(2, 30, 7)))
def test_it_may_break_off_at_any_message(
    stored: tuple[list[Stored], Attachments], first: int
) -> None:
    messages, attachments = stored
    for end in range(first, 400, 28):
        result = audited(messages[:end], attachments)
        assert (result.differences, len(result.notes)) == (0, 1), result.first


def test_another_version_is_said_and_audited_all_the_same(
    stored: tuple[list[Stored], Attachments],
) -> None:
    messages, attachments = stored
    result = audited(messages, attachments, version="9.9")
    assert result.good
    assert "recorded by mavgate test, audited by 9.9" in result.notes[0]
    assert "picture" not in result.compared
    assert result.compared["decision"] >= 12


def test_a_file_that_is_no_session_s_is_a_clear_error(tmp_path: Path) -> None:
    recorder = Recorder.open(tmp_path, "old", "20260101-000000", START_NS)
    recorder.close(START_NS)
    result = gcs_log_audit(recorder.path)
    assert result.exit_code == 4
    assert "cannot be audited: it holds no set-up of a session" in result.output
    bad = tmp_path / "bad.mcap"
    bad.write_bytes(b"#!/bin/sh\n")
    assert gcs_log_audit(bad).exit_code == 4


# --------------------------------------------------------------------------------- rotation


def test_a_record_of_several_files_is_audited_over_all_of_them(tmp_path: Path) -> None:
    recorder = Recorder.open(
        tmp_path,
        "rotated",
        "20260101-000000",
        START_NS,
        sealed=True,
        rotation=Rotation(age_ns=4_000_000_000),
    )
    flight = Flight()
    flight.recorder = recorder
    flight.hovering(2.0)
    flight.done(flight.goto(3.0, 0.0, 2.0))
    flight.done(flight.goto(500.0, 0.0, 2.0))
    flight.run(3.0)
    assert recorder.close(flight.now_ns)
    assert len(recorder.parts) >= 3
    result = audited(*read(*recorder.parts))
    assert (result.first, result.notes, result.good) == ([], [], True)
    alone = gcs_log_audit(recorder.parts[1])
    assert alone.exit_code == 4
    assert "it is part 2 of 20260101-000000_rotated" in alone.output
    hole = audited(*read(recorder.parts[0], *recorder.parts[2:]))
    assert not hole.good
