"""The Python library: a station as an object; its requests are in `requests/`.

`connect.py` starts a station process or joins one that runs; a thread reads its events.  A method
that asks for something returns when it is complete, or raises `Refused` or `NotCompleted`.  With
`wait=False` it returns as soon as the request is accepted, and the `Operation` that it returns can
be waited for or stopped.  Every method may be called from any thread: an `abort` in one ends the
`goto` that another waits for.

Places are metres east, north and up of the vehicle's local origin, headings degrees clockwise from
north, times seconds.
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from types import TracebackType

import msgspec

from gcs import ipc
from gcs.frames import Vec3
from gcs.operator import arguments, preflight
from gcs.operator.chosen_vehicle import ListenedVehicle
from gcs.operator.client import Listened, StationEnded, StationEvent
from gcs.operator.conversation import Conversation
from gcs.operator.failures import Disconnected, NotCompleted, NotHeard, Refused
from gcs.operator.operation import Operation
from gcs.operator.requests.flights import Flights, goto_of
from gcs.operator.requests.missions import Missions
from gcs.operator.requests.parameters import Parameters
from gcs.operator.stream import Stream

TELEMETRY_WAIT_S = 5.0
ANSWER_WAIT_S = 10.0
SETTLE_WAIT_S = 3.0
LOOK_S = 0.5
"""Between two looks at what may still come."""
KEPT_EVENTS = 10_000
"""Of an `events()` that is not read; the oldest are forgotten."""


@arguments.all_called_right
class Station(Flights, Missions, Parameters):
    """A connected station.  Made by `connect`; a `with` block leaves it at its end.

    Leaving a station of one's own ends it: a vehicle that it flies is held first.  A station that
    was joined goes on; if this program was in control of it, the vehicle is held.
    """

    def __init__(self, connection: Listened, vehicle: int = 0) -> None:
        """`vehicle`: the system id of the one of several that is flown; 0: none is chosen."""
        self._connection = ListenedVehicle(connection, vehicle)
        self._changed = threading.Condition()
        self.talk = Conversation()
        """What the station has told so far."""
        self._subscribed: dict[str, None] = {}
        self._messages: dict[str, Mapping[str, object]] = {}
        self._unknown_messages = ""
        self._readers: list[deque[ipc.Event]] = []
        self._left = False
        self._connection.listen(self._heard)

    def __enter__(self) -> Station:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Leave; a second time does nothing."""
        if self._left:
            return
        self._left = True
        self._connection.send(ipc.Leave("the program ends"))
        self._connection.close()

    def choose(self, vehicle: int, timeout_s: float = ANSWER_WAIT_S) -> None:
        """Of several vehicles: from now on fly and look at the one with this MAVLink system id.

        Also where it is not heard, so that nothing that follows is for another one: then it raises
        NotHeard.  What was asked of the vehicle before goes on.  Raises BadArgument, Disconnected.
        """
        sysid = arguments.sysid("choose", vehicle=vehicle)
        wait_s = arguments.positive("choose", timeout_s=timeout_s)
        with self._changed:
            self.talk.snapshot = None
            self._messages.clear()
            self._connection.choose(sysid)
        self.wait_until(lambda: self._shown == sysid, wait_s)
        if self._shown != sysid:
            raise NotHeard(f"vehicle {sysid} was not heard within {wait_s:g} s", wait_s)
        self.wait_until(lambda: self.talk.can_be_judged, SETTLE_WAIT_S)

    @property
    def _shown(self) -> int:
        return 0 if self.talk.snapshot is None else self.talk.snapshot.sysid

    # --------------------------------------------------------------------------- streams

    def stream(self) -> Stream:
        """A setpoint stream: velocities or positions, one after the other, in a `with` block.

        with station.stream() as stream:
            for seconds in stream.ticks(10.0):
                stream.velocity(1.0, 0.1 * seconds, 0.0)
        """
        return Stream(self)

    def velocity(
        self,
        east_m_s: float,
        north_m_s: float,
        up_m_s: float,
        yaw_rate_deg_s: float | None = None,
        *,
        seconds: float,
    ) -> None:
        """Fly this fast for so many seconds, more than 0, then hover.

        Raises Refused where that is refused, at once or on the way, such as before the fence: the
        vehicle hovers there then.  Raises NotCompleted, Disconnected.
        """
        for_s = arguments.positive("velocity", seconds=seconds)
        v_enu = arguments.numbers("velocity", east_m_s=east_m_s, north_m_s=north_m_s, up_m_s=up_m_s)
        rate = arguments.optional("velocity", yaw_rate_deg_s=yaw_rate_deg_s)
        with self.stream() as stream:
            for _ in stream.ticks(for_s):
                stream.send(ipc.Stream(v_enu=v_enu, yaw_rate_deg_s=rate))
                if stream.refusal is not None:
                    break
            refusal = stream.refusal
            stream.check()
        if refusal is not None:
            raise Refused(refusal.code, refusal.sentence, refusal.numbers)

    # --------------------------------------------------------------------------- reports

    @property
    def snapshot(self) -> ipc.Snapshot:
        """The latest of everything that a screen shows; ten times a second.

        Raises Disconnected.
        """
        self.wait_until(lambda: self.talk.snapshot is not None, ANSWER_WAIT_S)
        if self.talk.snapshot is None:
            raise NotHeard("the station tells nothing", ANSWER_WAIT_S)
        return self.talk.snapshot

    @property
    def state(self) -> str:
        """The gate's state: GROUNDED, HOVERING, MOVING, ... (`gcs.gate.states.State`)."""
        return self.snapshot.state

    @property
    def position_enu(self) -> Vec3 | None:
        """Metres east, north, up; None while it is not known."""
        return self.snapshot.pos_enu

    @property
    def armed(self) -> bool | None:
        """Whether the motors run, as the vehicle reports; None while it is not known."""
        return self.snapshot.armed

    @property
    def log_path(self) -> str:
        """The record of this flight."""
        return self.snapshot.log_path

    @property
    def in_control(self) -> bool:
        """Whether this program is the operator in control of the station."""
        hello, operators = self.talk.hello, self.talk.operators
        if hello is None:
            return False
        return hello.client == (1 if operators is None else operators.in_control)

    def telemetry(self, message: str, timeout_s: float = TELEMETRY_WAIT_S) -> Mapping[str, object]:
        """The latest fields of a MAVLink message of the vehicle, such as "BATTERY_STATUS".

        The first call for a message subscribes to it and waits until it is heard.  Raises
        BadArgument for a name that no message has; NotHeard if it is not heard in time.
        """
        arguments.text("telemetry", message=message)
        wait_s = arguments.seconds("telemetry", timeout_s=timeout_s)
        with self._changed:
            if message not in self._messages:
                self._unknown_messages = ""
                self._subscribed[message] = None
                self._connection.send(ipc.Subscribe([*self._subscribed]))
        self.wait_until(lambda: message in self._messages or bool(self._unknown_messages), wait_s)
        with self._changed:
            if message in self._messages:
                return self._messages[message]
            if self._unknown_messages:
                del self._subscribed[message]
                wanted = "the name of a MAVLink message"
                raise arguments.bad("telemetry", "message", wanted, message)
        raise NotHeard(f"no {message} was heard within {wait_s:g} s", wait_s)

    def events(self) -> Iterator[ipc.Event]:
        """Everything that the station tells from now on (`gcs.ipc`), until it ends or is left."""
        reader: deque[ipc.Event] = deque(maxlen=KEPT_EVENTS)
        with self._changed:
            self._readers.append(reader)
        return self._read(reader)

    # ------------------------------------------------------------------------- internals

    def _read(self, reader: deque[ipc.Event]) -> Iterator[ipc.Event]:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: reader or self.talk.ended is not None or self._left)
                if not reader:
                    return
                event = reader.popleft()
            yield event

    def request(self, ask: ipc.Ask, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Any request (`gcs.ipc.Ask`): until it is complete, or with `wait=False` accepted."""
        timeout_s = arguments.seconds(ask.word, timeout_s=timeout_s)
        deadline_s = None if timeout_s is None else time.monotonic() + timeout_s
        with self._changed:
            tracked = self.talk.ask(ask)
        if not self._connection.send(tracked.sent):
            raise self._end()
        self.wait_until(lambda: tracked.verdict is not None, timeout_s)
        verdict = tracked.verdict
        if verdict is None:
            text = f"{tracked.label}: no verdict after {timeout_s:g} s"
            raise NotCompleted("running", "", text, {"timeout_s": timeout_s})
        if verdict.outcome == "refused":
            raise Refused(verdict.code, verdict.sentence, verdict.numbers)
        if verdict.outcome != "accepted":
            raise NotCompleted(verdict.outcome, verdict.code, verdict.sentence, verdict.numbers)
        operation = Operation(self, tracked)
        if not wait:
            return operation
        left_s = None if deadline_s is None else max(0.0, deadline_s - time.monotonic())
        return operation.wait(left_s)

    def check(self, request: ipc.Ask, timeout_s: float = ANSWER_WAIT_S) -> ipc.Checked:
        """What the gate would say to a request now; nothing is done.  Raises Disconnected."""
        with self._changed:
            sent = self.talk.check(request)
        self.tell(sent)
        number_sent = sent.asked.id
        self.wait_until(lambda: self._checked(number_sent) is not None, timeout_s)
        answer = self._checked(number_sent)
        if answer is None:
            raise NotHeard("the station tells nothing", ANSWER_WAIT_S)
        return answer

    def check_goto(
        self, east_m: float, north_m: float, up_m: float, yaw_deg: float | None = None
    ) -> ipc.Checked:
        """The verdict that this `goto` would get now; nothing is done.

        `outcome` is accepted, refused or waits, with `code`, `sentence` and `numbers`.  The goal is
        also judged by itself, as from where the vehicle will hover: `goal_code` is empty where it
        clears, also while the vehicle stands on the ground or flies elsewhere.
        """
        return self.check(goto_of("check_goto", east_m, north_m, up_m, yaw_deg))

    def preflight(self, timeout_s: float = ANSWER_WAIT_S) -> ipc.PreflightReport:
        """Everything that matters before a take-off, row by row; `fails` says whether any does.

        What the station has not read of the vehicle is read first, and what comes slowly is waited
        for, up to `timeout_s`.  Raises Disconnected.
        """
        deadline_s = time.monotonic() + timeout_s
        report = self._preflight()
        while preflight.waiting(report) and time.monotonic() < deadline_s:
            self.wait_until(lambda: False, LOOK_S)
            report = self._preflight()
        for alternatives in preflight.to_read(report):
            for ask in alternatives:
                with contextlib.suppress(Refused, NotCompleted):
                    self.request(ask, True, timeout_s)
                    break
        return self._preflight()

    def _preflight(self) -> ipc.PreflightReport:
        with self._changed:
            asked = self.talk.preflight()
        self.tell(asked)
        self.wait_until(lambda: self.talk.preflight_answer(asked.id) is not None, ANSWER_WAIT_S)
        report = self.talk.preflight_answer(asked.id)
        if report is None:
            raise NotHeard("the station tells nothing", ANSWER_WAIT_S)
        return report

    def _checked(self, number_sent: int) -> ipc.Checked | None:
        answer = self.talk.checked
        return answer if answer is not None and answer.id == number_sent else None

    def tell(self, command: ipc.Command) -> None:
        """Send what has no answer of its own.  Raises Disconnected."""
        if not self._connection.send(command):
            raise self._end()

    def wait_until(self, done: Callable[[], bool], timeout_s: float | None) -> None:
        """Until `done()`, or the time is over.  Raises Disconnected."""
        with self._changed:
            self._changed.wait_for(lambda: done() or self.talk.ended is not None, timeout_s)
            if not done() and self.talk.ended is not None:
                raise self._end()

    def _end(self) -> Disconnected:
        if self._left:
            return Disconnected("this program has left the station")
        if self.talk.ended is None:
            return Disconnected("the connection to the station was lost")
        return Disconnected(str(self.talk.unexpected_end()))

    def _heard(self, event: StationEvent) -> None:
        """In the reader's thread."""
        with self._changed:
            self.talk.told(event)
            if not isinstance(event, StationEnded):
                self._note(event)
                for reader in self._readers:
                    reader.append(event)
            self._changed.notify_all()

    def _note(self, event: ipc.Event) -> None:
        match event:
            case ipc.StateEvent() if self.talk.snapshot is not None:
                # What a request that has just ended led to is known before the next snapshot.
                self.talk.snapshot = msgspec.structs.replace(
                    self.talk.snapshot,
                    state=event.after,
                    control=event.control,
                    severity=event.severity,
                )
            case ipc.MessageEvent():
                self._messages[event.name] = event.fields
            case ipc.Trouble() if event.text.startswith("no such MAVLink message"):
                self._unknown_messages = event.text
            case _:
                pass
