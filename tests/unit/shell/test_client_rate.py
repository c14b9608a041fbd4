"""A client's rate is that of its frames: packed, large, in pieces, or in what is no frame."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import pytest
from pymavlink.dialects.v10 import all as dialect1
from pymavlink.dialects.v20 import all as dialect

from gcs.session.inputs import ClientFlooded, Datagram
from gcs.shell.client_table import COMMAND_HZ, MAX_A_TURN, ClientLimits, ClientTable
from gcs.wire.frame import Frame, Garbage, split

RATE_HZ = 50.0
SECONDS = 20
LINK = 2
MOST_IN_ONE = 4096 // 13
"""The most frames of a datagram: what one of them may be over its sender's rate."""


def packed(message: dialect.MAVLink_message) -> bytes:
    return bytes(message.pack(dialect.MAVLink(None, 245, 190)))


def version1() -> bytes:
    beat = dialect1.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)
    return bytes(beat.pack(dialect1.MAVLink(None, 245, 190)))


def signed() -> bytes:
    mav = dialect.MAVLink(None, 245, 190)
    mav.signing.secret_key = b"k" * 32
    mav.signing.sign_outgoing = True
    mav.signing.timestamp = 1
    return bytes(dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3).pack(mav))


SMALL = packed(dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3))
LARGE = packed(dialect.MAVLink_file_transfer_protocol_message(0, 1, 1, bytes([0xFD] * 251)))
UNKNOWN = b"\xfd\x01\x00\x00\x00\xf5\xbe\xff\xff\x7f\x00\x00\x00"
"""No dialect has that message, so nobody can check it."""


class PaperPeer:
    """The way to a client that nobody sends anything."""

    name = "a client"
    expires = False
    stays = False

    def __init__(self, stream: bool) -> None:
        self.stream = stream

    def send(self, data: bytes) -> str:
        raise AssertionError(f"nothing is sent here: {data!r}")

    def forget(self) -> None:
        pass


class Sender:
    """One client at a table, and a clock."""

    def __init__(self, stream: bool = False) -> None:
        self.now_ns = 1_000_000_000
        self.table = ClientTable(LINK, ClientLimits(rate_hz=RATE_HZ))
        assert self.table.come(PaperPeer(stream), self.now_ns) == LINK
        self.handed_on: list[bytes] = []
        self.flooded = 0

    def sends(self, data: bytes) -> None:
        self.table.heard(LINK, data, self.now_ns)
        for arrival in self.table.take():
            if isinstance(arrival, Datagram):
                self.handed_on.append(arrival.data)
                assert not arrival.frames or [*arrival.frames] == split(arrival.data)

    def for_a_while(self, data: bytes, every_s: float) -> None:
        """The same again and again; what was dropped is told on the way."""
        for _ in range(round(SECONDS / every_s)):
            self.now_ns += round(every_s * 1e9)
            self.sends(data)
            self.table.sweep(self.now_ns)
            self.flooded += sum(isinstance(each, ClientFlooded) for each in self.table.take())

    @property
    def frames(self) -> int:
        """What the session would be given."""
        return sum(isinstance(item, Frame) for item in split_all(self.handed_on))


def split_all(datagrams: Sequence[bytes]) -> list[Frame | Garbage]:
    return [item for data in datagrams for item in split(data)]


@pytest.mark.parametrize("frame", [SMALL, LARGE, version1(), signed(), UNKNOWN])
def test_at_its_rate_nothing_is_dropped_however_large_its_frames_are(frame: bytes) -> None:
    sender = Sender()
    sender.for_a_while(frame, 1 / RATE_HZ)
    assert sender.frames == SECONDS * RATE_HZ
    assert not sender.flooded


@pytest.mark.parametrize("frame", [SMALL, LARGE, version1(), signed(), UNKNOWN])
@pytest.mark.parametrize("at_once", [1, 2, 15])
def test_who_packs_them_gets_no_more_and_no_less(frame: bytes, at_once: int) -> None:
    sender = Sender()
    sender.for_a_while(frame * at_once, 0.002)
    second = RATE_HZ
    assert SECONDS * RATE_HZ <= sender.frames <= SECONDS * RATE_HZ + second + at_once
    assert sender.flooded == pytest.approx(SECONDS, abs=2)


