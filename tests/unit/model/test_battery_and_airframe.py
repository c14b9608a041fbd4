"""The battery is spent by what is flown; an airframe file says what is wrong with it."""

from __future__ import annotations

import pytest

from vehicle_sim.model.airframe import AirframeError, load, parse
from vehicle_sim.model.battery import Battery


def test_current_over_time_is_charge() -> None:
    battery = Battery(load().battery)
    battery.draw(0.0, 0.0, 0.0, 0.0, 3600.0)
    assert battery.consumed_mah == pytest.approx(600.0)  # 0.6 A for an hour
    assert battery.remaining == pytest.approx(1.0 - 600.0 / 5000.0)


def test_a_heavier_load_sags_the_voltage_by_the_resistance() -> None:
    battery = Battery(load().battery)
    battery.draw(0.0, 0.0, 0.0, 0.0, 1e-6)
    idle_v, idle_a = battery.voltage_v, battery.current_a
    battery.draw(1.0, 1.0, 1.0, 1.0, 1e-6)
    assert idle_v - battery.voltage_v == pytest.approx(0.020 * (battery.current_a - idle_a))


def test_the_voltage_never_rises_while_it_is_drained() -> None:
    battery = Battery(load().battery)
    volts = []
    for _ in range(2000):
        battery.draw(0.67, 0.67, 0.67, 0.67, 1.0)
        volts.append(battery.voltage_v)
    assert volts == sorted(volts, reverse=True)
    assert battery.remaining == 0.0
    assert volts[-1] == pytest.approx(4 * 3.0 - battery.current_a * 0.020)


def test_an_unknown_key_is_named() -> None:
    with pytest.raises(AirframeError, match=r"x\.toml: unknown key 'colour'"):
        parse('colour = "red"', "x.toml")


def test_a_missing_section_is_named() -> None:
    with pytest.raises(AirframeError, match=r"section \[body\] is missing"):
        parse('name = "x"', "x.toml")


@pytest.mark.parametrize("value", ["0", "-1.0", '"much"', "true"])
def test_a_mass_must_be_a_positive_number(value: str) -> None:
    with pytest.raises(AirframeError, match="mass_kg must be a positive number"):
        parse(f"[body]\nmass_kg = {value}", "x.toml")


def test_broken_toml_is_told_with_its_line() -> None:
    with pytest.raises(AirframeError, match=r"x\.toml: .*line 2"):
        parse("\nmass = =", "x.toml")


def test_an_airframe_that_is_not_shipped_is_named() -> None:
    with pytest.raises(AirframeError, match="'x9000'"):
        load("x9000")
