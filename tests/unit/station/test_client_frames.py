"""Frames for a client that leave as one datagram are numbered as they are one by one."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from gcs.station.client_frames import UPGRADES_NS, ClientFrames
from gcs.wire import messages as m
from gcs.wire.codec import FrameWriter
from gcs.wire.rewrite import as_mavlink1, seq_of
from gcs.wire.signing import SecretKey, Signer

KEY = SecretKey(bytes(range(32)))
SOURCES = ((1, 1), (1, 154), (2, 1))


@st.composite
def frames(draw: st.DrawFn) -> bytes:
    """Of a few components, in either version, some signed; most are plain."""
    sysid, compid = draw(st.sampled_from(SOURCES))
    writer = FrameWriter(sysid, compid)
    writer.seq = draw(st.integers(0, 255))
    number = draw(st.integers(0, 2**32 - 1))
    raw = writer.write(m.Attitude(number, 0.1, 0.2, 0.3, 0.0, 0.0, 0.0))
    kind = draw(st.sampled_from(("plain", "plain", "plain", "v1", "signed")))
    if kind == "v1":
        older = as_mavlink1(raw)
        assert older is not None
        return older
    return Signer(KEY, 1).sign(raw, number) if kind == "signed" else raw


BATCHES = st.lists(st.lists(frames(), min_size=1, max_size=12), min_size=1, max_size=4)


@given(BATCHES, st.lists(st.sampled_from(SOURCES), max_size=5), st.booleans())
def test_one_behind_the_other_is_what_they_are_one_by_one(
    batches: list[list[bytes]], answered_for: list[tuple[int, int]], v1_alone: bool
) -> None:
    one_by_one, together = ClientFrames(), ClientFrames()
    now_ns = 0
    for client in (one_by_one, together):
        client.passed(batches[0], now_ns)
        if v1_alone:
            older = as_mavlink1(FrameWriter(255, 190).write(m.Heartbeat(0, 6, 8, 0, 4, 3)))
            assert older is not None
            client.spoke(older)
    for turn, batch in enumerate(batches):
        now_ns += UPGRADES_NS
        joined = together.joined(batch, now_ns)
        assert joined == b"".join(one_by_one.passed(batch, now_ns))
        if turn < len(answered_for):
            raw = FrameWriter(*answered_for[turn]).write(m.MissionCurrent(turn))
            assert together.answer(raw, now_ns) == one_by_one.answer(raw, now_ns)


@given(st.lists(st.booleans(), min_size=1, max_size=30), st.booleans())
def test_what_is_left_out_leaves_no_gap(is_left_out: list[bool], v1_alone: bool) -> None:
    """Frames of one component, some of them left out, and an answer in its name behind them."""
    client, writer = ClientFrames(), FrameWriter(1, 1)
    writer.seq = 250
    if v1_alone:
        older = as_mavlink1(FrameWriter(255, 190).write(m.Heartbeat(0, 6, 8, 0, 4, 3)))
        assert older is not None
        client.passed([], 0)
        client.spoke(older)
    raws = [writer.write(m.MissionCurrent(number)) for number, _ in enumerate(is_left_out)]
    left_out = [raw for raw, out in zip(raws, is_left_out, strict=True) if out]
    passed = client.passed(raws, UPGRADES_NS, left_out)
    assert len(passed) == len(raws) - len(left_out)
    answer = client.answer(writer.write(m.MissionCurrent(0)), UPGRADES_NS)
    assert answer is not None
    assert [seq_of(raw) for raw in (*passed, answer)] == [
        (250 + number) & 0xFF for number in range(len(passed) + 1)
    ]
