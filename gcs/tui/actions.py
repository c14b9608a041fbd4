"""What the keys do.  All that keys and typed lines (`line_actions.py`) send leaves from here."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from time import monotonic

import msgspec
from textual.events import Event, Key, Paste

from gcs import ipc, request_words
from gcs.operator.client import Listened
from gcs.tui import fleet
from gcs.tui.command_line import CommandLine
from gcs.tui.keyboard import DIRECTIONS, PendingGoal, VelocityKeys
from gcs.tui.keymap import Keymap
from gcs.tui.keys import ABORT_IN_A_LINE, ALWAYS
from gcs.tui.leaving import LeavingApp
from gcs.tui.panels import map_panel
from gcs.tui.panels.log_panel import LogPanel
from gcs.tui.scene import REFUSED, Answer
from gcs.tui.verdict_ahead import VerdictAhead


class KeyActions(LeavingApp):
    """Keys change a pending goal; Enter and the command keys send requests.

    Requests are written to the station in the key's handler itself, so that an abort waits for no
    drawing.
    """

    def __init__(self, connection: Listened, mission_path: str, keymap: Keymap) -> None:
        super().__init__(connection)
        self.keymap = keymap
        self.bound = {**keymap.actions, **ALWAYS}
        """What each key does; those of `ALWAYS` whatever keys a user has chosen."""
        self._of_station = {name for key in keymap.sections[-1][1] for name in key.names}
        self._mission_path = mission_path
        self._then: dict[int, Sequence[ipc.Ask]] = {}
        """What is sent once the request of that number is complete."""

    def redraw(self) -> None:
        """Draw every panel anew from the scene."""
        raise NotImplementedError

    def redraw_goal(self) -> None:
        """Draw what shows the pending goal."""
        raise NotImplementedError

    # ---------------------------------------------------------------- keys: the one door

    async def on_event(self, event: Event) -> None:
        """While a line is typed the keys are its letters.

        Esc and a letter that were read together, as after a stall of the network, come as Alt with
        that letter: the Esc counts, which stops the vehicle, and the letter is dropped."""
        if isinstance(event, Key) and event.key.startswith("alt+") and event.character:
            event = Key("escape", None)
        typed = isinstance(event, Key | Paste) and not event.is_forwarded
        line = self.query_one(CommandLine) if typed and self.query(CommandLine) else None
        if line is None or not line.display or (isinstance(event, Key) and event.key in ALWAYS):
            await super().on_event(event)
        elif isinstance(event, Key | Paste):
            await line.take(event)

    async def action_press(self, name: str) -> None:
        """Every key of ours comes through here.  Under an open page nothing is sent unseen: any key
        closes it, and of all keys only the abort acts as well."""
        self.scene.note_key()
        self.interrupted = self.interrupted or name == "ctrl+c"
        if name not in self._of_station:
            self._then.clear()  # whoever presses another key has something else in mind
        does = self.bound[name]
        aborts = name in (self.keymap.abort, ABORT_IN_A_LINE)
        line = self.query_one(CommandLine)
        if line.display and aborts:
            line.action_close()  # what is pressed next is not meant for it
        leaves = does == "leave" or name in ("y", "enter")
        if self._answered(leave=leaves) or self._close_help():
            if aborts:
                await self.run_action(does)
        elif name == "ctrl+c":
            self._leave("quit")
        else:
            await self.run_action(does)

    def on_key(self) -> None:
        """A key that is not ours."""
        self._answered(leave=False)
        self._close_help()

    def _close_help(self) -> bool:
        """Whether there was a page to close."""
        shown = [page for page in self.query("#help, #preflight") if page.display]
        for page in shown:
            page.display = False
        return bool(shown)

    # --------------------------------------------------------------- keys: pending goal

    def _set_pending(self, pending: PendingGoal) -> None:
        before, self.scene.pending = self.scene.pending, pending
        if before.ask != pending.ask:
            self.scene.pending_set = True
            self._connection.send(ipc.Pending(pending.goal_enu, pending.yaw_deg))
            self._look_ahead()
        self.redraw_goal()

    def _look_ahead(self) -> None:
        """Ask what the gate would say to the pending goal and to a typed line, where it is due."""
        scene = self.scene
        if scene.lost or not scene.heard_vehicle or self._leaving:
            return
        if scene.typed is not None:
            if scene.typed.ask is not None:
                self._ask_about(scene.typed.ask, scene.typed_ahead)
        elif scene.velocity is None:
            self._ask_about(scene.pending.ask, scene.ahead)

    def _ask_about(self, ask: ipc.Ask, ahead: VerdictAhead) -> None:
        now_s = monotonic()
        if ahead.due(ask, now_s):
            check = self.scene.talk.check(ask)
            ahead.asked(ask, check.asked.id, now_s)
            self._connection.send(check)

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
        """Send it under a number of its own, which is returned.  Of a file the name is shown."""
        shown = msgspec.structs.replace(request, path=Path(request.path).name)
        every = request.vehicle == ipc.EVERY
        label = ("" if every else self.scene.of_several) + request_words.label(shown)
        if not every:
            request = msgspec.structs.replace(request, vehicle=self._connection.sysid)
        numbered = self.scene.ask(request, label)
        if not self._connection.send(numbered):
            self.scene.answer = Answer(f"{request.word}: not sent, the link is down", REFUSED)
        return numbered.id

    def _request_in_turn(self, requests: Sequence[ipc.Ask]) -> None:
        """Each once the one before is complete; a key that is pressed meanwhile drops the rest."""
        number = self._request(requests[0])
        self._then = {number: requests[1:]} if requests[1:] else {}

    def _ended(self, event: ipc.EndingEvent) -> None:
        """A request has ended: what was to follow it does, if it is complete."""
        rest = self._then.pop(event.id, ())
        if rest and event.ended == "complete":
            self._request_in_turn(rest)

    def action_request(self, word: str) -> None:
        self._request(ipc.Ask(0, word))

    def action_stop_all(self) -> None:
        """Every vehicle, whichever is shown."""
        self._request(ipc.Ask(0, "abort", vehicle=ipc.EVERY))

    def action_send(self) -> None:
        self._request(self.scene.pending.ask)

    def action_take_off(self) -> None:
        self._request(ipc.Ask(0, "takeoff", up_m=self.scene.pending.take_off_up_m))

    def action_fly_mission(self) -> None:
        """Start the mission on board; with one of `--mission`, once that is on board."""
        start = ipc.Ask(0, "mission_start")
        upload = ipc.Ask(0, "mission_upload", path=self._mission_path)
        self._request_in_turn([upload, start] if self._mission_path else [start])

    def action_velocity(self) -> None:
        """Into velocity mode, which is a stream to the station, and out of it."""
        if self.scene.velocity is not None:
            self.scene.velocity = None
            self.action_request("stream_end")
            return
        self.scene.velocity = VelocityKeys()
        self.action_request("stream_begin")

    def _stream(self) -> None:
        """In velocity mode: what the keys say now, or to stand still; a typed velocity ends."""
        velocity, now_s = self.scene.velocity, monotonic()
        if velocity is None or self._leaving:
            return
        if velocity.over(now_s):
            self.action_velocity()
        else:
            self._connection.send(ipc.Stream(v_enu=velocity.flown(now_s)))

    def action_switch_fence(self) -> None:
        self._request(ipc.Ask(0, "fence", on=not self.scene.fence_on))

    # ------------------------------------------------------------------- keys: station

    def action_next_vehicle(self) -> None:
        seen = self.scene.snapshot
        number = 0 if seen is None else fleet.next_of(seen)
        if number:
            self.choose(number)
        else:
            self.scene.answer = Answer("no other vehicle is heard", "")

    def choose(self, sysid: int) -> None:
        """Show that vehicle: from now on keys and words are for that one."""
        if self.scene.velocity is not None:
            self.action_velocity()  # a stream of keys is for the vehicle that was shown
        self._then.clear()
        self.scene.choose(sysid)
        self._connection.choose(sysid)

    def action_acknowledge(self) -> None:
        if not self.scene.alarms.acknowledge():
            self.scene.answer = Answer("no alarm to acknowledge", "")
        self.redraw()

    def action_zoom(self, by: int) -> None:
        self.scene.zoom += by
        self.redraw()

    def action_pan(self, direction: str) -> None:
        """A quarter of what the map shows."""
        east, north, _ = DIRECTIONS[direction]
        size = self.query_one("#map").content_size
        view = map_panel.view_of(self.scene, size.width, size.height)
        east_m, north_m = self.scene.pan_en
        self.scene.pan_en = (
            east_m + east * view.half_width_m / 2,
            north_m + north * view.half_height_m / 2,
        )
        self.redraw()

    def click_map(self, column: int, row: int) -> None:
        """The pending goal goes where the map was clicked, at its height."""
        size = self.query_one("#map").content_size
        if self.scene.velocity is None and row < size.height - 1:
            east_m, north_m = map_panel.place(self.scene, size.width, size.height, (column, row))
            up_m = self.scene.pending.goal_enu[2]
            self._set_pending(replace(self.scene.pending, goal_enu=(east_m, north_m, up_m)))

    def action_fit(self) -> None:
        self.scene.zoom, self.scene.pan_en = 0, (0.0, 0.0)
        self.redraw()

    def action_log_level(self) -> None:
        self.scene.answer = Answer(f"log: {self.query_one(LogPanel).cycle_level()}", "")

    def action_preflight(self) -> None:
        self._connection.send(self.scene.talk.preflight())
        self.query_one("#preflight").display = True

    def action_items(self) -> None:
        """The mission panel, and back; a tall screen always has it."""
        self.screen.toggle_class("-mission")
        self.call_after_refresh(self.redraw)

    def action_help(self) -> None:
        self.query_one("#help").display = True
