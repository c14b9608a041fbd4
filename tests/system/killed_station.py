"""A station that is killed while it records, and what of the wire is then in its record."""

from __future__ import annotations

import os
import signal
import time
from dataclasses import dataclass
from pathlib import Path

from gcs.report import Direction
from tests.system.flight_log import frames, whole, wire
from tests.system.machine import KeptWaiting
from tests.system.programs import gcs
from tests.system.station import tapped
from tests.system.wire_tap import Crossing


@dataclass(frozen=True, slots=True)
class Loss:
    """Seconds before the kill from which on nothing was saved, 0 where all of it was."""

    received_s: float
    sent_s: float
    kept_waiting_s: float
    """What the station would have saved earlier, had the machine let it."""


def kill_and_recover(folder: Path, recorded_s: float) -> Loss:
    """kill -9 some time after the connection, then `gcs log recover`.

    Asserts that the recovered file is whole and holds the beginning of what an independent ear
    on the wire heard, without a gap.
    """
    with tapped(folder) as (operator, tap):
        kept = KeptWaiting(operator.client.pid)
        enough_s = time.monotonic() + recorded_s
        operator.dialogue.wait_until(lambda: time.monotonic() > enough_s, recorded_s)
        killed_ns, kept_waiting_s = time.monotonic_ns(), kept.seconds
        os.kill(operator.client.pid, signal.SIGKILL)
        tap.silence_vehicle()
        broken = operator.log_path

    saved = folder / "saved.mcap"
    ended = gcs("log", "recover", str(broken), "-o", str(saved))
    assert ended.returncode == 0, ended.stderr
    assert whole(saved).damaged == 0
    found = frames(saved)
    return Loss(
        _lost_s(killed_ns, tap.to_station, wire(found, Direction.RECEIVED)),
        _lost_s(killed_ns, tap.to_vehicle, wire(found, Direction.SENT)),
        kept_waiting_s,
    )


def _lost_s(killed_ns: int, crossed: list[Crossing], recorded: bytes) -> float:
    """Since the first datagram that is not whole in the record."""
    assert recorded
    assert b"".join(crossing.data for crossing in crossed).startswith(recorded)
    known = 0
    for crossing in crossed:
        known += len(crossing.data)
        if known > len(recorded):
            return (killed_ns - crossing.at_ns) / 1e9
    return 0.0
