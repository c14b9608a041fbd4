"""A live view of a station that runs: an operator's program that serves viewers.

A process of its own, with one loop.  What viewers send is parsed and kept here, at a lower priority
than the flight's, so that whatever it costs, the station goes on; to the station this is a program
like any other one on its local socket, which loses its connection when it does not read.
"""

from __future__ import annotations

import contextlib
import os
import secrets
import select
import socket
import sys
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.live.admission import Admission
from gcs.live.connection_graph import ConnectionGraph
from gcs.live.connections import Connections, Event, PortTakenError, Refused
from gcs.live.effects import Close, Effect, Frame, Join, Notice, Reply, Send, Values
from gcs.live.inputs import Ended, Input, Tick, Told
from gcs.live.server import Server, ServerInput
from gcs.live.session_layout import SessionLayout, remove_left
from gcs.live.viewers import LOOKING, Viewers
from gcs.operator.client import StationEnded, StationEvent
from gcs.operator.errors import ExitError
from gcs.operator.joined import JoinedStation, running_stations
from gcs.shell.stations import Description

TICK_S = 0.25
REJOIN_WAIT_S = 1.0
CODE_LETTERS = "abcdefghjkmnpqrstuvwxyz23456789"
"""Without those that are taken for one another."""
CODE_LENGTH = 8
NICE = 10
MAX_MEMORY_BYTES = 1 << 30
MAX_REFUSED = 16
"""Different pages that were not let in, and are told of once each."""
TAKEN_HINT = "another live view may be open; name a free port, as in 127.0.0.1:9000"
ADDRESS_HINT = "is the address one of this machine's, and does the station still run?"


class Interrupt(Protocol):
    """Set by a Ctrl-C, and then readable."""

    name: str

    def fileno(self) -> int: ...


@dataclass(frozen=True, slots=True)
class Address:
    """`port` 0: the first of the usual ones that is free; `allowed`: see `Admission`."""

    host: str = "127.0.0.1"
    port: int = 0
    allowed: frozenset[str] = frozenset()


def new_code() -> str:
    """31 letters, 8 times: 40 bits, which nobody tries out at five calls a second."""
    letters = [secrets.choice(CODE_LETTERS) for _ in range(CODE_LENGTH)]
    return "".join(letters)


