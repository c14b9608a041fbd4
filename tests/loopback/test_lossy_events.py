"""What the vehicle says of its flight, over a link that loses a quarter both ways."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from gcs import ipc
from gcs.gate.states import State
from tests.loopback.flight import Flight
from tests.loopback.lossy_link import Weather

LOSSY = Weather(loss=0.25)
SAID = (
    "Armed by external command",
    "Takeoff detected",
    "Landing detected",
    "Disarmed by landing",
)
"""PX4's texts of a short flight, each once (A5_takeoff_hold_only of the recorded scenarios)."""


FLIES = (State.HOVERING, State.HOLDING, State.EXTERNAL)


def insist(flight: Flight, word: str, seen: Callable[[], bool], up_m: float | None = None) -> None:
    """Ask until it is so: of the tries of one request all may be lost."""
    for _ in range(5):
        flight.done(flight.say(word, up_m=up_m))
        flight.run(5.0)
        if seen():
            return
    raise AssertionError(f"{word} five times: {flight.told()}")


@pytest.mark.parametrize("seed", range(1, 9))
def test_every_text_of_px4_is_told_once_by_itself_or_by_its_event(seed: int) -> None:
    flight = Flight("px4", seed=seed, up=LOSSY, down=LOSSY).connected()
    flight.run(10.0)  # it tells the number of its latest event every 3 s
    insist(flight, "arm", lambda: flight.vehicle.armed)
    # Where the answer to the take-off, or to the mode after it, is lost for good, it is held.
    insist(flight, "takeoff", lambda: flight.state in FLIES, up_m=3.0)
    insist(flight, "land", lambda: not flight.vehicle.armed)
    lines = [event.text for event in flight.of(ipc.LogEvent) if event.node == "vehicle"]
    assert {text: lines.count(text) for text in SAID} == dict.fromkeys(SAID, 1)