def test_one_datagram_may_take_its_sender_over_the_rate_who_then_waits() -> None:
    sender = Sender()
    many = SMALL * (4096 // len(SMALL))
    sender.for_a_while(many, 0.01)
    assert SECONDS * RATE_HZ <= sender.frames <= (SECONDS + 1) * RATE_HZ + MOST_IN_ONE


HOLD_V1 = bytes(dialect1.MAVLink_set_mode_message(1, 1, 5).pack(dialect1.MAVLink(None, 245, 190)))


def signed_hold() -> bytes:
    mav = dialect.MAVLink(None, 245, 190)
    mav.signing.secret_key = b"k" * 32
    mav.signing.sign_outgoing = True
    mav.signing.timestamp = 1
    return bytes(dialect.MAVLink_command_long_message(1, 1, 17, 0, *[0.0] * 7).pack(mav))


@pytest.mark.parametrize(
    "hold",
    [
        packed(dialect.MAVLink_command_long_message(1, 1, 17, 0, *[0.0] * 7)),
        packed(dialect.MAVLink_command_int_message(1, 1, 6, 192, 0, 0, *[0.0] * 4, 0, 0, 0.0)),
        HOLD_V1,
        signed_hold(),
    ],
)
def test_a_stop_is_handed_on_whatever_its_sender_streams(hold: bytes) -> None:
    sender = Sender()
    sender.for_a_while(SMALL, 0.0005)
    for number in range(1, 21):
        for _ in range(100):
            sender.now_ns += 500_000
            sender.sends(SMALL)
        sender.sends(hold)
        assert sender.handed_on.count(hold) == number


def test_commands_alone_go_a_little_over_the_rate() -> None:
    sender = Sender()
    hold = packed(dialect.MAVLink_command_long_message(1, 1, 17, 0, *[0.0] * 7))
    sender.for_a_while(hold, 0.001)
    assert sender.frames <= (SECONDS + 1) * (RATE_HZ + COMMAND_HZ)
    assert sender.flooded


def broken(inside: bytes) -> bytes:
    """A frame whose checksum is wrong, with others in its payload."""
    return b"\xfd" + bytes([len(inside)]) + LARGE[2:10] + inside + b"\x00\x00"


def after_noise(inside: bytes) -> bytes:
    return b"noise" + inside


@pytest.mark.parametrize("hide", [broken, after_noise])
def test_frames_in_what_is_no_frame_count_each(hide: Callable[[bytes], bytes]) -> None:
    sender = Sender()
    sender.for_a_while(hide(SMALL * 10), 0.01)
    assert sender.frames <= (SECONDS + 1) * RATE_HZ + 20


def test_noise_counts_by_its_bytes() -> None:
    """To look for frames in it takes longer than to take frames."""
    sender = Sender()
    sender.for_a_while(b"\xfd" + b"x" * 640, 0.01)
    assert len(sender.handed_on) <= (SECONDS + 1) * RATE_HZ / 11 + 1


def test_an_empty_datagram_counts_as_one() -> None:
    sender = Sender()
    sender.for_a_while(b"", 0.01)
    assert len(sender.handed_on) <= (SECONDS + 1) * RATE_HZ + 1


# ---------------------------------------------------------------------------------- streams


def in_pieces(sender: Sender, data: bytes, size: int, every_s: float) -> None:
    """As a serial line brings it; what the table does not want yet is not read."""
    before = 0
    for _ in range(round(SECONDS / every_s)):
        sender.now_ns += round(every_s * 1e9)
        if sender.table.may_read(LINK, sender.now_ns):
            sender.sends(data[before : before + size])
            before += size
    assert len(sender.handed_on) < MAX_A_TURN * SECONDS


@pytest.mark.parametrize("size", [5, 10, 21, 50])
def test_frames_that_come_in_pieces_count_once(size: int) -> None:
    """At 0.8 of the rate, in pieces of some bytes: nothing waits."""
    sender = Sender(stream=True)
    rate_bytes_s = 0.8 * RATE_HZ * len(SMALL)
    data = SMALL * round(SECONDS * RATE_HZ)
    in_pieces(sender, data, size, size / rate_bytes_s)
    assert sum(map(len, sender.handed_on)) >= SECONDS * rate_bytes_s - 2 * size


@pytest.mark.parametrize("size", [64, 1000, 4096])
def test_a_stream_that_floods_is_read_no_faster_than_its_rate(size: int) -> None:
    sender = Sender(stream=True)
    data = SMALL * 10_000
    in_pieces(sender, data, size, 0.005)
    frames = sum(map(len, sender.handed_on)) / len(SMALL)
    assert SECONDS * RATE_HZ <= frames <= (SECONDS + 1) * RATE_HZ + size / len(SMALL) + 1


def test_single_bytes_are_read_eight_times_as_often_at_the_most() -> None:
    sender = Sender(stream=True)
    in_pieces(sender, b"\xfe\xff" * 100_000, 1, 0.0005)
    assert len(sender.handed_on) <= 8 * (SECONDS + 1) * RATE_HZ + 8
