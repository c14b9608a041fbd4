"""The `:` line, its completion, the search of the log, and the question before leaving."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest
from textual.events import Key, Paste
from textual.pilot import Pilot

from gcs import ipc
from gcs.request_words import WORDS, Doer
from gcs.tui.app import FlyApp
from gcs.tui.completion import Known, complete, modes_of
from gcs.tui.verdict_ahead import LEAST_S, typed_line
from tests.unit.operator.fake_station import FakeStation
from tests.unit.tui.flown import drawn, flown, screen_text
from tests.unit.tui.listening_station import ListeningStation

pytestmark = pytest.mark.slow  # the screen's own timers

KNOWN = Known(("demo.toml", "lab3/square.toml"), modes_of("1/1 px4 quadrotor"))


async def typed(pilot: Pilot[None], text: str) -> None:
    """Each letter as a key, then Enter."""
    names = {" ": "space", "-": "minus", ".": "full_stop", "_": "underscore", "/": "slash"}
    await pilot.press("colon", *(names.get(letter, letter) for letter in text), "enter")


def test_a_typed_word_is_sent_and_space_types_a_space() -> None:
    async def script(_app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await typed(pilot, "goto 3 0 -2.5 90")
        assert station.requests() == ["goto"]
        (goal,) = station.sent
        assert isinstance(goal, ipc.Ask)
        assert (goal.goal_enu, goal.yaw_deg) == ((3.0, 0.0, -2.5), 90.0)
        await pilot.press("m")
        assert station.requests() == ["goto", "arm"]

    flown(script)


def test_what_comes_in_one_burst_keeps_its_order() -> None:
    """As a paste into a terminal without bracketed paste, or a quick hand, sends it."""

    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        names = {"\r": "enter", " ": "space", ":": "colon"}
        for letter in ":goto 1 0 2\r:land\r h:hold":
            app.post_message(Key(names.get(letter, letter), None if letter == "\r" else letter))
        app.post_message(Paste("& # of two\nlines"))
        app.post_message(Key("enter", None))
        await pilot.pause(0.1)
        assert station.requests() == ["goto", "land", "abort", "hold", "hold"]

    flown(script)


def test_a_typed_request_is_judged_before_it_is_sent() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.station.refusals[7.0, 0.0, 2.0] = ("OUTSIDE_FENCE", "350.0 m too far")
        await pilot.press("colon", *"goto", "space")
        await drawn(app, pilot)
        assert "goto: expected 3 numbers EAST NORTH UP [YAW_DEG]" in screen_text(app)
        await pilot.press("7", "space", "0", "space", "2")
        await pilot.pause(LEAST_S + 0.3)
        await drawn(app, pilot)
        assert "Enter: refused OUTSIDE_FENCE: 350.0 m too far" in screen_text(app)
        assert station.checked_goals()[-1] == (7.0, 0.0, 2.0)
        assert station.requests() == []
        await pilot.press("escape")
        await drawn(app, pilot)
        assert "OUTSIDE_FENCE" not in screen_text(app)

    flown(script, (80, 24))


@pytest.mark.parametrize(
    ("text", "asks", "hint"),
    [
        ("", "", ""),
        ("got", "", ""),
        ("goto 1 2", "", "goto: expected 3 numbers EAST NORTH UP [YAW_DEG], got 2"),
        ("goto 1 2 nan", "", "goto: UP: expected a number, got 'nan'"),
        ("takeoff 3", "takeoff", ""),
        ("forward 5", "goto", ""),
        ("mission upload a.plan", "", ""),  # the gate is not asked for it
        ("mission fly a.plan", "", ""),
        ("velocity 1 0 0", "", ""),
    ],
)
def test_what_the_gate_can_be_asked_of_a_line(text: str, asks: str, hint: str) -> None:
    line = typed_line(text)
    assert (line.ask.word if line.ask else "") == asks
    assert line.hint.startswith(hint)
    assert bool(line.hint) == bool(hint)
    assert line.goal_enu is None


def test_every_word_that_asks_a_station_is_one_of_the_line() -> None:
    for word in WORDS:
        if word.doer is not Doer.CONSOLE:
            assert complete(word.name[:-1], KNOWN).offers.count(word.name) == 1, word.name


def test_a_line_that_is_not_understood_is_told_with_what_would_be_right() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await typed(pilot, "goto 3")
        await drawn(app, pilot)
        assert "for example: goto 3 0 2" in screen_text(app)
        assert station.sent == []

    flown(script)


@pytest.mark.parametrize(("keys", "aborts"), [("escape", 0), ("escape escape", 1), ("ctrl+@", 1)])
def test_abort_is_always_near(keys: str, aborts: int) -> None:
    async def script(_app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await pilot.press("colon", "l", "a", "n", "d", *keys.split())
        assert station.requests() == ["abort"] * aborts

    flown(script)


def test_earlier_lines_come_back_and_tab_completes() -> None:
    async def script(_app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await typed(pilot, "hold")
        await typed(pilot, "photo")
        await pilot.press("colon", "up", "up", "enter")
        await pilot.press("colon", "t", "a", "k", "tab", "2", "enter")
        assert station.requests() == ["hold", "photo", "hold", "takeoff"]

    flown(script)


def test_a_mission_is_uploaded_and_then_started_by_one_line() -> None:
    async def script(_app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.station.state = "HOVERING"
        await typed(pilot, "mission fly demo")
        await pilot.pause()
        assert station.requests() == ["mission_upload", "mission_start"]
        upload = station.sent[0]
        assert isinstance(upload, ipc.Ask)
        assert Path(upload.path).is_file()

    flown(script)


def test_a_typed_velocity_ends_by_itself() -> None:
    async def script(_app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.station.state = "HOVERING"
        await typed(pilot, "velocity 1 0 0 0.8")
        await pilot.pause(1.2)
        assert station.requests() == ["stream_begin", "stream_end"]
        assert ipc.Stream(v_enu=(1.0, 0.0, 0.0)) in station.sent

    flown(script)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("tak", "takeoff "), ("mission u", "mission upload "), ("mode AUTO.LO", "mode AUTO.LOITER"),
        ("fence o", "fence o"), ("disarm ", "disarm --force"),
        ("mission fly lab", "mission fly lab3/"),
        ("xyz", "xyz"), ("goto 3", "goto 3"),
    ],
)  # fmt: skip
def test_tab_goes_as_far_as_is_certain(
    text: str, line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert complete(text, KNOWN).text.startswith(line)


def test_a_word_may_go_on_as_a_longer_word() -> None:
    assert set(complete("fence ", KNOWN).offers) >= {"on", "off", "fence put"}
    assert complete("fence of", KNOWN).text == "fence off"


def test_files_are_completed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "field.plan").write_text("{}")
    (tmp_path / "fields").mkdir()
    assert complete("mission upload fi", KNOWN).offers == ("field.plan", "fields/")
    assert complete("mission upload field.", KNOWN).text == "mission upload field.plan"


def test_the_log_is_searched_and_shown_whole_again() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.say(*(ipc.LogEvent(0, 2, "gate", f"item {n} reached") for n in (1, 2)))
        await pilot.press("slash", *"ITEM", "space", "1", "enter")
        await drawn(app, pilot)
        assert "item 1 reached" in screen_text(app)
        assert "item 2 reached" not in screen_text(app)
        await pilot.press("slash", "escape")
        await drawn(app, pilot)
        assert "item 2 reached" in screen_text(app)

    flown(script)


@pytest.mark.parametrize(
    ("keys", "leaves", "aborts"),
    [("q", 0, 0), ("q q", 1, 0), ("q y", 1, 0), ("q x", 0, 0), ("q space", 0, 1), ("ctrl+c", 1, 0)],
)
def test_whoever_flies_is_asked_before_leaving(keys: str, leaves: int, aborts: int) -> None:
    async def script(_app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.station.armed, station.station.pos = True, (0.0, 0.0, 2.0)
        station.fly(0.1)
        await pilot.pause()
        await pilot.press(*keys.split())
        assert sum(isinstance(each, ipc.Leave) for each in station.sent) == leaves
        assert station.requests() == ["abort"] * aborts

    flown(script)


def test_who_leaves_it_armed_on_the_ground_is_asked_too() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.station.armed = True
        station.fly(0.1)
        await pilot.pause()
        await pilot.press("q")
        await drawn(app, pilot)
        assert "The motors are armed, on the ground." in screen_text(app)
        assert not any(isinstance(each, ipc.Leave) for each in station.sent)
        await pilot.press("q")
        assert isinstance(station.sent[-1], ipc.Leave)

    flown(script)


@pytest.mark.parametrize(("client", "asks"), [(1, True), (7, False)])
def test_a_looker_on_is_asked_where_the_station_ends_with_its_screen(
    client: int, asks: bool
) -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.station.armed, station.station.pos = True, (0.0, 0.0, 2.0)
        station.station.in_control = ipc.OperatorInfo(2, "gcs fly")
        station.fly(0.1)
        await pilot.pause()
        assert app.scene.talk.hello is not None
        app.scene.talk.hello = msgspec.structs.replace(app.scene.talk.hello, client=client)
        await pilot.press("q")
        assert any(isinstance(each, ipc.Leave) for each in station.sent) is not asks

    flown(script)


def test_the_modes_offered_are_the_vehicles_own() -> None:
    assert "LOITER" in modes_of("1/1 ardupilot quadrotor")
    assert "AUTO.LOITER" in modes_of(FakeStation().snapshot().vehicle)
    assert modes_of("") == ()
