"""`gcs stations`: the stations that run on this machine, and how one is ended."""

from __future__ import annotations

import time

import click
import msgspec

from gcs.cli.options import AS_JSON, LINK, TAKE, with_options
from gcs.exit_codes import ExitCode
from gcs.shell.stations import Description


@click.group(
    invoke_without_command=True,
    epilog="Example: gcs stations --json\n\nThe JSON is an array, one object a station: "
    "docs/json.md.",
)
@with_options(AS_JSON)
@click.pass_context
def stations(ctx: click.Context, as_json: bool) -> None:
    """List the running stations of this user: process, vehicle, links, log."""
    if ctx.invoked_subcommand is not None:
        return
    from gcs.operator.joined import running_stations, why_no_station_is_found

    found = running_stations()
    if as_json:
        shown = [msgspec.structs.replace(each, token="") for each in found]
        click.echo(msgspec.json.encode(shown).decode())
    else:
        for each in found:
            click.echo("\n".join(_lines(each)))
        if not found:
            unsafe = why_no_station_is_found()
            click.echo(f"no station is found: {unsafe}" if unsafe else "no station is running")
    ctx.exit(ExitCode.DONE)


def _lines(each: Description) -> list[str]:
    started = time.strftime("%H:%M:%S", time.localtime(each.started_ns / 1e9))
    kept = ", kept" if each.keep else ""
    return [
        f"{each.pid}  {each.vehicle or 'no vehicle yet'}, since {started}{kept}",
        *(f"  link {endpoint}" for endpoint in each.endpoints),
        f"  log  {each.log_path or 'not recorded'}",
        *([f"  policy {each.policy}"] if each.policy else []),
    ]


@stations.command(epilog="Example: gcs stations end --link udpin://127.0.0.1:14550")
@with_options(LINK, TAKE, AS_JSON)
@click.pass_context
def end(ctx: click.Context, links: tuple[str, ...], take: bool, as_json: bool) -> None:
    """End a station; a vehicle that it flies is told to hold first."""
    from gcs.cli import oneshot_session
    from gcs.cli.running import the_station
    from gcs.ipc import Ask
    from gcs.request_words import SendRequests

    action = SendRequests((Ask(0, "station_end"),))
    how = oneshot_session.OneShotConfig(10.0, 10.0, as_json, "stations end", take=take, stops=True)
    task = oneshot_session.sending(action, 10.0)
    ctx.exit(oneshot_session.run_through(the_station(links), how, task))
