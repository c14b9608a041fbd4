"""An airframe file that cannot be used says which key, what is wrong and what would be right."""

from __future__ import annotations

from importlib import resources
from math import sqrt

import pytest

from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.plant.airframe import AirframeError, load, parse, shipped

GOOD = (
    resources.files("vehicle_sim.plant")
    .joinpath("airframes", "s500.toml")
    .read_text(encoding="utf-8")
)


def changed(old: str, new: str) -> str:
    assert old in GOOD
    return GOOD.replace(old, new)


def test_what_is_shipped_is_what_its_class_is() -> None:
    assert shipped() == ("racer250", "s500", "sih")
    racer, s500 = load("racer250"), load("s500")
    for airframe, light, heavy, low, high in ((racer, 0.55, 0.75, 5, 8), (s500, 1.2, 1.8, 2, 3)):
        weight_n = airframe.body.mass_kg * GRAVITY_M_S2
        assert light <= airframe.body.mass_kg <= heavy
        assert low <= 4.0 * airframe.motors.thrust_max_n / weight_n <= high
    assert load() == s500
    assert racer.name == "racer250"


def test_the_airframe_of_px4s_simulation_is_the_one_that_a_px4_listed() -> None:
    """SIH_* as PX4 1.14.3 told them (px4_1_14_params.json)."""
    sih = load("sih")
    body, motors = sih.body, sih.motors
    assert sih.name == "sih"
    assert body.mass_kg == 1.0  # SIH_MASS
    # SIH_IXX, SIH_IYY, SIH_IZZ
    assert (body.inertia_xx_kg_m2, body.inertia_yy_kg_m2, body.inertia_zz_kg_m2) == (
        0.025,
        0.025,
        0.03,
    )
    assert (motors.arm_right_m, motors.arm_forward_m) == (0.2, 0.2)  # SIH_L_ROLL, SIH_L_PITCH
    assert motors.thrust_max_n == 5.0  # SIH_T_MAX
    assert motors.torque_per_thrust_m * motors.thrust_max_n == pytest.approx(0.1)  # SIH_Q_MAX
    assert motors.time_constant_s == 0.05  # SIH_T_TAU


def test_the_airframe_of_px4s_simulation_drags_as_that_by_its_speed() -> None:
    """SIH_KDV = 1 N s/m: here between that of hovering rotors and that of rotors at full speed."""
    sih = load("sih")
    hover = sqrt(sih.body.mass_kg * GRAVITY_M_S2 / (4.0 * sih.motors.thrust_max_n))
    full_n_s_per_m = 4.0 * sih.motors.rotor_drag_n_s_per_m
    assert full_n_s_per_m * hover < 1.0 < full_n_s_per_m
    assert sih.body.drag_n_per_m2_s2 * 10.0**2 <= 0.02 * 10.0  # at 10 m/s: the square is nothing


def test_a_file_of_ones_own_is_parsed_from_its_text() -> None:
    mine = parse(changed("mass_kg = 1.5", "mass_kg = 1.9"), "mine.toml")
    assert mine.body.mass_kg == 1.9


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('colour = "red"', r"x\.toml: unknown key 'colour'$"),
        ("[motor]", r"x\.toml: unknown key 'motor'; did you mean 'motors'\?"),
        ('name = "x"', r"x\.toml: section \[body\] is missing"),
        ("\nmass = =", r"x\.toml: .*line 2"),
        (
            changed("mass_kg = 1.5", "mass = 1.5"),
            r"\[body\] unknown key 'mass'; did you mean 'mass_kg'\?",
        ),
        (changed("friction = 0.7", ""), r"\[gear\] friction is missing"),
        (changed("= 0.055", "= 0.070"), r"\[body\] inertia: .* 0\.07, .* 0\.058; no body"),
        (changed("= 8.5", "= 3.0"), r"\[motors\] thrust_max_n: four times 3 N cannot .* 4\.41 N"),
        (changed("idle = 0.08", "idle = 8"), r"\[motors\] idle is a part of full speed, not 8"),
    ],
)
def test_what_is_wrong_is_named(text: str, says: str) -> None:
    with pytest.raises(AirframeError, match=says):
        parse(text, "x.toml")


@pytest.mark.parametrize("value", ["0", "-1.0", '"much"', "true", "nan", "inf"])
def test_a_mass_must_be_a_positive_number(value: str) -> None:
    with pytest.raises(AirframeError, match=r"\[body\] mass_kg must be a positive number, is"):
        parse(changed("mass_kg = 1.5", f"mass_kg = {value}"), "x.toml")


def test_an_airframe_that_is_not_shipped_is_named_beside_those_that_are() -> None:
    with pytest.raises(AirframeError, match="'x9000' is shipped; there are racer250, s500, sih"):
        load("x9000")
