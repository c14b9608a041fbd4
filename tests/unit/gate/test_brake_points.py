"""Where a brake leads: the predicted stop, or as near to it as a goal may be."""

from __future__ import annotations

import math

import pytest

from gcs.frames import Vec3
from gcs.gate.airspace.stopping import stop_point
from gcs.gate.airspace.verifier import Verifier, verifier_for
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import Circle, Polygon
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Braking
from tests.unit.gate.airspace import HOME, around, at, flying

# px4 reacts in 1.4 s and brakes with 3.35 m/s2 beside and 9.8 m/s2 above: at 8 m/s it goes
# 11.2 + 64 / 6.7 = 20.752 m.  One of the sixteen positions that are tried is every 1.297 m.
DASH = 8.0
STOP_M = 11.2 + 64 / 6.7
STEP_M = STOP_M / 16


def brake(verifier: Verifier, pos_ned: Vec3, v_ned: Vec3, *, floor: bool = True) -> Vec3 | None:
    breach = verifier.predicted_stop(pos_ned, v_ned, floor_applies=floor)
    assert breach is not None
    return breach.brake_pos_ned


@pytest.mark.parametrize(
    ("here", "v_ned", "expected"),
    [
        (at(140, 0, 5), (0.0, DASH, 0.0), at(140 + 6 * STEP_M, 0, 5)),
        (at(-140, 0, 5), (0.0, -DASH, 0.0), at(-140 - 6 * STEP_M, 0, 5)),
        (at(0, 140, 5), (DASH, 0.0, 0.0), at(0, 140 + 6 * STEP_M, 5)),
        (at(0, -140, 5), (-DASH, 0.0, 0.0), at(0, -140 - 6 * STEP_M, 5)),
    ],
    ids=["east", "west", "north", "south"],
)
def test_it_is_the_farthest_sixteenth_of_the_way_that_keeps_the_margin(
    here: Vec3, v_ned: Vec3, expected: Vec3
) -> None:
    """148 m is the margin's edge: six steps lead to 147.78 m, seven beyond."""
    assert brake(flying(), here, v_ned) == pytest.approx(expected)


def test_up_it_is_the_same() -> None:
    """At 9 m/s 12.6 + 81 / 19.6 = 16.733 m; the margin's edge is 49.7 m: four steps, to 49.18 m."""
    found = brake(flying(), at(3, 7, 45), (0.0, 0.0, -9.0))
    assert found == pytest.approx(at(3, 7, 45 + 4 * (12.6 + 81 / 19.6) / 16))


def test_askew_it_stays_on_the_way_to_the_stop() -> None:
    here, v_ned = at(99, 99, 20), (7.0, 8.0, -1.0)
    braking = DEFAULT.braking_of("px4")
    stop_ned = stop_point(here, v_ned, braking)
    found = brake(flying(), here, v_ned)
    assert found is not None
    parts = [(f - a) / (b - a) for f, a, b in zip(found, here, stop_ned, strict=True)]
    assert parts == pytest.approx([parts[0]] * 3)
    assert 0.0 < parts[0] < 1.0
    assert (parts[0] * 16) == pytest.approx(round(parts[0] * 16))
    nearest_m, next_m = (
        math.hypot(*(a + part * (b - a) for a, b in zip(here[:2], stop_ned[:2], strict=True)))
        for part in (parts[0], parts[0] + 1 / 16)
    )
    assert nearest_m < 148.0 < next_m


def test_it_stays_where_it_is_allowed_to_hover_and_no_step_clears() -> None:
    """Nearer than the margin, and the speed leads along the wall into a corner."""
    corner = Zone(
        "yard", True, Polygon(((0.0, 0.0), (40.0, 0.0), (40.0, 40.0), (0.0, 40.0))), 0, 30
    )
    found = brake(around(corner), at(39, 30, 10), (DASH, 0.0, 0.0))
    assert found == at(39, 30, 10)


