"""Whatever holds a key as it comes in, the record has no key, and its audit finds no difference.

Frames with a key that looks like a frame; frames that were damaged or cut; bytes that a hostile
sender has made so that they are a good frame once the key is taken out of them.
"""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.audit.audit import audit
from gcs.audit.messages import Tape
from gcs.gate.states import State
from gcs.record.writer import Recorder
from gcs.session import inputs
from gcs.wire.blanking import without_key
from gcs.wire.crc import CRC_EXTRA, mcrf4xx
from gcs.wire.frame import Frame, Garbage, split
from tests.loopback.bridged import BridgedFlight
from tests.loopback.observed import START_NS

HEADER = b"\xfd\x2a\x00\x00\x00\xff\xbf\x00\x01\x00"
KEY = bytes(range(101, 133))
PIECES = range(1, 60, 7)


def setup(key: bytes) -> bytes:
    message = dialect.MAVLink_setup_signing_message(1, 1, key, 12345)
    return bytes(message.pack(dialect.MAVLink(None, 245, 190)))


def beat() -> bytes:
    mav = dialect.MAVLink(None, 245, 190)
    return bytes(dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3).pack(mav))


def damaged(key: bytes) -> bytes:
    raw = setup(key)
    return raw[:-1] + bytes([raw[-1] ^ 1])


def good_without_its_key() -> bytes:
    """Its checksum is that of a frame with zeros for a key."""
    zeros = bytes(31) + b"\x01"
    raw = setup(zeros)
    checksum = mcrf4xx(raw[1:20] + bytes(32) + CRC_EXTRA[256]).to_bytes(2, "little")
    return raw[:20] + KEY + checksum


def good_around_one() -> bytes:
    """Another frame with a SETUP_SIGNING for its payload, whose checksum is that without the key.

    FILE_TRANSFER_PROTOCOL, 110: 254 bytes of payload or fewer.
    """
    inside = setup(KEY)
    assert len(inside) == 54
    head = bytes([0xFD, 3 + len(inside), 0, 0, 1, 245, 190, 110, 0, 0, 0, 1, 1])
    checksum = mcrf4xx(head[1:] + without_key(inside) + CRC_EXTRA[110]).to_bytes(2, "little")
    return head + inside + checksum


CASES = {
    "plain": setup(KEY),
    "damaged": damaged(KEY),
    "a header in the key": setup(KEY[:5] + HEADER + KEY[:17]),
    "a header at the end of the key": setup(KEY[:22] + HEADER),
    "magics in a damaged key": damaged(bytes([0xFD, 0xFE] * 16)),
    "cut": setup(KEY)[:40],
    "cut before the key": setup(KEY)[:20],
    "good without its key": good_without_its_key(),
    "good around one": good_around_one(),
}


def flown() -> tuple[BridgedFlight, Tape]:
    tape = Tape()
    flight = BridgedFlight()
    flight.recorder = Recorder.without_file(tape, START_NS)
    return flight, tape


def holds_no_key(tape: Tape) -> None:
    """And is reproduced."""
    messages = list(tape.take())
    for part in (KEY[:8], KEY[8:16], KEY[24:]):
        for message in messages:
            assert part not in message.data
            assert part.hex().encode() not in message.data
    result = audit(messages, tape.attachments, "test", "")
    assert result.good, (result.notes, result.first[:5])


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("after", [b"", beat()], ids=["alone", "before a heartbeat"])
def test_of_a_clients_datagram(case: str, after: bytes) -> None:
    flight, tape = flown()
    client = flight.join()
    flight.connected()
    client.send_raw(CASES[case] + after)
    flight.run(0.2)
    assert flight.is_in(State.GROUNDED)
    holds_no_key(tape)


@pytest.mark.parametrize("case", CASES)
def test_of_a_vehicles_datagram(case: str) -> None:
    flight, tape = flown()
    flight.connected()
    flight.feed(inputs.Datagram(0, CASES[case] + beat()))
    flight.run(0.2)
    holds_no_key(tape)


@pytest.mark.parametrize("case", CASES)
def test_of_a_clients_stream_that_is_read_in_pieces(case: str) -> None:
    """Cut anywhere, with a good frame after it: what a read ends with is recorded with it."""
    flight, tape = flown()
    flight.join()
    flight.connected()
    for link, size in enumerate(PIECES, 2):
        flight.clients[link] = flight.clients[1]
        flight.feed(inputs.ClientCame(link, f"tcp 127.0.0.1:{link}", stream=True))
        data = beat() + CASES[case] + beat() * 8
        for begin in range(0, len(data), size):
            flight.feed(inputs.Datagram(link, data[begin : begin + size]))
    flight.run(0.2)
    holds_no_key(tape)


def test_these_bytes_are_what_they_are_called() -> None:
    """Else the tests above would show nothing."""
    for name in ("damaged", "magics in a damaged key", "good without its key", "cut"):
        assert {type(item) for item in split(CASES[name])} == {Garbage}, name
    around = CASES["good around one"]
    assert [type(item) for item in split(around)] == [Garbage, Frame, Garbage]
    once = around.replace(setup(KEY), without_key(setup(KEY)))
    assert [type(item) for item in split(once)] == [Frame]
