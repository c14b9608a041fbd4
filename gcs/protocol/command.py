r"""The command protocol, asking side (https://mavlink.io/en/services/command.html).

    queued --send--> WAITING --final ack------------------> ended with its result
                       | ^ \--no ack, tries left: again--/
                       | +---------------- no ack, no try left or past the deadline --> no answer
                       +--IN_PROGRESS--> WORKING --final ack--> ended; silence --> no answer

Invariants: every `Submit` has exactly one `Finished`; at most one command of an id is in flight
to a target, as an ack says which command it answers but not which try; no try leaves after its
deadline.  What the vehicle then does is telemetry's to tell: an ack only ends a command.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from enum import Enum, auto
from typing import TypeAlias, assert_never

import msgspec

from gcs.protocol.effects import (
    Address,
    CommandEffect,
    Finished,
    Heard,
    InProgress,
    LateAck,
    Send,
    Submit,
    Wake,
    Withdraw,
)
from gcs.wire.ids import Result
from gcs.wire.messages import CommandAck, CommandInt, CommandLong

ACK_WAIT_NS = 500_000_000
"""How long one try waits for its ack; MAVSDK's figure."""
WORK_WAIT_NS = 10_000_000_000
"""How long a command that is in progress may say nothing more."""
PERCENT_UNKNOWN = 255
MOST_COUNTED = 255
"""`confirmation` is one byte."""

Input: TypeAlias = Submit | Withdraw | Heard | Wake
_Key: TypeAlias = tuple[int, int, int]
"""Command id, target system, target component."""


class _Phase(Enum):
    WAITING = auto()
    WORKING = auto()


class _Event(Enum):
    ENDED = auto()  # an ack with a final result
    PROGRESS = auto()  # an ack IN_PROGRESS
    SILENCE = auto()  # the wait is over, a try may leave
    GIVEN_UP = auto()  # the wait is over, no try may leave


class _Act(Enum):
    FINISH = auto()
    REPORT = auto()
    REPEAT = auto()
    GIVE_UP = auto()


_TABLE: dict[tuple[_Phase, _Event], tuple[_Act, _Phase]] = {
    (_Phase.WAITING, _Event.ENDED): (_Act.FINISH, _Phase.WAITING),
    (_Phase.WAITING, _Event.PROGRESS): (_Act.REPORT, _Phase.WORKING),
    (_Phase.WAITING, _Event.SILENCE): (_Act.REPEAT, _Phase.WAITING),
    (_Phase.WAITING, _Event.GIVEN_UP): (_Act.GIVE_UP, _Phase.WAITING),
    (_Phase.WORKING, _Event.ENDED): (_Act.FINISH, _Phase.WORKING),
    (_Phase.WORKING, _Event.PROGRESS): (_Act.REPORT, _Phase.WORKING),
    (_Phase.WORKING, _Event.SILENCE): (_Act.GIVE_UP, _Phase.WORKING),
    (_Phase.WORKING, _Event.GIVEN_UP): (_Act.GIVE_UP, _Phase.WORKING),
}


@dataclass(slots=True)
class _Flight:
    """A command on its way."""

    submit: Submit
    wait_until_ns: int
    sent: int = 0
    phase: _Phase = _Phase.WAITING


@dataclass(frozen=True, slots=True)
class _Ended:
    token: int
    result: int | None


