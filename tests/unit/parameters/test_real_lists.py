"""Every parameter beside the list that the real autopilot sent.

The lists are facts, in `real_*.json` here: value and MAV_PARAM_TYPE of a PX4 1.14.3 and of an
ArduCopter 4.7.0-dev in their own simulations, of the parameters that this vehicle has too.
"""

from __future__ import annotations

import json
import struct
from pathlib import Path

import pytest

from vehicle_sim.autopilot.firmware import Firmware
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.autopilot.parameters.tables import RENAMED
from vehicle_sim.autopilot.parameters.tables.deliberate import DELIBERATE, NOT_LISTED

LISTS: dict[Personality, tuple[Firmware, str]] = {
    "px4": ("1.14", "real_px4_1_14.json"),
    "ardupilot": ("4.7", "real_arducopter_4_7.json"),
}
COUNTS = {
    "px4": {"equal": 532, "deliberate": 3, "not in the list": 1},
    "ardupilot": {"equal": 598, "deliberate": 4, "not in the list": 9},
}
either = pytest.mark.parametrize("personality", list(LISTS))


def real(personality: Personality) -> dict[str, tuple[float, int]]:
    file = Path(__file__).parent / LISTS[personality][1]
    read = json.loads(file.read_text())
    return {name: (float(value), int(kind)) for name, (value, kind) in read["parameters"].items()}


def shown(personality: Personality, canonical: str) -> str:
    renamed = RENAMED.get(LISTS[personality][0], {}).get(canonical)
    return canonical if renamed is None else renamed.new


def float32(value: float) -> float:
    return float(struct.unpack("<f", struct.pack("<f", value))[0])


@either
def test_every_default_is_the_real_one_or_has_a_reason(
    personality: Personality, capsys: pytest.CaptureFixture[str]
) -> None:
    listed = real(personality)
    ours = Parameters(personality, LISTS[personality][0])
    deliberate = {shown(personality, name): row for name, row in DELIBERATE[personality].items()}
    missing = {shown(personality, name) for name in NOT_LISTED[personality]}
    found: dict[str, list[str]] = {"equal": [], "deliberate": [], "not in the list": []}
    for spec in ours.specs:
        told = ours.value(spec.name)
        if spec.name not in listed:
            assert spec.name in missing, f"{spec.name} is not in the real list, without a reason"
            found["not in the list"].append(spec.name)
        elif spec.name in deliberate:
            own, _ = deliberate[spec.name]
            assert told == float32(own) != listed[spec.name][0], spec.name
            found["deliberate"].append(spec.name)
        else:
            assert told == pytest.approx(listed[spec.name][0], rel=2e-6, abs=1e-9), spec.name
            found["equal"].append(spec.name)
    counts = {what: len(names) for what, names in found.items()}
    with capsys.disabled():
        print(f"\n{personality}: {counts}")
    assert counts == COUNTS[personality]
    assert set(found["deliberate"]) == set(deliberate)
    assert set(found["not in the list"]) == missing


@either
def test_every_type_is_the_real_one(personality: Personality) -> None:
    listed = real(personality)
    ours = Parameters(personality, LISTS[personality][0])
    told = {spec.name: int(spec.stored_as) for spec in ours.specs if spec.name in listed}
    assert told == {name: kind for name, (_, kind) in listed.items()}


@either
def test_every_difference_says_why(personality: Personality) -> None:
    reasons = [why for _, why in DELIBERATE[personality].values()]
    reasons += NOT_LISTED[personality].values()
    assert all(len(why) > 15 for why in reasons)


@either
def test_what_is_inert_has_the_real_default(personality: Personality) -> None:
    ours = Parameters(personality)
    deliberate = DELIBERATE[personality]
    inert = [spec.name for spec in ours.specs if spec.inert]
    assert len(inert) > 400
    assert not set(inert) & set(deliberate)
