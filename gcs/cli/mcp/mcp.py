"""`gcs mcp`: an agent flies through the gate, over standard input and output."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Unpack

import click

from gcs.cli.options import LINK, TAKE, TIMEOUT, VEHICLE, RecordName, with_options
from gcs.cli.station_options import STATION_OPTIONS, OfStation, new_station

EPILOG = """\
Examples:

\b
  gcs mcp --sim
  gcs mcp --link udpin://127.0.0.1:14540 --policy lab --missions ~/missions

An MCP client starts it, such as with {"command": "gcs", "args": ["mcp", "--sim"]}. Where a station
runs already on the link, the agent joins it as one more operator. See docs/agents.md.

Standard output is the protocol's. When the client goes, the vehicle is held.
"""


@click.command(epilog=EPILOG)
@with_options(LINK, VEHICLE, TAKE)
@with_options(*STATION_OPTIONS)
@with_options(TIMEOUT)
@click.option(
    "--missions",
    type=click.Path(exists=True, file_okay=False),
    metavar="DIR",
    help="A folder whose mission files the agent may name, beside the shipped ones.",
)
@click.option(
    "--name",
    type=RecordName(),
    default="agent",
    show_default=True,
    help="What other operators and the record call the agent.",
)
@click.pass_context
def mcp(
    ctx: click.Context,
    links: tuple[str, ...],
    vehicle: int | None,
    take: bool,
    timeout: float,
    missions: str | None,
    name: str,
    **of: Unpack[OfStation],
) -> None:
    """Serve a station to an agent, by the Model Context Protocol on standard input and output."""
    from pathlib import Path

    check_installed()
    config = new_station(
        ctx, links, of, link_option="--link", name=name, timeout_s=timeout, vehicle=vehicle
    )
    from gcs.cli.mcp.session import run

    ctx.exit(run(config, of["policy"], name, Path(missions) if missions else None, take=take))


def check_installed() -> None:
    """Raises ExitError without the `mcp` package."""
    if find_spec("mcp") is None:
        from gcs.exit_codes import ExitCode
        from gcs.operator.errors import ExitError

        text = "the package mcp is not installed"
        raise ExitError(ExitCode.USAGE, text, "pip install 'mavgate[mcp]'")
