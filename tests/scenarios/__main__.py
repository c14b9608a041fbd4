"""Play every recorded scenario to our vehicle and print how far it agrees.

python -m tests.scenarios                    both autopilots
python -m tests.scenarios px4 H1 G2          those whose names begin so
python -m tests.scenarios --write            and note what differs in known_differences/
"""

from __future__ import annotations

import sys
from typing import get_args

from tests.scenarios.agree import Agreement, compare
from tests.scenarios.facts import recorded
from tests.scenarios.judged import by_judgement
from tests.scenarios.known import write
from tests.scenarios.play import play, playable
from vehicle_sim.autopilot.modes import Personality


def main(words: list[str]) -> None:
    personalities: list[Personality] = [p for p in get_args(Personality) if p in words]
    names = tuple(word for word in words if not word.startswith("--") and word not in personalities)
    for personality in personalities or get_args(Personality):
        total, found = Agreement(), dict[str, list[str]]()
        for name, scenario in recorded(personality).items():
            if not name.startswith(names or ("",)):
                continue
            if not playable(personality, scenario):
                print(f"{personality} {name}: not played")
                continue
            agreement = compare(scenario, play(personality, scenario))
            found[name], total = agreement.differences, total + agreement
            print(f"{personality} {name}: {agreement}", flush=True)
            if names:
                print("\n".join(f"    {line}" for line in agreement.differences))
        print(f"{personality}, {len(found)} scenarios: {total}")
        for judgement, number in by_judgement(personality, found).most_common():
            print(f"    {number} differences: {judgement.value}")
        if "--write" in words and not names:
            write(personality, found)


if __name__ == "__main__":
    main(sys.argv[1:])
