"""Reduce a real autopilot's log of a flight to its figures.

    python -m tests.scenarios.flights.reduce px4 LOG.tlog

The log's times are those of the recorder's clock, which a slow simulation falls behind; they are
made the vehicle's own by the messages that carry it.
"""

from __future__ import annotations

import sys
from bisect import bisect
from pathlib import Path
from typing import Any, Final, cast

import msgspec
from pymavlink import mavutil

from tests.scenarios.flights.facts import FOLDER, Timed, reduced
from tests.scenarios.flights.script import ENDS_S
from vehicle_sim.autopilot.modes import Personality

DATED: Final = ("ATTITUDE", "LOCAL_POSITION_NED", "SYSTEM_TIME")


def main(personality: str, log: str) -> None:
    played = cast(Personality, personality)
    raw = list(_messages(log))
    clock = [(t, own_s) for t, message in raw if (own_s := _own_s(message)) is not None]
    told = [Timed(_mapped(clock, t), message) for t, message in raw]
    kept = [each for each in told if each.t < ENDS_S[played]]
    flight = reduced(played, Path(log).name, kept)
    text = msgspec.json.format(msgspec.json.encode(flight), indent=0).decode()
    FOLDER.mkdir(exist_ok=True)
    (FOLDER / f"{played}.json").write_text(_by_rows(text) + "\n", encoding="utf-8")


def _messages(log: str) -> list[tuple[float, Any]]:
    reader = mavutil.mavlink_connection(log, dialect="all")
    read: list[tuple[float, Any]] = []
    while (message := reader.recv_msg()) is not None:
        if message.get_type() != "BAD_DATA":
            read.append((message._timestamp, message))
    return read


def _own_s(message: Any) -> float | None:
    """The vehicle's own time, where the message was sent at once."""
    if message.get_type() == "TIMESYNC" and message.tc1 == 0:
        return float(message.ts1) / 1e9
    if message.get_type() in DATED:
        return float(message.time_boot_ms) / 1e3
    return None


def _mapped(clock: list[tuple[float, float]], t: float) -> float:
    """Between two readings of the vehicle's clock, or as long after one as the recorder says."""
    after = min(max(bisect(clock, (t,)), 1), len(clock) - 1)
    (t0, own0), (t1, own1) = clock[after - 1], clock[after]
    if not t0 < t < t1:
        return t - t0 + own0 if t <= t0 or t1 <= t0 else t - t1 + own1
    return own0 + (t - t0) * (own1 - own0) / (t1 - t0)


def _by_rows(text: str) -> str:
    """A row a line."""
    return (
        text.replace(",\n", ", ").replace("[\n", "[").replace("\n]", "]").replace("], [", "],\n[")
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
