"""The air: its steady part comes in its time, its turbulence has the statistics it was given."""

from __future__ import annotations

from math import exp, sqrt

import pytest

from tests.unit.model.bodies import PLANTS, airborne, hover_motors, hovering, standing, state_bytes
from vehicle_sim.numerics.noise import key_of
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.quad import advance, begin
from vehicle_sim.plant.wind import LENGTH_D_M, LENGTH_M, WIND_EVERY, blow

S500 = PLANTS["s500"]
UPDATE_S = S500.dt_s * WIND_EVERY
AIRSPEED_M_S = 34.0
SIGMA_M_S = 2.0
LOW_FT = 10.0 / 0.3048
VERTICAL_RATIO = (0.177 + 0.000823 * LOW_FT) ** 0.4
"""Vertical over horizontal deviation at 10 m: MIL-F-8785C, turbulence at low altitude."""


def windy(seed: int = 1, vehicle: int = 0) -> Body:
    body = airborne(S500)
    body.gust_key = key_of(seed, vehicle, 0)
    body.wind_n = body.flow_n = AIRSPEED_M_S
    body.gust_m_s = SIGMA_M_S
    return body


def gusts(body: Body, updates: int) -> list[tuple[float, float, float]]:
    seen = []
    for k in range(WIND_EVERY, (updates + 1) * WIND_EVERY, WIND_EVERY):
        blow(body, S500, k)
        seen.append((body.gust_n, body.gust_e, body.gust_d))
    return seen


def mean(values: list[float]) -> float:
    return sum(values) / len(values)


@pytest.mark.parametrize(
    ("axis", "length_m", "ratio"),
    [(0, LENGTH_M, 1.0), (1, LENGTH_M, 1.0), (2, LENGTH_D_M, VERTICAL_RATIO)],
    ids=["north", "east", "down"],
)
def test_turbulence_has_its_mean_deviation_and_correlation_time(
    axis: int, length_m: float, ratio: float
) -> None:
    """Over 4,000 correlation times, the deviation's own deviation is 1.1 %."""
    correlation_s = length_m / AIRSPEED_M_S
    updates = round(4000.0 * correlation_s / UPDATE_S)
    values = [gust[axis] for gust in gusts(windy(), updates)]
    sigma = ratio * SIGMA_M_S
    assert abs(mean(values)) < 0.1 * sigma
    assert sqrt(mean([v * v for v in values])) == pytest.approx(sigma, rel=0.05)
    lag = round(correlation_s / UPDATE_S)
    alike = mean([a * b for a, b in zip(values, values[lag:], strict=False)]) / sigma**2
    assert alike == pytest.approx(exp(-lag * UPDATE_S / correlation_s), abs=0.05)
    # Nearly normal: even draws add up.
    within = mean([1.0 if abs(v) < sigma else 0.0 for v in values])
    assert within == pytest.approx(0.683, abs=0.03)


def test_the_axes_and_the_vehicles_blow_apart() -> None:
    one, other = gusts(windy(vehicle=0), 50_000), gusts(windy(vehicle=1), 50_000)
    for a, b in ((0, 1), (0, 2), (1, 2)):
        assert abs(mean([gust[a] * gust[b] for gust in one])) < 0.15 * SIGMA_M_S**2
    assert abs(mean([p[0] * q[0] for p, q in zip(one, other, strict=True)])) < 0.15 * SIGMA_M_S**2


def test_equal_seeds_blow_equal_bytes_and_others_do_not() -> None:
    def end(seed: int, vehicle: int) -> bytes:
        body = windy(seed, vehicle)
        gusts(body, 1000)
        body.gust_key = 0
        return state_bytes(body)

    assert end(1, 0) == end(1, 0)
    assert len({end(1, 0), end(1, 1), end(2, 0)}) == 3


def test_smooth_air_does_not_stir() -> None:
    body = standing(S500)
    for k in range(1, 101):
        advance(body, 0.0, 0.0, 0.0, 0.0, S500, k)
    assert (body.air_n, body.air_e, body.air_d) == (0.0, 0.0, 0.0)


def test_a_vehicle_begins_in_the_wind_that_was_declared() -> None:
    body = Body(wind_n=3.0, wind_e=-4.0)
    begin(body, 1, S500)
    blow(body, S500, WIND_EVERY)
    assert (body.air_n, body.air_e, body.air_d) == (3.0, -4.0, 0.0)


def test_a_change_of_the_wind_takes_its_rise_time() -> None:
    body = standing(S500)
    body.wind_n, body.wind_e, body.wind_rise_s = 8.0, -6.0, 2.0
    for k in range(1, round(2.0 / S500.dt_s) + 1):
        advance(body, 0.0, 0.0, 0.0, 0.0, S500, k)
    assert body.air_n == pytest.approx(8.0 * (1.0 - exp(-1.0)), rel=0.01)
    assert body.air_e == pytest.approx(-6.0 * (1.0 - exp(-1.0)), rel=0.01)


def test_without_a_rise_time_the_wind_is_there_at_once() -> None:
    body = standing(S500)
    body.wind_d, body.wind_rise_s = -1.5, 0.0
    blow(body, S500, WIND_EVERY)
    assert body.air_d == -1.5


def test_a_gust_pushes_a_hovering_vehicle_about_and_not_away() -> None:
    body = hovering(S500)
    body.gust_key, body.gust_m_s = key_of(3, 0, 0), 2.0
    fastest = 0.0
    for k in range(1, 5001):
        advance(body, *hover_motors(body, S500), S500, k)
        fastest = max(fastest, abs(body.vel_n) + abs(body.vel_e))
    assert 0.1 < fastest < 4.0
