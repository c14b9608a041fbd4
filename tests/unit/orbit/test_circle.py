"""What is made of an orbit that was asked for; the defaults by MAVLink's common.xml, DO_ORBIT."""

from __future__ import annotations

import math

import pytest

from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code, Refusal
from gcs.orbit.circle import Asked, Nose, Orbit, orbit_of

HERE = (3.0, 4.0, -10.0)
RULES = DEFAULT.stream
NAN = math.nan


def made(asked: Asked, before: Orbit | None = None) -> Orbit:
    found = orbit_of(asked, HERE, 0.5, before, RULES)
    assert isinstance(found, Orbit), found
    return found


def test_nothing_given_is_ten_metres_at_one_about_where_it_is() -> None:
    orbit = made(Asked())
    assert (orbit.centre_ned, orbit.radius_m, orbit.way, orbit.speed_m_s) == (HERE, 10.0, 1, 1.0)
    assert (orbit.turn_rad, orbit.nose, orbit.heading_rad) == (None, Nose.CENTRE, 0.5)


def test_what_is_not_given_is_as_it_is_flown_but_the_height() -> None:
    """Height: "NaN: Use current vehicle altitude"."""
    flown = made(Asked((20.0, 30.0, 40.0), -15.0, 4.0, 2.0, Nose.ALONG))
    orbit = made(Asked(), flown)
    assert orbit.centre_ned == (30.0, 20.0, HERE[2])
    assert (orbit.radius_m, orbit.way, orbit.speed_m_s) == (15.0, -1, 4.0)
    assert orbit.turn_rad == pytest.approx(4.0 * math.pi)
    assert orbit.nose is Nose.ALONG


def test_a_height_or_a_centre_alone() -> None:
    assert made(Asked((None, None, 25.0))).centre_ned == (3.0, 4.0, -25.0)
    assert made(Asked((7.0, 8.0, None))).centre_ned == (8.0, 7.0, -10.0)


@pytest.mark.parametrize(
    ("radius_m", "asked_m_s", "most_m_s"),
    [(8.0, 9.0, 4.0), (2.0, 2.0, 2.0), (500.0, 12.0, 10.0), (10.0, 4.0, 20**0.5)],
)
def test_the_speed_is_what_two_metres_per_second_squared_and_the_policy_allow(
    radius_m: float, asked_m_s: float, most_m_s: float
) -> None:
    """v^2 = a r.  What is faster is refused, with the most there is."""
    found = orbit_of(Asked(None, radius_m, asked_m_s), HERE, 0.5, None, RULES)
    if asked_m_s <= most_m_s:
        assert isinstance(found, Orbit)
        assert found.speed_m_s == pytest.approx(asked_m_s, abs=1e-4)
        assert found.speed_m_s <= RULES.max_speed_h_m_s
    else:
        assert isinstance(found, Refusal)
        assert found.code is Code.POLICY
        assert dict(found.numbers)["max_speed_m_s"] == pytest.approx(most_m_s, abs=1e-4)


@pytest.mark.parametrize(
    ("asked", "code"),
    [
        (Asked(radius_m=0.0), Code.UNSUPPORTED),
        (Asked(radius_m=-1.9), Code.UNSUPPORTED),
        (Asked(radius_m=1001.0), Code.UNSUPPORTED),
        (Asked(radius_m=NAN), Code.NON_FINITE),
        (Asked(radius_m=math.inf), Code.NON_FINITE),
        (Asked(speed_m_s=0.0), Code.UNSUPPORTED),
        (Asked(speed_m_s=-3.0), Code.UNSUPPORTED),
        (Asked(speed_m_s=math.inf), Code.NON_FINITE),
        (Asked(turns=-1.0), Code.UNSUPPORTED),
        (Asked(turns=NAN), Code.NON_FINITE),
        (Asked((1.0, None, 3.0)), Code.NON_FINITE),
        (Asked((None, 1.0, 3.0)), Code.NON_FINITE),
    ],
)
def test_what_is_none(asked: Asked, code: Code) -> None:
    found = orbit_of(asked, HERE, None, None, RULES)
    assert isinstance(found, Refusal)
    assert found.code is code


def test_the_entry_is_the_nearest_point() -> None:
    orbit = made(Asked((0.0, 0.0, 12.0), 10.0))
    assert orbit.entry_ned((30.0, 40.0, -3.0)) == pytest.approx((6.0, 8.0, -12.0))
    assert orbit.entry_ned((3.0, 4.0, -3.0)) == pytest.approx((6.0, 8.0, -12.0))


def test_from_its_centre_it_flies_where_its_nose_points() -> None:
    orbit = made(Asked(None, 10.0))
    ahead = (3.0 + 10.0 * math.cos(0.5), 4.0 + 10.0 * math.sin(0.5), -10.0)
    assert orbit.entry_ned(HERE) == pytest.approx(ahead)
