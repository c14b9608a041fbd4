"""The verdict of the pending goal before Enter."""

from __future__ import annotations

import pytest
from textual.pilot import Pilot

from gcs import ipc
from gcs.tui import look
from gcs.tui.app import FlyApp
from gcs.tui.keyboard import PendingGoal
from gcs.tui.panels import map_panel
from gcs.tui.scene import Scene
from gcs.tui.verdict_ahead import LEAST_S, RENEW_S, Ahead, VerdictAhead
from tests.unit.operator.fake_station import FakeStation
from tests.unit.tui.flown import drawn, flown, screen_text
from tests.unit.tui.listening_station import ListeningStation

pytestmark = pytest.mark.slow  # the screen's own timers

HERE = ipc.Ask(0, "goto", goal_enu=(0.0, 0.0, 2.0))
THERE = ipc.Ask(0, "goto", goal_enu=(500.0, 0.0, 2.0))
CLEARS = ipc.Checked(1, "goto", "accepted")
OUTSIDE = ipc.Checked(
    1, "goto", "refused", "BUSY", "it climbs", goal_code="OUTSIDE_FENCE", goal_sentence="350 m out"
)
NOT_NOW = ipc.Checked(1, "goto", "refused", "NOT_FLYING", "it stands on the ground")
WAITS = ipc.Checked(1, "goto", "waits")


def told(*answers: ipc.Checked) -> VerdictAhead:
    ahead = VerdictAhead()
    ahead.asked(HERE, 1, 0.0)
    for answer in answers:
        ahead.told(answer)
    return ahead


def test_it_is_asked_for_at_most_twice_a_second_and_renewed_while_the_goal_stays() -> None:
    ahead = VerdictAhead()
    assert ahead.due(HERE, 100.0)
    ahead.asked(HERE, 1, 100.0)
    assert not ahead.due(THERE, 100.0 + LEAST_S / 2)
    assert ahead.due(THERE, 100.0 + LEAST_S)
    assert not ahead.due(HERE, 100.0 + LEAST_S)
    assert ahead.due(HERE, 100.0 + RENEW_S)
    ahead.outdate()  # as a hold does
    assert ahead.due(HERE, 100.0 + LEAST_S)


@pytest.mark.parametrize(
    ("answer", "means", "words"),
    [
        (CLEARS, Ahead.FREE, "Enter: accepted, the goal clears"),
        (OUTSIDE, Ahead.REFUSED, "Enter: refused OUTSIDE_FENCE: 350 m out"),
        (NOT_NOW, Ahead.LATER, "Enter: not now (the goal clears): NOT_FLYING: it stands on"),
        (WAITS, Ahead.LATER, "Enter: waits for its turn"),
    ],
)
def test_an_answer_is_a_mark_and_a_sentence(answer: ipc.Checked, means: Ahead, words: str) -> None:
    ahead = told(answer)
    assert ahead.of(HERE) is means
    assert ahead.words(HERE).startswith(words)


def test_an_answer_about_another_goal_says_nothing() -> None:
    ahead = told(CLEARS)
    assert ahead.of(THERE) is Ahead.UNKNOWN
    ahead.asked(THERE, 2, 1.0)
    ahead.told(CLEARS)  # the first question's, late
    assert ahead.of(THERE) is Ahead.UNKNOWN


@pytest.mark.parametrize(
    ("answer", "mark"), [(CLEARS, map_panel.PENDING), (OUTSIDE, map_panel.REFUSED)]
)
def test_the_mark_on_the_map_has_the_colour_of_the_verdict(answer: ipc.Checked, mark: str) -> None:
    scene = Scene()
    for event in [*FakeStation().hello(), FakeStation().snapshot()]:
        scene.update(event)
    scene.pending = PendingGoal((1.5, -1.0, 2.0))
    scene.ahead.asked(scene.pending.ask, 1, 0.0)
    scene.ahead.told(answer)
    picture = map_panel.draw(scene, 60, 20)
    map_rows = picture.plain.rsplit("\n", 1)[0]
    at = map_rows.index(mark)
    (style,) = {str(span.style) for span in picture.spans if span.start <= at < span.end}
    assert style == look.AHEAD[scene.ahead.of(scene.pending.ask)]


def test_a_goal_is_judged_on_the_screen_before_it_is_sent() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.station.refusals[1.0, 0.0, 0.5] = ("OUTSIDE_FENCE", "350.0 m too far")
        await pilot.press("right")
        await pilot.pause(LEAST_S + 0.3)
        await drawn(app, pilot)
        assert "Enter: refused OUTSIDE_FENCE: 350.0 m too far" in screen_text(app)
        assert station.checked_goals()[-1] == (1.0, 0.0, 0.5)
        assert station.requests() == []

    flown(script, (80, 24))
