"""Runs a `SigningSetup` or a `LockSetup` over a link.  Nothing is recorded: a key is sent."""

from __future__ import annotations

import select
from typing import Protocol

from gcs.shell.clock import Clock
from gcs.shell.sockets import Link
from gcs.wire.frame import Frame, StreamSplitter, split

WAIT_S = 0.1
BURST = 256


class Setup(Protocol):
    """What is done to one vehicle, until it has its ending."""

    @property
    def ending(self) -> object | None: ...
    def handle(self, frame: Frame, now_ns: int) -> list[bytes]: ...
    def wake(self, now_ns: int) -> list[bytes]: ...


def run(setup: Setup, link: Link, clock: Clock) -> None:
    """Until it has its ending."""
    splitter = StreamSplitter()
    while setup.ending is None:
        link.poke(clock.now_ns())
        open_ones = [link] if link.fileno() >= 0 else []
        ready, _, _ = select.select(open_ones, [], [], WAIT_S)
        answers = setup.wake(clock.now_ns())
        for data in link.drain(BURST) if ready else ():
            items = splitter.feed(data) if link.stream else split(data)
            for item in items:
                if isinstance(item, Frame):
                    answers += setup.handle(item, clock.now_ns())
        for raw in answers:
            link.send(raw)
