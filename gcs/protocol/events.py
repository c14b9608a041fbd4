"""The receiving side of the events protocol: each event once and in order, lost ones asked again.

A vehicle numbers its EVENTs, says the latest number in CURRENT_EVENT_SEQUENCE, sends again what
REQUEST_EVENT asks for, and answers RESPONSE_EVENT_ERROR for what it has not kept
(https://mavlink.io/en/services/events.html; fields and flags by common.xml).  Numbers are 16 bits
and wrap.  Nothing is asked for that was told before the first number was heard.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, TypeAlias, assert_never

from gcs.protocol.effects import Address, Heard, Send, Wake
from gcs.wire.messages import CurrentEventSequence, Event, RequestEvent, ResponseEventError

ASK_AGAIN_NS: Final = 250_000_000
TRIES: Final = 8
"""Requests in a row that bring nothing, before what is missing is taken as lost."""
MOST_ASKED: Final = 64
"""Of a larger gap only the latest are asked for.  PX4 1.14 kept 20 (scenarios_px4.json, L2)."""
RESET: Final = 1
"""MAV_EVENT_CURRENT_SEQUENCE_FLAGS_RESET: the vehicle counts anew."""
_RING: Final = 1 << 16


@dataclass(frozen=True, slots=True)
class EventHeard:
    """The next event."""

    event: Event


@dataclass(frozen=True, slots=True)
class EventsLost:
    """So many events will never be heard."""

    count: int


EventEffect: TypeAlias = Send | EventHeard | EventsLost


class EventReceiver:
    """The events of one component."""

    def __init__(self, own: Address, target: Address, wait_ns: int = ASK_AGAIN_NS) -> None:
        self._own = own
        self._target = target
        self._wait_ns = wait_ns
        self._told: int | None = None
        """The number of the last event that was told or given up."""
        self._newest = 0
        """The highest number that is known to exist."""
        self._early: dict[int, Event] = {}
        """Events that wait for those before them."""
        self._gone: set[int] = set()
        self._behind = False
        self._tries = 0
        self._missing_then = 0
        self.deadline_ns: int | None = None

    def handle(self, event: Heard | Wake, now_ns: int) -> list[EventEffect]:
        match event:
            case Heard(sysid, compid, message):
                if not self._target.includes(sysid, compid):
                    return []
                match message:
                    case Event():
                        self._event(message)
                    case CurrentEventSequence(sequence, flags):
                        self._current(sequence, flags)
                    case ResponseEventError():
                        self._error(message)
                    case _:
                        return []
                effects = self._tell()
                if not self._missing():
                    self.deadline_ns = None
                elif self.deadline_ns is None:
                    self._tries = 0
                    effects += self._ask(now_ns)
                return effects
            case Wake():
                if self.deadline_ns is None or now_ns < self.deadline_ns:
                    return []
                return self._ask_again(now_ns)
            case _:
                assert_never(event)

    # ------------------------------------------------------------------------ what is heard

    def _event(self, event: Event) -> None:
        if self._told is None:
            self._begin((event.sequence - 1) % _RING)
        if self._ahead(event.sequence) > 0:
            self._early[event.sequence] = event
            self._exists(event.sequence)

    def _current(self, sequence: int, flags: int) -> None:
        if self._told is None:
            self._begin(sequence)
        elif self._ahead(sequence) >= 0:
            self._behind = False
            self._exists(sequence)
        elif self._behind or flags & RESET:
            self._begin(sequence)
        else:
            self._behind = True  # it may be late; twice in a row, the vehicle has started anew

    def _error(self, error: ResponseEventError) -> None:
        to = Address(error.target_system, error.target_component)
        if not to.includes(self._own.sysid, self._own.compid):
            return
        oldest = self._ahead(error.sequence_oldest_available)
        for number in self._missing():
            if number == error.sequence or self._ahead(number) < oldest:
                self._gone.add(number)

    # ------------------------------------------------------------------------------- inside

    def _begin(self, sequence: int) -> None:
        self._told = self._newest = sequence
        self._early.clear()
        self._gone.clear()
        self._behind = False

    def _ahead(self, sequence: int) -> int:
        """How far behind the last one that was told it comes; negative: it was before that."""
        assert self._told is not None
        return (sequence - self._told + _RING // 2) % _RING - _RING // 2

    def _exists(self, sequence: int) -> None:
        if self._ahead(sequence) > self._ahead(self._newest):
            self._newest = sequence

    def _tell(self) -> list[EventEffect]:
        """All whose turn it is; what is too far back is given up."""
        if self._told is None:
            return []
        effects, lost = self._give_up(self._ahead(self._newest) - MOST_ASKED)
        while self._told != self._newest:
            number = (self._told + 1) % _RING
            event = self._early.pop(number, None)
            if event is not None:
                effects.append(EventHeard(event))
            elif number in self._gone:
                self._gone.remove(number)
                lost += 1
            else:
                break
            self._told = number
        return [EventsLost(lost), *effects] if lost else effects

    def _give_up(self, count: int) -> tuple[list[EventEffect], int]:
        """Pass over the next `count`: those of them that have come, and how many have not."""
        if self._told is None or count <= 0:
            return [], 0
        passed = sorted(
            (number for number in self._early if self._ahead(number) <= count), key=self._ahead
        )
        told: list[EventEffect] = [EventHeard(self._early.pop(number)) for number in passed]
        self._gone = {number for number in self._gone if self._ahead(number) > count}
        self._told = (self._told + count) % _RING
        return told, count - len(told)

    def _missing(self) -> list[int]:
        if self._told is None:
            return []
        numbers = ((self._told + turn) % _RING for turn in range(1, self._ahead(self._newest) + 1))
        return [each for each in numbers if each not in self._early and each not in self._gone]

    def _ask_again(self, now_ns: int) -> list[EventEffect]:
        missing = self._missing()
        if len(missing) < self._missing_then:
            self._tries = 0
        if self._tries < TRIES:
            return self._ask(now_ns)
        self._gone.update(missing)
        self.deadline_ns = None
        return self._tell()

    def _ask(self, now_ns: int) -> list[EventEffect]:
        self._missing_then = len(self._missing())
        self._tries += 1
        self.deadline_ns = now_ns + self._wait_ns
        return [
            Send(RequestEvent(first, last, self._target.sysid, self._target.compid))
            for first, last in self._gaps()
        ]

    def _gaps(self) -> Iterator[tuple[int, int]]:
        """First and last number of each run of missing ones."""
        first = last = -1
        for number in self._missing():
            if first >= 0 and number == (last + 1) % _RING:
                last = number
                continue
            if first >= 0:
                yield first, last
            first = last = number
        if first >= 0:
            yield first, last
