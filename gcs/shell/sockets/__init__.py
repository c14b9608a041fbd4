"""Open links of any transport for the one loop: `open_link(endpoint) -> Link`."""

from __future__ import annotations

from typing import assert_never

from gcs.shell.endpoints import Endpoint, Kind
from gcs.shell.sockets.base import AddressInUse, Counters, Link
from gcs.shell.sockets.serial import SerialLine, SerialUnavailable
from gcs.shell.sockets.tcp import TcpIn, TcpOut
from gcs.shell.sockets.udp import UdpIn, UdpOut

__all__ = [
    "AddressInUse",
    "Counters",
    "Link",
    "SerialLine",
    "SerialUnavailable",
    "TcpIn",
    "TcpOut",
    "UdpIn",
    "UdpOut",
    "open_link",
]


def open_link(endpoint: Endpoint) -> Link:
    """Raises AddressInUse, SerialUnavailable, or another OSError."""
    match endpoint.kind:
        case Kind.UDP_IN:
            return UdpIn(endpoint)
        case Kind.UDP_OUT:
            return UdpOut(endpoint)
        case Kind.TCP_IN:
            return TcpIn(endpoint)
        case Kind.TCP_OUT:
            return TcpOut(endpoint)
        case Kind.SERIAL:
            return SerialLine(endpoint)
        case _:
            assert_never(endpoint.kind)
