"""A .tlog in windows: nothing is lost, nothing is made up, whatever is damaged."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.logfile.tlog import WINDOW_BYTES, read_windows
from gcs.mcap_file.errors import BadLogError
from tests.sample_files import elsewhere
from tests.shares import one_in
from tests.unit.logfile.tlogs import START_US, flight, read_by_pymavlink, stamped, unknown, write


class Read:
    """All that was read of one file."""

    def __init__(self, path: Path, window_bytes: int = WINDOW_BYTES) -> None:
        self.frames: list[bytes] = []
        self.times_us: list[int] = []
        self.gaps: list[bytes] = []
        self.whole = b""
        for window in read_windows(path, window_bytes):
            data = window.data
            parts: list[tuple[int, bytes]] = []
            for start, size, stamp, time_us in zip(
                window.frames.start.tolist(),
                window.frames.size.tolist(),
                window.stamped.tolist(),
                window.time_us.tolist(),
                strict=True,
            ):
                raw = data[start : start + size].tobytes()
                self.frames.append(raw)
                self.times_us.append(time_us)
                parts.append((start, (time_us.to_bytes(8, "big") if stamp else b"") + raw))
            for start, end in window.gaps:
                self.gaps.append(data[start:end].tobytes())
                parts.append((start, self.gaps[-1]))
            self.whole += b"".join(part for _, part in sorted(parts))


def test_times_and_frames_are_those_of_the_file(tmp_path: Path) -> None:
    frames = flight(50)
    read = Read(write(tmp_path / "a.tlog", frames, step_us=1000))
    assert read.frames == frames
    assert read.times_us == [START_US + 1000 * n for n in range(50)]
    assert read.gaps == []


def test_frames_of_unknown_messages_are_frames_where_time_stamps_stand_around_them(
    tmp_path: Path,
) -> None:
    frames = [*flight(3), unknown(), unknown(b"again"), *flight(3), unknown(b"last")]
    read = Read(write(tmp_path / "a.tlog", frames))
    assert read.frames == frames
    assert read.gaps == []


def test_damage_is_a_gap_and_the_next_frame_is_read(tmp_path: Path) -> None:
    frames = flight(10)
    damaged = [*frames[:4], frames[4][:-1] + b"?", *frames[5:]]
    path = write(tmp_path / "a.tlog", damaged)
    read = Read(path)
    assert read.frames == [*frames[:4], *frames[5:]]
    assert read.gaps == [stamped(damaged[4], START_US + 4 * 20_000)]
    assert read.whole == path.read_bytes()


def test_a_frame_without_a_time_stamp_is_still_a_frame(tmp_path: Path) -> None:
    frames = flight(3)
    (tmp_path / "a.tlog").write_bytes(stamped(frames[0]) + frames[1] + stamped(frames[2]))
    read = Read(tmp_path / "a.tlog")
    assert read.frames == frames
    assert read.times_us == [START_US, 0, START_US]


def test_a_file_that_ends_within_a_frame_is_read_to_there(tmp_path: Path) -> None:
    frames = flight(4)
    path = write(tmp_path / "a.tlog", frames)
    path.write_bytes(path.read_bytes()[:-3])
    read = Read(path)
    assert read.frames == frames[:3]
    assert read.gaps == [stamped(frames[3], START_US + 3 * 20_000)[:-3]]


@pytest.mark.slow
@pytest.mark.parametrize("name", one_in(2, ["arducopter_sitl.tlog", "quad_2015.tlog"]))
def test_real_files_hold_what_pymavlink_finds_in_them(name: str) -> None:
    path = elsewhere("logs", name)
    read = Read(path)
    theirs = list(read_by_pymavlink(path))
    good = [m for m in theirs if m.get_type() != "BAD_DATA"]
    assert read.frames == [bytes(m.get_msgbuf()) for m in good]
    assert [t * 1.0e-6 for t in read.times_us] == [m._timestamp for m in good]
    assert read.whole == path.read_bytes()


def test_the_flight_of_2015_has_75_477_good_messages_and_27_613_damaged_bytes() -> None:
    """shared/data/README.md: 75,477 messages and about 27 kB; the bytes by pymavlink: 17,082 in
    1,314 stretches, each behind a time stamp of 8 bytes, and 19 of a frame that breaks off.
    """
    read = Read(elsewhere("logs", "quad_2015.tlog"))
    assert len(read.frames) == 75_477
    assert len(read.gaps) == 1_315
    assert sum(map(len, read.gaps)) == 17_082 + 1_314 * 8 + 19


@pytest.mark.slow
@given(
    st.lists(
        st.one_of(
            st.integers(0, 17).map(lambda n: stamped(flight(18)[n])),
            st.integers(0, 17).map(lambda n: flight(18, mavlink1=True)[n]),
            st.binary(min_size=1, max_size=6).map(lambda b: stamped(unknown(b))),
            st.binary(max_size=30),
            st.just(b"\xfd\xff\x00"),
        ),
        max_size=14,
    ),
    st.sampled_from([1, 7, 64, 300, 4096]),
)
def test_any_bytes_are_read_without_loss_in_windows_of_any_size(
    parts: list[bytes], window_bytes: int
) -> None:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "a.tlog"
        path.write_bytes(stamped(flight(1)[0]) + b"".join(parts))
        read, at_once = Read(path, window_bytes), Read(path)
        assert read.whole == path.read_bytes()
        assert read.frames == at_once.frames


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "empty"),
        (b"just some text\n" * 100, "no MAVLink frame"),
        (b"\x89MCAP0\r\n" + bytes(100), "MCAP"),
        (bytes(3_000_000), "no MAVLink frame in its first"),
        (b"\xfd" * 300_000, "no MAVLink frame"),
    ],
)
def test_what_is_no_tlog_is_refused_with_the_reason(
    tmp_path: Path, content: bytes, reason: str
) -> None:
    (tmp_path / "a.tlog").write_bytes(content)
    with pytest.raises(BadLogError, match=reason):
        Read(tmp_path / "a.tlog")
