"""The control line: one JSON object asks, one answers; whatever comes, it never raises."""

from __future__ import annotations

import json

import pytest

from tests.unit.faults.stage import Stage
from vehicle_sim.simulation.control_line import LINE_MAX, Lines, answer


def ask(stage: Stage, **words: object) -> dict[str, object]:
    line = answer(json.dumps(words).encode(), stage.world)
    assert line.endswith(b"\n")
    told = json.loads(line)
    assert isinstance(told, dict)
    return told


def test_a_fault_strikes_and_is_mended() -> None:
    stage = Stage("px4")
    sensed = stage.vehicle.blocks.sensed
    assert ask(stage, id=1, do="fault", kind="gps_lost", keys={}, vehicle=1) == {"id": 1}
    assert sensed.gps_lost
    assert ask(stage, id=2, do="mend", kind="gps_lost", keys={}, vehicle=1) == {"id": 2}
    assert [sensed.gps_lost] == [False]


@pytest.mark.parametrize("vehicle", [1, None])
def test_a_fault_that_is_not_there_is_not_mended(vehicle: int | None) -> None:
    """Motor 2 is not motor 3, a link that delays is a fault of its own, and a clock jumps back by
    as much as it jumped."""
    stage = Stage("px4")

    def mend(kind: str, **keys: object) -> object:
        return ask(stage, do="mend", kind=kind, keys=keys, vehicle=vehicle).get("error")

    assert mend("gps_lost") == "gps_lost: no such fault to mend; there are: none"
    for kind, keys in (
        ("motor", {"motor": 2}),
        ("link", {"delay_s": 0.5}),
        ("clock_jump", {"by_s": 2.0}),
        ("rc_lost", {}),
    ):
        assert "error" not in ask(stage, do="fault", kind=kind, keys=keys, vehicle=vehicle)
    assert mend("motor", motor=3) == (
        "motor: no such fault to mend; there are: motor 2 gives 0 % of its thrust; "
        "the clock jumps by 2 s; the sticks are lost; every link delays by 0.5 s, +-0 s"
    )
    assert str(mend("clock_jump", by_s=1.0)).startswith("clock_jump: no such fault to mend")
    for kind, keys in (
        ("motor", {"motor": 2}),
        ("link", {}),
        ("clock_jump", {"by_s": 2.0}),
        ("rc_lost", {}),
    ):
        assert mend(kind, **keys) is None
        assert str(mend(kind, **keys)).startswith(f"{kind}: no such fault to mend")


def test_truth_is_told_in_full() -> None:
    stage = Stage("ardupilot")
    stage.run(1.0)
    told = ask(stage, id=7, do="truth", vehicle=1)["truth"]
    assert isinstance(told, dict)
    assert told["time_s"] == pytest.approx(1.0)
    assert told["landed"] is True


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ({"do": "dance"}, "do: must be fault, mend or truth"),
        ({}, "do: must be fault, mend or truth"),
        ({"do": "fault"}, "kind: must be one of"),
        ({"do": "fault", "kind": "motor"}, "motor: is missing"),
        ({"do": "fault", "kind": "gps_lost", "keys": 3}, "keys: must be an object"),
        ({"do": "fault", "kind": "gps_lost", "vehicle": 9}, "vehicle 9: no such vehicle"),
        ({"do": "fault", "kind": "gps_lost", "vehicle": True}, "vehicle: must be a system id"),
        ({"do": "fault", "kind": "link", "keys": {"link": 5}}, "no such vehicle or link"),
        ({"do": "mend", "kind": "reboot"}, "reboot: does not last"),
        ({"do": "truth", "vehicle": 2}, "vehicle 2: no such vehicle"),
    ],
)
def test_what_cannot_be_done_is_said(words: dict[str, object], said: str) -> None:
    told = ask(Stage("px4"), id=3, **words)
    assert told["id"] == 3
    assert said in str(told["error"])


@pytest.mark.parametrize("line", [b"", b"no JSON", b"[1]", b"\xff\xfe", b'{"do": '])
def test_a_line_that_is_no_object_is_answered_all_the_same(line: bytes) -> None:
    told = json.loads(answer(line, Stage("px4").world))
    assert told["id"] is None
    assert told["error"]


def test_bytes_become_lines_however_they_are_cut() -> None:
    lines = Lines()
    assert lines.feed(b'{"a"') == []
    assert lines.feed(b': 1}\n\n{"b": 2}\n{') == [b'{"a": 1}', b'{"b": 2}']
    assert lines.feed(b"x" * (LINE_MAX + 1)) == []
    assert lines.feed(b"\n{}\n") == [b"{}"]
