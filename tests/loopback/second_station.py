"""A station of ours as the client of a bridge of ours, on the same virtual clock."""

from __future__ import annotations

from gcs import ipc
from gcs.config import StationConfig
from gcs.gate.policy.parse import DEFAULT
from gcs.session import effects, inputs
from gcs.session.setup import Setup
from gcs.station.session import Session
from gcs.station.signatures import NO_KEYS
from tests.loopback.plan_clients import PlanFlight

CONFIG = StationConfig(endpoints=["bridge"], name="second station")


class SecondStation:
    """`say` a request, and `flight.until(lambda: station.ending)`; `files` is what it can read."""

    def __init__(self, flight: PlanFlight, files: dict[str, bytes]) -> None:
        self._flight = flight
        self._files = files
        self._link = flight.join(255, 190).link
        self.ending = ""
        """`complete`, or the code of what ended the request, and the sentence."""
        setup = Setup(CONFIG, "test", DEFAULT, "", ("a simulated link",), "")
        self._session = Session(setup, flight.now_ns, NO_KEYS)
        flight.clients[self._link] = self  # type: ignore[assignment]  # hears what it is sent
        flight.uploads.append(self)  # type: ignore[arg-type]  # and is woken

    def say(self, word: str, path: str = "") -> None:
        """One request of its operator."""
        self.ending = ""
        self._feed(inputs.OperatorLine(1, ipc.Ask(1, word, path=path)))

    def hear(self, data: bytes) -> None:
        """From the bridge."""
        self._feed(inputs.Datagram(0, data))

    @property
    def deadline_ns(self) -> int:
        return self._session.deadline_ns

    def look(self, now_ns: int) -> None:
        """The time has come, perhaps."""
        if now_ns >= self._session.deadline_ns:
            self._feed(inputs.Wake())

    def _feed(self, given: inputs.Input) -> None:
        for effect in self._session.handle(given, self._flight.now_ns):
            match effect:
                case effects.Transmit(_, data):
                    self._flight.to_bridge[self._link].send(data, self._flight.now_ns)
                case effects.ReadFile(token, path):
                    self._feed(inputs.FileRead(token, path, self._files.get(path), ""))
                case effects.Emit(ipc.VerdictEvent() as event) if event.outcome != "accepted":
                    self.ending = f"{event.code}: {event.sentence}"
                case effects.Emit(ipc.EndingEvent() as event):
                    told = f"{event.code}: {event.sentence}"
                    self.ending = event.ended if event.ended == "complete" else told
                case _:
                    pass
