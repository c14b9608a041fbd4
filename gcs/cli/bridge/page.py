"""`gcs bridge` on a terminal: a page that is drawn anew twice a second, log lines above it.

`bridge_text` has the words; this knows the terminal.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from types import TracebackType

from rich.console import Console, Group, JustifyMethod, RenderableType
from rich.live import Live
from rich.table import Table
from rich.text import Text

from gcs import ipc
from gcs.cli.bridge import text as bridge_text
from gcs.gate.effects import Level
from gcs.operator.text import event_text

DECISIONS = 8
OTHER_LINES = 10
"""Lines of the page that are no vehicles, no decisions and no clients."""
OUTCOME_STYLES = {"refused": "yellow", "accepted": "green"}
WIDE = 110
"""Letters that a row of every column of a vehicle takes, about."""
NUMBERS = ("in/s", "out/s", "lost", "refused", "dropped", "m/s", "battery")


class BridgePage:
    """A `Display` that draws; use it as a context, so that the cursor comes back."""

    def __init__(self, min_level: int) -> None:
        """`min_level`: of the log lines above the page."""
        self._min_level = min_level
        self._console = Console(highlight=False)
        self._live = Live(console=self._console, auto_refresh=False)
        self._decisions: deque[ipc.BridgeDecision] = deque(maxlen=DECISIONS)
        self._hello: ipc.Hello | None = None
        self._seen: ipc.Snapshot | None = None
        self._status: ipc.BridgeStatus | None = None

    def __enter__(self) -> BridgePage:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._live.stop()

    def event(self, event: ipc.Event) -> None:
        match event:
            case ipc.Hello():
                self._hello = event
                self._live.start()
            case ipc.Snapshot():
                self._seen = event
            case ipc.BridgeStatus():
                self._status = event
            case ipc.BridgeDecision():
                self._decisions.append(event)
            case ipc.LogEvent() if event.level >= self._min_level:
                style = "yellow" if event.level >= Level.WARNING else ""
                self._console.print(Text(event_text.log_line(event), style=style))
            case ipc.Trouble() if not event.exit_code:
                self._console.print(Text("\n".join(event_text.trouble_lines(event)), style="red"))
            case _:
                pass

    def draw(self) -> None:
        if self._hello is not None:
            self._live.update(self.page(self._console.height, self._console.width), refresh=True)

    def page(self, height: int, width: int) -> RenderableType:
        """The whole of it, in at most so many lines."""
        seen = self._seen
        clients = bridge_text.client_rows(self._status)
        vehicles = self._vehicles(narrow=width < WIDE)
        lines = sum(each.row_count if isinstance(each, Table) else 1 for each in vehicles)
        room = height - OTHER_LINES - min(DECISIONS, len(self._decisions)) - lines
        room = max(3, room)
        hidden = len(clients) - 1 - room
        parts: list[RenderableType] = [
            *vehicles,
            Text(f"in control: {bridge_text.control_line(seen)}"),
        ]
        parts += [_table(bridge_text.link_rows(self._status)), _table(clients[: room + 1])]
        if len(clients) == 1:
            parts += [Text(f"nobody yet; {where}", style="dim") for where in self._where]
        elif hidden > 0:
            parts.append(Text(f"and {hidden} more", style="dim"))
        parts += [self._decision(each) for each in self._decisions]
        parts.append(Text(self._footer(), style="dim"))
        return Group(*parts)

    def _vehicles(self, *, narrow: bool) -> list[Table | Text]:
        """Each vehicle once: one alone in a line, several in rows, with their notes below where
        they have no room there."""
        rows = bridge_text.vehicle_rows(self._status, narrow=narrow)
        if rows:
            notes = bridge_text.vehicle_notes(self._status) if narrow else []
            below = [Text(note, no_wrap=True, overflow="ellipsis") for note in notes]
            return [_table(rows, whole=True), *below]
        wrong = bridge_text.conditions_line(self._seen)
        warned = [Text(f"wrong: {wrong}", style="yellow")] if wrong else []
        return [Text(bridge_text.vehicle_line(self._seen), style="bold"), *warned]

    def _decision(self, decision: ipc.BridgeDecision) -> Text:
        several = self._status is not None and len(self._status.vehicles) > 1
        told = bridge_text.decision_line(decision, several=several)
        line = f"{bridge_text.clock_text(decision.time_ns)} {told}"
        style = OUTCOME_STYLES.get(decision.outcome, "")
        return Text(line, style=style, no_wrap=True, overflow="ellipsis")

    @property
    def _where(self) -> Sequence[str]:
        return self._hello.client_ports if self._hello else ()

    def _footer(self) -> str:
        policy = self._hello.policy if self._hello else ""
        size = f", {self._seen.recorded_mb:.1f} MB" if self._seen else ""
        log = self._seen.log_path if self._seen else ""
        return f"policy {policy}; log: {log or 'none'}{size}; Ctrl-C ends it, holding first"


def _table(rows: Sequence[bridge_text.Row], *, whole: bool = False) -> Table:
    """`whole`: where there is no room, only the last column is cut."""
    head, *rest = rows
    drawn = Table.grid(padding=(0, 2))
    for number, name in enumerate(head):
        justify: JustifyMethod = "right" if name in NUMBERS else "left"
        longest = max(len(row[number]) for row in rows)
        least = longest if whole and number < len(head) - 1 else None
        drawn.add_column(justify=justify, no_wrap=True, min_width=least)
    drawn.add_row(*(Text(name, style="dim") for name in head))
    for row in rest:
        in_control = "IN CONTROL" in row[-1]
        drawn.add_row(*(Text(word, style="bold" if in_control else "") for word in row))
    return drawn
