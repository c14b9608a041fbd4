"""What the facts say of the policy's bounds: how far a stop went, beside what is predicted for it.

A stop from v is predicted to take v * react_s + v^2 / (2 a_brake).  Judged by what a gate knows: the
vehicle's own speed.  How far its own position was from the truth meanwhile is position_error.
"""

import json
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from gcs.gate.policy.parse import DEFAULT

FACTS = Path(__file__).parent / "facts"
Fact = dict[str, Any]


def facts(personality: str) -> list[Fact]:
    path = FACTS / f"{personality}.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def way(speed: float, react: float, brake: float) -> float:
    return speed * react + speed * speed / (2.0 * brake)


def fit(pairs: Iterable[tuple[float, float]], room: float, top: float) -> tuple[float, float]:
    """react_s and a_brake that cover every (speed, way) with a share of room, and predict least.

    Least is the mean over all speeds up to `top`.
    """
    wanted = [(speed, metres * (1.0 + room)) for speed, metres in pairs if speed > 0.0]
    best = (float("inf"), 0.0, 0.0)
    for tenths in range(2, 61):
        react = 0.05 * tenths
        # The braking that each needs beside this reaction.
        needed = [s * s / (2.0 * (m - s * react)) for s, m in wanted if m > s * react]
        brake = min([*needed, 9.81])
        mean = sum(way(top * i / 20, react, brake) for i in range(1, 21)) / 20
        best = min(best, (mean, react, brake))
    return best[1], best[2]


def judged(records: list[Fact], predict: Callable[[float], float]) -> tuple[int, float, Fact]:
    """How many, and the worst share of what is predicted that was seen."""
    shares = [(r["estimated_stop_m"] / predict(r["estimated_m_s"]), i) for i, r in enumerate(records)]
    worst, index = max(shares)
    return len(records), worst, records[index]
