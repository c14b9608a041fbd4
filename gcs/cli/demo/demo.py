"""`gcs demo`: one whole flight on a simulated vehicle, shown as it happens, checked at the end."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from gcs.cli.live_option import ALLOW, LIVE, live_view, open_beside
from gcs.cli.options import LOG_DIR, TIMEOUT, with_options
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from rich.console import Console

    from gcs.cli.demo.script import Flown
    from gcs.operator.client import Polling
    from gcs.operator.dialogue import InterruptSource


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
@click.option(
    "--fleet",
    is_flag=True,
    help="Three vehicles with crossing ways: one of two goals is refused.",
)
@with_options(LIVE, ALLOW, LOG_DIR, TIMEOUT)
@click.pass_context
def demo(
    ctx: click.Context,
    autopilot: str,
    fleet: bool,
    live: tuple[str, int] | None,
    allow: tuple[str, ...],
    log_dir: str,
    timeout: float,
) -> None:
    """Fly a whole flight in about a minute: goals, refusals, a picture, an abort."""
    from rich.console import Console

    from gcs import resources
    from gcs.cli.demo.script import MISSION, fleet_config, station_config
    from gcs.operator.client import StationClient
    from gcs.operator.interrupts import Interrupts

    view = live_view(live, allow)
    config = (fleet_config if fleet else station_config)(autopilot, log_dir, timeout)
    mission_path = str(resources.find(MISSION))
    with Interrupts() as interrupts:
        station = StationClient.start(config)
        console = Console(highlight=False)
        open_beside(station, view, lambda line: console.print(line, markup=False))
        ctx.exit(run_over(station, interrupts, console, mission_path, timeout, fleet=fleet))


def run_over(
    connection: Polling,
    interrupts: InterruptSource,
    console: Console,
    mission_path: str,
    timeout_s: float,
    *,
    fleet: bool = False,
) -> int:
    """Fly the script with a station that is there already; returns the exit code."""
    from gcs.cli.demo.files import write_beside
    from gcs.cli.demo.script import FLEET_SCRIPT, SCRIPT, perform, wait_for_all, wait_for_fleet
    from gcs.cli.demo.show import FlightPrinter, show_table, show_what_to_do
    from gcs.operator.conversation import exit_code_of
    from gcs.operator.dialogue import Dialogue
    from gcs.operator.errors import Interrupted
    from gcs.operator.text import event_text

    flown: list[Flown] = []
    with FlightPrinter(console, connection.now_s) as printer:
        dialogue = Dialogue(connection, interrupts, printer.show_event)
        try:
            dialogue.wait_for_vehicle(timeout_s)
            printer.show_connected(dialogue.hello, dialogue.snapshot)
            if fleet:
                wait_for_fleet(dialogue, timeout_s)
            for step in FLEET_SCRIPT if fleet else SCRIPT:
                if step.say:
                    wait_for_all(dialogue, flown)
                    printer.show_headline(step.say)
                flown.append(perform(dialogue, step, mission_path))
                if step.wait and not flown[-1].as_expected:
                    break
        except Interrupted:
            ended = dialogue.leave("interrupted")
            for line in event_text.bye_lines(ended.bye, simulated=True) if ended.bye else ():
                console.print(line, markup=False, soft_wrap=True)
            return ExitCode.INTERRUPTED
        except ExitError:
            dialogue.leave("failed")
            raise
        ended = dialogue.leave("the demo is over")
    show_table(console, flown)
    log_path = ended.bye.log_path if ended.bye else ""
    show_what_to_do(console, log_path, write_beside(log_path) if log_path else [])
    unexpected = [one for one in flown if not one.as_expected]
    if unexpected:
        first = unexpected[0]
        raise ExitError(
            ExitCode.NOT_COMPLETED,
            f"the flight was not as scripted: {first.request.label} came to {first.came_to!r}, "
            f"expected {first.step.expect!r}",
            f"the record tells why: gcs log info {log_path}" if log_path else "",
        )
    return exit_code_of(ended)
