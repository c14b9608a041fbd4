"""One command, then leave: start a link, wait for a vehicle, ask, see it happen, go."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import click
import msgspec

from gcs import ipc
from gcs.cli import say, words
from gcs.cli.dialogue import Asked, Dialogue, Interrupt, Interrupted, Link, final_exit
from gcs.cli.exits import Exit, Fail
from gcs.cli.hush import WARNING, Hush
from gcs.cli.progress import Ticker
from gcs.config import LinkConfig

NEEDS_CONTROL = frozenset({"goto", "photo", "mission_start"})
Errand = Callable[[Dialogue, Ticker], Exit]
"""Clears the ticker before it prints anything itself."""


@dataclass(frozen=True, slots=True)
class ErrandConfig:
    """`wait_s` limits the effect, `timeout_s` the wait for a vehicle; seconds.

    `cautions`: tell what is always wrong with this vehicle, too.
    """

    timeout_s: float
    wait_s: float
    as_json: bool
    what: str
    cautions: bool = False


def run(config: LinkConfig, how: ErrandConfig, errand: Errand) -> int:
    """Do it over a link process of our own; gives the exit code."""
    from gcs.shell.client import LinkClient
    from gcs.shell.interrupts import Interrupts

    with Interrupts() as interrupts:
        return run_over(LinkClient.start(config), interrupts, how, errand)


def run_over(link: Link, interrupts: Interrupt, how: ErrandConfig, errand: Errand) -> int:
    """The same over a link that is there already."""
    hush = Hush(cautions=how.cautions)
    with Ticker(how.what, link.now_s()) as ticker:

        def watch(event: ipc.Event, asked: Asked | None) -> None:
            ticker.hear(event, link.now_s())
            if hush.hides(event, asked):
                return
            for line, err in _lines(event, asked, as_json=how.as_json):
                ticker.clear()
                click.echo(line, err=err)

        dialogue = Dialogue(link, interrupts, watch)
        try:
            dialogue.connect(how.timeout_s)
            code = errand(dialogue, ticker)
        except Interrupted:
            down = dialogue.leave("interrupted")
            ticker.clear()
            for line in say.farewell_lines(down.bye) if down.bye else ():
                click.echo(line, err=True)
            return Exit.INTERRUPTED
        except Fail:
            dialogue.leave("failed")
            raise
        down = dialogue.leave("done")
        return code or final_exit(down)


def asking(request: words.Request, wait_s: float) -> Errand:
    """The errand of asking for `request`, taking control first where a move needs it."""

    def errand(dialogue: Dialogue, ticker: Ticker) -> Exit:
        if any(ask.word in NEEDS_CONTROL for ask in request.asks):
            control = dialogue.take_control()
            if control is not None and not control.completed:
                return control.exit
        for ask in request.asks:
            asked = dialogue.settle(dialogue.ask(ask), wait_s)
            if not asked.settled:
                ticker.clear()
                click.echo(f"{asked.label}: not completed within {wait_s:g} s", err=True)
            if asked.exit:
                return asked.exit
        return Exit.DONE

    return errand


def _lines(event: ipc.Event, asked: Asked | None, *, as_json: bool) -> Iterator[tuple[str, bool]]:
    """What to print of an event, and whether it goes to standard error."""
    match event:
        case ipc.VerdictEvent() | ipc.EndingEvent() if asked is not None and as_json:
            yield msgspec.json.encode(event).decode(), False
        case ipc.VerdictEvent() if asked is not None:
            if event.outcome != "accepted":
                yield say.verdict_line(asked.label, event), False
        case ipc.EndingEvent() if asked is not None:
            yield say.ending_line(asked.label, event), False
        case ipc.LogEvent() if event.level >= WARNING:
            yield say.log_line(event), True
        case ipc.Trouble() if not event.exit_code:
            yield "\n".join(say.trouble_lines(event)), True
        case _:
            pass
