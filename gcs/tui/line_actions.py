"""What the typed lines do: any word of the console after `:`, a search of the log after `/`."""

from __future__ import annotations

import contextlib
from pathlib import Path
from time import monotonic

import msgspec

from gcs import ipc, request_words, resources
from gcs.operator.line_parser import LineError, parse_line
from gcs.operator.text import event_text
from gcs.tui import look
from gcs.tui.actions import KeyActions
from gcs.tui.command_line import CommandLine
from gcs.tui.keyboard import VelocityKeys
from gcs.tui.panels.log_panel import LogPanel
from gcs.tui.scene import REFUSED, Answer
from gcs.tui.verdict_ahead import typed_line


class LineActions(KeyActions):
    """They ask for the same as the keys, in the same ways."""

    def action_words(self) -> None:
        self.query_one(CommandLine).open(":")

    def action_search(self) -> None:
        self.query_one(CommandLine).open("/")

    def entered(self, prompt: str, text: str) -> None:
        """A line was finished."""
        self.scene.note_key()
        if prompt == ":":
            self._then.clear()
            self._run_line(text)
            self.redraw()

    def on_input_changed(self, changed: CommandLine.Changed) -> None:
        """What is searched for, or would be answered, is shown while it is typed."""
        if self.query_one(CommandLine).prompt == "/":
            self.query_one(LogPanel).search(changed.value)
        self.redraw()

    def _look_at_line(self) -> None:
        """What Enter would send now, where a line is typed."""
        line, scene = self.query_one(CommandLine), self.scene
        if not line.display or line.prompt != ":":
            scene.typed = None
        elif scene.typed is None or scene.typed.text != line.value:
            scene.typed = typed_line(line.value)

    def _run_line(self, text: str) -> None:
        try:
            line = parse_line(text)
        except LineError as error:
            self.scene.answer = Answer(f"{error.sentence}; {error.hint}", REFUSED)
            return
        match None if line is None else line.action:
            case None:
                pass
            case request_words.SendRequests(requests):
                self._request_in_turn([_with_file(each) for each in requests])
            case request_words.FlyVelocity(v_enu, seconds):
                self.scene.velocity = VelocityKeys(v_enu, monotonic() + seconds, typed=True)
                self.action_request("stream_begin")
            case request_words.ChooseVehicle(sysid):
                self._choose_typed(sysid)
            case request_words.ShowState():
                seen, number = self.scene.snapshot, self.scene.talk.number
                self._log_line(event_text.state_line(seen, number), look.PLAIN)
            case request_words.ShowPreflight():
                self.action_preflight()
            case request_words.ShowHelp():
                for each in request_words.help_lines():
                    self._log_line(each, look.PLAIN)
            case request_words.Quit():
                self.action_leave()
            case _:
                told = f"{text}: is for --plain and scripts: here a line does not wait"
                self.scene.answer = Answer(told, REFUSED)

    def _choose_typed(self, sysid: int) -> None:
        seen = self.scene.snapshot
        there = [] if seen is None else [seen.sysid, *(each.vehicle for each in seen.others)]
        if sysid not in there:
            heard = ", ".join(map(str, sorted(there))) or "none"
            told = f"vehicle {sysid}: not heard; there are: {heard}"
            self.scene.answer = Answer(told, REFUSED)
        elif sysid != there[0]:
            self.choose(sysid)

    def _log_line(self, text: str, style: str, level: int = 4, time_ns: int | None = None) -> None:
        for panel in self.query(LogPanel):  # none once the screen has been given back
            panel.tell(text, style, level, time_ns)


def _with_file(request: ipc.Ask) -> ipc.Ask:
    """A file is one of this program's folder, which need not be the station's, or is shipped."""
    if not request.path:
        return request
    path = Path(request.path).absolute()
    if request.word == "mission_upload":
        with contextlib.suppress(resources.MissionNotFoundError):
            path = resources.find(request.path).absolute()
    return msgspec.structs.replace(request, path=str(path))
