"""The air around a vehicle: a steady wind that changes in its time, and turbulence on it.

The turbulence is the low-altitude Dryden form of MIL-F-8785C (3.7.2 and 3.7.3), simplified: a
first-order Gauss-Markov process for each axis, with the length scales and the ratio of the
vertical to the horizontal intensity that the standard gives for 10 m above ground.
"""

from __future__ import annotations

from math import sqrt
from typing import Final

from vehicle_sim.numerics.noise import bits, uniform
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.constants import Plant

WIND_EVERY: Final = 5
"""Steps between two updates of the air."""

LENGTH_M: Final = 68.0
"""Horizontally: h / (0.177 + 0.000823 h)^1.2 in feet, h = 33 ft."""

LENGTH_D_M: Final = 10.0
"""Vertically: h itself."""

RATIO_D: Final = 0.53
"""Vertical over horizontal standard deviation: (0.177 + 0.000823 h)^0.4."""

_SLOWEST_M_S: Final = 1.0
"""Turbulence lives on where nothing moves through it: it passes at this speed at least."""


def blow(body: Body, plant: Plant, k: int) -> None:
    """`WIND_EVERY` steps of the air; `k` is the step number, which the noise draws by.

    The field stands still in the moving air (Taylor), so it passes at the airspeed V and its
    correlation time is L / V.  Whatever V does, the variance stays: g' = a g + sqrt(1 - a^2) s n.
    One even draw for each axis is enough; over a correlation time they add up to a normal one.
    """
    dt_s = plant.dt_s * WIND_EVERY
    follow = dt_s / (body.wind_rise_s + dt_s)
    flow_n = body.flow_n + follow * (body.wind_n - body.flow_n)
    flow_e = body.flow_e + follow * (body.wind_e - body.flow_e)
    flow_d = body.flow_d + follow * (body.wind_d - body.flow_d)
    body.flow_n = flow_n
    body.flow_e = flow_e
    body.flow_d = flow_d

    v_n = body.vel_n - flow_n
    v_e = body.vel_e - flow_e
    v_d = body.vel_d - flow_d
    speed = sqrt(v_n * v_n + v_e * v_e + v_d * v_d)
    way = dt_s * (speed if speed > _SLOWEST_M_S else _SLOWEST_M_S)
    # The bilinear form of exp(-way / length).
    keep = (2.0 * LENGTH_M - way) / (2.0 * LENGTH_M + way)
    keep_d = (2.0 * LENGTH_D_M - way) / (2.0 * LENGTH_D_M + way)
    stir = body.gust_m_s * sqrt(1.0 - keep * keep)
    stir_d = RATIO_D * body.gust_m_s * sqrt(1.0 - keep_d * keep_d)
    x = bits(body.gust_key, k)
    gust_n = keep * body.gust_n + stir * uniform(x & 0xFFFF)
    gust_e = keep * body.gust_e + stir * uniform((x >> 16) & 0xFFFF)
    gust_d = keep_d * body.gust_d + stir_d * uniform((x >> 32) & 0xFFFF)
    body.gust_n = gust_n
    body.gust_e = gust_e
    body.gust_d = gust_d
    body.air_n = flow_n + gust_n
    body.air_e = flow_e + gust_e
    body.air_d = flow_d + gust_d
