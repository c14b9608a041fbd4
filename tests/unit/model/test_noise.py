"""Noise has no state: a number for every seed, vehicle, source and step."""

from __future__ import annotations

import pytest

from vehicle_sim.numerics.noise import bits, key_of, mix64, normal, uniform

DRAWS = 20_000


def test_normal_noise_is_centred_and_has_unit_variance() -> None:
    key = key_of(1, 0, 0)
    draws = [normal(key, step) for step in range(DRAWS)]
    mean = sum(draws) / DRAWS
    assert abs(mean) < 0.03
    assert sum((x - mean) ** 2 for x in draws) / DRAWS == pytest.approx(1.0, abs=0.03)
    assert max(map(abs, draws)) < 3.5


@pytest.mark.parametrize("shift", [0, 16, 32, 48])
def test_each_quarter_of_the_bits_is_even(shift: int) -> None:
    key = key_of(2, 5, 1)
    draws = [uniform((bits(key, step) >> shift) & 0xFFFF) for step in range(DRAWS)]
    assert abs(sum(draws) / DRAWS) < 0.03
    assert sum(x * x for x in draws) / DRAWS == pytest.approx(1.0, abs=0.02)
    assert max(map(abs, draws)) < 1.7321
    tenths = [sum(1 for x in draws if int((x / 3.4641017 + 0.5) * 10) == i) for i in range(10)]
    assert max(tenths) - min(tenths) < 0.1 * DRAWS / 10 * 1.5


def test_the_ends_of_the_range_are_symmetric_about_zero() -> None:
    assert uniform(0) == -uniform(0xFFFF)


def test_the_mixing_is_splitmix64s() -> None:
    """The first outputs of the generator seeded with 0, which are published everywhere."""
    golden = 0x9E3779B97F4A7C15
    assert mix64(golden) == 0xE220A8397B1DCDAF
    assert mix64(2 * golden & 0xFFFFFFFFFFFFFFFF) == 0x6E789E6AA1B965F4


def test_seeds_vehicles_sources_and_steps_draw_apart() -> None:
    draws = {
        bits(key_of(seed, vehicle, source), step)
        for seed in range(3)
        for vehicle in range(3)
        for source in range(3)
        for step in range(10)
    }
    assert len(draws) == 3 * 3 * 3 * 10
