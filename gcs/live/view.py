"""A live view of a station that runs: an operator's program that serves viewers.

A process of its own.  What viewers send is parsed and kept here, at a lower priority than the
flight's, so that whatever it costs, the station goes on; to the station this is a program like any
other one on its local socket, which loses its connection when it does not read.
"""

from __future__ import annotations

import contextlib
import os
import secrets
import sys
import time
from dataclasses import dataclass
from typing import Protocol

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.live.effects import Close, Effect, Join, Notice, Reply, Send
from gcs.live.inbox import Inbox, Item
from gcs.live.inputs import Ended, Input, Tick, Told
from gcs.live.server import LiveServer, PortTakenError
from gcs.live.viewers import LOOKING, Viewers
from gcs.operator.client import Readable, StationEnded, StationEvent
from gcs.operator.errors import ExitError
from gcs.operator.joined import JoinedStation
from gcs.shell.stations import Description

TICK_S = 0.25
REJOIN_WAIT_S = 1.0
CODE_LETTERS = "abcdefghjkmnpqrstuvwxyz23456789"
"""Without those that are taken for one another."""
CODE_LENGTH = 8
NICE = 10
MAX_MEMORY_BYTES = 1 << 30
TAKEN_HINT = "another live view may be open; name a free port, as in 127.0.0.1:9000"
ADDRESS_HINT = "is the address one of this machine's, and does the station still run?"


class Interrupt(Protocol):
    """Set by a Ctrl-C, and then readable."""

    name: str

    def fileno(self) -> int: ...


@dataclass(frozen=True, slots=True)
class Address:
    """`port` 0: the first of the usual ones that is free."""

    host: str = "127.0.0.1"
    port: int = 0


def new_code() -> str:
    """31 letters, 8 times: 40 bits, which nobody tries out at five calls a second."""
    letters = [secrets.choice(CODE_LETTERS) for _ in range(CODE_LENGTH)]
    return "".join(letters)


class LiveView:
    """Serves viewers until the station ends."""

    def __init__(self, described: Description, address: Address) -> None:
        """Listens at once.  Raises PortTakenError; OSError if the station takes no connection."""
        self._described = described
        self._inbox = Inbox()
        self._server = LiveServer(self._inbox)
        self.code = new_code()
        self._viewers = Viewers(self.code, time.monotonic_ns())
        self._trusted: dict[int, JoinedStation] = {}
        self._looking = self._join(LOOKING)
        try:
            self.url = self._server.start(address.host, address.port)
        except (OSError, PortTakenError):
            self._looking.close_at_once()
            self._inbox.close()
            raise

    def run(self, interrupt: Interrupt | None = None) -> StationEnded | None:
        """Until the station ends; None if it was interrupted before."""
        _give_way()
        self._looking.send(ipc.WatchTopics())
        due_s = time.monotonic() + TICK_S
        while interrupt is None or not interrupt.name:
            also: list[Readable] = [self._inbox, *self._trusted.values()]
            if interrupt is not None:
                also.append(interrupt)
            polled = self._looking.poll(max(0.0, due_s - time.monotonic()), also)
            for event in polled.events:
                if isinstance(event, StationEnded):
                    if not self._rejoined(event):
                        return event
                else:
                    self._looked(event)
            if self._inbox in polled.ready:
                self._take()
            for viewer in [n for n, each in self._trusted.items() if each in polled.ready]:
                self._hear(viewer)
            if time.monotonic() >= due_s:
                due_s = time.monotonic() + TICK_S
                self._server.repeat()
                self._do(Tick())
        return None

    def close(self) -> None:
        """The viewers' connections end, and those to the station."""
        for joined in [self._looking, *self._trusted.values()]:
            joined.close_at_once()
        self._server.stop()
        self._inbox.close()

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
                self._server.message(event)
            case ipc.Topic():
                self._server.topic(event)
            case ipc.Trouble(text):
                self._server.notice(text, warning=True)
            case _:
                self._do(Told(LOOKING, event))

    def _hear(self, viewer: int) -> None:
        events: list[StationEvent] = self._trusted[viewer].poll(0.0).events
        for event in events:
            if isinstance(event, StationEnded | ipc.Bye):
                self._drop(viewer)
                self._do(Ended(viewer))
                return
            self._do(Told(viewer, event))

    # ---------------------------------------------------------------------------- the viewers

    def _take(self) -> None:
        items: list[Item] = self._inbox.take()
        for item in items:
            self._do(item)

    def _do(self, given: Input) -> None:
        effects = self._viewers.handle(given, self._server.parameters, time.monotonic_ns())
        for effect in effects:
            self._perform(effect)
        self._server.trust(self._viewers.trusted)

    def _perform(self, effect: Effect) -> None:
        match effect:
            case Join(viewer):
                with contextlib.suppress(OSError):
                    self._trusted[viewer] = self._join(viewer)
            case Send(viewer, command):
                self._send(viewer, command)
            case Close(viewer):
                self._drop(viewer)
            case Reply(call, answer):
                self._inbox.answer(call, answer)
            case Notice(text, warning):
                self._server.notice(text, warning=warning)

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

    The server's library takes 16 MiB of any number of viewers: with no memory left this process
    ends, and not another one.
    """
    if sys.platform != "win32":
        import resource

        os.nice(NICE)
        _, most = resource.getrlimit(resource.RLIMIT_DATA)
        if most == resource.RLIM_INFINITY or most > MAX_MEMORY_BYTES:
            resource.setrlimit(resource.RLIMIT_DATA, (MAX_MEMORY_BYTES, most))


def open_view(described: Description, address: Address) -> LiveView:
    """Join the station and listen.  Raises ExitError."""
    try:
        return LiveView(described, address)
    except PortTakenError as error:
        raise ExitError(ExitCode.ADDRESS_IN_USE, str(error), TAKEN_HINT) from error
    except OSError as error:
        raise ExitError(ExitCode.USAGE, f"no live view: {error}", ADDRESS_HINT) from error
