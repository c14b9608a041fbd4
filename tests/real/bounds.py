"""What the facts say of the policy's bounds: how far a stop went, beside what is predicted for it.

A stop from v is predicted to take v * react_s + v^2 / (2 a_brake).  Judged by what a gate knows:
the vehicle's own speed.  How far its own position was from the truth meanwhile is position_error.
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


Group = tuple[str, tuple[str, ...], Callable[[Fact], bool]]
GROUPS: tuple[Group, ...] = (
    ("a_brake_h_m_s2", ("steady",), lambda fact: fact["direction"] not in ("up", "down")),
    ("a_brake_h_m_s2", ("gaining",), lambda fact: fact["direction"] not in ("up", "down")),
    ("a_brake_h_m_s2", ("slowing",), lambda fact: fact["direction"] not in ("up", "down")),
    ("a_brake_v_m_s2 up", ("steady", "gaining"), lambda fact: fact["direction"] == "up"),
    ("a_brake_v_m_s2 down", ("steady", "gaining"), lambda fact: fact["direction"] == "down"),
)
SLOW_M_S = 2.0
"""Below it a PX4's wandering, and what a vehicle that leans still gains, are more than the stop."""


def report() -> str:
    """A line for each of the policy's bounds: how many stops, and the worst of seen / predicted."""
    lines = []
    for personality in ("px4", "ardupilot"):
        braking = DEFAULT.braking_of(personality)
        for name, kinds, chosen in GROUPS:
            records = [f for f in facts(personality) if f["kind"] in kinds and chosen(f)]
            if not records:
                continue
            level = "_h_" in name
            brake = braking.a_brake_h_m_s2 if level else braking.a_brake_v_m_s2
            error = braking.position_error_h_m if level else braking.position_error_v_m
            lines.append(f"[braking.{personality}] {name} {brake}, react_s {braking.react_s}:")
            for few, part in (
                (f"from {SLOW_M_S} m/s", [f for f in records if f["estimated_m_s"] >= SLOW_M_S]),
                ("slower", [f for f in records if f["estimated_m_s"] < SLOW_M_S]),
            ):
                if part:
                    told = judged(part, braking.react_s, brake, error)
                    lines.append(f"    {'+'.join(kinds):15s} {few:13s} {told}")
    return "\n".join(lines)


def judged(records: list[Fact], react: float, brake: float, error: float) -> str:
    def share(fact: Fact) -> float:
        speed = max(0.1, fact["estimated_m_s"])
        return float(fact["stop_m"]) / (way(speed, react, brake) + error)

    worst = max(records, key=share)
    pairs = [(f["estimated_m_s"], f["stop_m"] - error) for f in records]
    fitted, fitted_brake = fit(pairs, 0.05, max(speed for speed, _ in pairs))
    return (
        f"{len(records):3d} stops, worst {share(worst):.2f} of what is predicted"
        f" ({worst['stop_m']} m from {worst['estimated_m_s']} m/s {worst['direction']});"
        f" {fitted:.2f} s and {fitted_brake:.2f} m/s2 hold all, with 5 %"
    )
