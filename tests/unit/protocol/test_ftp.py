"""Files of a vehicle over links that lose some: each byte once, in order, and a true end."""

from __future__ import annotations

import random
import struct

import pytest

from gcs.protocol.effects import Address, Heard, Send, Wake
from gcs.protocol.transfers.byte_pieces import Pieces
from gcs.protocol.transfers.ftp import (
    ANSWER_NS,
    FileData,
    FileEnd,
    FileFailed,
    FileRead,
    FolderRead,
    FtpEffect,
)
from gcs.wire.messages import FileTransferProtocol

OWN, VEHICLE = Address(255, 190), Address(1, 1)
HEAD = struct.Struct("<HBBBBBxI")  # https://mavlink.io/en/services/ftp.html
OPEN, READ, BURST, RESET, LIST, TERMINATE, ACK, NAK = 4, 5, 15, 2, 3, 1, 128, 129
EOF, NO_SESSIONS, NOT_FOUND = 6, 5, 10
PACKETS_A_BURST = 20


class Server:
    """One file; answers as the specification says.  `told_size`: what it says of its size."""

    def __init__(self, data: bytes, *, loss: float = 0.0, told_size: int | None = None) -> None:
        self.data = data
        self.told_size = len(data) if told_size is None else told_size
        self.dice = random.Random(1)
        self.loss = loss
        self.busy = False
        self.asked: list[int] = []

    def lost(self) -> bool:
        return self.dice.random() < self.loss

    def answer(self, asked: FileTransferProtocol) -> list[FileTransferProtocol]:
        raw = bytes(asked.payload)
        seq, _, opcode, size, _, _, offset = HEAD.unpack_from(raw)
        self.asked.append(opcode)
        if opcode == RESET:
            self.busy = False
            return [reply(seq + 1, ACK, opcode)]
        if opcode == OPEN:
            if self.busy:
                return [reply(seq + 1, NAK, opcode, data=bytes([NO_SESSIONS]))]
            if raw[12 : 12 + size] != b"/a":
                return [reply(seq + 1, NAK, opcode, data=bytes([NOT_FOUND]))]
            return [reply(seq + 1, ACK, opcode, data=self.told_size.to_bytes(4, "little"))]
        if opcode == READ:
            part = self.data[offset : offset + size]
            if not part:
                return [reply(seq + 1, NAK, opcode, data=bytes([EOF]))]
            return [reply(seq + 1, ACK, opcode, offset=offset, data=part)]
        if opcode == BURST:
            return self.burst(seq, offset, size)
        return []

    def burst(self, seq: int, offset: int, size: int) -> list[FileTransferProtocol]:
        answers: list[FileTransferProtocol] = []
        for number in range(PACKETS_A_BURST):
            part = self.data[offset : offset + size]
            if not part:
                return [*answers, reply(seq + 1 + number, NAK, BURST, data=bytes([EOF]))]
            last = number == PACKETS_A_BURST - 1
            answers.append(reply(seq + 1 + number, ACK, BURST, offset=offset, data=part, last=last))
            offset += len(part)
        return answers


def reply(
    seq: int, opcode: int, asked: int, *, offset: int = 0, data: bytes = b"", last: bool = False
) -> FileTransferProtocol:
    head = HEAD.pack(seq % 0x10000, 0, opcode, len(data), asked, last, offset)
    return FileTransferProtocol(0, 255, 190, tuple((head + data).ljust(251, b"\0")))


def read(server: Server, path: str = "/a", start: int = 0) -> tuple[bytes, FtpEffect, float]:
    """What was given out, how it ended, and after how many seconds."""
    machine = FileRead(OWN, VEHICLE, path, start)
    now_ns, data = 0, b""
    effects = machine.start(now_ns)
    for _ in range(100_000):
        answers: list[FileTransferProtocol] = []
        for effect in effects:
            match effect:
                case Send(message=FileTransferProtocol() as asked):
                    answers += [] if server.lost() else server.answer(asked)
                case FileData(offset, part, _):
                    assert offset == start + len(data), "each byte once, in order"
                    data += part
                case FileEnd() | FileFailed():
                    assert machine.deadline_ns is None
                    return data, effect, now_ns / 1e9
        now_ns += 1_000_000
        effects = []
        for answer in answers:
            if not server.lost():
                effects += machine.handle(Heard(1, 1, answer), now_ns)
        if not answers and not effects:
            assert machine.deadline_ns is not None
            now_ns = max(now_ns, machine.deadline_ns)
            effects = machine.handle(Wake(), now_ns)
    raise AssertionError("it does not end")


