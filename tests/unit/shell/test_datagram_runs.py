"""Which datagrams become one input, and which stay what they were."""

from __future__ import annotations

import random

from gcs.session.inputs import Datagram
from gcs.shell.datagram_runs import MAX_FRAMES, MAX_RUN, pieces, runs
from gcs.wire.codec import FrameWriter
from gcs.wire.frame import MAX_DATAGRAM, Frame, plain_frames, split
from gcs.wire.messages import Attitude, Heartbeat, Message

WRITER = FrameWriter(1, 1)


def frame(message: Message | None = None) -> bytes:
    return WRITER.write(message or Attitude(1, 0.1, 0.2, 0.3, 0.0, 0.0, 0.5))


def test_whole_datagrams_of_plain_frames_are_put_together() -> None:
    first, second = frame() + frame(), frame()
    (run,) = runs(3, [first, second])
    assert (run.link, run.data) == (3, first + second)
    assert list(run.frames) == split(first + second)


def test_one_with_anything_else_in_it_is_an_input_of_its_own_and_in_its_turn() -> None:
    good = frame()
    wrong = good[:-1] + bytes((good[-1] ^ 1,))
    unknown = b"\xfd\x01\x00\x00\x00\x01\x01\xff\xff\x7f\x00\x00\x00"
    odd = [b"", b"text", good[:9], wrong, good + wrong, unknown, good + b"\0", frame()[:20] + good]
    for each in odd:
        assert list(runs(0, [good, each, good, good])) == [
            Datagram(0, good, tuple(plain_frames(good))),
            Datagram(0, each),
            Datagram(0, good + good, tuple(plain_frames(good + good))),
        ]


def test_no_run_is_longer_than_it_may_be_and_no_byte_is_lost() -> None:
    dice = random.Random(5)
    came = [b"".join(frame() for _ in range(dice.randint(1, 30))) for _ in range(60)]
    came.insert(20, frame() * 250)
    made = list(runs(0, came))
    assert b"".join(each.data for each in made) == b"".join(came)
    assert all(b"".join(item.raw for item in each.frames) == each.data for each in made)
    shorter = [each for each in made if each.data != came[20]]
    assert max(len(each.data) for each in shorter) <= MAX_RUN < len(came[20])
    assert max(len(each.frames) for each in shorter) <= MAX_FRAMES
    assert len(made) < len(came) / 2


def test_short_frames_in_a_run_are_no_more_than_are_counted_together() -> None:
    beat = frame(Heartbeat(0, 2, 12, 0, 4, 3))
    made = list(runs(0, [beat] * (2 * MAX_FRAMES + 1)))
    assert [len(each.frames) for each in made] == [MAX_FRAMES, MAX_FRAMES, 1]


def test_a_datagram_that_is_too_long_is_left_to_the_session() -> None:
    data = frame(Heartbeat(0, 2, 12, 0, 4)) * 1000
    assert len(data) > MAX_DATAGRAM
    assert list(runs(0, [data])) == [Datagram(0, data)]


def test_reads_of_a_stream_are_handed_on_as_they_came() -> None:
    reads = [frame(), b"", frame()[:5]]
    assert list(pieces(1, reads)) == [Datagram(1, read) for read in reads]


def test_plain_frames_are_what_split_finds_and_nothing_where_that_finds_more() -> None:
    dice = random.Random(9)
    for _ in range(500):
        data = bytearray(b"".join(frame() for _ in range(dice.randint(1, 3))))
        if dice.random() < 0.5:
            data[dice.randrange(len(data))] ^= 1 << dice.randrange(8)
        found, items = plain_frames(bytes(data)), split(bytes(data))
        if found:
            assert found == items
        else:
            assert not all(isinstance(item, Frame) and item.known for item in items)
