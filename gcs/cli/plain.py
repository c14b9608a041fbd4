"""`gcs fly --plain`: lines from standard input, one answer for each verdict and outcome."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from dataclasses import dataclass

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.operator import event_text, line_parser, request_words
from gcs.operator.client import StationEnded
from gcs.operator.dialogue import (
    Connection,
    Dialogue,
    InterruptSource,
    TrackedRequest,
    exit_code_of,
)
from gcs.operator.errors import ExitError, Interrupted
from gcs.operator.warning_filter import WarningFilter
from gcs.shell.pipes import LineSource

FRESH_WAIT_S = 0.5
Printer = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class PlainConfig:
    """`min_level` is of the log lines, 1 debug .. 5 fatal; time-outs in seconds."""

    timeout_s: float = 10.0
    min_level: int = 2
    as_json: bool = False
    strict: bool = False
    speedup: float = 1.0


class Input:
    """Numbered lines of a file descriptor, handed out one at a time."""

    def __init__(self, fd: int, name: str) -> None:
        self.source = LineSource(fd, keep_blank=True)
        self.name = name
        self.number = 0
        self._lines: list[str] = []

    def read(self) -> None:
        self._lines.extend(line.decode(errors="replace") for line in self.source.read())

    def take(self) -> str | None:
        if not self._lines:
            return None
        self.number += 1
        return self._lines.pop(0)


class Plain:
    """The console: reads a line when the one before is settled, prints what becomes of it.

    Answers go to `out`, log lines and complaints to `err`.
    """

    def __init__(
        self,
        connection: Connection,
        interrupts: InterruptSource,
        config: PlainConfig,
        out: Printer,
        err: Printer,
    ) -> None:
        self._config = config
        self._out, self._err = out, err
        self._dialogue = Dialogue(connection, interrupts, self._on_event)
        self._warnings = WarningFilter(cautions=True)
        self._bad_lines = False

    def run(self, script: Input) -> int:
        """Until `quit`, the end of the input, or Ctrl-C; returns the exit code."""
        try:
            self._dialogue.wait_for_vehicle(self._config.timeout_s)
            self._run_lines(script)
        except Interrupted as interrupt:
            self._err(f"gcs: {interrupt}: leaving; the link holds the vehicle first")
            self._show_end(self._dialogue.leave(str(interrupt)))
            return ExitCode.INTERRUPTED
        except ExitError:
            self._dialogue.leave("failed")
            raise
        ended = self._dialogue.leave("quit")
        self._show_end(ended)
        return self._exit_code(ended)

    def _run_lines(self, script: Input) -> None:
        while (text := self._next_line(script)) is not None:
            try:
                line = line_parser.parse_line(text)
            except line_parser.LineError as error:
                self._bad_lines = True
                self._err(f"{script.name}:{script.number}: {error.sentence}\n  hint: {error.hint}")
                continue
            if line is None:
                continue
            if isinstance(line.action, request_words.Quit):
                return
            self._act(line)

    def _next_line(self, script: Input) -> str | None:
        """None at the end of the input.  The station's events are read meanwhile."""
        while True:
            text = script.take()
            if text is not None:
                return text
            if script.source.ended:
                return None
            if self._dialogue.poll(1.0, (script.source,)):
                script.read()

    def _act(self, line: line_parser.Line) -> None:
        match line.action:
            case request_words.SendRequests(requests) if line.wait:
                self._dialogue.send_in_turn(requests, line.text)
            case request_words.SendRequests(requests):
                # Not waited for: what has to follow another request cannot be sent blindly.
                self._dialogue.send(requests[0], line.text)
            case request_words.Wait(seconds):
                self._dialogue.wait_until(lambda: False, seconds / self._config.speedup)
            case request_words.ShowState():
                self._show_state()
            case request_words.Quit():
                return

    def _show_state(self) -> None:
        """As it is after whatever was answered last: the latest snapshot may be from before."""
        latest = self._dialogue.snapshot
        self._dialogue.wait_until(lambda: self._dialogue.snapshot is not latest, FRESH_WAIT_S)
        seen = self._dialogue.snapshot
        if self._config.as_json and seen is not None:
            self._out(ipc.encode(seen).decode().rstrip())
        else:
            self._out(event_text.state_line(seen))

    def _on_event(self, event: ipc.Event, request: TrackedRequest | None) -> None:
        if isinstance(event, ipc.Snapshot):
            return
        if self._config.as_json:
            self._out(ipc.encode(event).decode().rstrip())
            return
        if self._warnings.hides(event, request):
            return
        match event:
            case ipc.VerdictEvent() if request is not None:
                self._out(event_text.verdict_line(request.label, event))
            case ipc.EndingEvent() if request is not None:
                self._out(event_text.outcome_line(request.label, event))
            case ipc.LogEvent() if event.level >= self._config.min_level:
                self._err(event_text.log_line(event))
            case ipc.Trouble() if not event.exit_code:
                self._err("\n".join(event_text.trouble_lines(event)))
            case _:
                pass

    def _show_end(self, ended: StationEnded) -> None:
        if ended.bye is None:
            self._err(f"gcs: the link ended without a good-bye\n{ended.stderr_tail}".rstrip())
            return
        for line in event_text.bye_lines(ended.bye):
            self._err(line)

    def _exit_code(self, ended: StationEnded) -> int:
        if code := exit_code_of(ended):
            return code
        if self._bad_lines:
            return ExitCode.USAGE
        return self._dialogue.first_failure() if self._config.strict else ExitCode.DONE


def stdin_input() -> Input:
    return Input(sys.stdin.fileno(), "<stdin>")


def to_stdout(line: str) -> None:
    """Answers are flushed at once: whoever reads the pipe waits for them."""
    print(line, flush=True)


def to_stderr(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


def stdin_is_a_terminal() -> bool:
    return os.isatty(sys.stdin.fileno())
