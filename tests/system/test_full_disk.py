"""A disk that is full in mid-flight, and then is not: the flight goes on, and says so."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.system.flight_log import Recorded, frames, whole
from tests.system.station import simulated

pytestmark = [
    pytest.mark.system,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="mounts a tmpfs"),
]


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A file system of 2 MB."""
    if os.geteuid() != 0:
        pytest.skip("mounting a tmpfs needs root")
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", str(disk)]
    made = subprocess.run(mount, capture_output=True, text=True, check=False)
    if made.returncode != 0:
        pytest.skip(f"no tmpfs here: {made.stderr.strip()}")
    try:
        yield disk
    finally:
        subprocess.run(["umount", str(disk)], check=True)


def fill(disk: Path) -> Path:
    """A file that leaves no room for any other."""
    ballast = disk / "ballast"
    with ballast.open("wb", buffering=0) as file:
        try:
            while True:
                file.write(bytes(4096))
        except OSError:
            return ballast


def test_a_full_disk_in_mid_flight_ends_in_a_second_part(small_disk: Path) -> None:
    with simulated(small_disk, speedup=3.0) as operator:
        operator.fly("arm", "takeoff 2")
        ballast = fill(small_disk)
        operator.until(lambda: operator.said("not recorded since"), "told of the loss")
        operator.fly("goto 3 0 2")
        seen = operator.dialogue.snapshot
        assert seen is not None
        assert not seen.recording
        assert "recorder failed" in " ".join(seen.conditions).replace("_", " ")
        ballast.unlink()
        operator.until(lambda: operator.said("recording again"), "told that it records again")
        operator.fly("goto 0 0 2", "land")
        first = operator.log_path
        down = operator.leave()

    second = first.with_name(f"{first.stem}_part2.mcap")
    assert down.bye is not None
    assert down.bye.log_path == str(second)
    assert down.bye.exit_code == 7  # not every byte of the flight is on record
    before, after = frames_of(first), frames(second)
    assert before
    assert after
    assert before[-1].at_ns < after[0].at_ns
    assert [state.state for state in whole(second).states][-1] == "GROUNDED"
    topics = {topic.topic for topic in whole(second).topics}
    assert {"/tf_static", "/vehicle/1/model", "/geofence"} <= topics
    assert whole(second).attachments == ["policy.toml", "parameters.json", "fence.json"]


def frames_of(broken: Path) -> list[Recorded]:
    """Of a part that could not be finished."""
    from gcs.record.recover import recover

    saved = broken.parent.parent / "saved.mcap"
    recover(broken, saved)
    return frames(saved)
