"""What stopped the station on a real autopilot, and did not show on a vehicle that was too kind.

Each test is of a row of autopilots.md, "Defects of gcs".  That the vehicle does what was recorded
is tested in tests/unit: real boot in test_real_boot.py, the mode after disarming in
test_mode_after_disarming.py, altered items in test_altered_items.py.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from gcs.gate.states import State
from tests.loopback.flight import Flight, Personality

TAKEOFF_ENDS_LOW_M = 0.5
"""NAV_MC_ALT_RAD, 0.8 m, is how much PX4 1.14 may leave; recorded were 0.3 to 0.7 m."""

PITCHED = """\
QGC WPL 110
0\t1\t0\t16\t0\t0\t0\t0\t47.397742\t8.545594\t488\t1
1\t0\t3\t22\t15\t0\t0\tnan\t47.397742\t8.545594\t5\t1
2\t0\t3\t16\t0\t0\t0\tnan\t47.397832\t8.545594\t5\t1
3\t0\t3\t21\t0\t0\t0\tnan\t47.397832\t8.545594\t0\t1
"""


def test_a_take_off_that_ends_low_ends_at_the_height_that_was_asked_for() -> None:
    """The vehicle is put into AUTO.LOITER 0.5 m low, where PX4 ends its take-off."""
    flight = Flight("px4").connected()
    flight.do("arm")
    ask = flight.say("takeoff", up_m=3.0)
    flight.until(lambda: flight.truth_enu()[2] > 2.0)
    low_ned = (0.0, 0.0, -(3.0 - TAKEOFF_ENDS_LOW_M))
    flight.vehicle.reposition(low_ned, None, None)
    assert flight.done(ask) == "complete"
    assert flight.is_in(State.HOVERING)
    flight.run(3.0)
    assert flight.truth_enu()[2] == pytest.approx(3.0, abs=0.3)


def test_it_flies_again_after_a_landing() -> None:
    flight = Flight("px4").hovering(3.0)
    flight.do("land")
    flight.until(lambda: not flight.vehicle.armed)
    assert flight.vehicle.mode_name == "OFFBOARD"
    flight.run(2.0)
    flight.do("arm")


def test_a_mode_that_is_asked_for_on_the_ground_is_seen() -> None:
    flight = Flight("px4").hovering(3.0)
    flight.do("land")
    flight.until(lambda: not flight.vehicle.armed)
    flight.run(2.0)
    assert flight.done(flight.say("mode", mode="LOITER")) == "complete"
    assert flight.vehicle.mode_name == "AUTO.LOITER"


def test_a_plan_whose_take_off_has_a_pitch_is_flown(tmp_path: Path) -> None:
    path = tmp_path / "pitched.waypoints"
    path.write_text(PITCHED, encoding="utf-8")
    flight = Flight("px4").connected()
    flight.do("mission_upload", path=str(path))


def test_arm_waits_for_a_vehicle_that_starts_up(personality: Personality) -> None:
    """Asked 10 s after power-up."""
    flight = Flight(personality, boot="real")
    flight.run(10.0)
    assert flight.done(flight.say("arm"), 60.0) == "complete"
