"""Typed lines: every word of the table, every way to get it wrong, and back to text."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs import ipc, request_words
from gcs.operator.line_parser import LineError, parse_line
from gcs.request_words import Quit, SendRequests, ShowHelp, ShowPreflight, ShowState, Wait


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
        ("move 2 0 -1", ipc.Ask(0, "goto", move_enu=(2.0, 0.0, -1.0))),
        ("move 2 0 1 90", ipc.Ask(0, "goto", move_enu=(2.0, 0.0, 1.0), yaw_deg=90.0)),
        ("forward 5", ipc.Ask(0, "goto", move_body=(5.0, 0.0, 0.0))),
        ("forward 5 -1 2", ipc.Ask(0, "goto", move_body=(5.0, -1.0, 2.0))),
        (
            "goto-global 47.3977601 -8.5 3",
            ipc.Ask(0, "goto", goal_global=(47.3977601, -8.5, 3.0)),
        ),
        (
            "goto-global 47.3977601 8.5 491 90 --amsl",
            ipc.Ask(0, "goto", goal_global=(47.3977601, 8.5, 491.0), amsl=True, yaw_deg=90.0),
        ),
        ("speed 1.5", ipc.Ask(0, "speed", speed_m_s=1.5)),
        ("heading -90", ipc.Ask(0, "heading", yaw_deg=-90.0)),
        ("orbit 5 1", ipc.Ask(0, "orbit", orbit=ipc.Circle(None, 5.0, 1.0, 1.0))),
        (
            "orbit -5 1 0 3 0 2",
            ipc.Ask(0, "orbit", orbit=ipc.Circle((3.0, 0.0, 2.0), -5.0, 1.0, 0.0)),
        ),
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
        ("mission set-current 3", ipc.Ask(0, "mission_set_current", item=3)),
    ],
)
def test_a_line_becomes_a_request_to_the_station(line: str, expected: ipc.Ask) -> None:
    assert requests(line) == (expected,)


def test_mission_fly_uploads_then_starts() -> None:
    words = [request.word for request in requests("mission fly a.toml")]
    assert words == ["mission_upload", "mission_start"]


@pytest.mark.parametrize(
    ("line", "action"),
    [
        ("wait 2.5", Wait(2.5)),
        ("state", ShowState()),
        ("status", ShowState()),
        ("preflight", ShowPreflight()),
        ("help", ShowHelp()),
        ("?", ShowHelp()),
        ("quit", Quit()),
    ],
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


@pytest.mark.parametrize(
    "typed",
    [
        "nan",
        "inf",
        "-inf",
        "infinity",
        "1_0",
        "1e999",
        "0x10",
        "\uff13",
        "\u0663",
        "1.5.",
        "--1",
        ".",
    ],
)
def test_what_only_looks_like_a_number_is_none(typed: str) -> None:
    with pytest.raises(LineError, match="EAST: expected a number"):
        parse_line(f"goto '{typed}' 0 2")


@pytest.mark.parametrize(
    ("typed", "number"),
    [("10", 10.0), ("+1.5", 1.5), ("-.5", -0.5), ("2.", 2.0), ("1e1", 10.0), ("1E-1", 0.1)],
)
def test_what_is_a_number(typed: str, number: float) -> None:
    assert requests(f"takeoff {typed}") == (ipc.Ask(0, "takeoff", up_m=number),)


@pytest.mark.parametrize(
    ("typed", "hint"),
    [
        ("aborrt", "did you mean abort?"),
        ("hodl", "did you mean hold?"),
        ("stat", "did you mean state?"),
        ("gotoo 3 0 2", "did you mean goto?"),
        ("takeof 2", "did you mean takeoff?"),
        ("hedding 90", "did you mean heading?"),
        ("misson fly a.toml", "did you mean mission?"),
        ("mission uplod a.toml", "did you mean mission upload?"),
        ("mission", "try mission upload"),
        ("xyzzy", "words: control, arm, takeoff"),
        ("arm all", "all is for: land, rtl, hold, abort"),
    ],
)
def test_a_hint_is_of_the_words_that_may_stand_there(typed: str, hint: str) -> None:
    with pytest.raises(LineError) as wrong:
        parse_line(typed)
    assert wrong.value.hint.startswith(hint)


@pytest.mark.parametrize("line", ["ABORT", "Abort", "abort  # now!"])
def test_an_abort_is_one_however_it_is_written(line: str) -> None:
    assert requests(line) == (ipc.Ask(0, "abort"),)


@pytest.mark.parametrize("line", ["!hold", "! hold", "  !hold  # at once"])
def test_a_mark_lets_a_stop_overtake(line: str) -> None:
    parsed = parse_line(line)
    assert parsed is not None
    assert parsed.text == "hold"
    assert parsed.overtakes(typed=False)


@pytest.mark.parametrize("word", request_words.WORDS, ids=lambda word: word.name)
def test_nothing_that_starts_a_motion_overtakes_and_every_stop_does(
    word: request_words.Word,
) -> None:
    parsed = parse_line(word.example)
    assert parsed is not None
    stops = {"abort", "hold", "land", "rtl"}
    assert parsed.overtakes(typed=True) == (word.name in stops | {"quit", "state", "help"})
    assert parsed.overtakes(typed=False) == (word.name == "abort")
    if word.at_once is request_words.ActsAtOnce.NEVER:
        with pytest.raises(LineError, match=f"{word.name}: waits for its turn"):
            parse_line("!" + word.example)


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("goto 1 2", "goto: expected 3 numbers EAST NORTH UP [YAW_DEG], got 2"),
        ("goto", "goto: expected 3 numbers EAST NORTH UP [YAW_DEG], got nothing"),
        ("goto 1 2 3 4 5", "goto: expected 3 numbers EAST NORTH UP [YAW_DEG], got 5"),
        ("goto 1 x 2", "goto: NORTH: expected a number, got 'x'"),
        ("goto 1,5 0 2", "goto: EAST: expected a number, got '1,5' (the decimal mark is a point)"),
        (
            "goto 1 0 2 nan",
            "goto: YAW_DEG: expected a number of degrees from -360 to 360, got 'nan'",
        ),
        (
            "goto 1 0 2 400",
            "goto: YAW_DEG: expected a number of degrees from -360 to 360, got '400'",
        ),
        ("goto 1 0 2 --speed 3", "goto: no option --speed"),
        ("goto -v 1 0 2", "goto: no option -v"),
        ("arm now", "arm: expected no arguments, got 1"),
        ("takeoff", "takeoff: expected 1 number UP, got nothing"),
        ("disarm -f", "disarm: no option -f"),
        ("disarm now", "disarm: expected at most [--force], got 1"),
        ("heading", "heading: expected 1 number of degrees from -360 to 360 YAW_DEG, got nothing"),
        (
            "goto-global 47 8 --amsl",
            "goto-global: expected 3 numbers LAT LON UP [--amsl] [YAW_DEG], got 2",
        ),
        ("goto-global 47 8 5 --sea", "goto-global: no option --sea"),
        (
            "orbit 5 1 1 0 0",
            "orbit: the centre is EAST NORTH UP, or nothing: where the vehicle is",
        ),
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


headings = st.floats(-360, 360).map(lambda degrees: round(degrees, 2))


@given(st.tuples(numbers, numbers, numbers), st.none() | headings)
def test_a_label_reads_back_as_the_same_request(
    goal: tuple[float, float, float], yaw: float | None
) -> None:
    request = ipc.Ask(0, "goto", goal_enu=goal, yaw_deg=yaw)
    (back,) = requests(request_words.label(request))
    assert back.goal_enu == pytest.approx(goal, rel=1e-5)
    assert (back.yaw_deg is None) == (yaw is None)


@pytest.mark.parametrize(
    "line",
    [
        "arm",
        "takeoff 2",
        "move 2 0 -1 90",
        "forward 5 -1 2",
        "goto-global 47.3977601 -8.5 491 --amsl 90",
        "heading 90",
        "speed 1.5",
        "orbit -5 1 0 3 0 2",
        "disarm --force",
        "mode HOLD",
        "fence off",
        "mission upload a.plan",
    ],
)
def test_labels_are_what_an_operator_would_type(line: str) -> None:
    assert request_words.label(requests(line)[0]) == line
