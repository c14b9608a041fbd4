"""`gcs attach`: another screen, or another console, on a station that runs."""

from __future__ import annotations

import click

from gcs.cli.options import ASCII, LINK, SYSID, TAKE, TIMEOUT, with_options

EPILOG = """\
Examples:

\b
  gcs attach
  gcs attach --take
  echo abort | gcs attach --plain
  gcs attach --vehicle 2

Without --take it looks on, and may abort, hold, land and return home; everything else is refused
with the name of the operator who is in control. `station take` takes over later. Leaving it does
not end the station.

Of several vehicles it is for the first that was heard, or for that of --vehicle; the key Tab, or
the words `vehicle 2`, choose another one.
"""


@click.command(epilog=EPILOG)
@with_options(LINK, TAKE, TIMEOUT, ASCII)
@click.option("--plain", is_flag=True, help="Read words from standard input, line by line.")
@click.option(
    "--vehicle",
    type=SYSID,
    metavar="SYSID",
    help="This one of several vehicles, by its MAVLink system id.  [default: the first heard]",
)
@click.option("--json", "as_json", is_flag=True, help="--plain: print the link's events as JSON.")
@click.option("--strict", is_flag=True, help="--plain: exit 6 or 8 when not all was completed.")
@click.pass_context
def attach(
    ctx: click.Context,
    links: tuple[str, ...],
    take: bool,
    timeout: float,
    plain: bool,
    vehicle: int | None,
    as_json: bool,
    strict: bool,
    ascii_only: bool,
) -> None:
    """Open a second screen on a running station."""
    from gcs.cli.running import joined_station, refuse_differences, the_station
    from gcs.config import Wanted
    from gcs.ipc import Ask

    found = the_station(links)
    refuse_differences(found, Wanted(vehicle=vehicle))
    if not plain:
        from gcs.cli.fly.fly import needs_a_terminal

        needs_a_terminal()
    station = joined_station(found, "gcs attach")
    if take:
        station.send(Ask(0, "station_take"))
    if plain:
        from gcs.cli.fly.standard_streams import stdin_input, to_stderr, to_stdout
        from gcs.operator.console.plain import Plain, PlainConfig
        from gcs.operator.interrupts import Interrupts

        how = PlainConfig(timeout, 2, as_json, strict, vehicle=vehicle or 0)
        with Interrupts() as interrupts:
            console = Plain(station, interrupts, how, to_stdout, to_stderr)
            ctx.exit(console.run(stdin_input()))
    from gcs.cli.settings import configured_keymap
    from gcs.tui.app import FlyApp
    from gcs.tui.result import print_result, until_hello

    events, keymap = until_hello(station), configured_keymap()
    app = FlyApp(station, events, keymap=keymap, ascii_only=ascii_only, vehicle=vehicle or 0)
    app.run()
    ctx.exit(print_result(app.result, lambda line: click.echo(line, err=True)))
