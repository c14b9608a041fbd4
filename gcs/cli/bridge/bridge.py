"""`gcs bridge`: MAVLink clients fly the vehicle through the gate."""

from __future__ import annotations

from typing import TYPE_CHECKING, Unpack

import click

from gcs.cli.options import (
    QUIET,
    SYSID,
    UTF8,
    VERBOSE,
    RecordName,
    Seconds,
    log_level,
    with_options,
)
from gcs.cli.station_options import STATION_OPTIONS, OfStation, new_station

if TYPE_CHECKING:
    from gcs.config import StationConfig
    from gcs.operator.client import StationEnded

EPILOG = """\
Examples:

\b
  gcs bridge --vehicle udpin://127.0.0.1:14540 --client udpout://127.0.0.1:14550
  gcs bridge --vehicle serial:///dev/ttyUSB0:57600 --client tcpin://127.0.0.1:5760 --policy lab
  gcs bridge --sim --client udpin://127.0.0.1:14551
  gcs bridge --explain DO_REPOSITION --policy my.toml

A client speaks MAVLink with the bridge as if that were the vehicle. What moves the vehicle is
verified by the gate, whoever sends it; what changes its settings is decided by [bridge] of the
policy; the rest is forwarded unchanged. The first client that asks for motion is in control.

On a terminal it shows a page, on a pipe it prints lines: decisions to standard output, the log to
standard error. Ctrl-C ends it: where the gate flies the vehicle, it holds first. `gcs attach` opens
a keyboard station on it.
"""


def _explained(name: str, policy: str) -> str:
    """The row of the classification, what a mode means, or whether a parameter may be written.

    Raises ExitError where there is none, and for a policy that is none.
    """
    from gcs.bridge.catalog.explain import explain, explanation
    from gcs.bridge.setup_policy.explain import parameter_explanation, policy_explanation
    from gcs.bridge.translate.explain import meaning_explanation, mode_explanation
    from gcs.exit_codes import ExitCode
    from gcs.operator.errors import ExitError
    from gcs.policy_file import PolicyFileError, load_policy

    try:
        rules = load_policy(policy)[0].bridge
    except PolicyFileError as error:
        raise ExitError(ExitCode.BAD_FILE, str(error), error.hint) from None
    try:
        row = explain(name)
    except KeyError as error:
        found = mode_explanation(name, rules.manual_modes) or parameter_explanation(name, rules)
        if found is None:
            hint = "if it is a parameter: no table here knows it, so a client may not write it; "
            hint += "flight modes are called as the autopilot calls them: POSCTL, AUTO.RTL, LOITER"
            raise ExitError(ExitCode.USAGE, str(error.args[0]), hint) from None
        return found
    lines = explanation(name), policy_explanation(row, rules), meaning_explanation(row.name)
    return "\n".join(line for line in lines if line)


OWN_COMPID = 191
"""MAV_COMP_ID_ONBOARD_COMPUTER: 255/190 is QGroundControl and 255/230 MAVProxy."""


