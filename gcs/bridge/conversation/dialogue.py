"""What one client has asked for and what it was answered: from a command to its COMMAND_ACK.

A command, or a mission item that is to be flown to at once, is acknowledged once: with a refusal's
reason; at the verdict where the gate alone decides (a go-to); else with what the vehicle itself
answered.  The same command again, sent because no answer came, is not asked a second time: it gets
IN_PROGRESS, but for what `Pending.answered_once` names, or the answer that it had.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import count
from typing import Final, TypeVar

import msgspec

from gcs import ipc, request_words
from gcs.bridge.conversation.answers import (
    acknowledgement,
    item_acknowledgement,
    orbit_status,
    result_of,
    texts,
)
from gcs.bridge.conversation.pending_requests import From, Pending, Told
from gcs.bridge.conversation.recent_texts import RecentTexts
from gcs.bridge.conversation.repeated_requests import GUIDED_ITEM, command_of, key_of
from gcs.bridge.effects import BridgeEffect, ClientRefused, ClientRequest, Reply
from gcs.gate.effects import Level
from gcs.gate.refusal import Code, Refusal
from gcs.wire.ids import Result
from gcs.wire.messages import Message

Over = TypeVar("Over", ipc.VerdictEvent, ipc.EndingEvent)

AGAIN_NS: Final = 2_000_000_000
"""The command that was accepted last, sent again within this time, is a repetition of it, not a new
one.  Anything else that was asked in between, by whomever, a refusal, or a stop is never answered
from memory, and neither is what has ended otherwise: the vehicle may be flown otherwise by now.
Nor is anything where a heartbeat has shown a change since: another mode, or that it is disarmed.  A
repetition is told by the time because COMMAND_INT and items have no `confirmation` to count it."""
STOPS: Final = request_words.STOPS | {"disarm"}
DECIDED_BY_GATE: Final = frozenset({"goto", "orbit", "stream_begin", "stream_end"})
"""Words that no command to the vehicle stands for: they are answered with the verdict."""
SEEN_SOON: Final = frozenset({"arm", "disarm", "control", "resume"})
"""Words that are answered when the vehicle shows it, within a second or two, because what a client
sends next (a take-off, a go-to) is refused before.  All else is answered as the vehicle answers."""


@dataclass(slots=True)
class Dialogue:
    """One client's requests of one vehicle.

    `client` is its number among the operators, `vehicle` a system id; `numbers` are those that its
    requests get, of which other dialogues of the same client take theirs.
    """

    client: int
    vehicle: int = 0
    numbers: Iterator[int] = field(default_factory=lambda: count(1))
    _next_text: int = 1
    _pending: dict[int, Pending] = field(default_factory=dict)
    _with: dict[int, list[int]] = field(default_factory=dict)
    """By the number of a request that is under way, those that end as it does: what was to arm
    first, too, and the same stop that was asked for before it."""
    _last_key: bytes = b""
    """The message that was asked for last."""
    _told: Told | None = None
    """Its answer, if it was accepted."""
    _shown: tuple[str, bool] | None = None
    """The mode of the last heartbeat, and whether it showed the vehicle armed."""
    _texts: RecentTexts = field(default_factory=RecentTexts)
    _refusals: RecentTexts = field(default_factory=RecentTexts)
    """Of messages that are not acknowledged."""
    _orbit_from: From | None = None
    """Who of this client has asked for the last orbit."""
    _streams_from: From | None = None
    """Who of this client sent the last sample of a stream."""

    # ----------------------------------------------------------------------------- asking

    def ask(
        self,
        asked_by: From,
        message: Message,
        asks: Sequence[ipc.Ask],
        now_ns: int,
        *,
        answered_by: str = "",
        note: str = "",
    ) -> list[BridgeEffect]:
        """Ask for `asks`, one after the other, because of a message; none: it is so already.

        `note` is told as soon as the first of them is accepted: of what is refused it is untrue.
        """
        key, command = key_of(message), command_of(message)
        done = self.text(asked_by, Level.INFO, note, now_ns) if note and not asks else []
        if not asks and not command:
            return done  # such as sticks in the middle, 25 a second: nothing came in between
        if asks and asks[0].word in STOPS:
            self._told = None
        stops = len(asks) == 1 and asks[0].word in STOPS
        between = stops and key != self._last_key  # it is a stop of its own
        repeated = None if between else self._repeated(asked_by, key, command, now_ns)
        if repeated is not None:
            return repeated
        self._last_key, self._told = key, None
        if not asks:
            return [*done, self._acknowledge(asked_by, command, Result.ACCEPTED)]
        if asks[0].word == "mission_check" and self._arming() is not None:
            asks = asks[1:]  # too late: the start of the mission verifies it, too
        pending = Pending(asked_by, command, key, tuple(asks[1:]), asks[0].word, asks[0].word)
        pending.answered_by, pending.note = answered_by, note
        if asks[-1].word == "orbit":
            self._orbit_from = self._streams_from = asked_by
        return self._ask_or_wait(pending, asks[0])

    def _ask_or_wait(self, pending: Pending, ask: ipc.Ask) -> list[BridgeEffect]:
        """Ask for `ask` now; an arming, after which something else is to be asked, waits for one
        that is under way."""
        arming = self._arming() if pending.rest and ask.word == "arm" else None
        if arming is None:
            return [ClientRequest(self.client, self._open(pending, ask))]
        number = self.number()
        self._pending[number] = pending
        self._with.setdefault(arming, []).append(number)
        return []

    def refuse(
        self, asked_by: From, message: Message | None, name: str, refusal: Refusal, now_ns: int
    ) -> list[BridgeEffect]:
        """What never reaches the gate: unsupported, denied by the table or by a guard.

        `name` is the message's or command's; a message that cannot be decoded is None.  Messages
        that are not acknowledged come in streams, as GPS_INPUT does: the same refusal is a decision
        once in some seconds.  The record has every refused frame.
        """
        key, command = key_of(message), command_of(message)
        text = f"{name}: {refusal.sentence}"
        if not command and not self._refusals.is_news(text, now_ns, key):
            return []
        repeated = self._repeated(asked_by, key, command, now_ns)
        if repeated is not None:
            return repeated
        pending = Pending(asked_by, command, key, (), name, "")
        return [ClientRefused(self.client, self._open(pending, ipc.Ask(0, name.lower())), refusal)]

    def forget(self) -> None:
        """Somebody else has asked for something: what was accepted may hold no more."""
        self._told = None

    def control_lost(self) -> None:
        """Another client, or nobody, is in control: what this one was told of its requests holds no
        more, though they may be flown on."""
        self._told = None
        for pending in self._pending.values():
            if pending.answered is not None:
                pending.key = b""

    def shown(self, mode_name: str, *, armed: bool) -> None:
        """A heartbeat of the vehicle: where it shows a change, what was accepted before may hold no
        more."""
        if self._shown != (mode_name, armed):
            self._shown, self._told = (mode_name, armed), None

    @property
    def arming(self) -> bool:
        """This client has asked for an arming that has not ended, or waits for a check first."""
        waiting = (ask.word for each in self._pending.values() for ask in each.rest)
        return self._arming() is not None or "arm" in waiting

    def _arming(self) -> int | None:
        """The arming that this client has asked for, and that has not ended."""
        arms = (number for number, each in self._pending.items() if each.word == "arm")
        return next(arms, None)

    def number(self) -> int:
        """The next number of a request of this client."""
        return next(self.numbers)

    def _open(self, pending: Pending, ask: ipc.Ask) -> ipc.Ask:
        number = self.number()
        self._pending[number] = pending
        return msgspec.structs.replace(ask, id=number, vehicle=self.vehicle)

    def _repeated(
        self, asked_by: From, key: bytes, command: int, now_ns: int
    ) -> list[BridgeEffect] | None:
        """The answer to a repetition; None where this is something new."""
        if not key:
            return None
        for pending in self._pending.values():
            if pending.key == key and pending.asked_by == asked_by:
                if pending.answered is None and pending.answered_once:
                    return []
                result = Result.IN_PROGRESS if pending.answered is None else pending.answered
                return [self._acknowledge(asked_by, command, result)]
        told = self._told
        if told is not None and told.key == key and told.until_ns > now_ns:
            return [self._acknowledge(asked_by, command, Result.ACCEPTED)]
        return None

    def stream(self, asked_by: From, sample: ipc.Stream) -> list[BridgeEffect]:
        """One sample of a setpoint stream; it has no answer of its own."""
        self._streams_from, self._told = asked_by, None
        self._orbit_replaced()
        return [ClientRequest(self.client, msgspec.structs.replace(sample, vehicle=self.vehicle))]

    # ---------------------------------------------------------------------------- answers

    def told(self, event: ipc.Event, now_ns: int) -> list[BridgeEffect]:
        """What the station tells this client as an operator, in MAVLink's words."""
        match event:
            case ipc.VerdictEvent() if event.outcome == "accepted":
                return self._verdict(event, now_ns)
            case ipc.VerdictEvent():
                return self._each_with(event, self._verdict, now_ns)
            case ipc.EndingEvent():
                return self._each_with(event, self._ending, now_ns)
            case ipc.StreamVerdictEvent():
                return self._stream_verdict(event, now_ns)
            case ipc.OrbitEvent():
                return self._orbit(event, now_ns)
            case _:
                return []

    def command_answered(self, operation: int, result: int, now_ns: int) -> list[BridgeEffect]:
        """The vehicle answered a command that the gate sent for a request of this client."""
        for number, pending in self._pending.items():
            if pending.operation == operation and operation:
                pending.vehicle_result = result
                if pending.rest:
                    return []  # the last of what was asked for answers the command
                if result == Result.ACCEPTED and pending.word not in SEEN_SOON:
                    both = [pending, *(self._pending[each] for each in self._with.get(number, ()))]
                    return [
                        done for each in both for done in self._answer(each, result, None, now_ns)
                    ]
        return []

    def _each_with(
        self,
        event: Over,
        told: Callable[[Over, int], list[BridgeEffect]],
        now_ns: int,
    ) -> list[BridgeEffect]:
        """What became of a request, and of those that end as it does."""
        effects = told(event, now_ns)
        for number in self._with.pop(event.id, ()):
            effects += told(msgspec.structs.replace(event, id=number), now_ns)
        return effects

    def _verdict(self, event: ipc.VerdictEvent, now_ns: int) -> list[BridgeEffect]:
        pending = self._pending.get(event.id)
        if pending is None:
            return []
        if event.outcome == "accepted":
            if pending.word == "orbit":
                self._orbit_replaced()
            pending.operation = event.operation
            note, pending.note = pending.note, ""
            said = self.text(pending.asked_by, Level.INFO, note, now_ns) if note else []
            if event.word in DECIDED_BY_GATE and not pending.rest:
                return [*said, *self._answer(pending, Result.ACCEPTED, None, now_ns)]
            return said
        del self._pending[event.id]
        code = _code(event.code)
        text = f"{pending.name}: {event.outcome} {event.code}: {event.sentence}"
        return [
            *self._answer(pending, result_of(code), code, now_ns),
            *self.text(pending.asked_by, Level.WARNING, text, now_ns, _plan_of(pending)),
        ]

    def _stream_verdict(self, event: ipc.StreamVerdictEvent, now_ns: int) -> list[BridgeEffect]:
        """Samples are refused from now on, or flown again.  Those that come while control is being
        taken are not flown yet, which the record has and a client need not read."""
        if self._streams_from is None or event.code == Code.CONTROL_PENDING:
            return []
        if event.outcome == "accepted":
            return self.text(self._streams_from, Level.INFO, "stream: flown", now_ns)
        text = f"stream: {event.outcome} {event.code}: {event.sentence}"
        return self.text(self._streams_from, Level.WARNING, text, now_ns)

    def _orbit_replaced(self) -> None:
        """Another one, or a stream of its own, is flown from now on: who asks for the one before
        again does not repeat it."""
        for pending in self._pending.values():
            if pending.word == "orbit" and pending.answered is not None:
                pending.key = b""

    def _orbit(self, event: ipc.OrbitEvent, now_ns: int) -> list[BridgeEffect]:
        """How its orbit is flown, as a PX4 in its Orbit mode tells it: QGroundControl draws it."""
        if self._orbit_from is None:
            return []
        to, status = self._orbit_from, orbit_status(event)
        return [] if status is None else [Reply(to.link, to.addressed, status)]

    def _ending(self, event: ipc.EndingEvent, now_ns: int) -> list[BridgeEffect]:
        pending = self._pending.pop(event.id, None)
        if pending is None:
            return []
        replaced = event.code in (Code.SUPERSEDED, Code.OPERATOR)
        if replaced and self._waits_for_same(event.id, pending):
            return []
        if event.ended == "complete":
            if pending.rest:
                ask, rest = pending.rest[0], pending.rest[1:]
                answered: list[BridgeEffect] = []
                if pending.word == pending.answered_by:
                    answered = self._answer(pending, Result.ACCEPTED, None, now_ns)
                following = replace(
                    pending, rest=rest, name=ask.word, word=ask.word, vehicle_result=None
                )
                return [*answered, *self._ask_or_wait(following, ask)]
            done = self._answer(pending, Result.ACCEPTED, None, now_ns)
            if pending.answered_by:
                text = f"{pending.name}: {event.ended}"
                done += self.text(pending.asked_by, Level.INFO, text, now_ns)
            return done
        if self._told is not None and self._told.key == pending.key:
            self._told = None
        code = _code(event.code)
        refused = pending.vehicle_result not in (None, Result.ACCEPTED)
        result = pending.vehicle_result if refused else result_of(code)
        assert result is not None
        text = f"{pending.name}: {event.ended} {event.code}: {event.sentence}"
        self._texts.is_news(gates_line(event), now_ns)  # it says the same
        return [
            *self._answer(pending, result, code, now_ns),
            *self.text(pending.asked_by, Level.WARNING, text, now_ns),
        ]

    def _waits_for_same(self, number: int, pending: Pending) -> bool:
        """A stop whose place the same stop of this client has taken is answered as that one is: it
        was not refused."""
        if pending.answered is not None or pending.word not in STOPS or not pending.key:
            return False
        for later, each in self._pending.items():
            same = each.key == pending.key and each.word == pending.word
            if same and later > number and each.answered is None:
                pending.key = b""  # from now on it follows, and nothing repeats or follows it
                self._pending[number] = pending
                self._with.setdefault(later, []).extend((number, *self._with.pop(number, ())))
                return True
        return False

    def _answer(
        self, pending: Pending, result: int, code: Code | None, now_ns: int
    ) -> list[BridgeEffect]:
        """COMMAND_ACK, once."""
        if pending.answered is not None or not pending.command:
            return []
        pending.answered = result
        if result == Result.ACCEPTED and pending.key == self._last_key:
            self._told = Told(pending.key, now_ns + AGAIN_NS)
        return [self._acknowledge(pending.asked_by, pending.command, result, code)]

    @staticmethod
    def _acknowledge(to: From, command: int, result: int, code: Code | None = None) -> Reply:
        if command == GUIDED_ITEM:
            return Reply(to.link, to.addressed, item_acknowledgement(result, to.source))
        return Reply(to.link, to.addressed, acknowledgement(command, result, to.source, code))

    def text(
        self, to: From, level: Level, text: str, now_ns: int, plan: bytes = b""
    ) -> list[BridgeEffect]:
        """STATUSTEXT for this client; the same words, of the same plan where it is about one, not
        more often than every few seconds."""
        if not self._texts.is_news(text, now_ns, plan):
            return []
        self._next_text = self._next_text % 0xFFFF + 1
        return [
            Reply(to.link, to.addressed, message) for message in texts(level, text, self._next_text)
        ]


def gates_line(event: ipc.EndingEvent) -> str:
    """What all clients are told of the ending of somebody's request (`StepContext.end`)."""
    return f"gate: {event.word}: {event.ended}: {event.sentence}"


def _plan_of(pending: Pending) -> bytes:
    """Which plan it is about; empty for all else."""
    return b"" if pending.command else pending.key


def _code(text: str) -> Code:
    """What is not among the gate's codes (BAD_REQUEST) cannot be flown."""
    return Code(text) if text in Code.__members__ else Code.UNSUPPORTED
