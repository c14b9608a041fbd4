"""/vehicle/N/phase: states of at least 0.4 s, for a state bar."""

from __future__ import annotations

import json

from gcs.record.derived import Derived
from gcs.record.derived.phase import Phases
from gcs.report import FsaItem, InputItem, RecordItem, StatusItem
from tests.unit.record.flights import MS, SECOND, START_NS
from tests.unit.record.viewer import fsa

WAKE = InputItem.of("Wake", {})


def bar(flight: list[tuple[int, RecordItem]], field: str = "state") -> list[tuple[int, str]]:
    """(ms, value) at every change of a field."""
    phases = Phases()
    found: list[tuple[int, str]] = []
    for at_ms, item in flight:
        for out in phases.handle(item, START_NS + at_ms * MS):
            value = json.loads(out.message).get(field, "")
            if not found or found[-1][1] != value:
                found.append((at_ms, value))
    return found


def every_50_ms(until_ms: int) -> list[tuple[int, RecordItem]]:
    return [(at_ms, WAKE) for at_ms in range(0, until_ms, 50)]


def test_a_state_of_milliseconds_does_not_name_the_long_one_after_it() -> None:
    """The demo's HOVERING of 10 ms before FLYING_MISSION."""
    changes: list[tuple[int, RecordItem]] = [
        (0, fsa("MOVING")),
        (1000, fsa("HOVERING")),
        (1010, fsa("FLYING_MISSION")),
    ]
    flight = sorted(changes + every_50_ms(3000), key=lambda one: one[0])
    assert bar(flight) == [(0, "MOVING"), (1450, "FLYING_MISSION")]


def test_a_state_that_stands_is_told_after_four_tenths_of_a_second() -> None:
    changes: list[tuple[int, RecordItem]] = [(0, fsa("MOVING")), (1000, fsa("HOLDING"))]
    flight = sorted(changes + every_50_ms(2000), key=lambda one: one[0])
    assert bar(flight) == [(0, "MOVING"), (1400, "HOLDING")]


def test_a_state_that_comes_back_at_once_was_never_left() -> None:
    changes: list[tuple[int, RecordItem]] = [
        (0, fsa("MOVING")),
        (1000, fsa("STALE")),
        (1300, fsa("MOVING")),
    ]
    assert bar(sorted(changes + every_50_ms(3000), key=lambda one: one[0])) == [(0, "MOVING")]


def test_mode_and_severity_are_debounced_by_themselves() -> None:
    def status(mode: str) -> StatusItem:
        return StatusItem(1, True, mode, "IN_AIR", None, None, 0.0, 0.0)

    changes: list[tuple[int, RecordItem]] = [
        (0, fsa("MOVING")),
        (0, status("OFFBOARD")),
        (1000, status("AUTO.LOITER")),
        (1200, status("AUTO.MISSION")),
    ]
    flight = sorted(changes + every_50_ms(3000), key=lambda one: one[0])
    assert bar(flight, "mode") == [(0, ""), (0, "OFFBOARD"), (1600, "AUTO.MISSION")]


def test_it_is_repeated_every_second_and_at_the_end_shows_the_last_state() -> None:
    derived = Derived()
    derived.handle(fsa("MOVING"), START_NS)
    repeated = [
        out
        for half in range(1, 7)
        for out in derived.tick(START_NS + half * SECOND // 2)
        if out.channel.topic.endswith("/phase")
    ]
    assert len(repeated) == 3
    derived.handle(fsa("GROUNDED"), START_NS + 3 * SECOND)
    last = [out for out in derived.close(START_NS + 3 * SECOND) if "phase" in out.channel.topic]
    assert [json.loads(out.message)["state"] for out in last] == ["GROUNDED"]


def test_each_vehicle_has_a_phase_of_its_own() -> None:
    phases = Phases()
    other = FsaItem(2, "HOVERING", 1, "", "", "OURS", "NOMINAL", None)
    outs = [*phases.handle(fsa("MOVING"), 1), *phases.handle(other, 1)]
    topics = {out.channel.topic for out in outs}
    assert topics == {"/vehicle/1/phase", "/vehicle/2/phase"}