@pytest.mark.parametrize(
    ("here", "v_ned"),
    [
        (at(149, 0, 5), (0.0, DASH, 0.0)),
        (at(-149, 0, 5), (0.0, -DASH, 0.0)),
        (at(0, 149, 5), (DASH, 0.0, 0.0)),
        (at(0, -149, 5), (-DASH, 0.0, 0.0)),
        (at(0, 0, 0.25), (0.0, 0.0, 5.0)),
        (at(0, 0, 49.75), (0.0, 0.0, -5.0)),
    ],
    ids=["east", "west", "north", "south", "down", "up"],
)
def test_nearer_than_the_margin_it_is_where_the_vehicle_is_and_never_behind(
    here: Vec3, v_ned: Vec3
) -> None:
    """A step back would keep the margin; but to stop takes less than to fly back.  The hold is
    judged as of a vehicle that stands."""
    assert brake(flying(), here, v_ned) == here


def test_outside_there_is_nowhere_to_brake() -> None:
    assert brake(flying(), at(160, 0, 5), (0.0, 0.0, 0.0)) is None


def test_no_brake_leads_below_the_ground_at_homes_height() -> None:
    home_ned = at(5, 6, 7)
    verifier = verifier_for(DEFAULT, "px4", home_ned, None)
    found = brake(verifier, at(150, 6, 6.5), (0.0, DASH, 0.0), floor=False)
    assert found is not None
    assert found[2] == -7.0


class TestStop:
    BRAKING = Braking(0.5, 4.0, 2.0, 0.3, 0.2)

    def test_it_counts_from_where_the_vehicle_is(self) -> None:
        """0.5 m/s north: 0.25 m of reaction and 0.03125 m of braking."""
        stop_ned = stop_point((100.0, 20.0, -3.0), (0.5, 0.0, 0.0), self.BRAKING)
        assert stop_ned == pytest.approx((100.28125, 20.0, -3.0))

    def test_east_and_down_each_by_its_own(self) -> None:
        """0.5 m/s down: 0.25 m of reaction and 0.0625 m of braking."""
        stop_ned = stop_point((100.0, 20.0, -3.0), (0.0, -0.5, 0.5), self.BRAKING)
        assert stop_ned == pytest.approx((100.0, 20.0 - 0.28125, -3.0 + 0.3125))


def test_a_breach_names_the_zone_and_the_numbers_it_was_decided_on() -> None:
    breach = flying().predicted_stop(at(140, 0, 5), (0.0, DASH, 0.0), floor_applies=True)
    assert breach is not None
    assert breach.zone == "home"
    assert dict(breach.numbers) == pytest.approx(
        {
            "clear_m": 10.0,
            "stop_clear_m": 10.0 - STOP_M,
            "limit_m": 0.5 + 2.0 - 1.5,
            "hold_over_limit_m": 10.0 - STOP_M - 1.0,
            "stopping_h_m": STOP_M + 0.5 + 2.0,
            "stopping_v_m": 0.2 + 0.3,
        }
    )


class TestLanding:
    """Where the floor does not apply the stop is no lower than the ground."""

    @pytest.mark.parametrize("home_up", [0.0, 7.0])
    def test_what_lands_at_home_stops_on_the_ground(self, home_up: float) -> None:
        verifier = verifier_for(DEFAULT, "px4", at(0, 0, home_up), None)
        here = at(3, 4, home_up + 0.5)
        falling = (0.0, 0.0, 5.0)
        assert verifier.predicted_stop(here, falling, floor_applies=False) is None
        assert verifier.predicted_stop(here, falling, floor_applies=True) is not None

    def test_below_home_it_stops_where_it_is(self) -> None:
        """Ground below home's height: what is there already is not lifted by the forecast."""
        zone = Zone("field", True, Circle((0.0, 0.0), 150.0), -20.0, 50.0)
        found = around(zone).predicted_stop(at(3, 4, -1), (0.0, 0.0, 5.0), floor_applies=False)
        assert found is None

    def test_a_tower_beneath_counts_until_the_ground(self) -> None:
        """Falling at 6 m/s it would go 8.4 + 36 / 19.6 = 10.24 m: from 4 m up, to the ground
        and no farther."""
        cellar = Zone("cellar", False, Circle((3.0, 4.0), 5.0), -30.0, -3.0)
        field = Zone("field", True, Circle((0.0, 0.0), 150.0))
        verifier = Verifier(DEFAULT, (field, cellar), "px4", HOME, origin_known=False)
        falling = (0.0, 0.0, 6.0)
        assert verifier.predicted_stop(at(3, 4, 4), falling, floor_applies=False) is None
        assert verifier.predicted_stop(at(3, 4, 4), falling, floor_applies=True) is not None
