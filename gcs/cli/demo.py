"""`gcs demo`: one whole flight on a simulated vehicle, told as it happens, checked at the end."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from gcs.cli.exits import Exit, Fail
from gcs.cli.options import LOG_DIR, TIMEOUT, with_options

if TYPE_CHECKING:
    from rich.console import Console

    from gcs.cli.demo_script import Flown
    from gcs.cli.dialogue import Interrupt, Link


@click.command(
    epilog="Example: gcs demo\n\nThe exit code is 0 only if every request came to what the "
    "script says: refused where it must be, complete where it must be."
)
@click.option(
    "--autopilot",
    type=click.Choice(["px4", "ardupilot"]),
    default="px4",
    show_default=True,
    help="Which autopilot the vehicle speaks like.",
)
@with_options(LOG_DIR, TIMEOUT)
@click.pass_context
def demo(ctx: click.Context, autopilot: str, log_dir: str, timeout: float) -> None:
    """Fly a whole flight in about a minute: hops, refusals, a picture, an abort, a mission."""
    from rich.console import Console

    from gcs import resources
    from gcs.config import LinkConfig, SimConfig
    from gcs.shell.client import LinkClient
    from gcs.shell.interrupts import Interrupts

    config = LinkConfig(
        sim=SimConfig(autopilot=autopilot),
        log_dir=log_dir,
        name="demo",
        connect_timeout_s=timeout,
    )
    mission_path = str(resources.find("demo.toml"))
    with Interrupts() as interrupts:
        link = LinkClient.start(config)
        console = Console(highlight=False)
        ctx.exit(run_over(link, interrupts, console, mission_path, timeout))


def run_over(
    link: Link, interrupts: Interrupt, console: Console, mission_path: str, timeout_s: float
) -> int:
    """Fly the script over a link that is there already; gives the exit code."""
    from gcs.cli import say
    from gcs.cli.demo_script import SCRIPT, finish, perform
    from gcs.cli.demo_show import Narrator, show_table, show_what_to_do
    from gcs.cli.dialogue import Dialogue, Interrupted, final_exit

    flown: list[Flown] = []
    with Narrator(console, link.now_s) as narrator:
        dialogue = Dialogue(link, interrupts, narrator.hear)
        try:
            dialogue.connect(timeout_s)
            narrator.connected(dialogue.hello, dialogue.snapshot)
            for step in SCRIPT:
                if step.say:
                    finish(dialogue, flown)
                    narrator.headline(step.say)
                flown.append(perform(dialogue, step, mission_path))
                if step.wait and not flown[-1].as_expected:
                    break
        except Interrupted:
            down = dialogue.leave("interrupted")
            for line in say.farewell_lines(down.bye) if down.bye else ():
                console.print(line, markup=False, soft_wrap=True)
            return Exit.INTERRUPTED
        except Fail:
            dialogue.leave("failed")
            raise
        down = dialogue.leave("the demo is over")
    show_table(console, flown)
    log_path = down.bye.log_path if down.bye else ""
    show_what_to_do(console, log_path)
    strange = [one for one in flown if not one.as_expected]
    if strange:
        first = strange[0]
        raise Fail(
            Exit.NOT_COMPLETED,
            f"the flight was not as scripted: {first.asked.label} came to {first.came_to!r}, "
            f"expected {first.step.expect!r}",
            f"the record tells why: gcs log info {log_path}" if log_path else "",
        )
    return final_exit(down)
