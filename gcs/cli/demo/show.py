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
from gcs.cli.demo.files import Written
from gcs.cli.demo.script import Flown
from gcs.enu_text import signed_enu
from gcs.operator.conversation import TrackedRequest
from gcs.operator.text import event_text
from gcs.operator.text.event_text import WARNING, WarningFilter

STYLES = {
    "accepted": "cyan",
    "complete": "green",
    "refused": "red",
    "aborted": "yellow",
    "superseded": "yellow",
    "timed out": "red",
    "taken over": "yellow",
}


class FlightPrinter:
    """Prints events line by line; on a terminal a last line shows where the vehicle is."""

    def __init__(self, console: Console, now_s: Callable[[], float]) -> None:
        self._console = console
        self._now_s = now_s
        self._start_s = now_s()
        self._status: Status | None = None
        self._warnings = WarningFilter(cautions=False)

    def __enter__(self) -> FlightPrinter:
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

    def show_connected(self, hello: ipc.Hello | None, seen: ipc.Snapshot | None) -> None:
        vehicle = seen.vehicle if seen is not None else "a vehicle"
        policy = hello.policy if hello is not None else "?"
        self._line(Text(f"{vehicle} is heard; policy {policy}"))

    def show_headline(self, sentence: str) -> None:
        self._console.print()
        self._console.print(Text(sentence, "bold"))

    def show_event(self, event: ipc.Event, request: TrackedRequest | None) -> None:
        if self._warnings.hides(event, request):
            return
        match event:
            case ipc.VerdictEvent() if request is not None:
                self._answer(request.label, event.outcome, event.code, event.sentence)
            case ipc.EndingEvent() if request is not None:
                self._answer(request.label, event.ended, event.code, event.sentence)
            case ipc.StateEvent():
                self._line(Text(f"  {event.before} → {event.after}", "dim"))
            case ipc.LogEvent() if event.level >= WARNING:
                self._line(Text(event_text.log_line(event), "yellow"))
            case ipc.Trouble() if not event.exit_code:
                self._line(Text("\n".join(event_text.trouble_lines(event)), "red"))
            case ipc.Snapshot() if self._status is not None:
                self._status.update(Text(f"{event.state}  {signed_enu(event.pos_enu)}", "dim"))
            case _:
                pass

    def _answer(self, label: str, what: str, code: str, sentence: str) -> None:
        line = Text.assemble((label, "bold"), ": ", (what, STYLES.get(what, "")))
        if code:
            line.append(f" {code}", STYLES.get(what, ""))
        if why := event_text.reason(what, code, sentence):
            line.append(f": {why}")
        self._line(line)

    def _line(self, text: Text) -> None:
        elapsed_s = self._now_s() - self._start_s
        self._console.print(Text.assemble((f"{elapsed_s:5.1f} s  ", "dim"), text), soft_wrap=True)


def show_table(console: Console, flown: Sequence[Flown]) -> None:
    """Request, verdict, outcome, reason; what was not as scripted is marked."""
    table = Table(box=box.SIMPLE_HEAD, title="The flight", title_justify="left")
    for column in ("", "request", "verdict", "ending", "reason"):
        table.add_column(column, no_wrap=column not in ("request", "reason"))
    for one in flown:
        verdict, outcome = one.request.verdict, one.request.outcome
        ruling = verdict.outcome if verdict else "-"
        ended = outcome.ended if outcome else ""
        last = outcome if outcome and outcome.ended != "complete" else verdict
        reason = f"{last.code} {last.sentence}".strip() if last and last.code else ""
        table.add_row(
            Text("✓", "green") if one.as_expected else Text("✗", "bold red"),
            Text(one.request.label),
            Text(ruling, STYLES.get(ruling, "")),
            Text(ended, STYLES.get(ended, "")),
            Text(reason, "dim"),
        )
    console.print()
    console.print(table)


def show_what_to_do(console: Console, log_path: str, beside: Sequence[Written]) -> None:
    """Where the record is, and what lies beside it; how to look at them."""
    if not log_path:
        console.print(Text("The flight was not recorded.", "bold red"))
        return
    console.print(Text.assemble("The whole flight is in ", (log_path, "bold")), soft_wrap=True)
    for file in beside:
        console.print(
            Text.assemble("  ", (str(file.path), "bold"), f"  {file.purpose}"), soft_wrap=True
        )
    if any(file.path.suffix == ".json" for file in beside):
        steps = "Open the record in Foxglove or Lichtblick, then Layouts > Import from file."
        console.print(Text(f"  {steps}"), soft_wrap=True)
    for command, purpose in (
        (f"gcs log info {log_path}", "what is in it"),
        ("gcs fly --sim", "fly yourself: ? shows the keys"),
    ):
        console.print(Text.assemble("  ", (command, "cyan"), f"  {purpose}"), soft_wrap=True)
