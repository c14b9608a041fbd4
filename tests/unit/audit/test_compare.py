"""Which messages differ, and in whose words that is told."""

from __future__ import annotations

import json
from zlib import crc32

import pytest

from gcs.audit.audit import scope_of
from gcs.audit.compare import Pair, Scope, differing
from gcs.audit.describe import kind_of_message, told_pair
from gcs.audit.messages import Stored
from gcs.audit.seals import Altered, Missing, SealCheck
from gcs.record import ros1
from gcs.record.derived import Derived
from gcs.record.parts import PartBegan, Seal
from gcs.report import Direction, LogEvent
from gcs.wire.codec import FrameWriter
from gcs.wire.messages import CommandAck

WITH, WITHOUT = "Python 3, with foxglove-sdk", "Python 3, without foxglove-sdk"


def decision(at_ns: int = 1, **values: object) -> Stored:
    return Stored("/gate/decision", at_ns, json.dumps(values).encode())


def picture(at_ns: int = 1) -> Stored:
    return Stored("/vehicle/1/tf", at_ns, b"x")


def log_line(text: str) -> Stored:
    outs = Derived().handle(LogEvent(1, 2, "gate", text), 1)
    (line,) = (out.message for out in outs if out.channel.topic == "/log")
    return Stored("/log", 1, line)


def sent(result: int, seq: int = 0) -> Stored:
    writer = FrameWriter(255, 190)
    for _ in range(seq):
        writer.write(CommandAck(400, 0))
    raw = writer.write(CommandAck(400, result))
    data = ros1.codec(ros1.full_length(77)).encode(raw, 0, Direction.SENT)
    return Stored("/mavlink/255/190/COMMAND_ACK", 1, data, ros1.full_length(77))


# ------------------------------------------------------------------------------ comparing


def test_what_is_the_same_does_not_differ() -> None:
    assert differing([decision(a=1)], [decision(a=1)], Scope(), cut=False) == []


def test_one_that_is_otherwise_is_beside_the_one_in_its_place() -> None:
    ours = [picture(1), decision(2, a=1), decision(3, a=2)]
    theirs = [picture(1), decision(2, a=1), decision(3, a=3)]
    assert differing(ours, theirs, Scope(), cut=False) == [(ours[2], theirs[2])]


def test_one_that_is_missing_moves_none_of_those_after_it() -> None:
    ours = [decision(1, a=1), decision(2, a=2), decision(3, a=3)]
    theirs = [decision(1, a=1), decision(2, a=3)]
    assert differing(ours, theirs, Scope(), cut=False) == [(ours[1], None)]
    assert differing(theirs, ours, Scope(), cut=False) == [(None, ours[1])]


def test_another_time_is_a_difference_told_once() -> None:
    ours, theirs = [decision(1), decision(2)], [decision(5), decision(6)]
    assert differing(ours, theirs, Scope(), cut=False) == [(ours[0], theirs[0])]


def test_a_cut_turn_may_lack_its_end_and_nothing_else() -> None:
    ours, theirs = [decision(1, a=1)], [decision(1, a=1), decision(2, a=2)]
    assert differing(ours, theirs, Scope(), cut=True) == []
    assert differing(theirs, ours, Scope(), cut=True) == [(theirs[1], None)]


def test_without_pictures_times_and_what_is_drawn_do_not_count() -> None:
    ours, theirs = [picture(1), decision(2, a=1)], [decision(1, a=1)]
    assert differing(ours, theirs, Scope(pictures=False), cut=False) == []


@pytest.mark.parametrize(
    ("recorded_in", "audited_in", "same_version", "scope"),
    [
        (WITH, WITH, True, Scope()),
        ("", WITH, True, Scope()),
        (WITH, WITH, False, Scope(pictures=False)),
        (WITH, WITHOUT, True, Scope(pictures=False, log=False)),
        (WITHOUT, WITHOUT, True, Scope()),
    ],
)
def test_what_two_installations_can_compare(
    recorded_in: str, audited_in: str, same_version: bool, scope: Scope
) -> None:
    assert scope_of(recorded_in, audited_in, same_version=same_version) == scope


# ---------------------------------------------------------------------------------- words


@pytest.mark.parametrize(
    ("pair", "kind", "told"),
    [
        (
            (
                decision(request_id=3, word="goto", outcome="accepted"),
                decision(request_id=3, word="goto", outcome="refused", code="STALE"),
            ),
            "decision",
            ("#3 goto: outcome accepted", "#3 goto: outcome refused, code STALE"),
        ),
        (
            (None, decision(request_id=3, word="goto")),
            "decision",
            ("nothing", "#3 goto: request_id 3, word goto"),
        ),
        (
            (sent(0), sent(4)),
            "frame sent",
            ("COMMAND_ACK: result 0", "COMMAND_ACK: result 4"),
        ),
        (
            (sent(0), sent(0, seq=7)),
            "frame sent",
            ("COMMAND_ACK: seq 0", "COMMAND_ACK: seq 7"),
        ),
        (
            (log_line("Complete"), log_line("Über die Grenze")),
            "log line",
            ("log: line Complete", "log: line Über die Grenze"),
        ),
        (
            (decision(1), decision(2)),
            "decision",
            ("/gate/decision at 1 ns", "/gate/decision at 2 ns"),
        ),
    ],
)
def test_what_differs_is_told_field_by_field(pair: Pair, kind: str, told: tuple[str, str]) -> None:
    one = pair[0] or pair[1]
    assert one is not None
    assert kind_of_message(one) == kind
    assert told_pair(pair) == told


# ---------------------------------------------------------------------------------- seals


def test_a_seal_knows_how_many_there_were_and_what_they_were() -> None:
    check = SealCheck()
    check.message(Stored("/a", 10, b"123456789"))
    nine_digits = 0xCBF43926  # of these nine digits, as every description of CRC-32 has it
    assert check.seal(Seal(1, nine_digits), 20) is None
    check.message(Stored("/session/input", 20, b"seal"))
    check.message(Stored("/a", 30, b"123456780"))
    assert check.seal(Seal(3, nine_digits), 40) == Altered(20, 40)
    assert check.seal(Seal(5, 0), 60) == Missing(0, 60, 2)


def test_what_a_part_repeats_does_not_count() -> None:
    check = SealCheck()
    check.message(Stored("/a", 10, b"1"))
    part = Stored("/session/input", 20, b"part")
    assert check.begins_part(PartBegan(2, "x", 1, 1), part) is None
    check.message(Stored("/a", 21, b"1"))
    check.message(Stored("/a", 22, b"2"))
    assert check.seal(Seal(3, crc32(b"part12")), 30) is None
    other = SealCheck()
    assert other.begins_part(PartBegan(2, "x", 1, 4), part) == Missing(0, 20, 4)
