"""No frame that was never judged can be read in what leaves, by a receiver that lost bytes.

The receiver is pymavlink's parser, and the hidden frames are written by its packer.
"""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterable
from typing import Any

import pytest
from pymavlink.dialects.v20 import all as dialect
from pymavlink.generator.mavcrc import x25crc

from gcs.wire.hidden_frames import Separator, hides_frame

GPS_RTCM_DATA, COMMAND_LONG, STATUSTEXT = 233, 76, 253
CLIENT = (255, 190)


def crc(body: bytes, msgid: int) -> bytes:
    seed = dialect.mavlink_map[msgid].crc_extra
    checksum: int = x25crc(bytearray(body + bytes((seed,)))).crc
    return checksum.to_bytes(2, "little")


def v2(msgid: int, payload: bytes, seq: int = 0) -> bytes:
    body = bytes((len(payload), 0, 0, seq, *CLIENT)) + msgid.to_bytes(3, "little") + payload
    return b"\xfd" + body + crc(body, msgid)


def v1(msgid: int, payload: bytes, seq: int = 0) -> bytes:
    body = bytes((len(payload), seq, *CLIENT, msgid)) + payload
    return b"\xfe" + body + crc(body, msgid)


def disarm(version: int, seed: int = 0) -> bytes:
    """A forced disarm as the attacker of a flight made it: 44 bytes, or 41 of MAVLink 1."""
    writer = dialect.MAVLink(None, *CLIENT)
    writer.seq = seed % 256
    message = writer.command_long_encode(1, 1, 400, 0, 0, 21196, 0, 0, 0, 0, seed)
    return bytes(message.pack(writer, force_mavlink1=version == 1))


def taken(stream: bytes) -> list[Any]:
    """What pymavlink's parser takes of these bytes."""
    receiver = dialect.MAVLink(None)
    receiver.robust_parsing = True
    return [each for each in receiver.parse_buffer(stream) or [] if each.get_type() != "BAD_DATA"]


def commands(stream: bytes) -> int:
    return sum(each.get_type() == "COMMAND_LONG" for each in taken(stream))


@pytest.mark.parametrize("version", [1, 2])
@pytest.mark.parametrize("carrier", [v1, v2])
def test_a_whole_frame_in_a_payload(carrier: Any, version: int) -> None:
    raw = carrier(GPS_RTCM_DATA, b"\x06abc" + disarm(version) + b"d")
    assert commands(raw) == 0
    assert commands(raw[1:]) == 1
    assert hides_frame(raw)


@pytest.mark.parametrize("version", [1, 2])
def test_a_frame_that_the_loss_of_one_of_its_bytes_makes_good(version: int) -> None:
    inner = disarm(version)
    for at in range(1, len(inner)):
        raw = v2(GPS_RTCM_DATA, b"\x06" + inner[:at] + b"\x07" + inner[at:] + b"d")
        begins = raw.index(inner[:1], 1)
        without = raw[begins : begins + at] + raw[begins + at + 1 :]
        assert commands(without) == 1, at
        assert hides_frame(raw), at


def test_a_message_that_the_dialect_lacks_counts_with_any_seed() -> None:
    unknown = next(each for each in range(255) if each not in dialect.mavlink_map)
    for seed in range(256):
        body = bytes((3, 0, *CLIENT, unknown)) + b"abc"
        checksum = x25crc(bytearray((*body, seed))).crc.to_bytes(2, "little")
        assert hides_frame(v2(GPS_RTCM_DATA, b"\x06" + b"\xfe" + body + checksum + b"d"))


def begun_and_ended() -> tuple[bytes, bytes]:
    """Two frames, and a COMMAND_LONG that begins in one and ends in the other."""
    head = bytes((0xFD, 33, 0, 0, 0, *CLIENT)) + COMMAND_LONG.to_bytes(3, "little")
    first = v2(GPS_RTCM_DATA, b"\x06" + head + bytes(range(15)))
    begins = first.index(head)
    for seq in range(256):
        begun = first[begins:] + v2(GPS_RTCM_DATA, bytes(60), seq)[:10] + b"\x06abcde"
        second = v2(GPS_RTCM_DATA, b"\x06abcde" + crc(begun[1:43], COMMAND_LONG) + bytes(52), seq)
        if len(begun) == 43 and commands(first[1:] + second) == 1:
            return first, second
    raise AssertionError("none was found")


