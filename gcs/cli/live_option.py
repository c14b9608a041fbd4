"""`--live [HOST:PORT]`: a live view beside a station that a command has started."""

from __future__ import annotations

import ipaddress
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import click

if TYPE_CHECKING:
    from gcs.live.program import Opened
    from gcs.operator.client import StationClient

DEFAULT_HOST = "127.0.0.1"
ADDRESS_HELP = (
    f"{DEFAULT_HOST} and the first free port from 8765 on, unless given; a host that is not this "
    "machine alone lets all who reach it look on and stop the vehicle."
)


class AddressType(click.ParamType[Any]):
    """HOST, PORT or HOST:PORT, as (host, port); port 0 stands for the first free usual one."""

    name = "HOST:PORT"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, int]:
        if not isinstance(value, str):
            host, port = value
            return str(host), int(port)
        host, colon, port_text = value.rpartition(":")
        if value.isdecimal():
            host, port_text = DEFAULT_HOST, value
        elif not colon or value.endswith("]"):
            return value.strip("[]") or DEFAULT_HOST, 0
        if not (port_text.isascii() and port_text.isdecimal() and 0 < int(port_text) < 65536):
            self.fail(f"{value!r} is not as in {DEFAULT_HOST}:8765.", param, ctx)
        return host.strip("[]") or DEFAULT_HOST, int(port_text)


ADDRESS = AddressType()
LIVE = click.Option(
    ["--live"],
    is_flag=False,
    flag_value=DEFAULT_HOST,
    default=None,
    type=ADDRESS,
    metavar="[HOST:PORT]",
    help=f"Serve the flight to viewers such as Foxglove while it is flown: {ADDRESS_HELP}",
)
ALLOW = click.Option(
    ["--allow"],
    multiple=True,
    metavar="PAGE|NAME",
    help="--live: let this page, or this name of our machine, in too; see gcs live.",
)


class LiveView(NamedTuple):
    """Where a live view is wanted, and who is let in beside the usual ones."""

    host: str
    port: int
    allow: tuple[str, ...] = ()


def live_view(address: tuple[str, int] | None, allow: tuple[str, ...]) -> LiveView | None:
    """What `LIVE` and `ALLOW` say together."""
    if address is None and allow:
        raise click.UsageError("--allow is for the viewers of a live view: give --live, too")
    return None if address is None else LiveView(*address, allow)


def open_beside(
    station: StationClient, view: LiveView | None, echo: Callable[[str], None]
) -> list[str]:
    """Open a live view of a station that was just started, if one is wanted; what was told of it.

    Raises ExitError if there can be none; then the station is ended, too.  That a station has ended
    meanwhile, it tells itself.
    """
    if view is None:
        return []
    from gcs import ipc
    from gcs.live.program import Wanted, check_installed, opened_by
    from gcs.operator.errors import ExitError

    try:
        check_installed()
        wanted = Wanted(station.pid, view.host, view.port, [*view.allow])
        opened = opened_by(wanted, lambda: station.running)
    except ExitError:
        station.send(ipc.Leave("there is no live view"))
        station.close()
        raise
    lines = lines_about(opened, view.host) if opened is not None else []
    for line in lines:
        echo(line)
    return lines


def lines_about(opened: Opened, host: str) -> list[str]:
    """What whoever has asked for a live view is told of it."""
    layout = opened.layout or "what `gcs log layout` writes"
    lines = [
        f"live view: {opened.url}",
        "  Foxglove: Open connection > Foxglove WebSocket, then Layouts > Import from file:",
        f"  {layout}",
    ]
    if opened.layout:
        lines.append('  Press "take control" there, and a click in its 3D panel is a goal.')
    lines.append(f'  The service take_control takes {{"code": "{opened.code}"}}')
    if not _this_machine_alone(host):
        lines.append(f"  all who can reach {host} can look on, and stop the vehicle")
    return lines


def _this_machine_alone(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"
