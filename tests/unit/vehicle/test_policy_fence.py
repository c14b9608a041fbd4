"""The policy's fence as a vehicle keeps it: zones on Earth, a circle, a ceiling, and the rest."""

from __future__ import annotations

import pymap3d
import pytest

from gcs.gate.policy.parse import parse_policy
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Refusal
from gcs.plan.model import Circle, Polygon
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.vehicle.missions.policy_fence import VehicleFence, vehicle_fence
from tests.unit.station.vehicles import HOME
from tests.unit.vehicle.jobs.script import placed

CIRCLE = """[[fence]]
name = "yard"
kind = "circle"
radius_m = 80
ceiling_up_m = 40
"""
BOX = """[[fence]]
name = "box"
kind = "box"
east_m = [-30, 40]
north_m = [-30, 30]
"""
MAST = """[[fence]]
name = "mast"
kind = "circle"
inclusion = false
centre = [20, 10]
radius_m = 5
"""
CAGE = """[[fence]]
name = "cage"
kind = "box"
frame = "local"
east_m = [-5, 5]
north_m = [-5, 5]
ceiling_up_m = 2
"""


def policy(*parts: str) -> Policy:
    return parse_policy('name = "a test"\n' + "".join(parts), "a.toml")


def fence(policy: Policy, autopilot: Autopilot = PX4) -> VehicleFence:
    found = vehicle_fence(policy, placed(autopilot))
    assert isinstance(found, VehicleFence)
    return found


def test_a_circle_about_home_and_a_ceiling_are_parameters_and_no_zones() -> None:
    found = fence(policy(CIRCLE))
    assert found.zones.zones == ()
    assert (found.kept.reach_m, found.kept.ceiling_up_m) == (80.0, 40.0)
    assert not found.kept.zones
    assert found.not_kept == ()
    assert found.kept.silent_s == 0.5  # [stream] deadman_s of the default policy


@pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT])
def test_other_zones_stand_where_the_policy_s_stand(autopilot: Autopilot) -> None:
    found = fence(policy(CIRCLE, MAST, BOX), autopilot)
    mast, box = found.zones.zones
    assert (mast.inclusion, box.inclusion, found.kept.zones) == (False, True, True)
    assert isinstance(mast.shape, Circle)
    assert mast.shape.radius_m == 5.0
    assert isinstance(box.shape, Polygon)
    places = [mast.shape.centre, *box.shape.corners]
    seen = [
        pymap3d.geodetic2enu(lat, lon, 488.0, HOME.lat_deg, HOME.lon_deg, 488.0)[:2]
        for lat, lon in places
    ]
    meant = [(20, 10), (-30, -30), (40, -30), (40, 30), (-30, 30)]
    for (east_m, north_m), place in zip(meant, seen, strict=True):
        assert place == pytest.approx((east_m, north_m), abs=0.2)  # a sphere, beside WGS84
    assert found.kept.reach_m == 50.0  # the corner at 40, 30: nearer than the circle


def test_a_cage_about_the_local_origin_has_its_ceiling_above_home() -> None:
    telemetry = placed()
    telemetry.home_ned = (0.0, 0.0, -0.5)
    found = vehicle_fence(policy(CAGE), telemetry)
    assert isinstance(found, VehicleFence)
    assert found.kept.ceiling_up_m == pytest.approx(1.5)
    assert found.kept.reach_m == pytest.approx(50.0**0.5)


def test_what_no_vehicle_keeps_is_named_and_not_put() -> None:
    tower = MAST + "ceiling_up_m = 20\n"
    floor = BOX + "floor_up_m = 3\n"
    found = fence(policy("min_up_m = 1.0\n", CIRCLE, tower, floor))
    assert [zone.name for zone in found.zones.zones] == ["box"]
    text = "; ".join(found.not_kept)
    assert "zone 'mast', to stay out of up to a height" in text
    assert "the floor of zone 'box' at 3 m" in text
    assert "min_up_m = 1" in text


def test_a_px4_is_said_to_be_content_with_one_of_several_zones() -> None:
    both = policy(BOX, CAGE)
    assert any("every zone" in text for text in fence(both).not_kept)
    assert fence(both, ARDUPILOT).not_kept == ()


@pytest.mark.parametrize(
    ("severity", "breach"),
    [("caution", "hold"), ("hold", "hold"), ("return", "return"), ("land", "land")],
)
def test_a_breach_leads_to_what_the_policy_says(severity: str, breach: str) -> None:
    rules = policy(CIRCLE, f'[severities]\nfence_breached = "{severity}"\n')
    assert fence(rules).kept.breach == breach


def test_before_home_is_known_nothing_can_be_placed() -> None:
    telemetry = placed()
    telemetry.home_ned = None
    assert isinstance(vehicle_fence(policy(BOX), telemetry), Refusal)
