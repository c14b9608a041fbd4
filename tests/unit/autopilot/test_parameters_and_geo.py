"""Parameters are checked and read live; projections agree with the ellipsoid's answers roughly."""

from __future__ import annotations

from math import cos, inf, nan, radians

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.unit.autopilot.flight import HOMES, Flight
from vehicle_sim.autopilot.geo import projection
from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import ParameterError, Parameters, Quantity
from vehicle_sim.autopilot.parameters.tables import TABLES

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)


@either
def test_every_default_is_a_value_that_the_parameter_takes(personality: Personality) -> None:
    parameters = Parameters(personality)
    for spec in parameters.specs:
        value = parameters.value(spec.name)
        assert parameters.set(spec.name, value) == value
        assert len(spec.name) <= 16
    assert parameters.version == 0


@either
def test_the_table_is_sorted_as_parameters_are_listed(personality: Personality) -> None:
    names = [spec.name for spec in TABLES[personality]]
    assert names == sorted(names)
    assert len(names) >= 60


@either
def test_every_quantity_has_a_value(personality: Personality) -> None:
    parameters = Parameters(personality)
    assert all(parameters.si(quantity) >= 0.0 for quantity in Quantity)


def test_centimetres_become_metres() -> None:
    parameters = Parameters("ardupilot")
    parameters.set("RTL_ALT", 2000)
    assert parameters.si(Quantity.RETURN_UP_M) == pytest.approx(20.0)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("NO_SUCH", 1.0),
        ("MPC_XY_CRUISE", nan),
        ("NAV_DLL_ACT", 1.5),
        ("NAV_DLL_ACT", 2.0**31),
    ],
)
def test_a_value_that_it_does_not_take_is_refused_and_the_old_one_stays(
    name: str, value: float
) -> None:
    parameters = Parameters("px4")
    before = [parameters.get(spec.name) for spec in parameters.specs]
    with pytest.raises(ParameterError, match=name):
        parameters.set(name, value)
    assert [parameters.get(spec.name) for spec in parameters.specs] == before


@pytest.mark.parametrize(
    ("personality", "name", "value", "in_use"),
    [
        ("px4", "MPC_XY_CRUISE", inf, 20.0),
        ("px4", "MPC_XY_CRUISE", 1e39, 20.0),
        ("px4", "MPC_XY_CRUISE", -5.0, 0.5),
        ("px4", "GF_ACTION", 99.0, 5.0),
        ("px4", "COM_DL_LOSS_T", -7.0, 5.0),
        ("ardupilot", "WPNAV_SPEED", 99999.0, 2000.0),
        ("ardupilot", "FENCE_ACTION", 99.0, 5.0),
    ],
)
def test_a_value_out_of_bounds_is_told_as_it_was_set_and_the_nearest_one_acts(
    personality: Personality, name: str, value: float, in_use: float
) -> None:
    parameters = Parameters(personality)
    parameters.set(name, value)
    assert parameters.value(name) == (inf if value == 1e39 else value)
    assert parameters.get(name) == in_use


def test_a_changed_speed_acts_at_once() -> None:
    flight = Flight.hovering("px4", 5.0)
    flight.vehicle.reposition((80.0, 0.0, -5.0), None, None)
    flight.fly(4.0)
    flight.vehicle.parameters.set("MPC_XY_CRUISE", 2.0)
    flight.fly(3.0)
    assert flight.speed_m_s == pytest.approx(2.0, abs=0.2)


@either
@given(st.floats(-5000.0, 5000.0), st.floats(-5000.0, 5000.0), st.floats(-500.0, 500.0))
def test_there_and_back_is_the_same_place(
    personality: Personality, north: float, east: float, down: float
) -> None:
    there = projection(personality, HOMES[personality])
    assert there.to_local(there.to_geodetic((north, east, down))) == pytest.approx(
        (north, east, down), abs=1e-3
    )


@either
def test_a_thousandth_of_a_degree_is_a_hundred_and_eleven_metres(personality: Personality) -> None:
    home = HOMES[personality]
    there = projection(personality, home)
    north, _, _ = there.to_local(Geodetic(home.lat_deg + 0.001, home.lon_deg, home.alt_amsl_m))
    _, east, _ = there.to_local(Geodetic(home.lat_deg, home.lon_deg + 0.001, home.alt_amsl_m))
    length = {"px4": radians(0.001) * 6_371_000.0, "ardupilot": 1e4 * 0.011131884502145034}
    assert north == pytest.approx(length[personality], rel=1e-9)
    assert east == pytest.approx(length[personality] * cos(radians(home.lat_deg)), rel=1e-6)


def test_ardupilots_longitude_wraps_at_the_date_line() -> None:
    there = projection("ardupilot", Geodetic(0.0, 179.9999, 0.0))
    _, east, _ = there.to_local(Geodetic(0.0, -179.9999, 0.0))
    assert east == pytest.approx(2000 * 0.011131884502145034, rel=1e-6)
