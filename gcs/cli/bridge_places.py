"""Where a bridge is connected: every place is one end of one link only."""

from __future__ import annotations

from collections.abc import Sequence

import click

from gcs.shell.endpoints import Endpoint, EndpointError, Kind, parse_endpoint

_HERE = ("localhost", "::1", "0.0.0.0", "::", "")
_UDP = (Kind.UDP_IN, Kind.UDP_OUT)


def refuse_shared_places(
    vehicles: Sequence[str], clients: Sequence[str], *, vehicle_option: str = "--link"
) -> None:
    """Raises UsageError for what is no endpoint, for the same one twice, and for two that are the
    same place: what is sent to the one would come in at the other, and round and round.
    """
    taken: dict[tuple[str, str, int], tuple[str, str]] = {}
    named = [(vehicle_option, url) for url in vehicles] + [("--client", url) for url in clients]
    for option, url in named:
        try:
            place = _place(parse_endpoint(url))
        except EndpointError as error:
            raise click.UsageError(f"{option} {error}; {error.hint}") from error
        if place is None:
            continue
        if place in taken:
            raise click.UsageError(_why(taken[place], (option, url)))
        taken[place] = option, url


def _place(endpoint: Endpoint) -> tuple[str, str, int] | None:
    """Transport, host and port; all addresses of this machine are one.  None: any free port."""
    if endpoint.kind is Kind.SERIAL:
        return "serial", endpoint.device, 0
    if endpoint.port == 0:
        return None
    host = "" if endpoint.host in _HERE or endpoint.host.startswith("127.") else endpoint.host
    return ("udp" if endpoint.kind in _UDP else "tcp"), host, endpoint.port


def _why(first: tuple[str, str], second: tuple[str, str]) -> str:
    if first == second:
        return f"{first[0]} {first[1]} is given twice"
    both = f"{first[0]} {first[1]} and {second[0]} {second[1]}"
    return f"{both} are the same place: frames would go round in a loop; give one of them another"
