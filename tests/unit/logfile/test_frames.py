"""Frames in a large buffer: the same as the splitter finds, that looks at one after the other."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.generator.mavcrc import x25crc

from gcs.logfile.checksums import crc_of_rows
from gcs.logfile.frames import PADDING, Frames, find_frames, find_message
from gcs.wire.dialect import MESSAGES_BY_NAME
from gcs.wire.frame import Frame, StreamSplitter
from tests.unit.logfile.tlogs import flight


def found(raw: bytes, name: str | None = None) -> tuple[np.ndarray, Frames]:
    data = np.frombuffer(raw + bytes(PADDING), np.uint8)
    if name is None:
        return data, find_frames(data, len(raw))
    return data, find_message(data, len(raw), MESSAGES_BY_NAME[name].msgid)


def by_splitter(raw: bytes) -> list[tuple[int, Frame]]:
    splitter = StreamSplitter()
    frames, at = [], 0
    for item in [*splitter.feed(raw), *splitter.close()]:
        if isinstance(item, Frame) and item.known:
            frames.append((at, item))
        at += len(item.raw)
    return frames


def test_every_frame_is_found_as_it_is() -> None:
    raw = b"".join(flight(60) + flight(60, mavlink1=True, sysid=7))
    data, frames = found(raw)
    expected = by_splitter(raw)
    assert len(expected) == 120
    assert frames.start.tolist() == [start for start, _ in expected]
    assert frames.size.tolist() == [len(frame.raw) for _, frame in expected]
    assert frames.length.tolist() == [len(frame.payload) for _, frame in expected]
    assert frames.msgid.tolist() == [frame.msgid for _, frame in expected]
    sources = zip(*(each.tolist() for each in frames.source(data)), strict=True)
    assert list(sources) == [(f.seq, f.sysid, f.compid) for _, f in expected]


def test_a_wrong_checksum_costs_only_its_own_frame() -> None:
    frames = flight(12)
    frames[5] = frames[5][:-1] + bytes([frames[5][-1] ^ 1])
    assert len(found(b"".join(frames))[1]) == 11


def test_a_frame_within_another_is_no_frame_of_its_own() -> None:
    """A TUNNEL that carries a whole HEARTBEAT."""
    from pymavlink.dialects.v20 import all as dialect

    sender = dialect.MAVLink(None, srcSystem=1, srcComponent=1)
    inner = flight(5)[4]
    outer = sender.tunnel_encode(0, 0, 0, len(inner), inner.ljust(128, b"\0")).pack(sender)
    assert found(bytes(outer))[1].msgid.tolist() == [MESSAGES_BY_NAME["TUNNEL"].msgid]
    assert len(found(bytes(outer), "HEARTBEAT")[1]) == 0
    broken = bytes(outer[:-1]) + bytes([outer[-1] ^ 1])
    assert len(found(broken, "HEARTBEAT")[1]) == 1


@given(
    st.lists(
        st.one_of(
            st.integers(0, 17).map(lambda n: flight(18)[n]),
            st.integers(0, 17).map(lambda n: flight(18, mavlink1=True)[n]),
            st.binary(max_size=40),
            st.binary(min_size=1, max_size=12).map(lambda b: b"\xfd\x09\x00" + b),
            st.just(b"\xfe\x09"),
        ),
        max_size=12,
    ),
    st.integers(0, 60),
)
def test_among_any_bytes_the_splitter_and_numpy_agree(parts: list[bytes], cut: int) -> None:
    raw = b"".join(parts)
    raw = raw[: max(0, len(raw) - cut)]
    expected = by_splitter(raw)
    _, frames = found(raw)
    assert frames.start.tolist() == [start for start, _ in expected]
    for name in ("HEARTBEAT", "STATUSTEXT"):
        mine = [start for start, frame in expected if frame.name == name]
        assert found(raw, name)[1].start.tolist() == mine


@pytest.mark.parametrize("width", [0, 1, 2, 5, 9, 36, 255, 280])
def test_checksums_are_pymavlinks(width: int) -> None:
    rng = np.random.default_rng(width)
    rows = rng.integers(0, 256, (20, width), dtype=np.uint8)
    extra = rng.integers(0, 256, 20, dtype=np.uint8)
    expected = [
        x25crc(bytes(row) + bytes([more])).crc for row, more in zip(rows, extra, strict=True)
    ]
    assert crc_of_rows(rows, extra).tolist() == expected
