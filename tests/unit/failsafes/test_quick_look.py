"""The failsafes' quick look: nominal in a good flight, and at each threshold no more.

That it misses nothing in a flight is `test_quiet.py`; here are the numbers.
"""

from __future__ import annotations

import pytest

from tests.unit.failsafes.failsafe_inputs import (
    BAD,
    CHARGES,
    EKF_LIMIT,
    FULL,
    LOW_V,
    VOLTAGES,
    WELL,
    Look,
    S,
)
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.plant.sensed import Sensed


def _good(look: Look) -> tuple[Sensed, Estimated]:
    """Blocks in which nothing is wrong; the checks have looked once since arming."""
    look.sees()
    sensed = Sensed(battery_v=16.6, battery_a=0.0, battery_used_mah=100.0)
    return sensed, Estimated(age_s=10.0, placed=True, accuracy_m=0.4)


def _nominal(look: Look, sensed: Sensed, est: Estimated, sticks_lost: bool = False) -> bool:
    return look.checks.nominal(look.seen.wall_ns, sensed, est, sticks_lost)


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_the_quick_look_sees_a_good_flight_and_each_thing_that_is_wrong(
    personality: Personality,
) -> None:
    look = Look(personality)
    sensed, est = _good(look)
    assert _nominal(look, sensed, est)
    assert not _nominal(look, sensed, est, sticks_lost=True)
    est.dead_s = 5.0
    assert not _nominal(look, sensed, est)
    est.dead_s = 0.0
    look.checks.station_heard(look.seen.wall_ns)
    silent_ns = 10 * S if personality == "px4" else 5 * S
    assert look.checks.nominal(look.seen.wall_ns + silent_ns - 1, sensed, est, False)
    assert not look.checks.nominal(look.seen.wall_ns + silent_ns, sensed, est, False)
    look.checks.reset()
    assert not _nominal(look, sensed, est), "just armed"


def test_the_quick_look_knows_px4s_thresholds() -> None:
    look = Look("px4")
    sensed, est = _good(look)
    est.accuracy_m = 5.0
    assert _nominal(look, sensed, est)
    est.accuracy_m = 5.01
    assert not _nominal(look, sensed, est)
    look.parameters.set("COM_POS_FS_EPH", -1.0)
    assert _nominal(look, sensed, est)
    look.parameters.set("COM_POS_FS_EPH", 0.0)
    assert not _nominal(look, sensed, est)
    look.parameters.set("COM_POS_FS_EPH", 6.0)
    # 15 % of a lithium-polymer cell's charge is 3.65 V at rest.
    sensed.battery_v = 4 * 3.66
    assert _nominal(look, sensed, est)
    sensed.battery_v = 4 * 3.649
    assert not _nominal(look, sensed, est)
    sensed.battery_a = 4 * 0.02 / look.believed.resistance_ohm
    assert _nominal(look, sensed, est), "under load it sags"
    look.parameters.set("BAT1_CAPACITY", 5000.0)
    assert not _nominal(look, sensed, est), "by the charge drawn, which takes a closer look"


def test_the_quick_look_knows_ardupilots_thresholds() -> None:
    look = Look("ardupilot", VOLTAGES | CHARGES)
    sensed, est = _good(look)
    assert _nominal(look, sensed, est)
    sensed.battery_v = 13.99
    assert not _nominal(look, sensed, est)
    sensed.battery_v, sensed.battery_used_mah = 14.0, 4000.0
    assert _nominal(look, sensed, est)
    sensed.battery_used_mah = 4000.1
    assert not _nominal(look, sensed, est)
    sensed.battery_used_mah = 0.0
    for name in ("vel_ratio", "pos_ratio", "mag_ratio"):
        setattr(est, name, 0.79)
        assert _nominal(look, sensed, est)
        setattr(est, name, EKF_LIMIT)
        assert not _nominal(look, sensed, est)
        look.parameters.set("FS_EKF_THRESH", 0.0)
        assert _nominal(look, sensed, est)
        look.parameters.set("FS_EKF_THRESH", 0.8)
        setattr(est, name, 0.0)
    look.parameters.set("SIM_BATT_VOLTAGE", 15.0)
    assert not _nominal(look, sensed, est), "what SIM_BATT_VOLTAGE says is not in the sensors"


def test_the_quick_look_goes_on_looking_while_a_low_voltage_or_a_bad_estimate_is_counted() -> None:
    look = Look("ardupilot", VOLTAGES)
    sensed, est = _good(look)
    look.sees(power=LOW_V)
    assert not _nominal(look, sensed, est)
    look.sees(power=FULL)
    assert _nominal(look, sensed, est)
    look.sees(health=BAD)
    assert not _nominal(look, sensed, est)
    look.sees(health=WELL)
    assert _nominal(look, sensed, est)
