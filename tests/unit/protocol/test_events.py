"""The receiving side of the events protocol, on a link that loses, swaps and doubles."""

from __future__ import annotations

import random
from collections import deque

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs.protocol.effects import Address, Heard, Send, Wake
from gcs.protocol.events import (
    ASK_AGAIN_NS,
    MOST_ASKED,
    RESET,
    TRIES,
    EventEffect,
    EventHeard,
    EventReceiver,
    EventsLost,
)
from gcs.wire.messages import (
    CurrentEventSequence,
    Event,
    Message,
    RequestEvent,
    ResponseEventError,
)
from tests.shares import examples

OWN, VEHICLE = Address(255, 190), Address(1, 1)
RING = 1 << 16


def event(sequence: int) -> Event:
    return Event(0, 0, sequence % RING, 0, 0, 0x66, (0,) * 40)


def gone(sequence: int, oldest: int, to: Address = OWN) -> ResponseEventError:
    return ResponseEventError(sequence % RING, oldest % RING, to.sysid, to.compid, 0)


class Station:
    """Feeds a receiver and keeps what it answers."""

    def __init__(self) -> None:
        self.receiver = EventReceiver(OWN, VEHICLE)
        self.now_ns = 0
        self.told: list[int] = []
        self.lost = 0

    def hear(self, *messages: Message, sender: Address = VEHICLE) -> list[RequestEvent]:
        heard = (Heard(sender.sysid, sender.compid, message) for message in messages)
        return [
            ask for each in heard for ask in self._keep(self.receiver.handle(each, self.now_ns))
        ]

    def wait(self, ns: int = ASK_AGAIN_NS) -> list[RequestEvent]:
        self.now_ns += ns
        return self._keep(self.receiver.handle(Wake(), self.now_ns))

    def _keep(self, effects: list[EventEffect]) -> list[RequestEvent]:
        asked: list[RequestEvent] = []
        for effect in effects:
            match effect:
                case EventHeard(heard):
                    self.told.append(heard.sequence)
                case EventsLost(count):
                    self.lost += count
                case Send(message):
                    assert isinstance(message, RequestEvent)
                    asked.append(message)
        return asked


def test_events_in_order_are_told_at_once_and_nothing_is_asked_for() -> None:
    station = Station()
    numbers = [65534, 65535, 0, 1]
    assert station.hear(*map(event, numbers), CurrentEventSequence(1, 0)) == []
    assert (station.told, station.receiver.deadline_ns) == (numbers, None)


def test_a_gap_is_asked_for_at_once_and_what_is_behind_it_waits() -> None:
    station = Station()
    station.hear(event(65534))
    assert station.hear(event(2)) == [RequestEvent(65535, 1, 1, 1)]
    assert station.told == [65534]
    station.hear(event(65535), event(0), event(1))
    assert station.told == [65534, 65535, 0, 1, 2]
    assert station.receiver.deadline_ns is None


def test_the_last_one_is_missed_by_the_sequence_that_the_vehicle_tells() -> None:
    station = Station()
    station.hear(event(7))
    assert station.hear(CurrentEventSequence(9, 0)) == [RequestEvent(8, 9, 1, 1)]


def test_what_was_before_the_first_that_is_heard_is_not_asked_for() -> None:
    assert Station().hear(CurrentEventSequence(40, 0)) == []
    assert Station().hear(event(40)) == []


def test_each_run_of_missing_ones_is_asked_for_again_and_again_then_given_up() -> None:
    station = Station()
    runs = [RequestEvent(2, 3, 1, 1), RequestEvent(5, 5, 1, 1)]
    assert station.hear(event(1), event(4), event(6)) == runs[:1]
    assert station.wait(ASK_AGAIN_NS - 1) == []
    assert station.wait(1) == runs
    again = [station.wait() for _ in range(TRIES)]
    assert again == [runs] * (TRIES - 2) + [[], []]
    assert (station.told, station.lost) == ([1, 4, 6], 3)
    assert station.receiver.deadline_ns is None


def test_what_the_vehicle_has_not_kept_is_lost_with_all_before_it() -> None:
    """L2: RESPONSE_EVENT_ERROR to 255/190 names 45 as the oldest that is left."""
    station = Station()
    station.hear(event(40), event(47))
    station.hear(gone(41, 45))
    assert (station.told, station.lost) == ([40], 4)
    station.hear(event(45), event(46))
    assert station.told == [40, 45, 46, 47]


