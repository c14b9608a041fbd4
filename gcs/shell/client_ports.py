"""Where MAVLink clients reach the vehicle through this station: ports for the one `select` loop."""

from __future__ import annotations

from collections.abc import Sequence

from gcs.shell.client_port_kinds import LinkPort, Port, Source, UdpPort, open_port
from gcs.shell.client_table import Arrival, ClientLimits, ClientTable
from gcs.shell.endpoints import Endpoint

SWEEP_NS = 500_000_000


class ClientPorts:
    """All client ports of a station."""

    def __init__(self, first_link: int, limits: ClientLimits | None = None) -> None:
        """None yet; `open` adds one.  Their clients have link numbers from `first_link` up."""
        self._table = ClientTable(first_link, limits or ClientLimits())
        self._ports: list[Port] = []
        self.waiting: list[Source] = []
        """What `select` is to wait for, of the ports that wait for datagrams: always the same."""
        self.others: list[Port] = []
        """The ports that have more than that: see `sources` and `sinks`."""
        self._links: list[LinkPort] = []
        self._first_read = 0
        self._sweep_ns = 0

    def open(self, endpoint: Endpoint) -> None:
        """Raises AddressInUse, SerialUnavailable, or another OSError."""
        port = open_port(endpoint, self._table)
        self._ports.append(port)
        if isinstance(port, UdpPort):
            self.waiting.append(port.socket)
        else:
            self.others.append(port)
        if isinstance(port, LinkPort):
            self._links.append(port)

    def sources(self, now_ns: int) -> list[Source]:
        """What `select` is to wait for beside `waiting`; a client that has sent too much is not
        among them."""
        return [source for port in self.others for source in port.sources(now_ns)]

    @property
    def sinks(self) -> list[Source]:
        """Connections that have something queued."""
        return [sink for port in self.others for sink in port.sinks]

    @property
    def deadline_ns(self) -> int:
        """When `turn` has something to do although nothing can be read."""
        deadline_ns = self._sweep_ns
        for port in self._links:
            due_ns = port.deadline_ns
            if due_ns is not None and due_ns < deadline_ns:
                deadline_ns = due_ns
        return deadline_ns

    def turn(
        self, readable: Sequence[object], writable: Sequence[object], now_ns: int
    ) -> list[Arrival]:
        """Who came, what they sent, and who has gone, in order; at most `MAX_A_TURN` or so.

        Whose port is read first changes from turn to turn.
        """
        if now_ns >= self._sweep_ns:
            self._sweep_ns = now_ns + SWEEP_NS
            self._table.sweep(now_ns)
        self._first_read = (self._first_read + 1) % max(1, len(self._ports))
        for port in self._ports[self._first_read :] + self._ports[: self._first_read]:
            if writable:
                port.flush(writable)
            port.turn(readable, now_ns)
        return self._table.take()

    def send(self, link: int, data: bytes) -> None:
        """To one client, whole; nothing where it has gone."""
        self._table.send(link, data)

    def verify(self, link: int, now_ns: int) -> None:
        """The client there, if it is there still, has shown that it has the key."""
        self._table.verify(link, now_ns)

    @property
    def endpoints(self) -> list[Endpoint]:
        """As they were opened: with the port that was given where any free one was asked for."""
        return [_with_port(port) for port in self._ports]

    def describe(self) -> tuple[str, ...]:
        """A line each, for a person."""
        return tuple(port.describe() for port in self._ports)

    def close(self) -> None:
        self._table.close()
        for port in self._ports:
            port.close()


def _with_port(port: Port) -> Endpoint:
    at = port.endpoint
    return Endpoint(at.kind, at.host, port.port, at.device, at.baud)
