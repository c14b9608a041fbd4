"""How much charge is left, of one battery and of several."""

from __future__ import annotations

import pytest

from gcs.vehicle.health.battery import MOST_AGE_NS, Charge
from gcs.wire.ids import BatteryFunction
from gcs.wire.messages import BatteryStatus, SysStatus

S = 1_000_000_000


def first(left_pct: int) -> SysStatus:
    return SysStatus(0, 0, 0, 0, 12_000, -1, 0, 0, 0, 0, 0, 0, left_pct)


def battery(
    number: int, left_pct: int, function: int = BatteryFunction.PROPULSION
) -> BatteryStatus:
    return BatteryStatus(0, 0, 0, (12_000,) * 10, 0, number, function, 1, left_pct)


def test_before_anything_is_told_nobody_knows() -> None:
    assert Charge().left_pct(0) is None


def test_the_first_battery_alone() -> None:
    charge = Charge()
    charge.system_status(first(80), S)
    assert charge.left_pct(2 * S) == 80.0
    charge.system_status(first(79), 2 * S)
    assert charge.left_pct(2 * S) == 79.0


def test_the_least_of_those_that_drive_motors() -> None:
    charge = Charge()
    charge.system_status(first(100), S)
    charge.battery_status(battery(0, 100), S)
    charge.battery_status(battery(1, 16), S)
    charge.battery_status(battery(2, 5, BatteryFunction.PAYLOAD), S)
    assert charge.left_pct(2 * S) == 16.0


def test_a_vehicle_that_tells_it_in_battery_status_alone() -> None:
    charge = Charge()
    charge.system_status(first(-1), S)
    charge.battery_status(battery(0, 90), S)
    assert charge.left_pct(2 * S) == 90.0


def test_what_it_does_not_know_any_more_counts_no_more() -> None:
    charge = Charge()
    charge.system_status(first(14), S)
    charge.system_status(first(-1), 2 * S)
    assert charge.left_pct(2 * S) is None


@pytest.mark.parametrize(("later_ns", "left_pct"), [(0, 60.0), (1, None)])
def test_what_was_told_long_ago_counts_no_more(later_ns: int, left_pct: float | None) -> None:
    charge = Charge()
    charge.system_status(first(60), S)
    assert charge.left_pct(S + MOST_AGE_NS + later_ns) == left_pct