class CommandClient:
    """All commands of one ground station on one link, to whatever targets."""

    def __init__(
        self, own: Address, ack_wait_ns: int = ACK_WAIT_NS, work_wait_ns: int = WORK_WAIT_NS
    ) -> None:
        """`own` is who we are: an ack that names somebody else is not ours."""
        self._own = own
        self._ack_wait_ns = ack_wait_ns
        self._work_wait_ns = work_wait_ns
        self._flights: dict[_Key, _Flight] = {}
        self._queues: dict[_Key, deque[Submit]] = {}
        self._ended: dict[_Key, _Ended] = {}

    @property
    def deadline_ns(self) -> int | None:
        """When the next wait is over."""
        return min((flight.wait_until_ns for flight in self._flights.values()), default=None)

    @property
    def busy(self) -> bool:
        """Whether any command has not ended."""
        return bool(self._flights)

    def handle(self, event: Input, now_ns: int) -> list[CommandEffect]:
        match event:
            case Submit():
                return self._submit(event, now_ns)
            case Withdraw(token):
                return self._withdraw(token, now_ns)
            case Heard():
                if isinstance(event.message, CommandAck):
                    return self._answered(event, event.message, now_ns)
                return []
            case Wake():
                return self._wake(now_ns)
            case _:
                assert_never(event)

    def _submit(self, submit: Submit, now_ns: int) -> list[CommandEffect]:
        key = _key(submit.command)
        flight = self._flights.get(key)
        if flight is None:
            return self._launch(key, submit, now_ns)
        if not submit.urgent:
            self._queues.setdefault(key, deque()).append(submit)
            return []
        dropped = [flight.submit, *self._queues.pop(key, ())]
        gone: list[CommandEffect] = [
            Finished(old.token, key[0], None, "gave way to an urgent one") for old in dropped
        ]
        return gone + self._launch(key, submit, now_ns)

    def _withdraw(self, token: int, now_ns: int) -> list[CommandEffect]:
        """In flight: its ack, should it come, is a late one.  In the queue: it never leaves."""
        for key, flight in self._flights.items():
            if flight.submit.token == token:
                return self._finish(key, None, "withdrawn", now_ns)
        for key, queue in self._queues.items():
            for submit in queue:
                if submit.token == token:
                    queue.remove(submit)
                    return [Finished(token, key[0], None, "withdrawn")]
        return []

    def _launch(self, key: _Key, submit: Submit, now_ns: int) -> list[CommandEffect]:
        """First try, or the end of one that waited in the queue for too long."""
        if now_ns > submit.deadline_ns:
            self._ended[key] = _Ended(submit.token, None)
            self._flights.pop(key, None)
            late = Finished(submit.token, key[0], None, "its time was over before it could be sent")
            return [late, *self._next(key, now_ns)]
        flight = _Flight(submit, now_ns)
        self._flights[key] = flight
        return [_try(flight, now_ns, self._ack_wait_ns)]

    def _next(self, key: _Key, now_ns: int) -> list[CommandEffect]:
        queue = self._queues.get(key)
        if not queue:
            return []
        submit = queue.popleft()
        if not queue:
            del self._queues[key]
        return self._launch(key, submit, now_ns)

    def _answered(self, heard: Heard, ack: CommandAck, now_ns: int) -> list[CommandEffect]:
        if not Address(ack.target_system, ack.target_component).includes(
            self._own.sysid, self._own.compid
        ):
            return []
        keys = self._flights.keys() | self._ended.keys()
        asked = [
            key
            for key in keys
            if key[0] == ack.command and Address(key[1], key[2]).includes(heard.sysid, heard.compid)
        ]
        for key in sorted(asked, key=lambda key: key not in self._flights):
            if key not in self._flights:
                return self._late(key, ack)
            final = ack.result != Result.IN_PROGRESS
            return self._step(key, _Event.ENDED if final else _Event.PROGRESS, now_ns, ack)
        return []

    def _late(self, key: _Key, ack: CommandAck) -> list[CommandEffect]:
        ended = self._ended[key]
        if ack.result in (ended.result, Result.IN_PROGRESS):
            return []
        self._ended[key] = _Ended(ended.token, ack.result)
        return [LateAck(ended.token, key[0], ack.result, ended.result)]

    def _wake(self, now_ns: int) -> list[CommandEffect]:
        effects: list[CommandEffect] = []
        for key, flight in list(self._flights.items()):
            if now_ns < flight.wait_until_ns:
                continue
            submit = flight.submit
            tries_left = submit.tries is None or flight.sent < submit.tries
            may_try = tries_left and now_ns <= submit.deadline_ns
            event = _Event.SILENCE if may_try else _Event.GIVEN_UP
            effects += self._step(key, event, now_ns, None)
        return effects

    def _step(
        self, key: _Key, event: _Event, now_ns: int, ack: CommandAck | None
    ) -> list[CommandEffect]:
        flight = self._flights[key]
        act, flight.phase = _TABLE[flight.phase, event]
        match act:
            case _Act.FINISH:
                assert ack is not None
                return self._finish(key, ack.result, "", now_ns)
            case _Act.REPORT:
                assert ack is not None
                flight.wait_until_ns = now_ns + self._work_wait_ns
                percent = None if ack.progress == PERCENT_UNKNOWN else ack.progress
                return [InProgress(flight.submit.token, key[0], percent)]
            case _Act.REPEAT:
                return [_try(flight, now_ns, self._ack_wait_ns)]
            case _Act.GIVE_UP:
                return self._finish(key, None, _silence(flight), now_ns)
            case _:
                assert_never(act)

    def _finish(self, key: _Key, result: int | None, text: str, now_ns: int) -> list[CommandEffect]:
        token = self._flights.pop(key).submit.token
        self._ended[key] = _Ended(token, result)
        return [Finished(token, key[0], result, text), *self._next(key, now_ns)]


def _key(command: CommandLong | CommandInt) -> _Key:
    return (command.command, command.target_system, command.target_component)


def _silence(flight: _Flight) -> str:
    if flight.phase is _Phase.WORKING:
        return "it was in progress, then nothing more was said"
    return f"no answer to {flight.sent} " + ("try" if flight.sent == 1 else "tries")


def _try(flight: _Flight, now_ns: int, ack_wait_ns: int) -> Send:
    """The next try; `confirmation` counts them where the message has room for it.

    What is tried only once is waited for until its deadline: a slow answer is an answer.
    """
    command = flight.submit.command
    if flight.sent and isinstance(command, CommandLong):
        command = msgspec.structs.replace(command, confirmation=min(flight.sent, MOST_COUNTED))
    flight.sent += 1
    only_try = flight.submit.tries == 1
    flight.wait_until_ns = flight.submit.deadline_ns if only_try else now_ns + ack_wait_ns
    return Send(command)
