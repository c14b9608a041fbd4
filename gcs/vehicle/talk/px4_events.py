"""PX4's events: heard in order, and handed to `vehicle_texts.py`, which makes texts of them.

An event that is not known here is told by its number, at debug level: its text, which PX4 says too,
is told like any other.
"""

from __future__ import annotations

from typing import Final, assert_never

from gcs.gate.effects import Level
from gcs.protocol.effects import Address, Heard, Send, Wake
from gcs.protocol.events import (
    ASK_AGAIN_NS,
    EventEffect,
    EventHeard,
    EventReceiver,
    EventsLost,
)
from gcs.protocol.px4_event_words import is_known
from gcs.session.speedup_waits import Times
from gcs.session.work import Log, Work
from gcs.vehicle.talk.vehicle_texts import Words
from gcs.wire.messages import CurrentEventSequence, Event, ResponseEventError

EVENT_MESSAGES: Final = frozenset({Event, CurrentEventSequence, ResponseEventError})
NODE: Final = "vehicle"


class Events:
    """The events of one vehicle's autopilot."""

    def __init__(self, own: Address, words: Words, times: Times) -> None:
        self._own = own
        self._words = words
        self._wait_ns = times.real_ns(ASK_AGAIN_NS)
        self._receiver: EventReceiver | None = None

    @property
    def deadline_ns(self) -> int | None:
        return self._receiver.deadline_ns if self._receiver else None

    def start(self, target: Address) -> None:
        """A vehicle appears, or is back and may have started anew."""
        self._receiver = EventReceiver(self._own, target, self._wait_ns)

    def heard(self, heard: Heard, now_ns: int) -> list[Work]:
        """One of `EVENT_MESSAGES`."""
        return self._handle(heard, now_ns)

    def wake(self, now_ns: int) -> list[Work]:
        return self._handle(Wake(), now_ns)

    def _handle(self, event: Heard | Wake, now_ns: int) -> list[Work]:
        if self._receiver is None:
            return []
        effects = self._receiver.handle(event, now_ns)
        return [work for effect in effects for work in self._work(effect, now_ns)]

    def _work(self, effect: EventEffect, now_ns: int) -> list[Work]:
        match effect:
            case Send():
                return [effect]
            case EventHeard(event):
                self._words.event(event, now_ns)
                if is_known(event):
                    return []
                return [Log(Level.DEBUG, NODE, f"event {event.id:#010x} (not known here)")]
            case EventsLost(count):
                were = "1 event was" if count == 1 else f"{count} events were"
                return [Log(Level.DEBUG, NODE, f"{were} lost")]
            case _:
                assert_never(effect)
