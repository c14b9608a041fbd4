"""An hour-long record: its size, and what a viewer waits for, as written and compacted.

Run: python -m tools.measure_hour [FILE]    (without FILE an hour is flown on a virtual clock)
"""

from __future__ import annotations

import shutil
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from mcap.reader import make_reader

from gcs.record.compact import compact
from gcs.record.writer import Recorder
from tests.loopback.flight import Flight
from tests.loopback.observed import START_NS

HOUR_S = 3600.0
BACKFILLED = 12
PLOTTED = ("/vehicle/1/state", "/mavlink/1/1/ATTITUDE", "/mavlink/1/1/LOCAL_POSITION_NED")
REPEATS = 5


def flown(folder: Path) -> Path:
    """Legs of 10 m, one after the other, until the hour is over."""
    recorder = Recorder.open(folder, "hour", "20260101-000000", START_NS, sealed=True)
    flight = Flight(params={"SIM_BAT_DRAIN": 36000.0})
    flight.recorder = recorder
    flight.hovering(5.0)
    until_ns = flight.now_ns + round(HOUR_S * 1e9)
    while flight.now_ns < until_ns:
        for east_m, north_m in ((10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (0.0, 0.0)):
            flight.goto(east_m, north_m, 5.0)
            flight.run(12.0)
    assert recorder.close(flight.now_ns)
    return recorder.path


def measured(path: Path) -> None:
    """One line of the table."""
    with open(path, "rb") as file:
        init_ms = _best(lambda: make_reader(file).get_summary())
        reader = make_reader(file)
        summary = reader.get_summary()
        assert summary is not None
        assert summary.statistics is not None
        counts = summary.statistics.channel_message_counts
        topics = [
            channel.topic
            for number, channel in summary.channels.items()
            if counts.get(number, 0) > HOUR_S / 2
        ][:BACKFILLED]
        middle = (summary.statistics.message_start_time + summary.statistics.message_end_time) // 2

        def backfill() -> None:
            for topic in topics:
                found = reader.iter_messages([topic], ending_before=middle, reverse=True)
                next(iter(found))

        backfill_ms = _best(backfill)
        plots_ms = _best(lambda: sum(1 for _ in reader.iter_messages(list(PLOTTED))), 1)
    print(
        f"{path.name}: {path.stat().st_size / 1e6:.1f} MB, "
        f"{summary.statistics.message_count} messages, {len(summary.chunk_indexes)} chunks, "
        f"init {init_ms:.1f} ms, backfill of {len(topics)} {backfill_ms:.0f} ms, "
        f"read for plots {plots_ms:.0f} ms",
        flush=True,
    )


def _best(measure: Callable[[], object], repeats: int = REPEATS) -> float:
    times = []
    for _ in range(repeats):
        begun = time.process_time()
        measure()
        times.append(time.process_time() - begun)
    return min(times) * 1e3


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        path = Path(sys.argv[1]) if sys.argv[1:] else flown(Path(name))
        copy = Path(shutil.copy(path, Path(name) / "compacted.mcap"))
        measured(path)
        begun = time.monotonic()
        compact(copy)
        print(f"compacted in {time.monotonic() - begun:.1f} s")
        measured(copy)


if __name__ == "__main__":
    main()
