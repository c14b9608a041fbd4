"""`gcs fly`: the keyboard screen.  A process of its own; the station never waits for it."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
import threading
from collections.abc import Callable, Sequence
from time import monotonic

from rich.console import RenderableType
from textual.app import App, ComposeResult
from textual.binding import Binding, BindingsMap
from textual.containers import Horizontal, Vertical
from textual.events import Resize
from textual.widget import Widget

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.operator import event_text
from gcs.operator.client import Listened, StationEnded, StationEvent
from gcs.operator.station_loss import after_station_died
from gcs.tui import frame_panels, fsa_panel, height_panel, look, map_panel, vehicle_panel
from gcs.tui.hang_up import on_hang_up
from gcs.tui.keyboard import PendingGoal, VelocityKeys
from gcs.tui.keymap import DEFAULT, Keymap
from gcs.tui.log_panel import LogPanel
from gcs.tui.result import SessionResult
from gcs.tui.scene import Answer, Scene

REDRAW_S = 0.1
STREAM_S = 0.1
LEAVE_WAIT_S = 8.0
RESTORE_WAIT_S = 5.0
"""For the screen to be given back.  A terminal that has closed, or that nobody reads, blocks every
write to it, and with it the loop: then the process ends by SIGALRM."""
SMALL_ROWS = 34
FOLDED_AFTER_S = 2.0


class Panel(Widget):
    """A drawing that fills whatever room it is given; put on the screen only where it changed."""

    can_focus = False

    def __init__(self, draw: Callable[[int, int], RenderableType], name: str, title: str = ""):
        super().__init__(id=name)
        self._draw = draw
        self._drawn: RenderableType = ""
        self.border_title = title

    def redraw(self) -> None:
        if self.display and self._drawing() != self._drawn:
            self.refresh()

    def render(self) -> RenderableType:
        self._drawn = self._drawing()
        return self._drawn

    def _drawing(self) -> RenderableType:
        return self._draw(self.content_size.width, self.content_size.height)


class FlyApp(App[None]):
    """Keys change a pending goal; Enter and the command keys send requests to the gate.

    Events are read in a thread and handled in the application's loop; the screen is drawn from
    the latest snapshot at 10 Hz, whatever comes in.  Requests are written to the station in the
    key handler itself, so that an abort waits for no drawing.
    """

    CSS_PATH = "fly.tcss"
    TITLE = "mavgate"
    ENABLE_COMMAND_PALETTE = False

    def __init__(
        self,
        connection: Listened,
        events: Sequence[ipc.Event] = (),
        *,
        mission_path: str = "",
        timeout_s: float | None = None,
        keymap: Keymap = DEFAULT,
    ) -> None:
        """`events`: those that came already.  `mission_path`: what the mission key uploads first.
        `timeout_s`: leave if no vehicle is heard within it; None waits for ever."""
        super().__init__()
        self._keys_of = keymap
        self._bindings = BindingsMap(
            Binding(name, f"press({name!r})", key.help, show=False, priority=True)
            for key in keymap.keys
            for name in key.names
        )
        self._mission_path = mission_path
        self._timeout_s = timeout_s
        self._start_after: int | None = None
        self.interrupted = False
        self._connection = connection
        self._first_events = events
        self.scene = Scene()
        self._leaving = False
        self._station_gone = threading.Event()

    @property
    def result(self) -> SessionResult:
        """How it ended, once `run` has returned; waits for the station process to end."""
        self._end_within(0.0)
        talk = self.scene.talk
        if talk.ended is None:
            talk.told(self._connection.close())
        return SessionResult(talk, self._leaving)

    @property
    def heard_vehicle(self) -> bool:
        """Whether any vehicle was heard at all."""
        return self.scene.heard_vehicle

    # ------------------------------------------------------------------------- screen

    def compose(self) -> ComposeResult:
        scene = self.scene
        yield Panel(lambda columns, _: frame_panels.header(scene, columns), "header")
        with Horizontal(id="upper"):
            yield Panel(lambda columns, rows: map_panel.draw(scene, columns, rows), "map", "map")
            yield Panel(lambda _, rows: height_panel.draw(scene, rows), "height", "up m")
            with Vertical(id="side"):
                yield Panel(lambda _c, _r: fsa_panel.draw(scene), "fsa", "state")
                yield Panel(lambda _c, _r: vehicle_panel.draw(scene), "vehicle", "vehicle")
        yield Panel(lambda _c, _r: vehicle_panel.goals(scene), "goals")
        yield Panel(lambda columns, _: vehicle_panel.answer(scene, columns), "answer")
        yield LogPanel()
        yield Panel(lambda columns, _: frame_panels.footer(columns, self._keys_of), "footer")
        page = Panel(lambda _c, _r: frame_panels.help_table(self._keys_of), "help", "keys")
        page.border_subtitle = "any key closes this, Space aborts as well"
        yield page
        yield Panel(lambda _c, _r: frame_panels.farewell(scene), "farewell")

    def on_mount(self) -> None:
        loop = asyncio.get_running_loop()
        for event in self._first_events:
            self._handle(event)
        self._connection.listen(lambda event: self._hear(loop, event))
        self.set_interval(REDRAW_S, self.redraw)
        self.set_interval(STREAM_S, self._stream)
        self.set_interval(FOLDED_AFTER_S, self.query_one(LogPanel).tell_folded)
        if self._timeout_s is not None:
            self.set_timer(self._timeout_s, self._leave_without_vehicle)
        if not self.is_headless and sys.platform != "win32":
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                loop.add_signal_handler(number, self._leave, number.name)
                # The loop hears of it through a pipe; this runs even while it hangs in a write.
                signal.signal(number, lambda *_: self._end_within(LEAVE_WAIT_S + RESTORE_WAIT_S))
            on_hang_up(sys.__stdin__.fileno() if sys.__stdin__ else 0, self._leave_without_screen)

    def _hear(self, loop: asyncio.AbstractEventLoop, event: StationEvent) -> None:
        """In the reader's thread."""
        if isinstance(event, StationEnded):
            self._station_gone.set()
        if not loop.is_closed():  # then nothing handles events any more
            loop.call_soon_threadsafe(self._handle, event)

    def _leave_without_screen(self) -> None:
        """The terminal has closed: the station holds the vehicle, and this process ends with it.

        In a thread of its own.  The loop may be stuck in a write for ever.
        """
        self._connection.send(ipc.Leave("the terminal has closed"))
        self._station_gone.wait(LEAVE_WAIT_S)
        os._exit(ExitCode.INTERRUPTED)

    def on_resize(self, event: Resize) -> None:
        self.screen.set_class(event.size.height < SMALL_ROWS, "-small")

    def redraw(self) -> None:
        """Draw every panel anew from the scene."""
        for panel in self.query("#answer").results(Panel):
            rows = vehicle_panel.answer_rows(self.scene, panel.content_size.width)
            if panel.styles.height is None or panel.styles.height.value != rows:
                panel.styles.height = rows
        for panel in self.query(Panel):
            panel.redraw()

    # -------------------------------------------------------------------------- events

    def _handle(self, event: StationEvent) -> None:
        if isinstance(event, StationEnded):
            self._handle_end(event)
            return
        self.scene.update(event)
        match event:
            case ipc.LogEvent():
                style = look.LEVEL[event.level]
                self._log_line(event_text.log_line(event), style, event.level, event.time_ns)
            case ipc.StateEvent(before="STREAMING", after=after) if after != "STALE":
                self.scene.velocity = None
            case ipc.VerdictEvent(word="stream_begin", outcome="refused"):
                self.scene.velocity = None
            case ipc.EndingEvent() if event.id == self._start_after:
                self._start_after = None
                if event.ended == "complete":
                    self._request(ipc.Ask(0, "mission_start"))
            case ipc.Trouble():
                for line in event_text.trouble_lines(event):
                    self._log_line(line, look.BAD)
            case ipc.Snapshot():
                hover_enu = self.scene.take_hover_point()
                if hover_enu is not None:
                    self._set_pending(self.scene.pending.at(hover_enu))
            case _:
                pass

    def _handle_end(self, ended: StationEnded) -> None:
        self.scene.talk.told(ended)
        if self._leaving:
            self._give_back()
            return
        sentence = f"the link process has ended (exit code {ended.exit_code}); q leaves"
        self.scene.answer = Answer(sentence.upper(), "refused")
        alone = [after_station_died(self.scene.snapshot)] if ended.bye is None else []
        for line in [sentence, *alone, *ended.stderr_tail.splitlines()]:
            self._log_line(line, look.BAD)

    def _log_line(self, text: str, style: str, level: int = 4, time_ns: int | None = None) -> None:
        self.query_one(LogPanel).tell(text, style, level, time_ns)

    # ---------------------------------------------------------------- keys: the one door

    async def action_press(self, name: str) -> None:
        """Every key of ours comes through here.  Under an open help page nothing is sent unseen:
        any key closes it, and of all keys only the abort acts as well."""
        self.scene.note_key()
        self.interrupted = self.interrupted or name == "ctrl+c"
        self._start_after = None  # whoever presses another key has something else in mind
        if not self._close_help() or name == self._keys_of.abort:
            await self.run_action(self._keys_of.actions[name])

    def on_key(self) -> None:
        """A key that is not ours."""
        self._close_help()

    def _close_help(self) -> bool:
        """Whether there was a page to close."""
        page = self.query_one("#help")
        shown = bool(page.display)
        page.display = False
        return shown

    # --------------------------------------------------------------- keys: pending goal

    def _set_pending(self, pending: PendingGoal) -> None:
        before, self.scene.pending = self.scene.pending, pending
        if (before.goal_enu, before.yaw_deg) != (pending.goal_enu, pending.yaw_deg):
            self._connection.send(ipc.Pending(pending.goal_enu, pending.yaw_deg))
        self.redraw()

    def action_move(self, direction: str) -> None:
        if self.scene.velocity is not None:
            step_m = self.scene.pending.step_m
            self.scene.velocity = self.scene.velocity.pressed(direction, step_m, monotonic())
            self._stream()
            return
        self._set_pending(self.scene.pending.moved(direction))

    def action_turn(self, by_deg: float) -> None:
        seen = self.scene.snapshot
        self._set_pending(self.scene.pending.turned(by_deg, None if seen is None else seen.yaw_deg))

    def action_free_yaw(self) -> None:
        self._set_pending(self.scene.pending.with_free_yaw())

    def action_step(self) -> None:
        self._set_pending(self.scene.pending.with_next_step())

    def action_here(self) -> None:
        seen = self.scene.snapshot
        if seen is not None and seen.pos_enu is not None:
            self._set_pending(self.scene.pending.at(seen.pos_enu))

    # --------------------------------------------------------------------- keys: send

    def _request(self, request: ipc.Ask) -> int:
        """Send it under a number of its own, which is returned."""
        numbered = self.scene.ask(request)
        if not self._connection.send(numbered):
            self.scene.answer = Answer(f"{request.word}: not sent, the link is down", "refused")
        return numbered.id

    def action_request(self, word: str) -> None:
        self._request(ipc.Ask(0, word))

    def action_send(self) -> None:
        pending = self.scene.pending
        goal = ipc.Ask(0, "goto", goal_enu=pending.goal_enu, yaw_deg=pending.yaw_deg)
        self._request(goal)

    def action_take_off(self) -> None:
        self._request(ipc.Ask(0, "takeoff", up_m=self.scene.pending.take_off_up_m))

    def action_fly_mission(self) -> None:
        """Start the mission on board; with one of `--mission`, once that is on board."""
        if self._mission_path:
            upload = ipc.Ask(0, "mission_upload", path=self._mission_path)
            self._start_after = self._request(upload)
        else:
            self.action_request("mission_start")

    def action_velocity(self) -> None:
        """Into velocity mode, which is a stream to the station, and out of it."""
        if self.scene.velocity is not None:
            self.scene.velocity = None
            self.action_request("stream_end")
            return
        self.scene.velocity = VelocityKeys()
        self.action_request("stream_begin")

    def _stream(self) -> None:
        """In velocity mode: what the keys say now, or to stand still."""
        if self.scene.velocity is not None and not self._leaving:
            self._connection.send(ipc.Stream(v_enu=self.scene.velocity.flown(monotonic())))

    def action_switch_fence(self) -> None:
        self._request(ipc.Ask(0, "fence", on=not self.scene.fence_on))

    # ------------------------------------------------------------------- keys: station

    def action_zoom(self, by: int) -> None:
        self.scene.zoom += by
        self.redraw()

    def action_fit(self) -> None:
        self.scene.zoom = 0
        self.redraw()

    def action_log_level(self) -> None:
        self.scene.answer = Answer(f"log: {self.query_one(LogPanel).cycle_level()}", "")

    def action_help(self) -> None:
        self.query_one("#help").display = True

    def action_leave(self) -> None:
        self._leave("quit")

    def _leave_without_vehicle(self) -> None:
        if not self.heard_vehicle:
            self._leave("no vehicle heard")

    def _leave(self, reason: str) -> None:
        """Once: say good-bye, show it, and exit when the station has ended, or after 8 s."""
        if self.scene.talk.ended is not None:
            self._give_back()
        elif not self._leaving:
            self._leaving = True
            self._connection.send(ipc.Leave(reason))
            self.query_one("#farewell").display = True
            self.set_timer(LEAVE_WAIT_S, self._give_back)

    def _give_back(self) -> None:
        """Give the screen back, and end."""
        self._end_within(RESTORE_WAIT_S)
        self.exit()

    def _end_within(self, seconds: float) -> None:
        """End the process by SIGALRM then, unless another time (0: none) is set before."""
        if not self.is_headless and sys.platform != "win32":
            signal.setitimer(signal.ITIMER_REAL, seconds)
