"""The path that a plan flies from where the vehicle is, and whether all of it clears."""

from __future__ import annotations

import json

import pytest
from msgspec import structs

from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import MissionRules, Policy
from gcs.gate.policy.zonespec import CircleSpec
from gcs.gate.refusal import Code, Refusal
from gcs.plan.legs import FlightPath
from gcs.plan.model import Plan
from gcs.plan.settings import USUAL
from gcs.plan.verify import Verification, Verifying
from gcs.protocol.autopilot import ARDUPILOT, GENERIC, PX4, Autopilot
from gcs.vehicle.missions.paths import ClearedMission, autopilot_name, cleared, on_earth, verifying
from gcs.vehicle.talk.telemetry import Telemetry
from tests.unit.plan import samples
from tests.unit.station.vehicles import SECOND_NS
from tests.unit.vehicle.jobs.script import START_NS, placed
from tests.unit.vehicle.plans import BOX, FAR, LAT, LON, plan

BACK = samples.simple(3, 20, 2, [0, 0, 0, 0, 0, 0, 0])


def read(data: bytes) -> Plan:
    return samples.read_json(json.loads(data))


def path(data: bytes, telemetry: Telemetry | None = None) -> FlightPath:
    found = verified(read(data), telemetry or placed())
    assert isinstance(found, Verification)
    return found.path


def verified(
    plan: Plan, telemetry: Telemetry, policy: Policy = DEFAULT, now_ns: int = START_NS
) -> Verification | Refusal:
    """With parameters as delivered and no rally points."""
    settings = USUAL[autopilot_name(telemetry)]
    found = verifying(plan, policy, telemetry, settings, telemetry.return_up_m, (), now_ns)
    if isinstance(found, Verifying):
        while found.result is None:
            found.step()
        return found.result
    return found


def refusal(found: object) -> Code:
    assert isinstance(found, Refusal)
    return found.code


@pytest.mark.parametrize(
    ("autopilot", "name"), [(PX4, "px4"), (ARDUPILOT, "ardupilot"), (GENERIC, "px4")]
)
def test_a_stranger_is_spoken_to_as_a_px4(autopilot: Autopilot, name: str) -> None:
    assert autopilot_name(placed(autopilot)) == name


def test_a_path_begins_where_the_vehicle_is() -> None:
    telemetry = placed()
    telemetry.pos_ned = (3.0, 4.0, -5.0)
    assert path(BOX, telemetry).segments[0][0] == (3.0, 4.0, -5.0)


def test_items_lie_where_the_vehicle_s_own_projection_puts_them() -> None:
    """Item 2 is 1e-4 degrees north of home: 11.12 m on px4's sphere, 11.13 m for ardupilot."""
    for autopilot, north_m in ((PX4, 11.1195), (ARDUPILOT, 11.1319)):
        ends = [end for _, end in path(BOX, placed(autopilot)).segments]
        assert any(abs(end[0] - north_m) < 2e-3 and end[2] == -10.0 for end in ends)


def test_a_return_flies_at_the_vehicle_s_own_return_height_and_lands() -> None:
    data = plan(
        samples.waypoint(1, LAT, LON, 10, command=22),
        samples.waypoint(2, LAT + 1e-4, LON, 10),
        BACK,
    )
    ends = [end for _, end in path(data).segments]
    assert any(end[2] == pytest.approx(-30.0) for end in ends)
    assert ends[-1] == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)


@pytest.mark.parametrize("unknown", ["origin", "home_ned", "pos_ned"])
def test_what_is_not_known_is_no_path(unknown: str) -> None:
    telemetry = placed()
    setattr(telemetry, unknown, None)
    assert refusal(verified(read(BOX), telemetry)) is Code.NO_ORIGIN


def test_placed_on_earth_metres_become_degrees_and_degrees_stay() -> None:
    assert on_earth(read(BOX), placed()) == read(BOX)
    telemetry = placed()
    telemetry.home = None
    found = on_earth(read(BOX), telemetry)
    assert refusal(found) is Code.NO_ORIGIN


# ------------------------------------------------------------------------------- the verdict


def judged(
    data: bytes | Plan,
    telemetry: Telemetry | None = None,
    policy: Policy = DEFAULT,
    after_s: float = 0.0,
) -> ClearedMission | Refusal:
    """The verdict so long after the vehicle's last position."""
    plan = data if isinstance(data, Plan) else read(data)
    now_ns = START_NS + round(after_s * SECOND_NS)
    found = verified(plan, telemetry or placed(), policy, now_ns)
    return found if isinstance(found, Refusal) else cleared(found)


