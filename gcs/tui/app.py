"""`gcs fly`: the keyboard screen.  A process of its own; the station never waits for it."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from time import monotonic

from rich.console import RenderableType
from textual.app import ComposeResult
from textual.binding import Binding, BindingsMap
from textual.containers import Horizontal, Vertical
from textual.events import Click, Resize
from textual.message import Message
from textual.widgets import Static

from gcs import ipc, resources
from gcs.operator.client import Listened, StationEnded, StationEvent
from gcs.operator.station_loss import after_station_died
from gcs.operator.text import event_text
from gcs.tui import look, preflight_page, wind
from gcs.tui.ascii_signs import needed
from gcs.tui.command_line import CommandLine
from gcs.tui.completion import Known, modes_of
from gcs.tui.keymap import DEFAULT, Keymap
from gcs.tui.line_actions import LineActions
from gcs.tui.panels import (
    decisions_panel,
    frame_panels,
    fsa_panel,
    height_panel,
    map_panel,
    mission_panel,
    vehicle_panel,
)
from gcs.tui.panels.graphs import Graphs
from gcs.tui.panels.log_panel import LogPanel
from gcs.tui.panels.panel import Panel
from gcs.tui.scene import REFUSED, Answer

REDRAW_S = 0.1
STREAM_S = 0.1
SMALL_ROWS = 34
WIDE_COLUMNS = 150
TALL_ROWS = 50
GOAL_PANELS = ("#goals", "#ahead", "#map", "#height")
FOLDED_AFTER_S = 2.0


class MapPanel(Panel):
    """The map, which can be clicked, and zoomed by the wheel."""

    class Clicked(Message):
        """On a cell of the drawing."""

        def __init__(self, column: int, row: int) -> None:
            super().__init__()
            self.column, self.row = column, row

    def on_click(self, event: Click) -> None:
        at = event.get_content_offset(self)
        if at is not None:
            self.post_message(self.Clicked(at.x, at.y))


class FlyApp(LineActions):
    """The panels, and what the station tells.

    Events are read in a thread and handled in the application's loop; the screen is drawn from
    the latest snapshot at 10 Hz, whatever comes in.
    """

    CSS_PATH = "fly.tcss"
    TITLE = "mavgate"
    ENABLE_COMMAND_PALETTE = False
    AUTO_FOCUS = None  # keys are letters of the line only while that is open

    def __init__(
        self,
        connection: Listened,
        events: Sequence[ipc.Event] = (),
        *,
        mission_path: str = "",
        timeout_s: float | None = None,
        keymap: Keymap = DEFAULT,
        ascii_only: bool = False,
        vehicle: int = 0,
    ) -> None:
        """`events`: those that came already.  `mission_path`: what the mission key uploads first.
        `timeout_s`: leave if no vehicle is heard within it; None waits for ever.
        `ascii_only`: draw without any other sign, as where the terminal is not UTF-8.  `vehicle`:
        the system id of the one of several that is shown at first; 0: the first that was heard."""
        super().__init__(connection, mission_path, keymap)
        self._bindings = BindingsMap(
            Binding(name, f"press({name!r})", show=False, priority=True) for name in self.bound
        )
        self._timeout_s = timeout_s
        self._first_events = events
        self._subscribed = ""
        self._vehicle = vehicle
        self._ascii = ascii_only or needed()

    # ------------------------------------------------------------------------- screen

    def compose(self) -> ComposeResult:
        scene, line = self.scene, CommandLine(self.entered)
        graphs = Graphs(scene.numbers)
        yield Panel(lambda columns, _: frame_panels.header(scene, columns), "header")
        yield Panel(lambda columns, _: frame_panels.alarms(scene, columns), "alarms")
        with Horizontal(id="upper"):
            yield MapPanel(lambda columns, rows: map_panel.draw(scene, columns, rows), "map", "map")
            yield Panel(lambda _, rows: height_panel.draw(scene, rows), "height", "up m")
            with Vertical(id="side"):
                yield Panel(lambda _c, _r: fsa_panel.draw(scene), "fsa", "state")
                yield Panel(lambda _c, _r: vehicle_panel.draw(scene), "vehicle", "vehicle")
                yield Panel(lambda *size: mission_panel.draw(scene, *size), "mission", "mission")
            with Vertical(id="wide"):
                yield Panel(graphs.draw, "graphs", "last ten minutes")
                yield Panel(
                    lambda *size: decisions_panel.draw(scene, *size), "decided", "decisions"
                )
        yield Panel(lambda _c, _r: vehicle_panel.goals(scene), "goals")
        yield Panel(lambda _c, _r: vehicle_panel.ahead(scene), "ahead")
        yield Panel(lambda columns, _: vehicle_panel.answer(scene, columns), "answer")
        yield LogPanel()
        with Horizontal(id="typed"):
            yield Static(id="prompt")
            yield line
        yield Panel(lambda columns, _: self._footer(line, columns), "footer")
        page = Panel(lambda _c, _r: frame_panels.help_table(self.keymap), "help", "keys")
        page.border_subtitle = "any key closes this, Space aborts as well"
        yield page
        before = Panel(lambda _c, _r: preflight_page.draw(scene), "preflight", "before a take-off")
        before.border_subtitle = page.border_subtitle
        yield before
        yield Panel(lambda _c, _r: frame_panels.question(scene), "question")
        yield Panel(lambda _c, _r: frame_panels.farewell(scene), "farewell")

    def _footer(self, line: CommandLine, columns: int) -> RenderableType:
        if line.display:
            return frame_panels.typing(line, columns)
        return frame_panels.footer(columns, self.keymap)

    def on_mount(self) -> None:
        loop = asyncio.get_running_loop()
        self.screen.set_class(self._ascii, "-ascii")
        for event in self._first_events:
            self._handle(event)
        self._connection.listen(lambda event: self._hear(loop, event))
        self._connection.send(self.scene.talk.list_operations())
        self.set_interval(REDRAW_S, self.redraw)
        self.set_interval(STREAM_S, self._stream)
        self.set_interval(FOLDED_AFTER_S, self.query_one(LogPanel).tell_folded)
        if self._timeout_s is not None:
            self.set_timer(self._timeout_s, self._leave_without_vehicle)
        self._leave_on_signals()

    def _hear(self, loop: asyncio.AbstractEventLoop, event: StationEvent) -> None:
        """In the reader's thread."""
        if isinstance(event, StationEnded):
            self._station_gone.set()
        if not loop.is_closed():  # then nothing handles events any more
            loop.call_soon_threadsafe(self._handle, event)

    def on_resize(self, event: Resize) -> None:
        self.screen.set_class(event.size.height < SMALL_ROWS, "-small")
        self.screen.set_class(event.size.width >= WIDE_COLUMNS, "-wide")
        self.screen.set_class(event.size.height >= TALL_ROWS, "-tall")

    def on_map_panel_clicked(self, clicked: MapPanel.Clicked) -> None:
        self.click_map(clicked.column, clicked.row)

    def on_mouse_scroll_up(self) -> None:
        self.action_zoom(-1)

    def on_mouse_scroll_down(self) -> None:
        self.action_zoom(1)

    def redraw_goal(self) -> None:
        """Only what a moved goal changes: the sooner it is on the screen."""
        for name in GOAL_PANELS:
            for panel in self.query(name).results(Panel):
                panel.redraw()

    def redraw(self) -> None:
        """Draw every panel anew from the scene; ring where an alarm wants it."""
        if not self.query("#alarms"):
            return  # the screen has been given back
        self._look_at_line()
        self._look_ahead()
        if self.scene.alarms.rings(monotonic()):
            self.bell()
        self._make_room()
        for panel in self.query(Panel):
            panel.redraw()

    def _make_room(self) -> None:
        """As many rows as the alarms, the answer and a typed line need."""
        self.query_one("#alarms").display = bool(self.scene.alarms.open)
        panel = self.query_one("#answer")
        rows = vehicle_panel.answer_rows(self.scene, panel.content_size.width)
        if panel.styles.height is None or panel.styles.height.value != rows:
            panel.styles.height = rows
        line = self.query_one(CommandLine)
        typed = self.query_one("#typed")
        if typed.display != line.display:
            typed.display = line.display
            self.query_one("#prompt", Static).update(line.prompt)

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
            case ipc.EndingEvent():
                self._ended(event)
            case ipc.History(log=lines):
                self.query_one(LogPanel).before(lines)
            case ipc.Trouble():
                for line in event_text.trouble_lines(event):
                    self._log_line(line, look.BAD)
            case ipc.Snapshot():
                hover_enu = self.scene.take_hover_point()
                if hover_enu is not None:
                    self.scene.pending = self.scene.pending.at(hover_enu)
                self._meet(event)
                if event.others and event.vehicle and not self._connection.sysid:
                    # From now on each request names the one that is shown.
                    self.choose(self._vehicle or event.sysid)
            case _:
                pass

    def _handle_end(self, ended: StationEnded) -> None:
        self.scene.talk.told(ended)
        if self._leaving:
            self._give_back()
            return
        code = ended.exit_code
        what = "connection to the station was lost"
        how = what if code is None else f"link process has ended (exit code {code})"
        sentence = f"the {how}; q leaves"
        self.scene.answer = Answer(sentence.upper(), REFUSED)
        self.scene.alarms.station_lost()
        alone = [after_station_died(self.scene.snapshot)] if ended.bye is None else []
        for line in [sentence, *alone, *ended.stderr_tail.splitlines()]:
            self._log_line(line, look.BAD)

    def _meet(self, seen: ipc.Snapshot) -> None:
        """A vehicle is heard for the first time: what it is asked to tell, and what Tab knows."""
        wanted = wind.message_for(seen.vehicle)
        if wanted != self._subscribed:
            self._subscribed = wanted
            self._connection.send(ipc.Subscribe([wanted] if wanted else []))
            known = Known(tuple(resources.shipped()), modes_of(seen.vehicle))
            self.query_one(CommandLine).known = known