def test_a_frame_that_ends_in_the_next_one() -> None:
    first, second = begun_and_ended()
    assert not hides_frame(first)
    assert not hides_frame(second)
    for foreign in (True, False):
        out = Separator()
        one, two = out.apart(first, foreign=True), out.apart(second, foreign=foreign)
        assert one == first
        assert two != second
        assert two.endswith(second)
        assert commands(one[1:] + two) == 0
        assert [each.get_type() for each in taken(one + two)] == ["GPS_RTCM_DATA"] * 2


def test_a_frame_that_becomes_another_one_where_a_byte_of_its_header_is_lost() -> None:
    """MAVLink 1: without its sequence number the first byte of a text is the message id."""
    follows = v1(0, bytes(9))
    for number in itertools.count():
        raw = v1(STATUSTEXT, bytes((COMMAND_LONG,)) + bytes(28) + number.to_bytes(4, "little"))
        inner = raw[:2] + raw[3:] + follows[:1]
        if crc(inner[1:-2], COMMAND_LONG) == inner[-2:]:
            break
    assert commands(raw[:2] + raw[3:] + follows) == 1
    out = Separator()
    assert out.apart(raw, foreign=True) == raw
    apart = out.apart(follows, foreign=False)
    assert commands(raw[:2] + raw[3:] + apart) == 0
    assert commands(raw + apart) == 0


def attack(dice: random.Random) -> bytes:
    """A frame that carries others, whole or in part, at any place."""
    inner = disarm(dice.choice((1, 2)), dice.randrange(1 << 16))
    begin, end = sorted((dice.randrange(len(inner)), dice.randrange(len(inner))))
    part = dice.choice((inner, inner, inner[begin:], inner[:end], inner + inner[:end]))
    payload = dice.randbytes(dice.randrange(1, 60)) + part + dice.randbytes(dice.randrange(4))
    return dice.choice((v1, v2))(GPS_RTCM_DATA, payload + b"d", dice.randrange(256))


def lossy(stream: bytes, rate: float, dice: random.Random) -> bytes:
    return bytes(byte for byte in stream if dice.random() >= rate)


def left(frames: Iterable[bytes]) -> bytes:
    """What leaves of a client's frames."""
    out = Separator()
    return b"".join(out.apart(raw, foreign=True) for raw in frames if not hides_frame(raw))


@pytest.mark.parametrize("rate", [0.0001, 0.001, 0.01])
def test_no_command_is_read_in_a_stream_that_loses_bytes(rate: float) -> None:
    dice = random.Random(round(rate * 1e6))
    frames = [attack(dice) for _ in range(2000)]
    carried = left(frames)
    assert carried.count(b"\xfd") > 100, "nothing was sent"
    assert commands(lossy(carried, rate, dice)) == 0
    if rate > 0.0005:
        assert commands(lossy(b"".join(frames), rate, dice)) > 0, "the attack does nothing"


def test_what_clients_send_is_hardly_ever_refused() -> None:
    """Random bytes of the greatest payload that corrections for a GPS have."""
    dice = random.Random(1)
    frames = [v2(GPS_RTCM_DATA, dice.randbytes(182), seq % 256) for seq in range(2000)]
    assert sum(map(hides_frame, frames)) <= 4


def test_text_hides_nothing_and_leaves_as_it_is() -> None:
    out = Separator()
    for seq in range(256):
        raw = v2(STATUSTEXT, b"\x06" + "Höhe 12 m, 風".encode(), seq)
        assert not hides_frame(raw)
        assert out.apart(raw, foreign=False) == raw
