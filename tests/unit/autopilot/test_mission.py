"""Missions: what is refused at the door, and how the items are flown."""

from __future__ import annotations

from dataclasses import replace
from math import inf, nan

import pytest

from tests.unit.autopilot.flight import Flight, item
from vehicle_sim.autopilot.interface import ImageCaptured, Landed, MissionReached, PlanItem, Result
from vehicle_sim.autopilot.modes import Personality

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)
HOME = item(0, 16, frame=0)


def numbered(personality: Personality, *items: PlanItem) -> tuple[PlanItem, ...]:
    """As uploaded: ArduPilot has home at index 0; sequence numbers and jumps shift with it."""
    first = 1 if personality == "ardupilot" else 0
    shifted = [
        replace(it, seq=i + first, p1=it.p1 + first if it.command == 177 else it.p1)
        for i, it in enumerate(items)
    ]
    return (HOME, *shifted) if first else tuple(shifted)


def started(personality: Personality, *items: PlanItem) -> Flight:
    flight = Flight(personality).boot()
    plan = numbered(personality, *items)
    assert flight.vehicle.check_plan(plan) is None
    flight.vehicle.load_plan(plan)
    if personality == "ardupilot":
        flight.vehicle.set_mode_kind("guided")
        flight.vehicle.arm(False)
    assert flight.vehicle.mission_start(0, 0) is Result.ACCEPTED
    return flight


def reached(flight: Flight) -> list[int]:
    first = 1 if flight.personality == "ardupilot" else 0
    return [event.seq - first for event in flight.seen if isinstance(event, MissionReached)]


@either
def test_a_square_is_flown_and_landed(personality: Personality) -> None:
    flight = started(
        personality,
        item(0, 22, up_m=4.0),
        item(1, 16, 6.0, 0.0, 4.0),
        item(2, 16, 6.0, 6.0, 5.0, p1=1.0),
        item(3, 16, 0.0, 6.0, 4.0),
        item(4, 21, 0.0, 0.0, 0.0),
    )
    assert flight.vehicle.armed
    assert flight.vehicle.mission_state == 3
    flight.fly(3.0, lambda: flight.landed() is Landed.TAKEOFF)
    flight.fly(60.0, lambda: not flight.vehicle.armed)
    assert reached(flight) == [0, 1, 2, 3, 4]
    assert flight.vehicle.mission_state == 5
    assert flight.off((0.0, 0.0, 0.0)) < 0.6


@either
def test_after_the_last_item_it_holds(personality: Personality) -> None:
    flight = started(personality, item(0, 22, up_m=4.0), item(1, 16, 5.0, 0.0, 4.0))
    flight.fly(20.0, lambda: flight.vehicle.mission_state == 5)
    flight.fly(4.0)
    assert flight.vehicle.mode_name == ("AUTO.LOITER" if personality == "px4" else "AUTO")
    assert flight.off((5.0, 0.0, -4.0)) < 0.4


@either
def test_a_mission_ends_with_a_return(personality: Personality) -> None:
    flight = started(personality, item(0, 22, up_m=4.0), item(1, 16, 9.0, 0.0, 4.0), item(2, 20))
    name = "RTL_RETURN_ALT" if personality == "px4" else "RTL_ALT"
    flight.vehicle.parameters.set(name, 6.0 if personality == "px4" else 600.0)
    flight.fly(60.0, lambda: not flight.vehicle.armed)
    assert flight.off((0.0, 0.0, 0.0)) < 0.6


@either
def test_a_jump_repeats_and_then_goes_on(personality: Personality) -> None:
    flight = started(
        personality,
        item(0, 22, up_m=3.0),
        item(1, 16, 3.0, 0.0, 3.0),
        item(2, 16, 0.0, 0.0, 3.0),
        item(3, 177, p1=1.0, p2=2.0),
        item(4, 16, 0.0, 3.0, 3.0),
    )
    flight.fly(60.0, lambda: flight.vehicle.mission_state == 5)
    assert reached(flight) == [0, 1, 2, 1, 2, 1, 2, 4]


