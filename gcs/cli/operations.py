"""`gcs operations`: what a running station has under way; wait for it, or stop it."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import click
import msgspec

from gcs.cli.options import AS_JSON, LINK, Seconds, with_options
from gcs.exit_codes import ExitCode

if TYPE_CHECKING:
    from gcs.operator.operations import OperationsView

LIST_WAIT_S = 10.0


@click.group(
    invoke_without_command=True,
    epilog="Example: gcs operations --json\n\nstate: running, complete, aborted, superseded, "
    "timed out or taken over.",
)
@with_options(LINK, AS_JSON)
@click.pass_context
def operations(ctx: click.Context, links: tuple[str, ...], as_json: bool) -> None:
    """List accepted requests of all operators: number, request, who asked, since when, state."""
    ctx.obj = links
    if ctx.invoked_subcommand is not None:
        return
    from gcs.operator.text.event_text import operation_line

    with _view(links) as view:
        listed = view.listed(LIST_WAIT_S)
    if as_json:
        click.echo(msgspec.json.encode(listed).decode())
    else:
        now_ns = time.time_ns()
        click.echo("\n".join(operation_line(each, now_ns) for each in listed) or "none")
    ctx.exit(ExitCode.DONE)


@operations.command(
    epilog="Example: gcs operations wait 7\n\nExit codes: 0 it is complete, 2 no such operation, "
    "5 refused by the vehicle, 8 it ended otherwise or not in time."
)
@click.argument("number", metavar="ID", type=int)
@click.option("--wait", type=Seconds(), default=300.0, show_default=True, metavar="S")
@with_options(AS_JSON)
@click.pass_context
def wait(ctx: click.Context, number: int, wait: float, as_json: bool) -> None:
    """Wait until an operation has ended; exit with how."""
    from gcs.gate.refusal import Code
    from gcs.operator.text.event_text import operation_line

    with _view(ctx.obj) as view:
        ended = view.ended(number, wait)
    if as_json:
        click.echo(msgspec.json.encode(ended).decode())
    else:
        click.echo(operation_line(ended, time.time_ns()))
    if ended.state == "complete":
        ctx.exit(ExitCode.DONE)
    refused = ended.code == Code.VEHICLE_REFUSED
    ctx.exit(ExitCode.REFUSED_BY_VEHICLE if refused else ExitCode.NOT_COMPLETED)


@operations.command(
    epilog="Example: gcs operations stop 7\n\nExit codes: 0 done, 6 it is not under way, "
    "8 the vehicle was not seen to hold."
)
@click.argument("number", metavar="ID", type=int)
@with_options(AS_JSON)
@click.pass_context
def stop(ctx: click.Context, number: int, as_json: bool) -> None:
    """Stop an operation that is under way: an abort, by anyone."""
    from gcs.cli import oneshot_session
    from gcs.cli.running import the_station
    from gcs.ipc import Ask
    from gcs.request_words import SendRequests

    action = SendRequests((Ask(0, "abort", operation=number),))
    how = oneshot_session.OneShotConfig(10.0, 60.0, as_json, "operations stop", stops=True)
    task = oneshot_session.sending(action, 60.0)
    ctx.exit(oneshot_session.run_through(the_station(ctx.obj), how, task))


def _view(links: tuple[str, ...]) -> OperationsView:
    from gcs.cli.running import joined_station, the_station
    from gcs.operator.operations import OperationsView

    joined = joined_station(the_station(links), "gcs operations", hold_on_leave=False)
    return OperationsView(joined)