@click.command(epilog=EPILOG)
@click.option(
    "--vehicle",
    "vehicles",
    multiple=True,
    type=UTF8,
    metavar="URL",
    help="Where the vehicle is: udpin:// udpout:// tcpin:// tcpout:// serial://. May be given more "
    "than once.",
)
@with_options(*STATION_OPTIONS)
@click.option(
    "--name",
    type=RecordName(),
    default="bridge",
    show_default=True,
    help="Goes into the log's file name.",
)
@click.option(
    "--target",
    type=SYSID,
    metavar="SYSID",
    help="Fly this vehicle alone, by its MAVLink system id; clients see others on the link, and "
    "command none of them.  [default: every one that is heard]",
)
@click.option(
    "--sysid",
    type=SYSID,
    default=255,
    show_default=True,
    help="The bridge's own MAVLink system id.",
)
@click.option(
    "--compid",
    type=click.IntRange(1, 255),
    default=OWN_COMPID,
    show_default=True,
    help="Its component id.",
)
@click.option(
    "--lock",
    is_flag=True,
    help="First give the vehicle on each link (with --target that one) the key of --sign-key, and "
    "make it ask the bridge before it arms (PX4). Without --sign-key the latter alone. Says what "
    "it changes. The vehicle must be disarmed.",
)
@click.option(
    "--set-fence",
    is_flag=True,
    help="With --lock: give the vehicle a fence of its own where it has none, or a wider one: a "
    "cylinder about home as large as the policy's fence.",
)
@click.option(
    "--enforce-sysid",
    is_flag=True,
    help="With --lock: an ArduPilot hears the bridge's system id alone. Clients need the same one "
    "(--sysid) to read anything from it.",
)
@click.option(
    "--timeout",
    type=Seconds(),
    metavar="S",
    help="Exit 3 when no vehicle is heard for so many seconds.  [default: wait; with --lock: 10]",
)
@click.option(
    "--explain",
    metavar="NAME",
    help="Say what becomes of a client's message, command, flight mode or parameter by the policy, "
    "and why; then end.",
)
@click.option("--plain", is_flag=True, help="Lines on a terminal, too.")
@click.option("--json", "as_json", is_flag=True, help="Print the events as JSON, a line each.")
@with_options(VERBOSE, QUIET)
@click.pass_context
def bridge(
    ctx: click.Context,
    vehicles: tuple[str, ...],
    name: str,
    target: int | None,
    sysid: int,
    compid: int,
    lock: bool,
    set_fence: bool,
    enforce_sysid: bool,
    timeout: float | None,
    explain: str | None,
    plain: bool,
    as_json: bool,
    verbose: bool,
    quiet: bool,
    **of: Unpack[OfStation],
) -> None:
    """MAVLink clients fly the vehicle, and the gate is in between."""
    import msgspec

    if explain is not None:
        click.echo(_explained(explain, of["policy"]))
        ctx.exit()
    if not (of["sim"] or vehicles):
        hint = "such as --vehicle udpin://127.0.0.1:14540, or --sim for one of our own"
        raise click.UsageError(f"where is the vehicle? {hint}")
    if not of["clients"]:
        hint = "such as --client udpin://127.0.0.1:14551 or --client udpout://127.0.0.1:14550"
        raise click.UsageError(f"where do clients reach it? {hint}")
    if lock and of["sim"]:
        raise click.UsageError("--lock is for a vehicle of yours: leave out --sim")
    if not lock and (set_fence or enforce_sysid):
        raise click.UsageError("--set-fence and --enforce-sysid are parts of --lock")
    config = new_station(
        ctx,
        vehicles,
        of,
        link_option="--vehicle",
        name=name,
        timeout_s=timeout or 10.0,
        vehicle=target,
    )
    config = msgspec.structs.replace(config, bridge=True, sysid=sysid, compid=compid)
    if lock:
        from gcs.cli.bridge.lock import LockOptions, lock_vehicles

        options = LockOptions(sysid, of["policy"], set_fence, enforce_sysid)
        lock_vehicles(vehicles, of["sign_key"], options, target, timeout or 10.0)
    level = log_level(2, quiet=quiet, verbose=verbose)
    ctx.exit(_run(config, timeout, page=not (plain or as_json), as_json=as_json, min_level=level))


def _run(
    config: StationConfig, timeout_s: float | None, *, page: bool, as_json: bool, min_level: int
) -> int:
    """Until a signal; returns the exit code."""
    import sys

    from gcs.cli.bridge.lines import BridgeLines
    from gcs.cli.bridge.watch import watch
    from gcs.cli.fly.standard_streams import to_stderr, to_stdout
    from gcs.operator.client import StationClient
    from gcs.operator.interrupts import Interrupts

    simulated = config.sim is not None
    with Interrupts() as interrupts:
        station = StationClient.start(config)
        if page and sys.stdout.isatty():
            from gcs.cli.bridge.page import BridgePage

            with BridgePage(min_level) as drawn:
                ended = watch(station, interrupts, drawn, timeout_s)
        else:
            lines = BridgeLines(to_stdout, to_stderr, min_level=min_level, as_json=as_json)
            ended = watch(station, interrupts, lines, timeout_s)
    return _told_end(ended, simulated=simulated)


def _told_end(ended: StationEnded, *, simulated: bool) -> int:
    """Where the vehicle is, and where the record; the exit code."""
    from gcs.exit_codes import ExitCode
    from gcs.operator.text import event_text

    if ended.bye is None:
        click.echo(f"gcs: the link ended without a good-bye\n{ended.stderr_tail}", err=True)
        return ExitCode.BUG
    for line in event_text.bye_lines(ended.bye, simulated=simulated):
        click.echo(line, err=True)
    return ended.bye.exit_code
