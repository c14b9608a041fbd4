"""`gcs fly --plain`: words from standard input, one answer line for each verdict and ending."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from dataclasses import dataclass

from gcs import ipc
from gcs.cli import say, typed, words
from gcs.cli.dialogue import Asked, Dialogue, Interrupt, Interrupted, Link, final_exit
from gcs.cli.exits import Exit, Fail
from gcs.cli.hush import Hush
from gcs.shell.client import LinkDown
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
        link: Link,
        interrupts: Interrupt,
        config: PlainConfig,
        out: Printer,
        err: Printer,
    ) -> None:
        self._config = config
        self._out, self._err = out, err
        self._dialogue = Dialogue(link, interrupts, self._watch)
        self._hush = Hush(cautions=True)
        self._bad_lines = False

    def run(self, script: Input) -> int:
        """Until `quit`, the end of the input, or Ctrl-C; gives the exit code."""
        try:
            self._dialogue.connect(self._config.timeout_s)
            self._obey(script)
        except Interrupted as interrupt:
            self._err(f"gcs: {interrupt}: leaving; the link holds the vehicle first")
            self._farewell(self._dialogue.leave(str(interrupt)))
            return Exit.INTERRUPTED
        except Fail:
            self._dialogue.leave("failed")
            raise
        down = self._dialogue.leave("quit")
        self._farewell(down)
        return self._exit(down)

    def _obey(self, script: Input) -> None:
        while (text := self._next_line(script)) is not None:
            try:
                line = typed.parse_line(text)
            except typed.WordError as error:
                self._bad_lines = True
                self._err(f"{script.name}:{script.number}: {error.sentence}\n  hint: {error.hint}")
                continue
            if line is None:
                continue
            if isinstance(line.action, words.Quit):
                return
            self._act(line)

    def _next_line(self, script: Input) -> str | None:
        """None at the end of the input.  The link is followed meanwhile."""
        while True:
            text = script.take()
            if text is not None:
                return text
            if script.source.ended:
                return None
            if self._dialogue.poll(1.0, (script.source,)):
                script.read()

    def _act(self, line: typed.Line) -> None:
        match line.action:
            case words.Request() as request if line.wait:
                self._dialogue.perform(request, line.text)
            case words.Request() as request:
                # Not waited for: what has to follow another ask cannot be sent blindly.
                self._dialogue.ask(request.asks[0], line.text)
            case words.Wait(seconds):
                self._dialogue.until(lambda: False, seconds / self._config.speedup)
            case words.ShowState():
                self._show_state()
            case words.Quit():
                return

    def _show_state(self) -> None:
        """As it is after whatever was answered last: the latest snapshot may be from before."""
        latest = self._dialogue.snapshot
        self._dialogue.until(lambda: self._dialogue.snapshot is not latest, FRESH_WAIT_S)
        seen = self._dialogue.snapshot
        if self._config.as_json and seen is not None:
            self._out(ipc.encode(seen).decode().rstrip())
        else:
            self._out(say.state_line(seen))

    def _watch(self, event: ipc.Event, asked: Asked | None) -> None:
        if isinstance(event, ipc.Snapshot):
            return
        if self._config.as_json:
            self._out(ipc.encode(event).decode().rstrip())
            return
        if self._hush.hides(event, asked):
            return
        match event:
            case ipc.VerdictEvent() if asked is not None:
                self._out(say.verdict_line(asked.label, event))
            case ipc.EndingEvent() if asked is not None:
                self._out(say.ending_line(asked.label, event))
            case ipc.LogEvent() if event.level >= self._config.min_level:
                self._err(say.log_line(event))
            case ipc.Trouble() if not event.exit_code:
                self._err("\n".join(say.trouble_lines(event)))
            case _:
                pass

    def _farewell(self, down: LinkDown) -> None:
        if down.bye is None:
            self._err(f"gcs: the link ended without a good-bye\n{down.stderr_tail}".rstrip())
            return
        for line in say.farewell_lines(down.bye):
            self._err(line)

    def _exit(self, down: LinkDown) -> int:
        if code := final_exit(down):
            return code
        if self._bad_lines:
            return Exit.USAGE
        return self._dialogue.first_failure() if self._config.strict else Exit.DONE


def stdin_input() -> Input:
    return Input(sys.stdin.fileno(), "<stdin>")


def to_stdout(line: str) -> None:
    """Answers are flushed at once: whoever reads the pipe waits for them."""
    print(line, flush=True)


def to_stderr(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


def stdin_is_a_terminal() -> bool:
    return os.isatty(sys.stdin.fileno())