def contents(size: int) -> bytes:
    return random.Random(size).randbytes(size)


@pytest.mark.parametrize("size", [0, 1, 238, 239, 240, 239 * PACKETS_A_BURST, 20_000])
@pytest.mark.parametrize("told", ["exactly", "too much"])
@pytest.mark.parametrize("loss", [0.0, 0.2])
def test_a_file_is_read_whatever_is_lost_and_whatever_size_is_told(
    size: int, told: str, loss: float
) -> None:
    """ArduPilot says a megabyte of @PARAM/param.pck."""
    data = contents(size)
    server = Server(data, loss=loss, told_size=None if told == "exactly" else 1 << 20)
    assert read(server)[:2] == (data, FileEnd(size))


def test_a_partial_file_goes_on_where_it_ends() -> None:
    data = contents(5_000)
    assert read(Server(data, loss=0.1), start=1_234)[:2] == (data[1_234:], FileEnd(5_000))


def test_a_session_that_was_left_open_is_closed_and_tried_again() -> None:
    server = Server(contents(300))
    server.busy = True
    assert read(server)[1] == FileEnd(300)
    assert server.asked[:3] == [OPEN, RESET, OPEN]


def test_a_file_that_is_not_there_is_told_and_silence_is_given_up() -> None:
    ended = read(Server(b""), "/b")[1]
    assert isinstance(ended, FileFailed)
    assert ended.error == NOT_FOUND
    ended, seconds = read(Server(b"", loss=1.0))[1:]
    assert isinstance(ended, FileFailed)
    assert ended.error is None
    assert seconds == 4 * ANSWER_NS / 1e9


def test_an_answer_for_another_station_is_none_of_ours() -> None:
    machine = FileRead(OWN, VEHICLE, "/a")
    machine.start(0)
    other = FileTransferProtocol(0, 254, 190, reply(1, ACK, OPEN, data=b"\1\0\0\0").payload)
    assert machine.handle(Heard(1, 1, other), 1) == []
    assert machine.handle(Heard(2, 1, reply(1, ACK, OPEN, data=b"\1\0\0\0")), 1) == []


def test_two_talks_do_not_begin_with_the_same_number() -> None:
    """A PX4 repeats its last answer to the number before that answer's (recorded, 1.14.3)."""
    first, second = (FileRead(OWN, VEHICLE, "/a").start(now_ns)[0] for now_ns in (0, 5_000_000))
    assert first != second


def test_a_folder_is_listed_in_parts() -> None:
    machine = FolderRead(OWN, VEHICLE, "/log")
    machine.start(0)
    machine.handle(Heard(1, 1, reply(1, ACK, LIST, data=b"D.\0D2026\0Fa.ulg\x0917\0")), 1)
    machine.handle(Heard(1, 1, reply(2, ACK, LIST, offset=3, data=b"S\0Fb\x090\0")), 2)
    (listed,) = machine.handle(Heard(1, 1, reply(3, NAK, LIST, data=bytes([EOF]))), 3)
    assert [(e.name, e.size) for e in listed.entries] == [  # type: ignore[union-attr]
        ("2026", None),
        ("a.ulg", 17),
        ("b", 0),
    ]


def test_pieces_come_out_once_whatever_order_they_come_in() -> None:
    data = contents(10_000)
    for seed in range(30):
        dice = random.Random(seed)
        offsets = list(range(100, 10_000, 90)) * 2
        dice.shuffle(offsets)
        pieces, found = Pieces(100, 90), b""
        for offset in offsets[: len(offsets) // 2]:
            found += pieces.add(offset, data[offset : offset + 90])
        while missing := pieces.missing(4):
            assert all(pieces.at <= offset < pieces.end for offset in missing)
            for offset in missing:
                found += pieces.add(offset, data[offset : offset + 90])
        assert found == data[100 : pieces.end]
