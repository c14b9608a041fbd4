"""A link for the keyboard station, in the same process: the test says when time goes on."""

from __future__ import annotations

from collections.abc import Callable

from gcs import ipc
from gcs.shell.client import Heard, LinkDown
from tests.unit.cli.fake_link import TICK_S, FakeLink


class StationLink:
    """Keeps what was sent; `fly` lets the fake vehicle fly on."""

    def __init__(self, link: FakeLink | None = None) -> None:
        self.link = link or FakeLink()
        self.sent: list[ipc.Command] = []
        self.time_s = 0.0
        self._tell: Callable[[Heard], None] = lambda _: None

    def listen(self, tell: Callable[[Heard], None]) -> None:
        self._tell = tell
        self.say(*self.link.hello(), *self.link.tick(0.0))

    def send(self, command: ipc.Command) -> bool:
        self.sent.append(ipc.decode_command(ipc.encode(command)))
        self.say(*self.link.handle(self.sent[-1], self.time_s))
        return True

    def close(self) -> LinkDown:
        return LinkDown(None, -9, "")

    def say(self, *heard: Heard) -> None:
        for one in heard:
            self._tell(one)

    def fly(self, seconds: float) -> None:
        for _ in range(round(seconds / TICK_S)):
            self.time_s += TICK_S
            self.say(*self.link.tick(self.time_s))

    def asks(self) -> list[str]:
        return [command.word for command in self.sent if isinstance(command, ipc.Ask)]
