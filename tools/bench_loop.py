"""Simulated seconds per CPU second of the whole loop: ground station, link, vehicle, one core.

    python -m tools.bench_loop [--seconds 60] [--runs 5]

A flight to the lab's goals over and over; each personality, on a clear link and in bad weather.
Prints the best and the median of the runs, and the load of the machine, which it depends on.
"""

from __future__ import annotations

import argparse
import os
import statistics
import time

from tests.loopback.flight import PERSONALITIES, Flight, Personality
from tests.loopback.lossy_link import CLEAR, Weather

ROUGH = Weather(loss=0.1, duplicate=0.1, corrupt=0.05, delay_s=(0.001, 0.1))
CORNERS_ENU = ((3.0, 0.0, 2.0), (3.0, 3.0, 2.0), (0.0, 3.0, 2.0), (0.0, 0.0, 2.0))


def speed(personality: Personality, weather: Weather, seconds: float) -> float:
    """Fly for that many simulated seconds; simulated per second of CPU, take-off included."""
    begin = time.process_time()
    flight = Flight(personality, up=weather, down=weather).hovering(2.0)
    corner = 0
    while flight.elapsed_s < seconds:
        flight.goto(*CORNERS_ENU[corner % 4])
        corner += 1
        flight.run(5.0)
    return flight.elapsed_s / (time.process_time() - begin)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--runs", type=int, default=5)
    asked = parser.parse_args()
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    print(f"simulated seconds per CPU second, {asked.runs} runs, load {load:.1f}")
    for personality in PERSONALITIES:
        for name, weather in (("clear", CLEAR), ("rough", ROUGH)):
            runs = [speed(personality, weather, asked.seconds) for _ in range(asked.runs)]
            print(
                f"  {personality:10} {name:6} best {max(runs):6.1f}"
                f"  median {statistics.median(runs):6.1f}"
            )


if __name__ == "__main__":
    main()
