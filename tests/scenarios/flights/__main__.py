"""Play the recorded flights to our vehicle and print both beside each other.

python -m tests.scenarios.flights                 both autopilots
python -m tests.scenarios.flights px4             one
python -m tests.scenarios.flights px4 real        with the sensors of `--sensors real`
"""

from __future__ import annotations

import sys
from typing import get_args

from tests.scenarios.flights.agree import compare, lines
from tests.scenarios.flights.facts import recorded
from tests.scenarios.flights.known import KNOWN
from tests.scenarios.flights.play import played
from vehicle_sim.autopilot.modes import Personality


def main(words: list[str]) -> None:
    personalities: list[Personality] = [p for p in get_args(Personality) if p in words]
    for personality in personalities or get_args(Personality):
        real = recorded(personality)
        ours = played(personality, "real" if "real" in words else "good")
        found = compare(personality, real, ours)
        print(f"{personality}: {real.source} and ours")
        print("\n".join(lines(found)))
        print("  what differs:")
        for line in found.differences:
            print(f"    {line}  ({KNOWN[personality].get(line, 'NEW')})")
        for line in KNOWN[personality].keys() - set(found.differences):
            print(f"    gone: {line}")


if __name__ == "__main__":
    main(sys.argv[1:])
