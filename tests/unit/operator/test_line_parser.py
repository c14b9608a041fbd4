"""Typed lines: every word of the table, every way to get it wrong, and back to text."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs import ipc
from gcs.operator import request_words
from gcs.operator.line_parser import LineError, parse_line
from gcs.operator.request_words import Quit, SendRequests, ShowState, Wait


def requests(line: str) -> tuple[ipc.Ask, ...]:
    parsed = parse_line(line)
    assert parsed is not None
    assert isinstance(parsed.action, SendRequests)
    return parsed.action.requests


@pytest.mark.parametrize("word", request_words.WORDS, ids=lambda word: word.name)
def test_every_example_is_understood_and_is_of_its_word(word: request_words.Word) -> None:
    parsed = parse_line(word.example)
    assert parsed is not None
    assert parsed.text.startswith(word.name)
    assert parsed.wait


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("arm", ipc.Ask(0, "arm")),
        ("takeoff 2", ipc.Ask(0, "takeoff", up_m=2.0)),
        ("goto 3 -1.5 2", ipc.Ask(0, "goto", goal_enu=(3.0, -1.5, 2.0))),
        ("goto 3 0 2 90", ipc.Ask(0, "goto", goal_enu=(3.0, 0.0, 2.0), yaw_deg=90.0)),
        ("disarm", ipc.Ask(0, "disarm")),
        ("disarm --force", ipc.Ask(0, "disarm", force=True)),
        ("mode AUTO.LOITER", ipc.Ask(0, "mode", mode="AUTO.LOITER")),
        ("fence on", ipc.Ask(0, "fence", on=True)),
        ("fence off", ipc.Ask(0, "fence", on=False)),
        ("mission upload 'my file.plan'", ipc.Ask(0, "mission_upload", path="my file.plan")),
        (r"mission upload C:\plans\a.plan", ipc.Ask(0, "mission_upload", path=r"C:\plans\a.plan")),
        ("mission download x.plan", ipc.Ask(0, "mission_download", path="x.plan")),
        ("mission start", ipc.Ask(0, "mission_start")),
        ("mission clear", ipc.Ask(0, "mission_clear")),
    ],
)
def test_a_line_becomes_a_request_to_the_station(line: str, expected: ipc.Ask) -> None:
    assert requests(line) == (expected,)


def test_mission_fly_uploads_then_starts() -> None:
    words = [request.word for request in requests("mission fly a.toml")]
    assert words == ["mission_upload", "mission_start"]


@pytest.mark.parametrize(
    ("line", "action"), [("wait 2.5", Wait(2.5)), ("state", ShowState()), ("quit", Quit())]
)
def test_words_for_the_console_send_nothing(line: str, action: request_words.Action) -> None:
    parsed = parse_line(line)
    assert parsed is not None
    assert parsed.action == action


@pytest.mark.parametrize("line", ["photo &", "photo&", "  photo   &  # later"])
def test_an_ampersand_at_the_end_does_not_wait(line: str) -> None:
    parsed = parse_line(line)
    assert parsed is not None
    assert parsed.text == "photo"
    assert not parsed.wait


@pytest.mark.parametrize("line", ["", "   ", "# a comment", "  # another", "&"])
def test_nothing_is_nothing(line: str) -> None:
    assert parse_line(line) is None


@pytest.mark.parametrize("typed", ["nan", "inf", "-inf"])
def test_what_is_no_number_for_flying_travels_as_null_for_the_gate_to_refuse(typed: str) -> None:
    (request,) = requests(f"goto {typed} 0 2")
    sent = ipc.decode_command(ipc.encode(request))
    assert isinstance(sent, ipc.Ask)
    assert sent.goal_enu == (None, 0.0, 2.0)
    assert request_words.label(sent) == "goto nan 0 2"


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("goto 1 2", "goto: expected 3 numbers EAST NORTH UP [YAW_DEG], got 2"),
        ("goto", "goto: expected 3 numbers EAST NORTH UP [YAW_DEG], got nothing"),
        ("goto 1 2 3 4 5", "goto: expected 3 numbers EAST NORTH UP [YAW_DEG], got 5"),
        ("goto 1 x 2", "goto: NORTH: expected a number, got 'x'"),
        ("goto 1,5 0 2", "goto: EAST: expected a number, got '1,5' (the decimal mark is a point)"),
        ("goto 1 0 2 nan", "goto: YAW_DEG: expected a finite number, got 'nan'"),
        ("arm now", "arm: expected no arguments, got 1"),
        ("takeoff", "takeoff: expected 1 number UP, got nothing"),
        ("disarm -f", "disarm: expected --force or nothing, got '-f'"),
        ("fence", "fence: expected on or off, got nothing"),
        ("fence maybe", "fence: expected on or off, got 'maybe'"),
        ("wait -1", "wait: SECONDS: expected a number of seconds, not negative, got '-1'"),
        ("wait inf", "wait: SECONDS: expected a number of seconds, not negative, got 'inf'"),
        ("mission upload", "mission upload: expected 1 file FILE, got nothing"),
        ("got 1 2 3", "got: not a word of ours"),
        ("mode 'OFF", "cannot read the line: No closing quotation"),
    ],
)
def test_a_wrong_line_says_what_was_expected(line: str, sentence: str) -> None:
    with pytest.raises(LineError) as wrong:
        parse_line(line)
    assert wrong.value.sentence == sentence
    assert wrong.value.hint


def test_an_unfinished_mission_word_lists_the_whole_ones() -> None:
    with pytest.raises(LineError, match="expected one of: mission upload, mission start"):
        parse_line("mission")


numbers = st.floats(-1e4, 1e4).map(lambda metres: round(metres, 2))


@given(st.tuples(numbers, numbers, numbers), st.none() | numbers)
def test_a_label_reads_back_as_the_same_request(
    goal: tuple[float, float, float], yaw: float | None
) -> None:
    request = ipc.Ask(0, "goto", goal_enu=goal, yaw_deg=yaw)
    (back,) = requests(request_words.label(request))
    assert back.goal_enu == pytest.approx(goal, rel=1e-5)
    assert (back.yaw_deg is None) == (yaw is None)


@pytest.mark.parametrize(
    "line",
    ["arm", "takeoff 2", "disarm --force", "mode HOLD", "fence off", "mission upload a.plan"],
)
def test_labels_are_what_an_operator_would_type(line: str) -> None:
    assert request_words.label(requests(line)[0]) == line


def test_infinity_is_kept_until_it_is_encoded() -> None:
    (request,) = requests("takeoff inf")
    assert request.up_m is not None
    assert math.isinf(request.up_m)
