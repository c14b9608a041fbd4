"""The page behind the preflight key."""

from __future__ import annotations

import pytest
from textual.pilot import Pilot

from gcs import ipc
from gcs.tui.app import FlyApp
from tests.unit.tui.flown import drawn, flown, screen_text
from tests.unit.tui.listening_station import ListeningStation

pytestmark = pytest.mark.slow  # the screen's own timers


def test_the_key_shows_what_fails_with_what_mends_it_and_any_key_closes_it() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.station.preflight_rows.append(ipc.PreflightRow("battery", "fail", "12 % are left"))
        await pilot.press("P")
        await drawn(app, pilot)
        shown = screen_text(app)
        assert "FAIL     battery: 12 % are left" in shown
        assert ":param set NAV_DLL_ACT 2" in shown
        assert shown.index("battery") < shown.index("failsafes"), "the failures first"
        await pilot.press("m")
        assert not app.query_one("#preflight").display

    _, station = flown(script, size=(80, 24))
    assert station.requests() == [], "under the page a key does nothing else"


def test_the_typed_word_shows_it_too() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await pilot.press("colon", *"preflight", "enter")
        await drawn(app, pilot)
        assert app.query_one("#preflight").display

    flown(script)
