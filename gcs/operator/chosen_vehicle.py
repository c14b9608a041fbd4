"""One vehicle of several, for a program that knows a single one: the same words for every face.

What is asked is asked of the chosen vehicle, and the station tells of that one (`ipc.Show`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import msgspec

from gcs import ipc
from gcs.operator.client import Listened, Polled, Polling, Readable, StationEnded, StationEvent


class Chosen:
    """The choice; 0: none, so that the station takes its first vehicle, or asks for a name."""

    def __init__(self, connection: Listened | Polling, sysid: int = 0) -> None:
        self._connection = connection
        self.sysid = 0
        if sysid:
            self.choose(sysid)

    def choose(self, sysid: int) -> None:
        """From now on that one is meant, heard or not."""
        if sysid != self.sysid:
            self.sysid = sysid
            self._connection.send(ipc.Show(sysid))

    def send(self, command: ipc.Command) -> bool:
        """An abort of an operation names its vehicle by that."""
        return self._connection.send(self._named(command) if self.sysid else command)

    def close(self) -> StationEnded:
        return self._connection.close()

    def _named(self, command: ipc.Command) -> ipc.Command:
        if isinstance(command, ipc.Check):
            return ipc.Check(msgspec.structs.replace(command.asked, vehicle=self.sysid))
        if not isinstance(command, ipc.Ask | ipc.Stream | ipc.Preflight):
            return command
        if command.vehicle:
            return command  # it names its own, or every one
        return msgspec.structs.replace(command, vehicle=self.sysid)

    def _told(self, events: Iterable[StationEvent]) -> list[StationEvent]:
        """Without snapshots of the vehicle before, which were under way when it was chosen."""
        return [
            each
            for each in events
            if not (self.sysid and isinstance(each, ipc.Snapshot) and each.vehicle)
            or each.sysid == self.sysid
        ]


class ChosenVehicle(Chosen):
    """For a program that waits for events."""

    _connection: Polling

    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> Polled:
        polled = self._connection.poll(timeout_s, also)
        return Polled(self._told(polled.events), polled.ready)

    def now_s(self) -> float:
        return self._connection.now_s()


class ListenedVehicle(Chosen):
    """For a program that is called for every event."""

    _connection: Listened

    def listen(self, on_event: Callable[[StationEvent], None]) -> None:
        def heard(event: StationEvent) -> None:
            for each in self._told([event]):
                on_event(each)

        self._connection.listen(heard)
