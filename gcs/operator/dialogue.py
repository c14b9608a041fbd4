"""A dialogue with a station: send requests, follow each to its outcome, leave in good order.

Typed lines, the one-shot commands and the demo all work through this; what they print is decided
by the `on_event` that they pass in.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import msgspec

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.gate.refusal import Code
from gcs.gate.states import LandedState, State
from gcs.operator import request_words
from gcs.operator.client import Polled, Readable, StationEnded
from gcs.operator.errors import ExitError, Interrupted
from gcs.operator.station_loss import after_station_died, record_hint

LEAVE_WAIT_S = 20.0
START_WAIT_S = 60.0
"""A busy machine takes seconds to start a process, and a name server to answer."""
SETTLE_WAIT_S = 3.0
POLL_S = 0.5
UNKNOWN_LANDED = ("", LandedState.UNDEFINED.name)


class Connection(Protocol):
    """What a dialogue needs of the way to a station; `StationClient` is one."""

    def send(self, command: ipc.Command) -> bool: ...
    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> Polled: ...
    def now_s(self) -> float: ...
    def close(self) -> StationEnded: ...


class InterruptSource(Readable, Protocol):
    """Where a Ctrl-C is noted; `Interrupts` is one."""

    name: str

    def forget(self) -> None: ...


@dataclass(slots=True)
class TrackedRequest:
    """One request that was sent, and what the station has answered so far."""

    sent: ipc.Ask
    label: str
    verdict: ipc.VerdictEvent | None = None
    outcome: ipc.EndingEvent | None = None

    @property
    def settled(self) -> bool:
        """Nothing more will be answered: it was refused or superseded, or its outcome is known."""
        if self.outcome is not None:
            return True
        return self.verdict is not None and self.verdict.outcome != "accepted"

    @property
    def completed(self) -> bool:
        return self.outcome is not None and self.outcome.ended == "complete"

    @property
    def exit_code(self) -> ExitCode:
        """What a one-shot command exits with because of it."""
        if self.completed:
            return ExitCode.DONE
        if self.verdict is None or self.outcome is not None or not self.settled:
            vehicle_refused = self.outcome is not None and self.outcome.code == Code.VEHICLE_REFUSED
            return ExitCode.REFUSED_BY_VEHICLE if vehicle_refused else ExitCode.NOT_COMPLETED
        return _EXIT_CODE_OF_REFUSAL.get(self.verdict.code, ExitCode.REFUSED_BY_GATE)


_EXIT_CODE_OF_REFUSAL: dict[str, ExitCode] = {
    Code.NO_VEHICLE: ExitCode.NO_VEHICLE,
    Code.VEHICLE_REFUSED: ExitCode.REFUSED_BY_VEHICLE,
    Code.NO_ANSWER: ExitCode.NOT_COMPLETED,
    Code.BAD_MISSION: ExitCode.BAD_FILE,
    Code.RECORDER_DOWN: ExitCode.RECORDER,
    Code.SEVERAL_VEHICLES: ExitCode.USAGE,
    "BAD_REQUEST": ExitCode.USAGE,  # the session's code for what is no request at all
}

EventHandler = Callable[[ipc.Event, TrackedRequest | None], None]
"""Is given every event, and the request that it answers if it is of this dialogue."""


class Hints(NamedTuple):
    """What a person can do who hears no vehicle, in the options of the command that was given."""

    start: str
    choose: str


OPERATOR_HINTS = Hints(
    "start one with `vehicle-sim`, use `gcs fly --sim`, or name the link with --link",
    "choose one with --vehicle",
)


class Dialogue:
    """One operator's talk with one station.

    Whatever waits raises `Interrupted` on a Ctrl-C, and `ExitError` if the station ends although
    nobody has asked it to.
    """

    def __init__(
        self, connection: Connection, interrupts: InterruptSource, on_event: EventHandler
    ) -> None:
        self._connection = connection
        self._interrupts = interrupts
        self._on_event = on_event
        self._leaving = False
        self._watched: tuple[Readable, Callable[[], None]] | None = None
        self._requests: dict[int, TrackedRequest] = {}
        self.hello: ipc.Hello | None = None
        self.snapshot: ipc.Snapshot | None = None
        self.bridge: ipc.BridgeStatus | None = None
        self.trouble: ipc.Trouble | None = None
        self.ended: StationEnded | None = None

    # ------------------------------------------------------------------------- waiting

    def watch(self, source: Readable, on_ready: Callable[[], None]) -> None:
        """Call `on_ready` whenever `source` is readable, whatever is being waited for.

        Until `unwatch`, or until this operator leaves.  What it raises ends the waiting.
        """
        self._watched = (source, on_ready)

    def unwatch(self) -> None:
        self._watched = None

    def wait_until(self, done: Callable[[], bool], timeout_s: float | None = None) -> None:
        """Read events until `done()`, or the time is over."""
        start_s = self._connection.now_s()
        while not done():
            left_s = POLL_S
            if timeout_s is not None:
                left_s = min(left_s, timeout_s - (self._connection.now_s() - start_s))
                if left_s <= 0:
                    return
            self.poll(left_s)

    def poll(self, timeout_s: float) -> None:
        """Read what events there are, waiting at most `timeout_s`."""
        sources: list[Readable] = [self._interrupts]
        if self._watched is not None:
            sources.append(self._watched[0])
        polled = self._connection.poll(timeout_s, sources)
        for event in polled.events:
            if isinstance(event, StationEnded):
                self.ended = event
            else:
                self._handle(event)
        if self.ended is not None and not self._leaving:
            raise unexpected_end(self.ended, self.trouble, self.snapshot)
        if self._interrupts.name and not self._leaving:
            raise Interrupted(self._interrupts.name)
        if self._watched is not None and self._watched[0] in polled.ready:
            self._watched[1]()

    def wait_for_vehicle(self, timeout_s: float, settle_s: float = SETTLE_WAIT_S) -> ipc.Snapshot:
        """Wait for a vehicle with a position, then for `settle_s` for its home and landed state.

        The time counts from the station's first word: until then it opens its links, or fails to.
        Raises ExitError with NO_VEHICLE if none is heard.  A vehicle that was heard but is not
        complete in time is returned as it is: the gate knows best what it can still do.
        """
        self._wait_for_hello()
        self.wait_until(self._position_known, timeout_s)
        seen = self._heard(timeout_s)
        self.wait_until(self._can_be_judged, settle_s)
        return self.snapshot or seen

    def wait_until_heard(self, timeout_s: float, hints: Hints = OPERATOR_HINTS) -> ipc.Snapshot:
        """Wait for the first word of a vehicle, for what may be asked of one without a position.

        Raises ExitError with NO_VEHICLE if none is heard.
        """
        self._wait_for_hello()
        self.wait_until(
            lambda: self.snapshot is not None and bool(self.snapshot.vehicle), timeout_s
        )
        return self._heard(timeout_s, hints)

    def _wait_for_hello(self) -> None:
        """Raises ExitError: what keeps the station from starting, or that it does not start."""
        self.wait_until(lambda: self.hello is not None, START_WAIT_S)
        if self.hello is None:
            raise ExitError(ExitCode.BUG, f"the link process said nothing for {START_WAIT_S:g} s")

    def _heard(self, timeout_s: float, hints: Hints = OPERATOR_HINTS) -> ipc.Snapshot:
        if self.snapshot is None or not self.snapshot.vehicle:
            where = ", ".join(self.hello.endpoints) if self.hello else "the link"
            if self.snapshot is not None and self.snapshot.vehicles:
                raise ExitError(
                    ExitCode.NO_VEHICLE,
                    f"that vehicle was not heard within {timeout_s:g} s ({where})",
                    f"heard: {', '.join(self.snapshot.vehicles)}; {hints.choose}",
                )
            raise ExitError(
                ExitCode.NO_VEHICLE,
                f"no vehicle heard within {timeout_s:g} s ({where})",
                hints.start,
            )
        return self.snapshot

    # ------------------------------------------------------------------------ requests

    def send(self, request: ipc.Ask, label: str = "") -> TrackedRequest:
        """Send one request, whose id is given here; its answers are noted in what is returned."""
        number = len(self._requests) + 1
        numbered = msgspec.structs.replace(request, id=number)
        tracked = TrackedRequest(numbered, label or request_words.label(request))
        self._requests[number] = tracked
        self._connection.send(numbered)
        return tracked

    def wait_settled(
        self, tracked: TrackedRequest, timeout_s: float | None = None
    ) -> TrackedRequest:
        """Wait until `tracked` is refused or superseded, or its outcome is known."""
        self.wait_until(lambda: tracked.settled, timeout_s)
        return tracked

    def send_in_turn(
        self,
        requests: Sequence[ipc.Ask],
        label: str = "",
        go_on: Callable[[], bool] = lambda: True,
    ) -> list[TrackedRequest]:
        """Send one after the other, each when the one before is complete, while `go_on()`.

        `label` is of all together; two requests are told apart by labels of their own.
        """
        done: list[TrackedRequest] = []
        for request in requests:
            tracked = self.send(request, label if len(requests) == 1 else "")
            done.append(self.wait_settled(tracked))
            if not (tracked.completed and go_on()):
                break
        return done

    def take_control(self) -> TrackedRequest | None:
        """Take control of a vehicle that flies without us; None if there is no need."""
        assert self.snapshot is not None
        if self.snapshot.state == State.EXTERNAL.name:
            return self.wait_settled(self.send(ipc.Ask(0, "control")))
        if self.snapshot.state == State.HOLDING.name:
            return self.wait_settled(self.send(ipc.Ask(0, "resume")))
        return None

    def first_failure(self) -> ExitCode:
        """The exit code of the first request that was not completed, DONE if all were."""
        codes = (tracked.exit_code for tracked in self._requests.values())
        return next((code for code in codes if code), ExitCode.DONE)

    # ------------------------------------------------------------------------- leaving

    def leave(self, reason: str = "quit") -> StationEnded:
        """Say good-bye and wait: the station holds the vehicle first.

        A second Ctrl-C ends the waiting.
        """
        self._leaving = True
        self.unwatch()
        self._interrupts.forget()
        if self.ended is None:
            self._connection.send(ipc.Leave(reason))
        self.wait_until(lambda: self.ended is not None or bool(self._interrupts.name), LEAVE_WAIT_S)
        return self._connection.close()

    # ------------------------------------------------------------------------ internals

    def _handle(self, event: ipc.Event) -> None:
        tracked: TrackedRequest | None = None
        match event:
            case ipc.Hello():
                self.hello = event
            case ipc.Snapshot():
                self.snapshot = event
            case ipc.BridgeStatus():
                self.bridge = event
            case ipc.VerdictEvent():
                tracked = self._requests.get(event.id)
                if tracked is not None:
                    tracked.verdict = event
            case ipc.EndingEvent():
                tracked = self._requests.get(event.id)
                if tracked is not None:
                    tracked.outcome = event
            case ipc.ProgressEvent():
                tracked = self._requests.get(event.id)
            case ipc.Trouble():
                self.trouble = event
            case _:
                pass
        self._on_event(event, tracked)

    def _position_known(self) -> bool:
        seen = self.snapshot
        return seen is not None and bool(seen.vehicle) and seen.pos_enu is not None

    def _can_be_judged(self) -> bool:
        """Before that a vehicle on the ground and one in the air look alike to the gate."""
        seen = self.snapshot
        if seen is None or seen.home_enu is None or seen.listening:
            return False
        return seen.landed not in UNKNOWN_LANDED and seen.state != State.STALE.name


def unexpected_end(
    ended: StationEnded, trouble: ipc.Trouble | None, seen: ipc.Snapshot | None = None
) -> ExitError:
    """Why the station ended although nobody asked it to, and what its vehicle does now.

    `trouble` and `seen` are the last that it told; who is sent no snapshots passes none.
    """
    if trouble is not None and trouble.exit_code:
        return ExitError(trouble.exit_code, trouble.text, trouble.hint)
    if ended.bye is not None:
        return ExitError(ended.bye.exit_code or ExitCode.BUG, ended.bye.sentence)
    if ended.exit_code is None:
        return ExitError(ExitCode.NOT_COMPLETED, "the connection to the station was lost")
    code, tail = ended.exit_code, ended.stderr_tail
    words = f"its last words:\n{tail}" if tail else "it left no word"
    return ExitError(
        ExitCode.BUG,
        f"the link process died (exit code {code}); {after_station_died(seen)}",
        "\n".join(filter(None, (record_hint(seen.log_path if seen else ""), words))),
    )


def exit_code_of(ended: StationEnded) -> int:
    """What the station's good-bye says the exit code is; BUG if there was no good-bye."""
    return ExitCode.BUG if ended.bye is None else ended.bye.exit_code
