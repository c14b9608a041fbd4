"""The whole station against one simulator, in one process, on a virtual clock.

An operator's program meets it as it meets any station (`gcs.operator.client.Polling`): what it
sends is fed into the session, and while it waits, time passes.  Nothing here reads a clock or a
file, so equal flights are equal byte for byte.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from hashlib import blake2b

from gcs import ipc
from gcs.campaign.simulators import Simulator
from gcs.operator.client import Polled, Readable, StationEnded, StationEvent
from gcs.record.writer import Recorder
from gcs.session import effects, inputs
from gcs.session.requests import FIRST
from gcs.station.session import Session

NO_FILE = "a campaign's flight reads the files alone that its words name"
NO_FOLDER = "a campaign's flight writes no files"


class VirtualStation:
    """One session, one simulator, one clock."""

    def __init__(
        self,
        session: Session,
        simulator: Simulator,
        recorder: Recorder,
        now_ns: int,
        files: Mapping[str, bytes],
        watch: Callable[[int], None],
    ) -> None:
        """`files` are all that the session can read, by the names that its operator uses; `watch`
        is called with the time after every step of the simulator."""
        self._session, self._simulator, self._recorder = session, simulator, recorder
        self._files, self._watch = files, watch
        self._events: list[StationEvent] = []
        self._bytes = blake2b(digest_size=8)
        self._finish: effects.Finish | None = None
        self.now_ns = now_ns

    @property
    def digest(self) -> str:
        """Of every byte that went over the link, both ways, with its time."""
        return self._bytes.hexdigest()

    # ---------------------------------------------------------------- an operator's way to it

    def send(self, command: ipc.Command) -> bool:
        self._feed(inputs.OperatorLine(FIRST, command))
        return self._finish is None

    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> Polled:
        """Time passes until there are events, for at most `timeout_s`."""
        until_ns = self.now_ns + round(timeout_s * 1e9)
        while not self._events and self._finish is None and self._step(until_ns):
            pass
        events, self._events = self._events, []
        if self._finish is not None:
            events.append(self.close())
        return Polled(events)

    def now_s(self) -> float:
        return self.now_ns / 1e9

    def close(self) -> StationEnded:
        finish = self._finish
        if finish is None:
            return StationEnded(None, None, "")
        return StationEnded(ipc.Bye(finish.exit_code, "", finish.sentence), finish.exit_code, "")

    # -------------------------------------------------------------------------------- time

    def _step(self, until_ns: int) -> bool:
        """To the next thing that happens, if it does by then."""
        session_ns, simulator_ns = self._session.deadline_ns, self._simulator.deadline_ns
        next_ns = max(self.now_ns, min(session_ns, simulator_ns))
        if next_ns > until_ns:
            self.now_ns = until_ns
            return False
        self.now_ns = next_ns
        if simulator_ns <= next_ns:
            self._simulate([])
            self._watch(next_ns)
        if session_ns <= next_ns:
            self._feed(inputs.Wake())
        return True

    def _simulate(self, datagrams: list[bytes]) -> None:
        """Let the simulator live up to now, and hear what it says."""
        for data in datagrams:
            self._note(b">", data)
        for data in self._simulator.handle(self.now_ns, datagrams):
            self._note(b"<", data)
            self._feed(inputs.Datagram(0, data))

    def _note(self, way: bytes, data: bytes) -> None:
        self._bytes.update(way + self.now_ns.to_bytes(8, "big") + data)

    def _feed(self, given: inputs.Input) -> None:
        """Hand the session an input, now; then what its effects lead back to.

        As in the station's loop, nothing is heard any more once the session has finished.
        """
        waiting, sent = deque([given]), list[bytes]()
        while waiting and self._finish is None:
            now_ns = self._recorder.input_ns(self.now_ns)
            for effect in self._session.handle(waiting.popleft(), now_ns):
                if type(effect) is effects.Record:
                    self._recorder.write(effect.item, now_ns)
                elif type(effect) is effects.Transmit:
                    sent.append(effect.data)
                else:
                    waiting.extend(self._performed(effect))
            if self.now_ns >= self._recorder.deadline_ns:
                self._recorder.tick(self.now_ns)
        if sent:
            self._simulate(sent)

    def _performed(self, effect: effects.Effect) -> Iterator[inputs.Input]:
        """Do it; what the session is to hear of it."""
        match effect:
            case effects.Emit(event, operator) if operator in (effects.EVERYONE, FIRST):
                self._events.append(event)
            case effects.ReadFile(token, path):
                data = self._files.get(path)
                yield inputs.FileRead(token, path, data, NO_FILE if data is None else "")
            case effects.WriteFile(token, path, _):
                yield inputs.FileWritten(token, path, NO_FOLDER)
            case effects.Finish():
                self._finish = effect
            case _:
                pass
