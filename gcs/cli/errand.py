"""One command, then leave: start a link, wait for a vehicle, ask, see it happen, go."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import click
import msgspec

from gcs import ipc
from gcs.cli import say, words
from gcs.cli.dialogue import Asked, Dialogue, Interrupt, Interrupted, Link, final_exit
from gcs.cli.exits import Exit, Fail
from gcs.cli.progress import Ticker
from gcs.config import LinkConfig

NEEDS_CONTROL = frozenset({"goto", "photo", "mission_start"})
Errand = Callable[[Dialogue], Exit]


@dataclass(frozen=True, slots=True)
class ErrandConfig:
    """`wait_s` limits the effect, `timeout_s` the wait for a vehicle; seconds."""

    timeout_s: float
    wait_s: float
    as_json: bool
    what: str


def run(config: LinkConfig, how: ErrandConfig, errand: Errand) -> int:
    """Do it over a link process of our own; gives the exit code."""
    from gcs.shell.client import LinkClient
    from gcs.shell.interrupts import Interrupts

    with Interrupts() as interrupts:
        return run_over(LinkClient.start(config), interrupts, how, errand)


def run_over(link: Link, interrupts: Interrupt, how: ErrandConfig, errand: Errand) -> int:
    """The same over a link that is there already."""
    with Ticker(how.what, link.now_s()) as ticker:

        def watch(event: ipc.Event, asked: Asked | None) -> None:
            ticker.hear(event, link.now_s())
            _print(event, asked, as_json=how.as_json)

        dialogue = Dialogue(link, interrupts, watch)
        try:
            dialogue.connect(how.timeout_s)
            code = errand(dialogue)
        except Interrupted:
            dialogue.leave("interrupted")
            return Exit.INTERRUPTED
        except Fail:
            dialogue.leave("failed")
            raise
        down = dialogue.leave("done")
        return code or final_exit(down)


def asking(request: words.Request, wait_s: float) -> Errand:
    """The errand of asking for `request`, taking control first where a move needs it."""

    def errand(dialogue: Dialogue) -> Exit:
        if any(ask.word in NEEDS_CONTROL for ask in request.asks):
            control = dialogue.take_control()
            if control is not None and not control.completed:
                return control.exit
        for ask in request.asks:
            asked = dialogue.settle(dialogue.ask(ask), wait_s)
            if not asked.settled:
                click.echo(f"{asked.label}: not completed within {wait_s:g} s", err=True)
            if asked.exit:
                return asked.exit
        return Exit.DONE

    return errand


def _print(event: ipc.Event, asked: Asked | None, *, as_json: bool) -> None:
    match event:
        case ipc.VerdictEvent() | ipc.EndingEvent() if asked is not None:
            if as_json:
                click.echo(msgspec.json.encode(event).decode())
            elif isinstance(event, ipc.VerdictEvent):
                if event.outcome != "accepted":
                    click.echo(say.verdict_line(asked.label, event))
            else:
                click.echo(say.ending_line(asked.label, event))
        case ipc.LogEvent() if event.level >= 3:
            click.echo(say.log_line(event), err=True)
        case ipc.Trouble() if not event.exit_code:
            click.echo("\n".join(say.trouble_lines(event)), err=True)
        case _:
            pass
