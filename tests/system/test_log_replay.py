"""An old flight over UDP: pymavlink and our own station watch it."""

from __future__ import annotations

import struct
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from pymavlink import mavutil

from gcs.exit_codes import ExitCode
from gcs.report import Direction, FrameItem
from tests.system.machine import KeptWaiting
from tests.system.patience import PATIENT_S
from tests.system.programs import GCS, gcs, running
from tests.system.vehicle_program import free_port
from tests.unit.record.flights import MS, frame_v1, frame_v2, record

pytestmark = pytest.mark.system

STEP_NS = 20 * MS
COUNT = 150
"""Three seconds."""


def old_flight(count: int) -> Iterator[bytes]:
    """What a PX4 on the ground sends: a heartbeat a second, a position every 20 ms."""
    for number in range(count):
        if number % 50 == 0:
            yield frame_v1(
                0, struct.pack("<IBBBBB", 4 << 16 | 3 << 24, 2, 12, 81, 4, 3), number & 255
            )
        else:
            payload = struct.pack("<I6f", 20 * number, 1.0, 2.0, -3.0, 0.0, 0.0, 0.0)
            yield frame_v2(32, payload, number & 255)


def recorded(directory: Path, count: int = COUNT) -> tuple[Path, list[bytes]]:
    frames = list(old_flight(count))
    items = [FrameItem(0, Direction.RECEIVED, raw) for raw in frames]
    return record(directory, items, step_ns=STEP_NS), frames


@pytest.mark.parametrize("speed", [1.0, 10.0])
def test_pymavlink_receives_the_frames_in_order_at_their_times(
    tmp_path: Path, speed: float
) -> None:
    file, frames = recorded(tmp_path)
    port = free_port()
    peer = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", source_system=255)
    arrived: list[tuple[float, bytes]] = []
    try:
        link = f"udpout://127.0.0.1:{port}"
        with running(
            GCS, "log", "replay", str(file), "--speed", f"{speed:g}", "--link", link
        ) as it:
            kept = KeptWaiting(it.pid)
            until_s = time.monotonic() + PATIENT_S
            while len(arrived) < len(frames) and time.monotonic() < until_s:
                message = peer.recv_match(blocking=True, timeout=1.0)
                if message is not None:
                    arrived.append((time.monotonic(), bytes(message.get_msgbuf())))
                    peer.mav.heartbeat_send(6, 8, 0, 0, 4)
            late_s = 0.25 + kept.seconds
            it.until_out("frames sent")
            assert it.ended() == 0
            (told,) = [line for line in it.out if "frames sent" in line]
    finally:
        peer.close()
    assert [raw for _, raw in arrived] == frames
    assert told.startswith(f"{COUNT} frames sent, ")
    assert int(told.split(", ")[1].split()[0]) > 0, "what a client says is counted"
    took_s = arrived[-1][0] - arrived[0][0]
    expected_s = (COUNT - 1) * STEP_NS / 1e9 / speed
    assert took_s == pytest.approx(expected_s, abs=late_s)
    # Each frame by its own time: a middle one, against the first.
    middle_s = arrived[COUNT // 2][0] - arrived[0][0]
    assert middle_s == pytest.approx(COUNT // 2 * STEP_NS / 1e9 / speed, abs=late_s)


@pytest.mark.thorough
def test_status_shows_the_vehicle_and_commands_are_not_answered(tmp_path: Path) -> None:
    file, _ = recorded(tmp_path, 400)
    port = free_port()
    with running(GCS, "log", "replay", str(file), "--loop", "--link", f"udpout://127.0.0.1:{port}"):
        link = ("--link", f"udpin://127.0.0.1:{port}", "--log-dir", str(tmp_path / "logs"))
        seen = gcs("status", *link)
        assert seen.returncode == ExitCode.DONE, seen.stderr
        assert "1/1 px4 quadrotor" in seen.stdout
        assert "E +2.00 N +1.00 U +3.00 m" in seen.stdout
        armed = gcs("arm", *link)
        assert armed.returncode == ExitCode.NOT_COMPLETED
        assert "arm: timed out NO_ANSWER" in armed.stdout
