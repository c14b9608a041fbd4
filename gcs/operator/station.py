"""The Python library: a station as an object, with one method a request.

`connect.py` starts a station process or joins one that runs; a thread reads its events.  A method
that asks for something returns when it is complete, or raises `Refused` or `NotCompleted`.  With
`wait=False` it returns as soon as the request is accepted, and the `Operation` that it returns can
be waited for or stopped.  Every method may be called from any thread: an `abort` in one ends the
`goto` that another waits for.

Places are metres east, north and up of the vehicle's local origin, headings degrees clockwise from
north, times seconds.
"""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from types import TracebackType

import msgspec

from gcs import ipc
from gcs.frames import Vec3
from gcs.operator.client import Listened, StationEnded, StationEvent
from gcs.operator.conversation import Conversation, Found, TrackedRequest
from gcs.operator.failures import Disconnected, NotCompleted, Refused
from gcs.operator.stream import Stream, number

TELEMETRY_WAIT_S = 5.0
ANSWER_WAIT_S = 10.0
KEPT_EVENTS = 10_000
"""Of an `events()` that is not read; the oldest are forgotten."""


class Operation:
    """An accepted request, which may still be under way."""

    def __init__(self, station: Station, tracked: TrackedRequest) -> None:
        self._station = station
        self._tracked = tracked
        self.asked = tracked.sent

    @property
    def id(self) -> int:
        """The station's number of it, as `gcs operations` shows it."""
        return 0 if self._tracked.verdict is None else self._tracked.verdict.operation

    @property
    def state(self) -> str:
        """running, complete, aborted, superseded, timed out or taken over."""
        return "running" if self._tracked.outcome is None else self._tracked.outcome.ended

    @property
    def found(self) -> list[Found]:
        """What was read for it."""
        return self._tracked.found

    def wait(self, timeout_s: float | None = None) -> Operation:
        """Until it is complete.  Raises NotCompleted, Disconnected."""
        self._station.wait_until(lambda: self._tracked.settled, timeout_s)
        ending = self._tracked.outcome
        if ending is None:
            text = f"{self._tracked.label} is still under way after {timeout_s:g} s"
            raise NotCompleted("running", "", text)
        if ending.ended != "complete":
            raise NotCompleted(ending.ended, ending.code, ending.sentence)
        return self

    def stop(self) -> None:
        """Abort it, if it is still under way; if it is not, nothing else is stopped instead.

        Raises Refused with NOT_RUNNING, NotCompleted, Disconnected.
        """
        self._station.request(ipc.Ask(0, "abort", operation=self.id))

    def __repr__(self) -> str:
        return f"<Operation {self.id} {self._tracked.label}: {self.state}>"


