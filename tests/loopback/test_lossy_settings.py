"""The vehicle's settings over a link that loses them: what needs one waits for it."""

from __future__ import annotations

from pathlib import Path

import pytest

from gcs import ipc
from gcs.gate.states import State
from tests.loopback.flight import HOMES, PERSONALITIES, Flight, Personality
from tests.loopback.lossy_link import Weather

LOSSY = Weather(loss=0.25)
RETURNS = """\
QGC WPL 110
0\t1\t0\t16\t0\t0\t0\t0\t{lat}\t{lon}\t{alt}\t1
1\t0\t3\t22\t0\t0\t0\t0\t{lat}\t{lon}\t5\t1
2\t0\t3\t20\t0\t0\t0\t0\t0\t0\t0\t1
"""


@pytest.mark.parametrize("seed", range(1, 6))
@pytest.mark.parametrize("personality", PERSONALITIES)
def test_a_mission_that_returns_is_verified_though_a_quarter_is_lost(
    personality: Personality, seed: int, tmp_path: Path
) -> None:
    """clients.md, gate 3: refused as RTL_BLOCKED in five of five, asked for right at the start."""
    flight = Flight(personality, seed=seed, up=LOSSY, down=LOSSY)
    flight.until(lambda: flight.is_in(State.GROUNDED) and flight.home_ned is not None, 20.0)
    home = HOMES[personality]
    path = tmp_path / "returns.waypoints"
    path.write_text(
        RETURNS.format(lat=home.lat_deg, lon=home.lon_deg, alt=home.alt_amsl_m), encoding="utf-8"
    )
    ask = flight.say("mission_upload", path=str(path))
    flight.until(lambda: bool(flight.verdicts(ask)), 20.0)
    (verdict,) = flight.verdicts(ask)
    assert (verdict.outcome, verdict.code) == ("accepted", ""), verdict.sentence
    assert not [t for t in flight.of(ipc.Trouble) if "return height" in t.text]
