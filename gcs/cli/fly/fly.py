"""`gcs fly`: the keyboard screen, or the same requests as typed lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Unpack

import click

from gcs.cli import completers
from gcs.cli.live_option import ALLOW, LIVE, LiveView, live_view, open_beside
from gcs.cli.options import (
    ASCII,
    LINK,
    QUIET,
    UTF8,
    VEHICLE,
    VERBOSE,
    RecordName,
    Seconds,
    log_level,
    with_options,
)
from gcs.cli.settings import configured, configured_keymap
from gcs.cli.station_options import STATION_OPTIONS, OfStation, new_station

if TYPE_CHECKING:
    from gcs.config import StationConfig
    from gcs.tui.keymap import Keymap

EPILOG = """\
Examples:

\b
  gcs fly --sim
  gcs fly --link udpin://127.0.0.1:14550 --policy lab
  gcs fly --sim 3
  gcs fly --sim --live
  gcs fly --sim --client udpout://127.0.0.1:14550
  printf 'arm\\ntakeoff 2\\ngoto 3 0 2\\nland\\n' | gcs fly --sim --plain

Of several vehicles each request is for one: the key Tab, or the words `vehicle 2`, say which. Space
and `abort` stop that one, the key A and `abort all` every one that flies.

With --plain, answers go to standard output and the log to standard error; `help` lists the words.
A line is done when the one before has its ending or its refusal; a line that ends in & is not
waited for. `abort` never waits: it acts as soon as it is read, and the lines before it that have
not begun are dropped, in a script too. On a terminal `hold`, `land`, `rtl` and `quit` (and the end
of the input) do the same; in a script they stand in line, unless they begin with ! (`!hold`). The
exit code is 0 when the session ended in order, whatever was refused; with --strict it is 6 when
something was refused and 8 when something accepted was not completed. A line that cannot be
understood is passed over and makes it 2.
"""


PLAIN_TIMEOUT_S = 10.0


def usual_timeout_s() -> float:
    """How long --plain waits for a vehicle where no option says it."""
    found = configured("timeout_s")
    return PLAIN_TIMEOUT_S if found is None else float(found.value)


@click.command(epilog=EPILOG)
@with_options(LINK, VEHICLE)
@with_options(*STATION_OPTIONS)
@click.option(
    "--timeout",
    type=Seconds(),
    metavar="S",
    help="Seconds to wait for a vehicle to be heard.  [default: with --plain 10; at the keyboard "
    "as long as you like]",
)
@click.option(
    "--name",
    type=RecordName(),
    default="flight",
    show_default=True,
    help="Goes into the log's file name.",
)
@click.option(
    "--mission",
    type=UTF8,
    default="",
    metavar="FILE",
    help="A mission file: the key i uploads it, then flies it.",
    shell_complete=completers.missions,
)
@click.option(
    "--keep", is_flag=True, help="The link lives on when this operator leaves; see gcs stations."
)
@with_options(LIVE, ALLOW)
@click.option(
    "--verifier",
    type=UTF8,
    default="",
    metavar="FILE",
    help="Your own rule, in Python: verify(start, goal, policy) returns None, or a sentence that "
    "refuses. Asked for every leg that the gate would let be flown; see missions/lab3.",
)
@click.option("--plain", is_flag=True, help="Read words from standard input, line by line.")
@click.option("--json", "as_json", is_flag=True, help="--plain: print the link's events as JSON.")
@click.option("--strict", is_flag=True, help="--plain: exit 6 or 8 when not all was completed.")
@with_options(VERBOSE, QUIET, ASCII)
@click.pass_context
def fly(
    ctx: click.Context,
    links: tuple[str, ...],
    vehicle: int | None,
    timeout: float | None,
    name: str,
    keep: bool,
    mission: str,
    live: tuple[str, int] | None,
    allow: tuple[str, ...],
    verifier: str,
    plain: bool,
    as_json: bool,
    strict: bool,
    verbose: bool,
    quiet: bool,
    ascii_only: bool,
    **of: Unpack[OfStation],
) -> None:
    """Fly by keyboard: keys change a pending goal, Enter sends it through the gate."""
    import msgspec

    if of["sim"] and vehicle is not None:
        raise click.UsageError("--sim starts a vehicle of its own: leave out --vehicle")
    view = live_view(live, allow)
    config = new_station(
        ctx,
        links,
        of,
        link_option="--link",
        name=name,
        timeout_s=timeout or usual_timeout_s(),
        vehicle=vehicle,
    )
    rule_path = verifier or msgspec.UNSET
    config = msgspec.structs.replace(config, keep=keep, rule_path=rule_path, fleet=vehicle is None)
    if plain and mission:
        raise click.UsageError("--mission is for the keyboard; with --plain type: mission fly FILE")
    mission_path = _mission(mission) if mission else ""
    if plain:
        level = log_level(2, quiet=quiet, verbose=verbose)
        ctx.exit(_fly_plain(config, view, min_level=level, as_json=as_json, strict=strict))
    ctx.exit(
        _fly_keyboard(
            config, view, timeout, mission_path, configured_keymap(), ascii_only=ascii_only
        )
    )


def _fly_plain(
    config: StationConfig,
    view: LiveView | None,
    *,
    min_level: int,
    as_json: bool,
    strict: bool,
) -> int:
    from gcs.cli.fly.standard_streams import stdin_input, to_stderr, to_stdout
    from gcs.operator.client import StationClient
    from gcs.operator.console.plain import Plain, PlainConfig
    from gcs.operator.interrupts import Interrupts

    how = PlainConfig(
        config.connect_timeout_s,
        min_level,
        as_json,
        strict,
        config.speedup,
        simulated=config.sim is not None and not config.keep,
    )
    with Interrupts() as interrupts:
        station = StationClient.start(config)
        open_beside(station, view, to_stderr)
        return Plain(station, interrupts, how, to_stdout, to_stderr).run(stdin_input())


def _mission(file: str) -> str:
    """Path of the file, or of the shipped mission of that name, read once to see that it is one.

    Raises ExitError with BAD_FILE.
    """
    from gcs import resources
    from gcs.cli.mission.files import read_plan

    read_plan(file, None)
    return str(resources.find(file))


def needs_a_terminal() -> None:
    """Raises UsageError where the screen has none."""
    import sys

    from gcs.cli.fly.standard_streams import stdin_is_a_terminal

    if not (stdin_is_a_terminal() and sys.stdout.isatty() and sys.stderr.isatty()):
        raise click.UsageError("the keyboard station needs a terminal; use --plain on a pipe")


def _fly_keyboard(
    config: StationConfig,
    view: LiveView | None,
    timeout_s: float | None,
    mission_path: str,
    keymap: Keymap,
    *,
    ascii_only: bool,
) -> int:
    needs_a_terminal()
    from gcs import ipc
    from gcs.exit_codes import ExitCode
    from gcs.gate.effects import Level
    from gcs.operator.client import StationClient
    from gcs.operator.errors import Interrupted
    from gcs.operator.interrupts import Interrupts
    from gcs.tui.app import FlyApp
    from gcs.tui.result import print_result, until_hello

    with Interrupts() as interrupts:
        station = StationClient.start(config)
        try:
            events = until_hello(station, interrupts)
        except Interrupted:
            click.echo("gcs: interrupted", err=True)
            return ExitCode.INTERRUPTED
        told = open_beside(station, view, lambda line: click.echo(line, err=True))
        events += [ipc.LogEvent(0, Level.INFO, "live", line.strip()) for line in told]
    app = FlyApp(
        station,
        events,
        mission_path=mission_path,
        timeout_s=timeout_s,
        keymap=keymap,
        ascii_only=ascii_only,
    )
    app.run()
    simulated = config.sim is not None
    ended = simulated and not config.keep
    code = print_result(app.result, lambda line: click.echo(line, err=True), simulated=ended)
    if code or app.heard_vehicle:
        return code
    if app.interrupted:
        return ExitCode.INTERRUPTED
    if simulated:
        return ExitCode.DONE
    click.echo(
        "  hint: start one with `vehicle-sim`, use `gcs fly --sim`, or name the link with --link",
        err=True,
    )
    return ExitCode.NO_VEHICLE
