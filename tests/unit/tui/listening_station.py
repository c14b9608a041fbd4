"""A station for the keyboard screen, in the same process: the test says when time goes on."""

from __future__ import annotations

from collections.abc import Callable

from gcs import ipc
from gcs.operator.client import StationEnded, StationEvent
from tests.unit.operator.fake_station import TICK_S, FakeStation


class ListeningStation:
    """Keeps what was sent; `fly` lets the fake vehicle fly on."""

    def __init__(self, station: FakeStation | None = None) -> None:
        self.station = station or FakeStation()
        self.sent: list[ipc.Command] = []
        self.looked: list[ipc.Command] = []
        """What only asks: verdicts before they are needed, and messages to be told."""
        self.time_s = 0.0
        self._on_event: Callable[[StationEvent], None] = lambda _: None

    def listen(self, on_event: Callable[[StationEvent], None]) -> None:
        self._on_event = on_event
        self.say(*self.station.hello(), *self.station.tick(0.0))

    def send(self, command: ipc.Command) -> bool:
        wire = ipc.decode_command(ipc.encode(command))
        looks = isinstance(wire, ipc.Check | ipc.Preflight | ipc.Subscribe | ipc.ListOperations)
        (self.looked if looks else self.sent).append(wire)
        self.say(*self.station.handle(wire, self.time_s))
        return True

    def close(self) -> StationEnded:
        return StationEnded(None, -9, "")

    def say(self, *events: StationEvent) -> None:
        for event in events:
            self._on_event(event)

    def fly(self, seconds: float) -> None:
        for _ in range(round(seconds / TICK_S)):
            self.time_s += TICK_S
            self.say(*self.station.tick(self.time_s))

    def checked_goals(self) -> list[ipc.Maybe3 | None]:
        """What the gate was asked about, and not asked for."""
        return [each.asked.goal_enu for each in self.looked if isinstance(each, ipc.Check)]

    def requests(self) -> list[str]:
        return [command.word for command in self.sent if isinstance(command, ipc.Ask)]
