"""The keyboard screen without a terminal, driven by real key presses through a script."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable

from textual.pilot import Pilot

from gcs.tui.app import FlyApp
from gcs.tui.keymap import DEFAULT, Keymap
from tests.unit.tui.listening_station import ListeningStation

Script = Callable[[FlyApp, ListeningStation, Pilot[None]], Awaitable[None]]


def flown(
    script: Script, size: tuple[int, int] = (120, 40), keys: Keymap = DEFAULT
) -> tuple[FlyApp, ListeningStation]:
    """Run the station headless through `script`."""

    async def run() -> tuple[FlyApp, ListeningStation]:
        station = ListeningStation()
        app = FlyApp(station, keymap=keys)
        async with app.run_test(size=size) as pilot:
            await pilot.pause()
            await script(app, station, pilot)
        return app, station

    return asyncio.run(run())


async def drawn(app: FlyApp, pilot: Pilot[None]) -> None:
    await pilot.pause()
    app.redraw()
    await pilot.pause()


def screen_text(app: FlyApp) -> str:
    lines = app.screen._compositor.render_strips()
    return "\n".join("".join(segment.text for segment in strip) for strip in lines)
