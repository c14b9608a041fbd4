"""A dialogue with a station: send requests, follow each to its outcome, leave in good order.

Typed lines, the one-shot commands and the demo all work through this; what they print is decided
by the `on_event` that they pass in.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.gate.states import State
from gcs.operator.client import Polling, Readable, StationEnded
from gcs.operator.conversation import Conversation, TrackedRequest
from gcs.operator.errors import ExitError, Interrupted

LEAVE_WAIT_S = 20.0
START_WAIT_S = 60.0
"""A busy machine takes seconds to start a process, and a name server to answer."""
SETTLE_WAIT_S = 3.0
POLL_S = 0.5


class InterruptSource(Readable, Protocol):
    """Where a Ctrl-C is noted; `Interrupts` is one."""

    name: str

    def forget(self) -> None: ...


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


class Dialogue(Conversation):
    """One operator's talk with one station, over a connection that is polled.

    Whatever waits raises `Interrupted` on a Ctrl-C, and `ExitError` if the station ends although
    nobody has asked it to.
    """

    def __init__(
        self, connection: Polling, interrupts: InterruptSource, on_event: EventHandler
    ) -> None:
        super().__init__()
        self._connection = connection
        self._interrupts = interrupts
        self._on_event = on_event
        self._leaving = False
        self._watched: tuple[Readable, Callable[[], None]] | None = None
        self._sent: list[TrackedRequest] = []

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
            tracked = self.told(event)
            if not isinstance(event, StationEnded):
                self._on_event(event, tracked)
        if self.ended is not None and not self._leaving:
            raise self.unexpected_end()
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
        self.wait_until(lambda: self.position_known, timeout_s)
        seen = self._heard(timeout_s)
        self.wait_until(self._settled, settle_s)
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

    def _settled(self) -> bool:
        """Nothing more is to come of what the gate judges by."""
        return self.can_be_judged and not (self.snapshot and self.snapshot.listening)

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
        tracked = self.ask(request, label)
        self._sent.append(tracked)
        self._connection.send(tracked.sent)
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

    def look_before_flight(self) -> ipc.PreflightReport:
        """What the station knows now of everything that matters before a take-off."""
        asked, before = self.preflight(), self.trouble
        self._connection.send(asked)
        self.wait_until(
            lambda: self.preflight_answer(asked.id) is not None or self.trouble is not before,
            START_WAIT_S,
        )
        report = self.preflight_answer(asked.id)
        if report is None and self.trouble is not before:
            hint = "it may be of an older version: gcs stations end, or use that version"
            raise ExitError(ExitCode.NOT_COMPLETED, "the running station tells no preflight", hint)
        if report is None:
            raise ExitError(ExitCode.BUG, f"the station said nothing for {START_WAIT_S:g} s")
        return report

    def take_control(self) -> TrackedRequest | None:
        """Take control of a vehicle that flies without us; None if there is no need."""
        assert self.snapshot is not None
        if self.snapshot.state != State.EXTERNAL.name:
            return None
        return self.wait_settled(self.send(ipc.Ask(0, "control")))

    def first_failure(self) -> ExitCode:
        """The exit code of the first request that was not completed, DONE if all were."""
        codes = (tracked.exit_code for tracked in self._sent)
        return next((code for code in codes if code), ExitCode.DONE)

    # ------------------------------------------------------------------------- leaving

    def leave(self, reason: str = "quit", *, hold: bool = False) -> StationEnded:
        """Say good-bye and wait: the station holds the vehicle first, of a one-shot with `hold`.

        A second Ctrl-C ends the waiting.
        """
        self._leaving = True
        self.unwatch()
        self._interrupts.forget()
        if self.ended is None:
            self._connection.send(ipc.Leave(reason, hold))
        self.wait_until(lambda: self.ended is not None or bool(self._interrupts.name), LEAVE_WAIT_S)
        return self._connection.close()
