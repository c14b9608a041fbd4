"""A vehicle's logs by the log protocol, over links that lose some."""

from __future__ import annotations

import random

import pytest

from gcs.protocol.effects import Address, Heard, Send, Wake
from gcs.protocol.transfers.vehicle_log import (
    LogBytes,
    LogEffect,
    LogEnd,
    LogFailed,
    LogList,
    LogRead,
    LogsListed,
)
from gcs.wire.messages import (
    LogData,
    LogEntry,
    LogRequestData,
    LogRequestEnd,
    LogRequestList,
    Message,
)

VEHICLE = Address(1, 1)
NUMBER = 7


class Vehicle:
    """Keeps logs 5, 6 and 7; the last one is `data`."""

    def __init__(self, data: bytes = b"", loss: float = 0.0) -> None:
        self.data = data
        self.loss = loss
        self.dice = random.Random(2)
        self.ended = 0

    def answer(self, asked: Message) -> list[Message]:
        told: list[Message] = []
        if self.dice.random() < self.loss:
            return told
        match asked:
            case LogRequestList():
                told = [LogEntry(0, 10, number, 3, NUMBER) for number in (5, 6, NUMBER)]
            case LogRequestData(ofs=ofs, count=count):
                end = min(ofs + count, len(self.data))
                for at in range(ofs, end, 90):
                    piece = self.data[at : min(at + 90, end)]
                    told.append(LogData(at, NUMBER, len(piece), tuple(piece.ljust(90, b"\0"))))
                told = told or [LogData(ofs, NUMBER, 0, (0,) * 90)]
            case LogRequestEnd():
                self.ended += 1
        return [each for each in told if self.dice.random() >= self.loss]


def played(machine: LogList | LogRead, vehicle: Vehicle) -> tuple[bytes, LogEffect]:
    """The bytes that were given out, and how it ended."""
    now_ns, data = 0, b""
    effects = machine.start(now_ns)
    begun = None
    for _ in range(100_000):
        answers = []
        ended = None
        for effect in effects:
            match effect:
                case Send(message=message):
                    answers += vehicle.answer(message)
                case LogBytes(offset, part):
                    begun = offset if begun is None else begun
                    assert offset == begun + len(data)
                    data += part
                case _:
                    ended = effect
        if ended is not None:
            assert machine.deadline_ns is None
            return data, ended
        now_ns += 1_000_000
        effects = [e for a in answers for e in machine.handle(Heard(1, 1, a), now_ns)]
        if not answers:
            assert machine.deadline_ns is not None
            now_ns = max(now_ns, machine.deadline_ns)
            effects = machine.handle(Wake(), now_ns)
    raise AssertionError("it does not end")


@pytest.mark.parametrize("loss", [0.0, 0.3])
def test_every_log_is_listed(loss: float) -> None:
    _, listed = played(LogList(VEHICLE), Vehicle(loss=loss))
    assert isinstance(listed, LogsListed)
    assert [each.id for each in listed.logs] == [5, 6, 7]


def test_none_is_an_answer_too_and_silence_is_given_up() -> None:
    machine = LogList(VEHICLE)
    machine.start(0)
    assert machine.handle(Heard(1, 1, LogEntry(0, 0, 0, 0, 0)), 1) == [LogsListed(())]
    assert isinstance(played(LogList(VEHICLE), Vehicle(loss=1.0))[1], LogFailed)


@pytest.mark.parametrize("size", [0, 1, 89, 90, 91, 20_050])
@pytest.mark.parametrize("loss", [0.0, 0.2])
def test_a_log_is_read_whatever_is_lost(size: int, loss: float) -> None:
    log = random.Random(size).randbytes(size)
    vehicle = Vehicle(log, loss)
    assert played(LogRead(VEHICLE, NUMBER, size), vehicle) == (log, LogEnd(size))
    assert vehicle.ended == 1 or loss


def test_a_part_goes_on_where_it_ends() -> None:
    log = random.Random(1).randbytes(5_000)
    read = played(LogRead(VEHICLE, NUMBER, 5_000, 1_234), Vehicle(log, 0.1))
    assert read == (log[1_234:], LogEnd(5_000))


def test_a_log_that_is_shorter_than_it_was_listed_is_told() -> None:
    read = played(LogRead(VEHICLE, NUMBER, 500), Vehicle(bytes(200)))
    assert read == (bytes(200), LogFailed("it ends after 200 bytes"))