def test_a_plan_that_only_jumps_does_not_hang() -> None:
    flight = started(
        "px4", item(0, 22, up_m=3.0), item(1, 178, p2=3.0), item(2, 177, p1=1.0, p2=-1.0)
    )
    flight.fly(8.0)
    assert flight.vehicle.mission_state == 3
    assert flight.up_m == pytest.approx(3.0, abs=0.4)


@either
def test_loiter_time_waits_and_loiter_turns_circles(personality: Personality) -> None:
    flight = started(
        personality,
        item(0, 22, up_m=4.0),
        item(1, 19, 2.0, 0.0, 4.0, p1=3.0),
        item(2, 18, 2.0, 0.0, 4.0, p1=1.0, p3=5.0),
        item(3, 17, 0.0, 0.0, 4.0),
    )
    flight.fly(15.0, lambda: reached_now(flight) == [0, 1])
    radii, bearings = [], set()
    while reached_now(flight) == [0, 1]:
        flight.fly(0.2)
        n, e, _ = flight.pos
        radii.append(((n - 2.0) ** 2 + e**2) ** 0.5)
        bearings.add((n > 2.0, e > 0.0))
        assert flight.vehicle.time_ns < 90e9
    assert max(radii) < 6.0
    assert sorted(radii)[len(radii) // 2] == pytest.approx(5.0, abs=0.5)
    assert len(bearings) == 4
    flight.fly(20.0)
    assert flight.vehicle.mission_state == 3  # LOITER_UNLIM has no end
    assert flight.off((0.0, 0.0, -4.0)) < 0.4


def reached_now(flight: Flight) -> list[int]:
    flight.seen += flight.vehicle.events()
    return reached(flight)


@either
def test_speed_camera_yaw_and_delay_items(personality: Personality) -> None:
    turns = [item(4, 115, p1=90.0, p2=45.0, p3=1.0, p4=0.0)]
    flight = started(
        personality,
        item(0, 22, up_m=4.0),
        item(1, 178, p1=1.0, p2=2.0, p3=-1.0),
        item(2, 2000, p2=0.0, p3=1.0),
        item(3, 530, frame=2, p2=0.0),
        *(turns if personality == "ardupilot" else []),  # PX4 flies no conditions
        item(5, 93, p1=1.5),
        item(6, 16, 20.0, 0.0, 4.0),
    )
    fastest = 0.0
    while flight.vehicle.mission_state == 3:
        flight.fly(0.2)
        n, e, _ = flight.vehicle.truth.v_ned
        fastest = max(fastest, (n * n + e * e) ** 0.5)
        assert flight.vehicle.time_ns < 60e9
    assert 1.8 < fastest < 2.3
    assert any(isinstance(event, ImageCaptured) for event in flight.seen)
    assert any("no such equipment" in text for text in flight.texts())


def test_distance_triggers_the_camera() -> None:
    flight = started(
        "px4",
        item(0, 22, up_m=4.0),
        item(1, 206, p1=4.0, p3=1.0),
        item(2, 16, 16.0, 0.0, 4.0),
        item(3, 206, p1=0.0),
        item(4, 16, 30.0, 0.0, 4.0),
    )
    flight.vehicle.parameters.set("CAM_EXPOSURE_S", 0.1)
    flight.fly(60.0, lambda: flight.vehicle.mission_state == 5)
    assert flight.vehicle.images_captured == 4  # at 0, 4, 8 and 12 m; at 14 the item is reached


@either
def test_leaving_the_mission_and_coming_back_goes_on_at_the_current_item(
    personality: Personality,
) -> None:
    flight = started(personality, item(0, 22, up_m=4.0), item(1, 16, 40.0, 0.0, 4.0))
    flight.fly(7.0)
    assert reached_now(flight) == [0]
    copter = personality == "ardupilot"
    paused = flight.vehicle.pause() if copter else flight.vehicle.set_mode_kind("hold")
    assert paused is Result.ACCEPTED
    flight.fly(6.0)
    assert flight.vehicle.mission_state == 4
    where = flight.pos
    flight.fly(2.0)
    assert flight.off(where) < 0.4
    resumed = flight.vehicle.resume() if copter else flight.vehicle.set_mode_kind("mission")
    assert resumed is Result.ACCEPTED
    assert flight.vehicle.mission_state == 3
    flight.fly(20.0, lambda: flight.vehicle.mission_state == 5)
    assert reached(flight) == [0, 1]


def test_px4_takes_off_by_itself_where_the_plan_does_not() -> None:
    flight = started("px4", item(0, 16, 5.0, 0.0, 6.0))
    flight.fly(30.0, lambda: flight.vehicle.mission_state == 5)
    flight.fly(4.0)
    assert flight.off((5.0, 0.0, -6.0)) < 0.4


def test_ardupilot_wants_a_take_off_item() -> None:
    flight = Flight("ardupilot").boot()
    flight.vehicle.load_plan(numbered("ardupilot", item(0, 16, 5.0, 0.0, 6.0)))
    flight.vehicle.set_mode_kind("guided")
    flight.vehicle.arm(False)
    assert flight.vehicle.mission_start(0, 0) is Result.FAILED


def test_ardupilot_stays_on_the_ground_in_auto_until_the_mission_is_started() -> None:
    flight = Flight("ardupilot").boot()
    flight.vehicle.load_plan(numbered("ardupilot", item(0, 22, up_m=4.0)))
    flight.vehicle.set_mode_kind("guided")
    flight.vehicle.arm(False)
    assert flight.vehicle.set_mode_kind("mission") is Result.ACCEPTED
    flight.fly(3.0)
    assert flight.up_m < 0.01
    assert flight.vehicle.mission_start(0, 0) is Result.ACCEPTED
    flight.fly(6.0, lambda: flight.up_m > 3.0)


@either
def test_global_frames_are_flown_above_their_datum(personality: Personality) -> None:
    flight = Flight(personality).boot()
    home = flight.vehicle.origin
    assert home is not None
    lat, lon = round((home.lat_deg + 5e-5) * 1e7), round(home.lon_deg * 1e7)
    relative = PlanItem(1, 6, 16, 0.0, 0.0, 0.0, nan, lat, lon, 6.0, 1)
    above_sea = PlanItem(2, 0, 16, 0.0, 0.0, 0.0, nan, lat, lon, home.alt_amsl_m + 8.0, 1)
    take_off = item(0, 22, frame=3, up_m=4.0)
    flight.vehicle.load_plan(numbered(personality, take_off, relative, above_sea))
    if personality == "ardupilot":
        flight.vehicle.set_mode_kind("guided")
        flight.vehicle.arm(False)
    assert flight.vehicle.mission_start(0, 0) is Result.ACCEPTED
    flight.fly(20.0, lambda: reached_now(flight) == [0, 1])
    assert flight.up_m == pytest.approx(6.0, abs=2.1)
    flight.fly(10.0)
    assert flight.up_m == pytest.approx(8.0, abs=0.4)
    assert flight.pos[0] == pytest.approx(5.56, abs=0.4)


@either
def test_a_plan_taken_away_in_flight_leaves_the_vehicle_holding(personality: Personality) -> None:
    flight = started(personality, item(0, 22, up_m=4.0), item(1, 16, 40.0, 0.0, 4.0))
    flight.fly(7.0)
    flight.vehicle.load_plan(numbered(personality))
    flight.fly(5.0)
    assert flight.speed_m_s < 0.25
    assert flight.vehicle.mission_state == 1


@either
def test_another_item_can_be_made_current(personality: Personality) -> None:
    first = 1 if personality == "ardupilot" else 0
    flight = started(
        personality,
        item(0, 22, up_m=4.0),
        item(1, 16, 30.0, 0.0, 4.0),
        item(2, 16, 0.0, 5.0, 4.0),
    )
    flight.fly(9.0)
    assert flight.vehicle.mission_set_current(99) is Result.DENIED
    assert flight.vehicle.mission_set_current(2 + first) is Result.ACCEPTED
    flight.fly(20.0, lambda: flight.vehicle.mission_state == 5)
    assert reached(flight) == [0, 2]


@pytest.mark.parametrize(
    ("bad", "word"),
    [
        (item(1, 82, 1.0), "82"),
        (item(1, 9999), "9999"),
        (item(1, 16, 1.0, frame=10), "frame 10"),
        (item(1, 16, 1.0, frame=2), "frame 2"),
        (item(1, 16, frame=3, up_m=5.0), "missing"),
        (item(1, 178, p2=0.0), "speed"),
        (item(1, 207, p1=1.0), "geofence"),
        (item(1, 18, 1.0, p1=0.0), "turns"),
        (item(1, 19, 1.0, p1=-4.0), "time"),
        (item(1, 115, p1=inf), "heading"),
        (item(1, 201, p1=2.0), "region"),
    ],
)
def test_what_cannot_be_flown_is_refused_with_its_seq_and_why(bad: PlanItem, word: str) -> None:
    refusal = Flight("px4").vehicle.check_plan((item(0, 22, up_m=3.0), bad))
    assert refusal is not None
    assert refusal[0] == 1
    assert word in refusal[1]


@pytest.mark.parametrize(
    ("bad", "word"),
    [
        (item(1, 16, 1.0, up_m=nan), "altitude"),
        (item(1, 16, 95_000.0, frame=3, up_m=5.0), "Earth"),
        (item(1, 177, p1=7.0, p2=1.0), "jump"),
    ],
)
def test_px4_stores_and_flies_what_leads_nowhere_and_ardupilot_refuses_it(
    bad: PlanItem, word: str
) -> None:
    """C11: PX4 1.14 arms with a jump beyond the end, with LAT 91, and without an altitude."""
    flight = Flight("px4").boot()
    plan = (item(0, 22, up_m=3.0), bad)
    assert flight.vehicle.check_plan(plan) is None
    flight.vehicle.load_plan(plan)
    assert flight.vehicle.set_mode_kind("mission") is Result.ACCEPTED
    assert flight.vehicle.arm(False) is Result.ACCEPTED
    flight.fly(15.0)
    assert flight.up_m > 2.2  # NAV_MC_ALT_RAD below its height
    refusal = Flight("ardupilot").vehicle.check_plan((item(0, 16), bad))
    assert refusal is not None
    assert word in refusal[1]


@pytest.mark.parametrize(
    "plan",
    [
        (item(0, 22, up_m=3.0), item(1, 112, p1=3.0), item(2, 16, 8.0, up_m=3.0)),
        (item(0, 16, 8.0, up_m=3.0), item(1, 22, up_m=3.0)),
        (item(0, 21, 8.0), item(1, 16, 8.0, up_m=3.0)),
    ],
    ids=["condition", "take-off second", "landing first"],
)
def test_px4_stores_and_does_not_fly_what_is_not_feasible(plan: tuple[PlanItem, ...]) -> None:
    """C9, C9c, C11."""
    flight = Flight("px4").boot()
    assert flight.vehicle.check_plan(plan) is None
    flight.vehicle.load_plan(plan)
    assert flight.vehicle.set_mode_kind("mission") is Result.ACCEPTED
    assert flight.vehicle.arm(False) is Result.TEMPORARILY_REJECTED
    flight.vehicle.set_mode_kind("hold")
    assert flight.vehicle.arm(False) is Result.ACCEPTED
    assert flight.vehicle.set_mode_kind("mission") is Result.TEMPORARILY_REJECTED


def test_px4_goes_up_to_the_first_item_says_so_and_does_not_begin_a_mission_anew_in_the_air() -> (
    None
):
    """C6 and C10."""
    flight = Flight("px4").boot()
    flight.vehicle.load_plan((item(0, 16, 6.0, 0.0, 8.0),))
    flight.vehicle.set_mode_kind("mission")
    assert flight.vehicle.arm(False) is Result.ACCEPTED
    flight.fly(40.0, lambda: flight.vehicle.mode_name == "AUTO.LOITER")
    assert flight.up_m == pytest.approx(8.0, abs=0.5)
    assert "Takeoff to 8.0 meters above home" in flight.texts()
    assert "Mission finished, loitering" in flight.texts()
    assert flight.vehicle.set_mode_kind("mission") is Result.ACCEPTED
    flight.fly(1.0)
    assert flight.vehicle.mode_name == "AUTO.LOITER"
    assert flight.texts()[-1] == "No valid mission available, loitering"


def test_ardupilots_home_item_is_not_judged_nor_flown() -> None:
    assert Flight("ardupilot").vehicle.check_plan((item(0, 9999), item(1, 22, up_m=3.0))) is None
    assert Flight("px4").vehicle.check_plan((item(0, 9999),)) is not None