class Station:
    """A connected station.  Made by `connect`; a `with` block leaves it at its end.

    Leaving a station of one's own ends it: a vehicle that it flies is held first.  A station that
    was joined goes on; if this program was in control of it, the vehicle is held.
    """

    def __init__(self, connection: Listened, *, tells_messages: bool = True) -> None:
        """`tells_messages`: those that it tells are of the vehicle that is flown."""
        self._connection = connection
        self._tells_messages = tells_messages
        self._changed = threading.Condition()
        self.talk = Conversation()
        """What the station has told so far."""
        self._subscribed: dict[str, None] = {}
        self._messages: dict[str, Mapping[str, object]] = {}
        self._unknown_messages = ""
        self._readers: list[deque[ipc.Event]] = []
        self._left = False
        connection.listen(self._heard)

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

    # --------------------------------------------------------------------------- requests

    def control(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Take control of a vehicle that flies without the station, and hover."""
        return self.request(ipc.Ask(0, "control"), wait, timeout_s)

    def arm(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        return self.request(ipc.Ask(0, "arm"), wait, timeout_s)

    def disarm(
        self, *, force: bool = False, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Stop the motors on the ground; `force` in the air too, where the policy allows it."""
        return self.request(ipc.Ask(0, "disarm", force=force), wait, timeout_s)

    def takeoff(
        self, up_m: float, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Climb to `up_m` metres above the take-off point and hover."""
        return self.request(ipc.Ask(0, "takeoff", up_m=number(up_m)), wait, timeout_s)

    def goto(
        self,
        east_m: float,
        north_m: float,
        up_m: float,
        yaw_deg: float | None = None,
        *,
        wait: bool = True,
        timeout_s: float | None = None,
    ) -> Operation:
        """Fly straight there and hover."""
        goal = (number(east_m), number(north_m), number(up_m))
        return self.request(ipc.Ask(0, "goto", goal_enu=goal, yaw_deg=yaw_deg), wait, timeout_s)

    def orbit(
        self,
        radius_m: float,
        speed_m_s: float,
        centre: tuple[float, float, float] | None = None,
        *,
        turns: float = 0.0,
        nose: str = "centre",
        wait: bool | None = None,
        timeout_s: float | None = None,
    ) -> Operation:
        """Fly to the circle and round it; a positive radius is clockwise, seen from above.

        `centre` is metres east, north, up; None is where the vehicle is.  `turns` 0 is until
        something else is asked for, and then it is waited for only if that is said.  `nose`:
        centre, initial, free, along.  Raises ValueError for numbers that are not finite.
        """
        if not all(map(math.isfinite, (radius_m, speed_m_s, turns, *(centre or ())))):
            raise ValueError("an orbit has finite numbers only")
        circle = ipc.Circle(centre, radius_m, speed_m_s, turns, nose)
        waits = turns > 0.0 if wait is None else wait
        return self.request(ipc.Ask(0, "orbit", orbit=circle), waits, timeout_s)

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
        """Fly this fast for so many seconds, then hover.

        Raises Refused where that is refused, at once or on the way, such as before the fence: the
        vehicle hovers there then.  Raises NotCompleted, Disconnected.
        """
        with self.stream() as stream:
            for _ in stream.ticks(seconds):
                stream.velocity(east_m_s, north_m_s, up_m_s, yaw_rate_deg_s=yaw_rate_deg_s)
                if stream.refusal is not None:
                    break
            refusal = stream.refusal
            stream.check()
        if refusal is not None:
            raise Refused(refusal.code, refusal.sentence, refusal.numbers)

    def fly(self, path: str, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Upload a mission file (or a shipped mission by its name), then start it."""
        self.upload(path)
        return self.start_mission(wait=wait, timeout_s=timeout_s)

    def upload(self, path: str, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Verify a mission file, send it to the vehicle and read it back."""
        return self.request(ipc.Ask(0, "mission_upload", path=path), wait, timeout_s)

    def download(
        self, path: str, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Read mission, fence and rally points on board, and where home is, into a file."""
        return self.request(ipc.Ask(0, "mission_download", path=path), wait, timeout_s)

    def clear_mission(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Remove the mission on board; its fence and rally points stay."""
        return self.request(ipc.Ask(0, "mission_clear"), wait, timeout_s)

    def put_fence(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Put the policy's own fence on board, so that the vehicle keeps it when the link is down.

        On the ground; else Refused with IN_AIR.
        """
        return self.request(ipc.Ask(0, "fence_put"), wait, timeout_s)

    def upload_fence(
        self, path: str, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Send the fence of a file to the vehicle, in place of the one on board."""
        return self.request(ipc.Ask(0, "fence_upload", path=path), wait, timeout_s)

    def download_fence(
        self, path: str, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Read the fence on board into a file."""
        return self.request(ipc.Ask(0, "fence_download", path=path), wait, timeout_s)

    def clear_fence(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Remove the fence on board.  On the ground; else Refused with IN_AIR."""
        return self.request(ipc.Ask(0, "fence_clear"), wait, timeout_s)

    def upload_rally(
        self, path: str, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Send the rally points of a file to the vehicle, in place of those on board."""
        return self.request(ipc.Ask(0, "rally_upload", path=path), wait, timeout_s)

    def download_rally(
        self, path: str, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Read the rally points on board into a file."""
        return self.request(ipc.Ask(0, "rally_download", path=path), wait, timeout_s)

    def clear_rally(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Remove the rally points on board."""
        return self.request(ipc.Ask(0, "rally_clear"), wait, timeout_s)

    def start_mission(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Fly the mission on board."""
        return self.request(ipc.Ask(0, "mission_start"), wait, timeout_s)

    def land(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Land where it is."""
        return self.request(ipc.Ask(0, "land"), wait, timeout_s)

    def rtl(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Return to home and land."""
        return self.request(ipc.Ask(0, "rtl"), wait, timeout_s)

    def hold(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Stop and hold, in the vehicle's own hold mode."""
        return self.request(ipc.Ask(0, "hold"), wait, timeout_s)

    def abort(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Stop now and forget the goal; whoever is in control, and whatever is waited for."""
        return self.request(ipc.Ask(0, "abort"), wait, timeout_s)

    def resume(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """After a hold: hover under the station's control."""
        return self.request(ipc.Ask(0, "resume"), wait, timeout_s)

    def photo(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        return self.request(ipc.Ask(0, "photo"), wait, timeout_s)

    def mode(
        self, mode_name: str, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Ask for a flight mode by the autopilot's own name."""
        return self.request(ipc.Ask(0, "mode", mode=mode_name), wait, timeout_s)

    def take_control(self) -> None:
        """Be the operator in control of this station, in place of whoever is; all are told."""
        self.request(ipc.Ask(0, "station_take"))

    # ------------------------------------------------------------------------ parameters

    def parameters(self, timeout_s: float | None = None) -> dict[str, int | float]:
        """All parameters of the vehicle, by name; whole numbers where their type is.

        Raises Refused, NotCompleted, Disconnected.
        """
        return self._parameters(ipc.Ask(0, "param_list"), timeout_s)

    def parameter(self, name: str, timeout_s: float | None = None) -> int | float:
        """One parameter.  Raises Refused with BAD_PARAMETER where the vehicle has none of that
        name, and says which are near."""
        return self._parameters(ipc.Ask(0, "param_get", name=name), timeout_s)[name]

    def set_parameter(
        self, name: str, value: float, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Set a parameter; complete once it is read back as asked.

        What safety stands on is set while the vehicle is disarmed on the ground only.
        """
        ask = ipc.Ask(0, "param_set", name=name, value=number(value))
        return self.request(ask, wait, timeout_s)

    def _parameters(self, ask: ipc.Ask, timeout_s: float | None) -> dict[str, int | float]:
        found = self.request(ask, True, timeout_s).found
        told = [each for each in found if isinstance(each, ipc.ParametersEvent)]
        return {
            each.name: math.nan if each.value is None else each.value
            for event in told
            for each in event.parameters
        }

    # --------------------------------------------------------------------------- reports

    @property
    def snapshot(self) -> ipc.Snapshot:
        """The latest of everything that a screen shows; ten times a second.

        Raises Disconnected.
        """
        self.wait_until(lambda: self.talk.snapshot is not None, ANSWER_WAIT_S)
        if self.talk.snapshot is None:
            raise Disconnected("the station tells nothing")
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
        ValueError for a name that no message has, and for a vehicle of a bridge that is not its
        first, of which no messages are told; TimeoutError if it is not heard in time.
        """
        if not self._tells_messages:
            raise ValueError("of several vehicles only the first one's messages are told")
        with self._changed:
            if message not in self._messages:
                self._unknown_messages = ""
                self._subscribed[message] = None
                self._connection.send(ipc.Subscribe([*self._subscribed]))
        self.wait_until(
            lambda: message in self._messages or bool(self._unknown_messages), timeout_s
        )
        with self._changed:
            if message in self._messages:
                return self._messages[message]
            if self._unknown_messages:
                del self._subscribed[message]
                raise ValueError(self._unknown_messages)
        raise TimeoutError(f"no {message} was heard within {timeout_s:g} s")

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
        """Send it; return once it is complete, or with `wait=False` accepted."""
        deadline_s = None if timeout_s is None else time.monotonic() + timeout_s
        with self._changed:
            tracked = self.talk.ask(ask)
        if not self._connection.send(tracked.sent):
            raise self._end()
        self.wait_until(lambda: tracked.verdict is not None, timeout_s)
        verdict = tracked.verdict
        if verdict is None:
            raise NotCompleted("running", "", f"{tracked.label}: no verdict after {timeout_s:g} s")
        if verdict.outcome == "refused":
            raise Refused(verdict.code, verdict.sentence, verdict.numbers)
        if verdict.outcome != "accepted":
            raise NotCompleted(verdict.outcome, verdict.code, verdict.sentence)
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
            raise Disconnected("the station tells nothing")
        return answer

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
