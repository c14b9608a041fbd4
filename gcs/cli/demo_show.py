"""What the demo prints: the flight as it happens, the table at its end, and what to do next."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import TracebackType

from rich import box
from rich.console import Console
from rich.status import Status
from rich.table import Table
from rich.text import Text

from gcs import ipc
from gcs.cli import say
from gcs.cli.demo_script import Flown
from gcs.cli.dialogue import Asked
from gcs.cli.hush import WARNING, Hush

STYLES = {
    "accepted": "cyan",
    "complete": "green",
    "refused": "red",
    "aborted": "yellow",
    "superseded": "yellow",
    "timed out": "red",
    "taken over": "yellow",
}


class Narrator:
    """Tells events line by line; on a terminal a last line shows where the vehicle is."""

    def __init__(self, console: Console, now_s: Callable[[], float]) -> None:
        self._console = console
        self._now_s = now_s
        self._start_s = now_s()
        self._status: Status | None = None
        self._hush = Hush(cautions=False)

    def __enter__(self) -> Narrator:
        if self._console.is_terminal:
            self._status = self._console.status("starting a vehicle and a link")
            self._status.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._status is not None:
            self._status.stop()

    def connected(self, hello: ipc.Hello | None, seen: ipc.Snapshot | None) -> None:
        vehicle = seen.vehicle if seen is not None else "a vehicle"
        policy = hello.policy if hello is not None else "?"
        self._line(Text(f"{vehicle} is heard; policy {policy}"))

    def headline(self, sentence: str) -> None:
        self._console.print()
        self._console.print(Text(sentence, "bold"))

    def hear(self, event: ipc.Event, asked: Asked | None) -> None:
        if self._hush.hides(event, asked):
            return
        match event:
            case ipc.VerdictEvent() if asked is not None:
                self._told(asked.label, event.outcome, event.code, event.sentence)
            case ipc.EndingEvent() if asked is not None:
                self._told(asked.label, event.ended, event.code, event.sentence)
            case ipc.StateEvent():
                self._line(Text(f"  {event.before} → {event.after}", "dim"))
            case ipc.LogEvent() if event.level >= WARNING:
                self._line(Text(say.log_line(event), "yellow"))
            case ipc.Trouble() if not event.exit_code:
                self._line(Text("\n".join(say.trouble_lines(event)), "red"))
            case ipc.Snapshot() if self._status is not None:
                self._status.update(Text(f"{event.state}  {say.enu(event.pos_enu)}", "dim"))
            case _:
                pass

    def _told(self, label: str, what: str, code: str, sentence: str) -> None:
        line = Text.assemble((label, "bold"), ": ", (what, STYLES.get(what, "")))
        if code:
            line.append(f" {code}", STYLES.get(what, ""))
        if why := say.reason(what, code, sentence):
            line.append(f": {why}")
        self._line(line)

    def _line(self, text: Text) -> None:
        elapsed_s = self._now_s() - self._start_s
        self._console.print(Text.assemble((f"{elapsed_s:5.1f} s  ", "dim"), text), soft_wrap=True)


def show_table(console: Console, flown: Sequence[Flown]) -> None:
    """Request, verdict, ending, reason; what was not as scripted is marked."""
    table = Table(box=box.SIMPLE_HEAD, title="The flight", title_justify="left")
    for column in ("", "request", "verdict", "ending", "reason"):
        table.add_column(column, no_wrap=column not in ("request", "reason"))
    for one in flown:
        verdict, ending = one.asked.verdict, one.asked.ending
        outcome = verdict.outcome if verdict else "-"
        ended = ending.ended if ending else ""
        told = ending if ending and ending.ended != "complete" else verdict
        reason = f"{told.code} {told.sentence}".strip() if told and told.code else ""
        table.add_row(
            Text("✓", "green") if one.as_expected else Text("✗", "bold red"),
            Text(one.asked.label),
            Text(outcome, STYLES.get(outcome, "")),
            Text(ended, STYLES.get(ended, "")),
            Text(reason, "dim"),
        )
    console.print()
    console.print(table)


def show_what_to_do(console: Console, log_path: str) -> None:
    """Where the record is and how to look at it."""
    if not log_path:
        console.print(Text("The flight was not recorded.", "bold red"))
        return
    console.print(Text.assemble("The whole flight is in ", (log_path, "bold")), soft_wrap=True)
    for command, purpose in (
        (f"gcs log info {log_path}", "what is in it"),
        ("gcs log layout", "write a layout for Foxglove, then open file and layout there"),
        ("gcs fly --sim", "fly yourself: ? shows the keys"),
    ):
        console.print(Text.assemble("  ", (command, "cyan"), f"  {purpose}"), soft_wrap=True)
