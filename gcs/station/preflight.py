"""The answer to `ipc.Preflight`: what is known of a vehicle, and what the station knows of itself.

Where the policy asks for it (`[arming] preflight`), the gate of each vehicle on the ground hears
which rows fail.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final

from gcs import ipc
from gcs.config import DISK_CRITICAL_BYTES, DISK_LOW_BYTES
from gcs.gate.condition import Condition
from gcs.gate.refusal import Refusal
from gcs.session.work import Work, condition
from gcs.vehicle.gate_port import NOT_FLYING
from gcs.vehicle.preflight import OF_ROWS, Found, Known, Verdict, known, row, rows, worst
from gcs.vehicle.vehicle import Vehicle

EARLIEST_YEAR: Final = 2023
"""A clock that shows an earlier one was never set."""


YEAR_NS: Final = 31_556_952_000_000_000
"""On average."""


@dataclass(frozen=True, slots=True)
class Itself:
    """What only the station knows."""

    now_ns: int
    recording: bool
    log_path: str
    free_bytes: int | None = None
    """On the disk of the record; None: not known yet."""
    arm_requires_recording: bool = False


def _recorder(own: Itself, _seen: Known | None) -> Found:
    if own.recording:
        return Found(Verdict.PASS, own.log_path)
    bad = Verdict.FAIL if own.arm_requires_recording else Verdict.CAUTION
    return Found(bad, "nothing is recorded: a folder that can be written, with room: --log-dir")


def _disk(own: Itself, _seen: Known | None) -> Found:
    if own.free_bytes is None:
        sentence = "its room is not known"
        return Found(Verdict.CAUTION, sentence, waits=own.recording)
    words = f"{own.free_bytes / 1e9:.1f} GB are free"
    if own.free_bytes < DISK_CRITICAL_BYTES:
        return Found(Verdict.FAIL, f"{words}: the record would end in flight; make room")
    if own.free_bytes < DISK_LOW_BYTES:
        return Found(Verdict.CAUTION, f"{words}: make room")
    return Found(Verdict.PASS, words)


def _clock(own: Itself, seen: Known | None) -> Found:
    bad = None if seen is None else worst(seen, OF_ROWS["clock"])
    if bad is not None:
        return bad
    year = 1970 + own.now_ns // YEAR_NS
    if year < EARLIEST_YEAR:
        return Found(Verdict.CAUTION, f"this computer is in {year}: set it, the record is dated so")
    return Found(Verdict.PASS, f"no tick is late, and this computer is in {year}")


def _others(_own: Itself, seen: Known | None) -> Found:
    bad = None if seen is None else worst(seen, OF_ROWS["other stations"])
    return bad or Found(Verdict.PASS, "none with this station's number")


CHECKS: Final[dict[str, Callable[[Itself, Known | None], Found]]] = {
    "other stations": _others,
    "recorder": _recorder,
    "disk": _disk,
    "clock": _clock,
}
"""What is looked at of the station."""


def report(
    asked: ipc.Preflight, vehicle: Vehicle, refusal: Refusal | None, own: Itself
) -> ipc.PreflightReport:
    """Every row; `refusal` says why nothing can be asked of the vehicle that was named."""
    seen = known(vehicle, own.now_ns) if refusal is None else None
    if refusal is None:
        refusal = vehicle.refusal(own.now_ns)
    if seen is None or vehicle.telemetry is None or refusal is not None:
        sentence = "none is heard" if refusal is None else refusal.sentence
        first = [row("vehicle", Found(Verdict.FAIL, sentence, waits=True))]
        return ipc.PreflightReport(asked.id, [*first, *_rows(own, seen)])
    return ipc.PreflightReport(
        asked.id,
        [*rows(seen), *_rows(own, seen)],
        vehicle.telemetry.sysid,
        [list(names) for names in seen.stops.unread],
        seen.mission_told and bool(seen.mission_unverified) and not seen.mission_refused,
    )


def before_arming(vehicle: Vehicle, own: Itself) -> list[Work]:
    """For the gate, where other rows fail than it was told: which, and why.

    In the air nothing is failing: what matters there the gate hears by itself.
    """
    seen = known(vehicle, own.now_ns)
    if seen is None:
        return []
    failing = [
        each
        for each in (*rows(seen), *_rows(own, seen))
        if each.verdict == Verdict.FAIL and vehicle.gate.state in NOT_FLYING
    ]
    names = tuple(each.name for each in failing)
    if names == vehicle.failing:
        return []
    vehicle.failing = names
    text = "; ".join(f"{each.name}: {each.sentence}" for each in failing)
    return [condition(Condition.PREFLIGHT_FAILED, bool(failing), text)]


def _rows(own: Itself, seen: Known | None) -> Iterator[ipc.PreflightRow]:
    return (row(name, judge(own, seen)) for name, judge in CHECKS.items())
