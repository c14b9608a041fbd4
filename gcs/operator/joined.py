"""The way into a station that runs already: find it, join it, speak JSON lines with it."""

from __future__ import annotations

import os
import select
import socket
from collections.abc import Sequence
from pathlib import Path

import msgspec

from gcs import ipc
from gcs.operator.client import EventReader, Polled, Readable, StationEnded, StationEvent
from gcs.shell import stations
from gcs.shell.endpoints import EndpointError, parse_endpoint
from gcs.shell.stations import Description

READ_BYTES = 65_536
SEND_WAIT_S = 5.0
LEAVE_WAIT_S = 5.0
MAX_REST_BYTES = 1 << 24


def running_stations() -> list[Description]:
    """The stations of this user on this machine, the oldest first."""
    return stations.running(*stations.folders_of())


def why_no_station_is_found() -> str:
    """Why stations of this user may run and are not found; empty where nothing is in the way."""
    return next(filter(None, map(stations.why_unsafe, stations.folders_of())), "")


def station_on(links: Sequence[str]) -> Description | None:
    """The running station that has one of these links open."""
    wanted = []
    for link in links:
        try:
            wanted.append(parse_endpoint(link))
        except EndpointError:
            continue  # whoever opens it will say so
    for found in running_stations() if wanted else ():
        if any(stations.holds(found, endpoint) for endpoint in wanted):
            return found
    return None


class JoinedStation(EventReader):
    """A connection to a running station, which goes on when this program leaves it.

    The same as `gcs.operator.client.StationClient` for whoever talks over it.
    """

    def __init__(self, connected: socket.socket, described: Description) -> None:
        super().__init__()
        self.description = described
        connected.setblocking(False)
        self._socket = connected
        self._rest = b""

    @classmethod
    def join(
        cls, described: Description, what: str, *, hold_on_leave: bool = True
    ) -> JoinedStation:
        """Connect and say who comes: `what` is the program, as other operators see it.

        Raises OSError if the station takes no connection.
        """
        joined = cls(stations.connect(described), described)
        name = f"{what}, pid {os.getpid()}"
        joined.send(ipc.Join(name, token=described.token, hold_on_leave=hold_on_leave))
        return joined

    def fileno(self) -> int:
        return self._socket.fileno()

    def send(self, command: ipc.Command) -> bool:
        """Write one command at once.  False if the connection has ended.  From any thread."""
        if isinstance(command, ipc.Ask) and command.path:
            command = _with_path_from_here(command)
        left = ipc.encode(command)
        with self._send_lock:
            while left:
                try:
                    left = left[self._socket.send(left) :]
                except BlockingIOError:
                    if not select.select([], [self._socket], [], SEND_WAIT_S)[1]:
                        return False
                except (OSError, ValueError):
                    return False
        return True

    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> Polled:
        if self._ended:
            return Polled([self._end()])
        sources: list[Readable] = [self, *also]
        ready, _, _ = select.select(sources, [], [], max(0.0, timeout_s))
        polled = Polled(ready=[source for source in ready if source in also])
        if self in ready:
            polled.events.extend(self._read())
        return polled

    def close(self) -> StationEnded:
        """End the connection; the station goes on."""
        if self._listener is not None:
            self._listener.join(LEAVE_WAIT_S)
        deadline_s = self.now_s() + LEAVE_WAIT_S
        while self._bye is None and not self._ended and self.now_s() < deadline_s:
            self.poll(deadline_s - self.now_s())
        self._ended = True
        self._socket.close()
        return self._end()

    def close_at_once(self) -> None:
        """End the connection without a word: for the station, this operator is lost."""
        self._ended = True
        self._socket.close()

    def _read(self) -> list[StationEvent]:
        try:
            data = self._socket.recv(READ_BYTES)
        except BlockingIOError:
            return []
        except OSError:
            data = b""
        *lines, self._rest = (self._rest + data).split(b"\n")
        events: list[StationEvent] = [self._event(line, "station") for line in lines if line]
        if not data or len(self._rest) > MAX_REST_BYTES:
            self._ended = True
            events.append(self._end())
        return events

    def _end(self) -> StationEnded:
        return StationEnded(self._bye, None, "")


def _with_path_from_here(ask: ipc.Ask) -> ipc.Ask:
    """The station may have been started in another folder; a shipped mission's name stays one."""
    path = Path(ask.path)
    if ask.word.endswith("_download") or path.exists():
        return msgspec.structs.replace(ask, path=str(path.absolute()))
    return ask
