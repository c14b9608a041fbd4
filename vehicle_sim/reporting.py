"""Where `vehicle-sim` says things: plain lines, JSON lines for tests, or a live face.

One protocol; the command line chooses.
"""

from __future__ import annotations

import os
import select
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Protocol

import click

from vehicle_sim.shell.urls import Url, UrlKind
from vehicle_sim.simulation.traffic import Log

if TYPE_CHECKING:
    from vehicle_sim.live_page import LivePage, Rhythm, VehicleLine

REDRAW_NS: Final = 250_000_000
LEVELS: Final = {"debug": 0, "info": 1, "warning": 2, "error": 3, "fatal": 4}
_TOLD_ONE_BY_ONE: Final = 8
"""Beyond so many vehicles the start says ranges."""


@dataclass(frozen=True, slots=True)
class Contact:
    """One vehicle and its links, as they were opened."""

    system: int
    urls: tuple[Url, ...]


@dataclass(frozen=True, slots=True)
class Launch:
    """What was started."""

    what: str
    contacts: tuple[Contact, ...]


class Reporter(Protocol):
    """Where it is said."""

    redraw_ns: int
    """How often `show` is wanted; 0 = never."""

    def ready(self, launch: Launch) -> None: ...
    def log(self, line: Log) -> None: ...
    def show(self, statuses: Sequence[VehicleLine], rhythm: Rhythm) -> None: ...
    def answer(self, line: bytes) -> None: ...
    def close(self) -> None: ...


_CONNECT: Final = {
    UrlKind.UDP_OUT: "sends to {url.host}:{url.port}; connect with {url.other_end}",
    UrlKind.UDP_IN: "listens on UDP port {url.port}; connect with {url.other_end}",
    UrlKind.TCP_IN: "listens on TCP port {url.port}; connect with {url.other_end}",
    UrlKind.TCP_OUT: "connects to TCP port {url.port} of {url.host}; "
    "wait for it with {url.other_end}",
}


def announcement(launch: Launch) -> list[Log]:
    """What to connect to, and how; beyond a handful only the ends of a range."""
    contacts = launch.contacts
    everybody = f"vehicle{contacts[0].system}"
    if len(contacts) > 1:
        everybody = f"vehicles {contacts[0].system} to {contacts[-1].system}"
    shared = [url for url in contacts[0].urls if all(url in each.urls for each in contacts)]
    lines = [Log("info", everybody, launch.what)]
    shown = contacts if len(contacts) <= _TOLD_ONE_BY_ONE else (contacts[0], contacts[-1])
    for contact in shown:
        lines += [
            _how(f"vehicle{contact.system}", url) for url in contact.urls if url not in shared
        ]
    return lines + [_how(everybody, url) for url in shared]


def _how(who: str, url: Url) -> Log:
    return Log("info", who, _CONNECT[url.kind].format(url=url))


def spelled(line: Log) -> str:
    return f"{line.level.upper()} {line.node}: {line.text}"


def _print(line: str) -> None:
    """To whoever still reads."""
    try:
        click.echo(line)
        sys.stdout.flush()
    except OSError:
        # The reader is gone, or the disk is full; the vehicle flies on, as its failsafes have it.
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115


def _print_if_read(line: str) -> None:
    """Nobody waits for a reader who does not read: the line is lost, and the vehicle flies on."""
    try:
        room = bool(select.select([], [sys.stdout], [], 0.0)[1])
    except (OSError, ValueError):
        room = True  # no descriptor, or none that can be asked
    if room:
        _print(line)


class Plain:
    """A line for everything that happens."""

    redraw_ns = 0

    def __init__(self, threshold: str) -> None:
        self._threshold = LEVELS[threshold]

    def ready(self, launch: Launch) -> None:
        for line in announcement(launch):
            self.log(line)

    def log(self, line: Log) -> None:
        if LEVELS[line.level] >= self._threshold:
            _print_if_read(spelled(line))

    def show(self, statuses: Sequence[VehicleLine], rhythm: Rhythm) -> None:
        pass

    def answer(self, line: bytes) -> None:
        pass

    def close(self) -> None:
        pass


def _json(value: Mapping[str, object]) -> str:
    import json  # only under --control

    return json.dumps(value)


class Json(Plain):
    """The control line's other half: every line is one JSON object."""

    def ready(self, launch: Launch) -> None:
        vehicles = [
            {"system": contact.system, "urls": [str(url.other_end) for url in contact.urls]}
            for contact in launch.contacts
        ]
        _print(_json({"ready": vehicles}))

    def log(self, line: Log) -> None:
        if LEVELS[line.level] >= self._threshold:
            _print_if_read(_json({"log": spelled(line)}))

    def answer(self, line: bytes) -> None:
        _print(line.decode().rstrip())


def in_foreground() -> bool:
    """Whether the terminal of standard output is ours now: a program that was started with `&`, or
    put into the background later, shares it with whatever else writes there."""
    if sys.platform == "win32":
        return True
    try:
        return os.tcgetpgrp(sys.stdout.fileno()) == os.getpgrp()
    except (OSError, ValueError):
        return False


class Live(Plain):
    """One live line per vehicle, under the log; plain lines while in the background."""

    redraw_ns = REDRAW_NS

    def __init__(self, threshold: str) -> None:
        super().__init__(threshold)
        self._face: LivePage | None = None

    def log(self, line: Log) -> None:
        if self._face is None:
            super().log(line)
        elif LEVELS[line.level] >= self._threshold:
            self._face.say(spelled(line), LEVELS[line.level] >= LEVELS["warning"])

    def show(self, statuses: Sequence[VehicleLine], rhythm: Rhythm) -> None:
        if not in_foreground():
            self.close()
            return
        if self._face is None:
            from vehicle_sim.live_page import LivePage

            self._face = LivePage()
        self._face.show(statuses, rhythm)

    def close(self) -> None:
        if self._face is not None:
            self._face.close()
            self._face = None