def test_a_path_inside_the_fence_clears_with_its_numbers() -> None:
    answer = judged(BOX)
    assert isinstance(answer, ClearedMission)
    assert answer.evidence != ()


def test_the_item_whose_leg_does_not_clear_is_named_as_people_count() -> None:
    answer = judged(FAR)
    assert isinstance(answer, Refusal)
    assert answer.sentence.startswith("item 2")


def test_a_position_that_is_older_than_the_policy_allows_is_no_beginning() -> None:
    assert DEFAULT.position_age_s == 1.0
    assert isinstance(judged(BOX, after_s=1.0), ClearedMission)
    assert refusal(judged(BOX, after_s=1.001)) is Code.STALE


@pytest.mark.parametrize("unknown", ["origin", "home_ned", "pos_ned"])
def test_where_the_vehicle_s_place_is_not_known_nothing_clears(unknown: str) -> None:
    telemetry = placed()
    setattr(telemetry, unknown, None)
    assert refusal(judged(BOX, telemetry)) is Code.NO_ORIGIN


def test_a_return_whose_height_is_not_known_is_blocked() -> None:
    telemetry = placed()
    telemetry.return_up_m = None
    data = plan(samples.waypoint(1, LAT, LON, 10, command=22), BACK)
    assert refusal(judged(data, telemetry)) is Code.RTL_BLOCKED


def test_a_path_that_is_not_known_whole_does_not_clear() -> None:
    terrain = samples.simple(2, 16, 10, [0, 0, 0, None, LAT, LON, 10])
    data = plan(samples.waypoint(1, LAT, LON, 10, command=22), terrain)
    assert refusal(judged(data)) is Code.BAD_MISSION


def test_a_zone_of_the_policy_between_two_items_is_seen_though_both_are_clear() -> None:
    """From 0 to 11.1 m north at 10 m: a pole of 1 m stands at 5.5 m."""

    def with_pole_at(north_m: float) -> Policy:
        pole = CircleSpec(name="pole", radius_m=1.0, centre=(0.0, north_m), inclusion=False)
        return structs.replace(DEFAULT, margin_h_m=0.5, fence=(*DEFAULT.fence, pole))

    answer = judged(BOX, policy=with_pole_at(5.5))
    assert isinstance(answer, Refusal)
    assert answer.zone == "pole"
    assert isinstance(judged(BOX, policy=with_pole_at(-5.5)), ClearedMission)


def test_the_plan_s_own_fence_is_kept_as_well_as_the_policy_s() -> None:
    document = samples.box()
    centre = {"center": [LAT, LON], "radius": 5}
    document["geoFence"]["circles"] = [{"circle": centre, "inclusion": True, "version": 1}]
    assert isinstance(judged(samples.read_json(document)), Refusal)
    assert isinstance(judged(BOX), ClearedMission)


def test_a_failsafe_return_that_a_zone_blocks_is_what_the_policy_makes_of_it() -> None:
    """The mission ends east of a pole, and home lies west of it; it flies around."""
    pole = CircleSpec(
        name="pole", radius_m=3.0, centre=(30.0, 0.0), inclusion=False, ceiling_up_m=45.0
    )
    policy = structs.replace(DEFAULT, fence=(*DEFAULT.fence, pole))
    east = 60.0 / (111_194.93 * 0.67687)
    north = 40.0 / 111_194.93
    data = plan(
        samples.waypoint(1, LAT, LON, 10, command=22),
        samples.waypoint(2, LAT + north, LON, 10),
        samples.waypoint(3, LAT + north, LON + east, 10),
        samples.waypoint(4, LAT, LON + east, 10),
    )
    refusal = judged(data, policy=policy)
    assert isinstance(refusal, Refusal)
    assert (refusal.code, refusal.zone) == (Code.RTL_BLOCKED, "pole")
    warns = structs.replace(policy, mission=MissionRules("warn"))
    answer = judged(data, policy=warns)
    assert isinstance(answer, ClearedMission)
    (warning,) = answer.warnings
    assert "pole" in warning
    free = judged(data)
    assert isinstance(free, ClearedMission)
    assert free.warnings == ()
