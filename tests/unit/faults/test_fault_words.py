"""Faults as sentences."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from vehicle_sim.simulation.fault_script import KINDS, fault_of

KEYS: dict[str, Mapping[str, object]] = {
    "motor": {"motor": 1},
    "payload": {"mass_kg": -0.5},
    "thrust": {"scale": 0.9},
    "inertia": {"scale": 1.5},
    "clock_jump": {"by_s": -2.5},
}


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_and_its_end_is_a_sentence(kind: str) -> None:
    fault = fault_of(kind, KEYS.get(kind, {}), "test")
    for each in (fault, fault.ended()):
        if each is not None:
            words = each.described()
            assert "(" not in words.split(" (")[0]
            assert "=" not in words
            assert "-0 " not in words + " "


@pytest.mark.parametrize(
    ("kind", "keys", "sentence"),
    [
        (
            "wind",
            {"wind_ned_m_s": [4.0, -0.0, 0.0], "gust_m_s": 1.5},
            "the wind is 4 m/s from 180 degrees, with gusts of 1.5 m/s",
        ),
        ("wind", {}, "no wind"),
        (
            "gps_glitch",
            {"offset_ned_m": [-0.0, 3.0, 0.0]},
            "every GPS fix is off by 0, 3, 0 m (north, east, down)",
        ),
        ("motor", {"motor": 2, "health": 0.4}, "motor 2 gives 40 % of its thrust"),
        ("link", {"loss": 0.3, "delay_s": 0.2}, "every link loses 30 %, delays by 0.2 s, +-0 s"),
        ("link", {"out": True, "link": 1, "direction": "in"},
         "link 1 loses everything towards the vehicle"),
        ("clock_jump", {"by_s": -2.5}, "the clock jumps by -2.5 s"),
    ],
)  # fmt: skip
def test_a_sentence_has_the_numbers_and_their_units(
    kind: str, keys: Mapping[str, object], sentence: str
) -> None:
    assert fault_of(kind, keys, "test").described() == sentence
