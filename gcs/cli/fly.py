"""`gcs fly`: the keyboard screen, or the same requests as typed lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

from gcs.cli.live_option import LIVE, open_beside
from gcs.cli.options import (
    LINK,
    LOG_DIR,
    POLICY,
    UTF8,
    VEHICLE,
    FiniteRange,
    RecordName,
    Seconds,
    Seed,
    with_options,
)
from gcs.cli.record_options import COMPACT, ROTATE_AGE, ROTATE_SIZE, with_files
from gcs.operator.number_text import read_number

if TYPE_CHECKING:
    from gcs.config import StationConfig

EPILOG = """\
Examples:

\b
  gcs fly --sim
  gcs fly --link udpin://127.0.0.1:14550 --policy lab
  gcs fly --sim --live
  printf 'arm\\ntakeoff 2\\ngoto 3 0 2\\nland\\n' | gcs fly --sim --plain

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


def _place(_ctx: click.Context, _param: click.Parameter, text: str) -> str:
    """LAT,LON,ALT, looked at before anything is started."""
    if not text:
        return text
    try:
        lat_deg, lon_deg, alt_m = (read_number(part) for part in text.split(","))
    except ValueError:
        raise click.BadParameter(f"{text!r} is not as in 47.397742,8.545594,488") from None
    if not (abs(lat_deg) < 90.0 and abs(lon_deg) <= 180.0 and -500.0 <= alt_m <= 9000.0):
        raise click.BadParameter(
            f"{text!r} is not on Earth: latitude within 90, longitude within 180 degrees, "
            "height from -500 to 9000 m"
        )
    return text


@click.command(epilog=EPILOG)
@with_options(LINK, VEHICLE)
@click.option("--sim", is_flag=True, help="Start a vehicle of our own, on a private port.")
@click.option(
    "--autopilot",
    type=click.Choice(["px4", "ardupilot"]),
    default="px4",
    show_default=True,
    help="Which autopilot the --sim vehicle speaks like.",
)
@click.option(
    "--home",
    default="",
    callback=_place,
    metavar="LAT,LON,ALT",
    help="Where the --sim vehicle stands: degrees, degrees, metres above mean sea level.",
)
@click.option(
    "--seed", type=Seed(), default=1, show_default=True, help="Seed of the --sim vehicle."
)
@click.option(
    "--speedup",
    type=FiniteRange(min=0, max=200, min_open=True),
    default=1.0,
    show_default=True,
    help="Times real time, for the --sim vehicle and the ground station.",
)
@with_options(POLICY, LOG_DIR)
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
)
@click.option(
    "--keep", is_flag=True, help="The link lives on when this operator leaves; see gcs stations."
)
@with_options(ROTATE_SIZE, ROTATE_AGE, COMPACT, LIVE)
@click.option("--plain", is_flag=True, help="Read words from standard input, line by line.")
@click.option("--json", "as_json", is_flag=True, help="--plain: print the link's events as JSON.")
@click.option("--strict", is_flag=True, help="--plain: exit 6 or 8 when not all was completed.")
@click.option("--verbose", "-v", is_flag=True, help="--plain: debug lines too.")
@click.option("--quiet", "-q", is_flag=True, help="--plain: warnings and errors only.")
@click.pass_context
def fly(
    ctx: click.Context,
    links: tuple[str, ...],
    vehicle: int | None,
    sim: bool,
    autopilot: str,
    home: str,
    seed: int,
    speedup: float,
    policy: str,
    log_dir: str,
    timeout: float | None,
    name: str,
    keep: bool,
    mission: str,
    rotate_size: int,
    rotate_age: float,
    compact: bool,
    live: tuple[str, int] | None,
    plain: bool,
    as_json: bool,
    strict: bool,
    verbose: bool,
    quiet: bool,
) -> None:
    """Fly by keyboard: keys change a pending goal, Enter sends it through the gate."""
    import os

    import msgspec

    from gcs.cli.options import station_config
    from gcs.config import SimConfig

    if sim and links:
        raise click.UsageError("--sim starts a vehicle of its own: leave out --link")
    if sim and vehicle is not None:
        raise click.UsageError("--sim starts a vehicle of its own: leave out --vehicle")
    if not sim:
        _refuse_options_of_the_sim(ctx)
    connect_s = timeout or PLAIN_TIMEOUT_S
    config = station_config(links, policy, log_dir, name=name, timeout_s=connect_s, vehicle=vehicle)
    if sim:
        simulated = SimConfig(autopilot=autopilot, home=home, seed=seed, speedup=speedup)
        config = msgspec.structs.replace(config, sim=simulated, endpoints=[])
    operator = f"gcs fly, pid {os.getpid()}"
    config = msgspec.structs.replace(config, speedup=speedup, keep=keep, operator=operator)
    config = with_files(config, rotate_size, rotate_age, compact)
    if plain and mission:
        raise click.UsageError("--mission is for the keyboard; with --plain type: mission fly FILE")
    mission_path = _mission(mission) if mission else ""
    if plain:
        level = 1 if verbose else 3 if quiet else 2
        ctx.exit(_fly_plain(config, live, min_level=level, as_json=as_json, strict=strict))
    ctx.exit(_fly_keyboard(config, live, timeout, mission_path))


def _fly_plain(
    config: StationConfig,
    live: tuple[str, int] | None,
    *,
    min_level: int,
    as_json: bool,
    strict: bool,
) -> int:
    from gcs.cli.plain import Plain, PlainConfig, stdin_input, to_stderr, to_stdout
    from gcs.operator.client import StationClient
    from gcs.operator.interrupts import Interrupts

    how = PlainConfig(
        config.connect_timeout_s,
        min_level,
        as_json,
        strict,
        config.speedup,
        simulated=config.sim is not None,
    )
    with Interrupts() as interrupts:
        station = StationClient.start(config)
        open_beside(station, live, to_stderr)
        return Plain(station, interrupts, how, to_stdout, to_stderr).run(stdin_input())


def _mission(file: str) -> str:
    """Path of the file, or of the shipped mission of that name, read once to see that it is one.

    Raises ExitError with BAD_FILE.
    """
    from gcs import resources
    from gcs.cli.mission import read_plan

    read_plan(file, None)
    return str(resources.find(file))


def _refuse_options_of_the_sim(ctx: click.Context) -> None:
    """They say what our own vehicle is to be; another one is as it is."""
    for name in ("autopilot", "home", "seed", "speedup"):
        if ctx.get_parameter_source(name) is not ParameterSource.DEFAULT:
            raise click.UsageError(f"--{name} is for the vehicle of --sim: add --sim, or leave it")


def needs_a_terminal() -> None:
    """Raises UsageError where the screen has none."""
    import sys

    from gcs.cli.plain import stdin_is_a_terminal

    if not (stdin_is_a_terminal() and sys.stdout.isatty() and sys.stderr.isatty()):
        raise click.UsageError("the keyboard station needs a terminal; use --plain on a pipe")


def _fly_keyboard(
    config: StationConfig,
    live: tuple[str, int] | None,
    timeout_s: float | None,
    mission_path: str,
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
        told = open_beside(station, live, lambda line: click.echo(line, err=True))
        events += [ipc.LogEvent(0, Level.INFO, "live", line.strip()) for line in told]
    app = FlyApp(station, events, mission_path=mission_path, timeout_s=timeout_s)
    app.run()
    simulated = config.sim is not None
    code = print_result(app.result, lambda line: click.echo(line, err=True), simulated=simulated)
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