class LiveView:
    """Serves viewers until the station ends."""

    def __init__(
        self, described: Description, address: Address, tell: Callable[[str], None] | None = None
    ) -> None:
        """Listens at once.  Raises PortTakenError; OSError if the station takes no connection.

        `tell`: is called with what the user should know.
        """
        self._described = described
        self._tell = tell or (lambda _: None)
        name = socket.gethostname()
        allowed = address.allowed | {name, f"{name}.local"}
        self._connections = Connections(Admission(address.host, allowed))
        self._server = Server(secrets.token_hex(8))
        self._graph = ConnectionGraph(os.path.basename(described.log_path))
        self.code = new_code()
        self._viewers = Viewers(self.code, time.monotonic_ns())
        self._trusted: dict[int, JoinedStation] = {}
        self._refused: set[str] = set()
        self._looking = self._join(LOOKING)
        try:
            self.url = self._connections.listen(address.port)
        except (OSError, PortTakenError):
            self._looking.close_at_once()
            raise
        port = self.url.rpartition(":")[2]
        if described.log_path:
            running = [described.log_path, *(each.log_path for each in running_stations())]
            remove_left(Path(described.log_path).parent, running)
        self.layout = SessionLayout(described.log_path, port, self.code)

    def run(self, interrupt: Interrupt | None = None) -> StationEnded | None:
        """Until the station ends; None if it was interrupted before."""
        _give_way()
        self._looking.send(ipc.WatchTopics())
        due_s = time.monotonic() + TICK_S
        while interrupt is None or not interrupt.name:
            readers: list[Any] = [self._looking, *self._trusted.values()]
            readers += [*self._connections.readers, *([interrupt] if interrupt else [])]
            wait_s = max(0.0, due_s - time.monotonic())
            ready, writable, _ = select.select(readers, self._connections.writers, [], wait_s)
            now_ns = time.monotonic_ns()
            for event in self._looking.poll(0.0).events if self._looking in ready else ():
                if isinstance(event, StationEnded):
                    if not self._rejoined(event):
                        return event
                else:
                    self._looked(event)
            self._viewers_said(self._connections.write(writable))
            self._viewers_said(self._connections.read(ready, now_ns))
            for viewer in [n for n, each in self._trusted.items() if each in ready]:
                self._hear(viewer)
            if time.monotonic() >= due_s:
                due_s = time.monotonic() + TICK_S
                self._tick()
        return None

    def close(self) -> None:
        """The viewers' connections end, and those to the station; the layout goes."""
        for joined in [self._looking, *self._trusted.values()]:
            joined.close_at_once()
        self._connections.close()
        self.layout.remove()

    def _tick(self) -> None:
        self._viewers_said(self._connections.tick(time.monotonic_ns()))
        if self._server.graph_wanted:
            self._serve(self._graph.graph())
        self._do(Tick())

    # ---------------------------------------------------------------------------- the station

    def _join(self, viewer: int) -> JoinedStation:
        what = f"viewer {viewer}" if viewer else "live view"
        return JoinedStation.join(self._described, what)

    def _rejoined(self, ended: StationEnded) -> bool:
        """Whether the station is there all the same: it ends the connection of one that has not
        read for too long, as when this process was stopped for a while."""
        if ended.bye is not None:
            return False
        self._looking.close_at_once()
        time.sleep(REJOIN_WAIT_S)
        try:
            self._looking = self._join(LOOKING)
        except OSError:
            return False
        return self._looking.send(ipc.WatchTopics())

    def _looked(self, event: ipc.Event) -> None:
        match event:
            case ipc.TopicMessage():
                self._serve(event)
                self._graph.message(event, wanted=self._server.graph_wanted)
                self.layout.message(event)
            case ipc.Topic():
                self._serve(event)
                self._graph.topic(event)
                self.layout.topic(event)
            case ipc.Trouble(text):
                self._tell(text)
                self._serve(Notice(None, text, warning=True))
            case _:
                self._do(Told(LOOKING, event))

    def _hear(self, viewer: int) -> None:
        joined = self._trusted.get(viewer)  # what came before may have ended it
        events: list[StationEvent] = joined.poll(0.0).events if joined else []
        for event in events:
            if isinstance(event, StationEnded | ipc.Bye):
                self._drop(viewer)
                self._do(Ended(viewer))
                return
            self._do(Told(viewer, event))

    # ---------------------------------------------------------------------------- the viewers

    def _viewers_said(self, events: Iterable[Event]) -> None:
        for event in events:
            if isinstance(event, Refused):
                self._refuse(event.why)
            else:
                self._serve(event)

    def _refuse(self, why: str) -> None:
        if why not in self._refused and len(self._refused) < MAX_REFUSED:
            self._refused.add(why)
            self._tell(why)
            self._serve(Notice(None, why, warning=True))

    def _serve(self, given: ServerInput) -> None:
        for effect in self._server.handle(given):
            if isinstance(effect, Frame):
                self._viewers_said(self._connections.send(effect))
            else:
                self._do(effect)

    def _do(self, given: Input) -> None:
        for effect in self._viewers.handle(given, time.monotonic_ns()):
            self._perform(effect)

    def _perform(self, effect: Effect) -> None:
        match effect:
            case Join(viewer):
                with contextlib.suppress(OSError):
                    self._trusted[viewer] = self._join(viewer)
            case Send(viewer, command):
                self._send(viewer, command)
            case Close(viewer):
                self._drop(viewer)
            case Reply() | Notice() | Values():
                self._serve(effect)

    def _send(self, viewer: int, command: ipc.Command) -> None:
        if viewer == LOOKING:
            self._looking.send(command)  # if it has ended, the next poll says so
            return
        joined = self._trusted.get(viewer)
        if joined is None or not joined.send(command):
            self._drop(viewer)
            self._do(Ended(viewer))

    def _drop(self, viewer: int) -> None:
        joined = self._trusted.pop(viewer, None)
        if joined is not None:
            joined.close_at_once()


def _give_way() -> None:
    """To the flight, on a machine that has too little of everything; where there is such a thing.

    With no memory left this process ends, and not another one.
    """
    if sys.platform != "win32":
        import resource

        os.nice(NICE)
        _, most = resource.getrlimit(resource.RLIMIT_DATA)
        if most == resource.RLIM_INFINITY or most > MAX_MEMORY_BYTES:
            resource.setrlimit(resource.RLIMIT_DATA, (MAX_MEMORY_BYTES, most))


def open_view(
    described: Description, address: Address, tell: Callable[[str], None] | None = None
) -> LiveView:
    """Join the station and listen.  Raises ExitError."""
    try:
        return LiveView(described, address, tell)
    except PortTakenError as error:
        raise ExitError(ExitCode.ADDRESS_IN_USE, str(error), TAKEN_HINT) from error
    except OSError as error:
        raise ExitError(ExitCode.USAGE, f"no live view: {error}", ADDRESS_HINT) from error
