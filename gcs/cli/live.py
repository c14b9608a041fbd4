"""`gcs live`: a station's flight in a viewer, while it is flown."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import click

from gcs.cli.live_option import ADDRESS, ADDRESS_HELP, DEFAULT_HOST
from gcs.cli.options import LINK, LOG_DIR, POLICY, TIMEOUT, with_options

if TYPE_CHECKING:
    from gcs.config import StationConfig
    from gcs.shell.stations import Description

EPILOG = f"""\
Examples:

\b
  gcs live                      of the station that runs, or of a new one
  gcs live --sim
  gcs live 127.0.0.1:9000
  gcs live 0.0.0.0 --allow https://viewer.example --allow station.lan
  gcs demo --live

HOST:PORT: {ADDRESS_HELP}

In Foxglove or Lichtblick: Open connection > Foxglove WebSocket, then import the layout whose path
is printed. A viewer looks, and may abort and hold; to fly it has to call take_control with the
code that is printed here: in the layout that is a button. Then a point or pose that is published
in the 3D panel is a goal.

Let in are programs, pages of app.foxglove.dev and of this machine, and the desktop viewers; --allow
adds a page (https://viewer.example) or a name that this machine is known by (station.lan).
"""


@click.command(epilog=EPILOG)
@click.argument("address", type=ADDRESS, default=DEFAULT_HOST, metavar="[HOST:PORT]")
@with_options(LINK)
@click.option("--sim", is_flag=True, help="Start a vehicle of our own, on a private port.")
@click.option("--allow", multiple=True, metavar="PAGE|NAME", help="Let this in, too (see below).")
@with_options(POLICY, LOG_DIR, TIMEOUT)
@click.pass_context
def live(
    ctx: click.Context,
    address: tuple[str, int],
    links: tuple[str, ...],
    sim: bool,
    allow: tuple[str, ...],
    policy: str,
    log_dir: str,
    timeout: float,
) -> None:
    """Serve the topics of a station to viewers over a WebSocket."""
    import msgspec

    from gcs.cli.options import station_config
    from gcs.cli.running import station_for
    from gcs.config import SimConfig
    from gcs.live.program import check_installed

    if sim and links:
        raise click.UsageError("--sim starts a vehicle of its own: leave out --link")
    check_installed()
    found = None if sim else station_for(links, anywhere=not links)
    if found is not None:
        ctx.exit(_of_running(found, address, allow))
    config = station_config(links, policy, log_dir, name="live", timeout_s=timeout)
    if sim:
        config = msgspec.structs.replace(config, sim=SimConfig(), endpoints=[])
    config = msgspec.structs.replace(config, operator=f"gcs live, pid {os.getpid()}")
    ctx.exit(_of_new(config, address, allow))


def _of_running(found: Description, address: tuple[str, int], allow: tuple[str, ...]) -> int:
    """Until that station ends, or a Ctrl-C, which it does not notice."""
    from gcs.cli.live_option import lines_about
    from gcs.cli.running import described_shortly
    from gcs.exit_codes import ExitCode
    from gcs.live.program import Opened
    from gcs.live.view import Address, open_view
    from gcs.operator.interrupts import Interrupts

    with Interrupts() as interrupts:
        where = Address(*address, frozenset(allow))
        view = open_view(found, where, lambda text: click.echo(text, err=True))
        click.echo(f"of the station of process {described_shortly(found)}")
        opened = Opened(view.url, view.code, view.layout.path)
        click.echo("\n".join(lines_about(opened, address[0])))
        if view.layout.why:
            click.echo(f"no layout is written: {view.layout.why}", err=True)
        try:
            ended = view.run(interrupts)
        finally:
            view.close()
        if ended is None:
            return ExitCode.DONE
    click.echo(ended.bye.sentence if ended.bye else "the station has ended", err=True)
    return ExitCode.DONE


def _of_new(config: StationConfig, address: tuple[str, int], allow: tuple[str, ...]) -> int:
    """A station without a screen, until a Ctrl-C: its log goes to standard error."""
    from gcs.cli.live_option import LiveView, open_beside
    from gcs.exit_codes import ExitCode
    from gcs.operator.client import StationClient
    from gcs.operator.dialogue import Dialogue
    from gcs.operator.errors import Interrupted
    from gcs.operator.interrupts import Interrupts
    from gcs.operator.text import event_text

    with Interrupts() as interrupts:
        station = StationClient.start(config)
        open_beside(station, LiveView(*address, allow), click.echo)
        dialogue = Dialogue(station, interrupts, lambda event, _: _print_log(event))
        try:
            dialogue.wait_until(lambda: False)
        except Interrupted as interrupt:
            ended = dialogue.leave(str(interrupt))
    simulated = config.sim is not None
    for line in event_text.bye_lines(ended.bye, simulated=simulated) if ended.bye else ():
        click.echo(line, err=True)
    return ended.bye.exit_code if ended.bye else ExitCode.BUG


def _print_log(event: object) -> None:
    from gcs import ipc
    from gcs.gate.effects import Level
    from gcs.operator.text import event_text

    if isinstance(event, ipc.LogEvent) and event.level >= Level.INFO:
        click.echo(event_text.log_line(event), err=True)
    if isinstance(event, ipc.Trouble):
        click.echo(event.text, err=True)
