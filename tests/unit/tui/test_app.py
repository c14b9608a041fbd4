"""The keyboard station, driven by real key presses against a fake link."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable

import pytest
from textual.pilot import Pilot

from gcs import ipc
from gcs.cli.exits import Exit, Fail
from gcs.shell.client import LinkDown
from gcs.tui.app import FlyApp
from gcs.tui.result import tell
from tests.unit.tui.fake_station import StationLink

Script = Callable[[FlyApp, StationLink, Pilot[None]], Awaitable[None]]


def flown(script: Script, size: tuple[int, int] = (120, 40)) -> tuple[FlyApp, StationLink]:
    """Run the station headless through `script`."""

    async def run() -> tuple[FlyApp, StationLink]:
        link = StationLink()
        app = FlyApp(link)
        async with app.run_test(size=size) as pilot:
            await pilot.pause()
            await script(app, link, pilot)
        return app, link

    return asyncio.run(run())


async def drawn(app: FlyApp, pilot: Pilot[None]) -> None:
    await pilot.pause()
    app.redraw()
    await pilot.pause()


def screen_text(app: FlyApp) -> str:
    lines = app.screen._compositor.render_strips()
    return "\n".join("".join(segment.text for segment in strip) for strip in lines)


def test_moving_keys_send_no_request_and_one_keyboard_record_a_change() -> None:
    async def script(_app: FlyApp, link: StationLink, pilot: Pilot[None]) -> None:
        await pilot.press("right", "up", "d", "w", "pageup", "r", "left", "s", "f", "]", "\\", "x")
        assert link.asks() == []
        assert all(isinstance(command, ipc.Pending) for command in link.sent)
        # Twelve keys, of which the step changes no goal.
        assert len(link.sent) == 11

    flown(script)


def test_enter_sends_the_pending_goal_once_and_keeps_it() -> None:
    async def script(app: FlyApp, link: StationLink, pilot: Pilot[None]) -> None:
        await pilot.press("right", "enter")
        goals = [command for command in link.sent if isinstance(command, ipc.Ask)]
        assert [goal.word for goal in goals] == ["goto"]
        assert goals[0].goal_enu == (1.0, 0.0, 0.5)
        assert goals[0].yaw_deg is None
        assert app.scene.pending.goal_enu == (1.0, 0.0, 0.5)

    flown(script)


def test_every_command_key_asks_for_its_word() -> None:
    async def script(_app: FlyApp, link: StationLink, pilot: Pilot[None]) -> None:
        await pilot.press("c", "m", "t", "l", "b", "h", "e", "p", "i", "k", "M")
        assert link.asks() == [
            "control", "arm", "takeoff", "land", "rtl", "hold", "resume", "photo",
            "mission_start", "fence", "disarm",
        ]  # fmt: skip

    flown(script)


@pytest.mark.parametrize("key", ["space", "escape"])
def test_abort_is_one_key_and_is_on_its_way_before_anything_is_drawn(key: str) -> None:
    async def script(_app: FlyApp, link: StationLink, pilot: Pilot[None]) -> None:
        await pilot.press("question_mark", key)
        assert link.asks() == ["abort"]

    flown(script)


def test_a_flight_is_seen_with_pending_and_active_goal_apart() -> None:
    async def script(app: FlyApp, link: StationLink, pilot: Pilot[None]) -> None:
        await pilot.press("m", "t")
        link.fly(1.0)
        await pilot.press("right", "right", "right", "enter", "up")
        link.fly(0.5)
        await drawn(app, pilot)
        shown = screen_text(app)
        assert "pending E +3.00 N +1.00 U +0.50" in shown
        assert "active E +3.00 N +0.00 U +0.50" in shown
        assert "MOVING" in shown
        assert "goto 3 0 0.5: accepted" in shown

    flown(script)


def test_a_refusal_is_shown_with_its_reason() -> None:
    async def script(app: FlyApp, _link: StationLink, pilot: Pilot[None]) -> None:
        await pilot.press("t")
        await drawn(app, pilot)
        assert "takeoff 1.5: refused NOT_ARMED: the vehicle is not armed" in screen_text(app)

    flown(script)


def test_everything_that_matters_fits_a_small_terminal() -> None:
    async def script(app: FlyApp, link: StationLink, pilot: Pilot[None]) -> None:
        link.link.pos = (1.0, 1.0, 0.0)
        link.fly(0.2)
        await pilot.press("right")
        await drawn(app, pilot)
        shown = screen_text(app)
        for needed in ("1/1 px4", "GROUNDED", "pending", "active", "98 %", "ABORT", "quit", "⌂"):
            assert needed in shown, needed

    flown(script, size=(80, 24))


def test_v_puts_the_pending_goal_where_the_vehicle_is() -> None:
    async def script(app: FlyApp, link: StationLink, pilot: Pilot[None]) -> None:
        link.link.pos = (4.04, -2.0, 3.0)
        link.fly(0.1)
        await pilot.press("v")
        assert app.scene.pending.goal_enu == (4.0, -2.0, 3.0)

    flown(script)


@pytest.mark.parametrize("key", ["q", "ctrl+c"])
def test_leaving_says_so_waits_for_the_link_and_gives_its_result(key: str) -> None:
    async def script(app: FlyApp, link: StationLink, pilot: Pilot[None]) -> None:
        await pilot.press(key)
        assert isinstance(link.sent[-1], ipc.Leave)
        assert "Waiting until the vehicle is seen holding" in screen_text(app)
        await pilot.press(key)
        assert sum(isinstance(command, ipc.Leave) for command in link.sent) == 1
        link.say(LinkDown(ipc.Bye(0, "logs/x.mcap", "held"), 0, ""))
        await pilot.pause()
        assert not app.is_running

    app, _ = flown(script)
    told: list[str] = []
    assert tell(app.result, told.append) == Exit.DONE
    assert told == ["gcs: held", "log: logs/x.mcap"]


def test_a_link_that_dies_is_told_and_is_an_error() -> None:
    async def script(app: FlyApp, link: StationLink, pilot: Pilot[None]) -> None:
        link.say(LinkDown(None, -9, "last words"))
        await drawn(app, pilot)
        assert "THE LINK PROCESS HAS ENDED (EXIT CODE -9)" in screen_text(app)
        assert "last words" in screen_text(app)
        await pilot.press("q")

    app, link = flown(script)
    assert not any(isinstance(command, ipc.Leave) for command in link.sent)
    with pytest.raises(Fail, match="died") as failed:
        tell(app.result, lambda _: None)
    assert failed.value.exit_code == Exit.BUG