def test_an_error_that_answers_another_station_is_none_of_ours() -> None:
    station = Station()
    station.hear(event(40), event(42), gone(41, 42, Address(254, 190)))
    assert station.lost == 0


def test_another_component_s_events_are_not_its() -> None:
    station = Station()
    assert station.hear(event(1), event(5), sender=Address(1, 100)) == []
    assert station.told == []


def test_of_a_very_large_gap_only_the_latest_are_asked_for() -> None:
    station = Station()
    (asked,) = station.hear(event(10), event(30_000))
    assert (asked.first_sequence, asked.last_sequence) == (30_001 - MOST_ASKED, 29_999)
    assert station.lost == 30_000 - MOST_ASKED - 10


def test_a_vehicle_that_counts_anew_says_so() -> None:
    station = Station()
    station.hear(event(100), CurrentEventSequence(3, RESET), event(4))
    assert (station.told, station.lost) == ([100, 4], 0)


def test_or_is_believed_when_it_is_behind_twice() -> None:
    station = Station()
    station.hear(event(100), CurrentEventSequence(99, 0), event(101), CurrentEventSequence(101, 0))
    assert station.told == [100, 101], "one was late"
    station.hear(CurrentEventSequence(3, 0), CurrentEventSequence(3, 0), event(4))
    assert station.told == [100, 101, 4]


class Vehicle:
    """Sends events, keeps the last 20, answers as recorded; the link is given by a die."""

    def __init__(self, seed: int, loss: float) -> None:
        self.dice = random.Random(seed)
        self.loss = loss
        self.next = 65526
        self.kept: deque[int] = deque(maxlen=20)
        self.air: list[Message] = []

    def send(self, message: Message) -> None:
        if self.dice.random() >= self.loss:
            self.air.insert(self.dice.randint(max(0, len(self.air) - 2), len(self.air)), message)
            if self.dice.random() < 0.1:
                self.air.append(message)

    def say(self) -> None:
        self.kept.append(self.next % RING)
        self.send(event(self.next))
        self.next += 1

    def answer(self, asked: RequestEvent) -> None:
        if self.dice.random() < self.loss:
            return
        for turn in range((asked.last_sequence - asked.first_sequence) % RING + 1):
            number = (asked.first_sequence + turn) % RING
            self.send(event(number) if number in self.kept else gone(number, self.kept[0]))


SAID = 40


def flown(seed: int, loss: float) -> Station:
    """20 s: an event every 0.4 s, the sequence every 3 s, then both sides settle."""
    vehicle, station = Vehicle(seed, loss), Station()
    station.hear(event(vehicle.next))
    vehicle.next += 1
    for turn in range(250):
        if turn < 4 * SAID and turn % 4 == 0:
            vehicle.say()
        if turn % 30 == 0 or turn > 220:
            vehicle.send(CurrentEventSequence((vehicle.next - 1) % RING, 0))
        came, vehicle.air = vehicle.air, []
        for asked in [*station.hear(*came), *station.wait(100_000_000)]:
            vehicle.answer(asked)
    return station


@given(seed=st.integers(0, 1 << 32), loss=st.floats(0.0, 0.9))
@settings(max_examples=examples(60), deadline=None)
def test_each_is_told_once_and_in_order_whatever_is_lost(seed: int, loss: float) -> None:
    station = flown(seed, loss)
    orders = [(number - 65526) % RING for number in station.told]
    assert orders == sorted(set(orders))
    assert len(orders) + station.lost <= 1 + SAID


@pytest.mark.parametrize("loss", [0.0, 0.1, 0.25])
def test_nearly_none_is_lost(loss: float) -> None:
    """An event is lost where it and then all tries, each a request and an answer, are lost."""
    flights = 100
    told = lost = 0
    for seed in range(flights):
        station = flown(seed, loss)
        told += len(station.told) - 1
        lost += station.lost
    assert told + lost == flights * SAID
    expected = flights * SAID * loss * (1.0 - (1.0 - loss) ** 2) ** TRIES
    assert lost <= 3.0 * expected
