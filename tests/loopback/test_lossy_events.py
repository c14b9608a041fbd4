"""What the vehicle says of its flight, over a link that loses a quarter both ways."""

from __future__ import annotations

import pytest

from gcs import ipc
from tests.loopback.air import Weather
from tests.loopback.flight import Flight

LOSSY = Weather(loss=0.25)
SAID = (
    "Armed by external command",
    "Takeoff detected",
    "Landing detected",
    "Disarmed by landing",
)
"""PX4's texts of a short flight, each once (A5_takeoff_hold_only of the recorded scenarios)."""


@pytest.mark.parametrize("seed", range(1, 9))
def test_every_text_of_px4_is_told_once_by_itself_or_by_its_event(seed: int) -> None:
    flight = Flight("px4", seed=seed, up=LOSSY, down=LOSSY).connected()
    flight.run(10.0)  # it tells the number of its latest event every 3 s
    flight.hovering(3.0)
    flight.do("land")
    flight.until(lambda: not flight.vehicle.armed, 30.0)
    flight.run(5.0)
    lines = [event.text for event in flight.of(ipc.LogEvent) if event.node == "vehicle"]
    assert {text: lines.count(text) for text in SAID} == dict.fromkeys(SAID, 1)
