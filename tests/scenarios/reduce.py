"""Reduce a recording of a real autopilot's scenarios to what the tests compare.

    python -m tests.scenarios.reduce RECORDING.json OUT.json

A recording holds, for each scenario, what was sent step by step with its answer and what was seen
with its time.  Tracks and figures are left out, and what followed after the scenario's end (the
landing that prepared the next one).  PX4 numbers its texts from the start on: where the first one
of a scenario has a higher number, it was flown before.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any, Final

END: Final = "(end of scenario: landing)"
KEPT_OF_STEPS: Final = ("t", "sent", "frame", "params", "items", "ack", "ok")
KEPT_OF_EVENTS: Final = ("t", "kind", "mode", "armed", "n", "e", "up", "state", "text")
KINDS: Final = ("STATE_AT_START", "HEARTBEAT", "LANDED_STATE", "STATUSTEXT")


LATE_S: Final = 1.2
"""States come with heartbeats: those of the end are seen so much later."""


def _is_late(event: dict[str, Any]) -> bool:
    return bool(event["kind"] != "STATUSTEXT")


def reduced(scenario: dict[str, Any]) -> dict[str, Any]:
    events = scenario["events"]
    last = max((told["t"] for told in (*scenario["steps"], *events)), default=0.0)
    end_s = next((event["t"] for event in events if event["kind"] == END), last)
    numbers = [event["id"] for event in events if event["kind"] == "STATUSTEXT" and "id" in event]
    return {
        "scenario": scenario["scenario"],
        "what": scenario["what"],
        "end_s": end_s,
        "flown_before": any(number > 1 for number in numbers[:1]),
        "steps": [
            {
                key: _named(step[key]) if key == "ack" else step[key]
                for key in KEPT_OF_STEPS
                if key in step
            }
            for step in scenario["steps"]
            if step["t"] <= end_s
        ],
        "events": [
            {key: event[key] for key in KEPT_OF_EVENTS if key in event}
            for event in events
            if event["kind"] in KINDS and event["t"] <= end_s + (LATE_S if _is_late(event) else 0.0)
        ],
    }


def _named(ack: str | int | None) -> str | None:
    """A mission's answer is told as a number in some places."""
    return (
        "MAV_MISSION_ACCEPTED"
        if ack == 0
        else f"MAV_MISSION_RESULT {ack}"
        if isinstance(ack, int)
        else ack
    )


def main(recording: str, out: str) -> None:
    told = json.loads(Path(recording).read_text(encoding="utf-8"))
    scenarios = [reduced(scenario) for scenario in told["scenarios"]]
    lines = ",\n".join(json.dumps(scenario) for scenario in scenarios)
    autopilot = json.dumps(told["meta"]["autopilot"])
    Path(out).write_text(
        f'{{"autopilot": {autopilot}, "scenarios": [\n{lines}\n]}}\n', encoding="utf-8"
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
