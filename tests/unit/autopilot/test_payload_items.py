"""Mission items of payloads, servos, relays, jump tags, guided limits and terrain.

Row 22 of clients.md.
"""

from __future__ import annotations

import pytest

from tests.unit.autopilot.flight import Flight, item
from tests.unit.autopilot.test_mission import either, numbered, reached, started
from vehicle_sim.autopilot.interface import PlanItem, Result, StatusText
from vehicle_sim.autopilot.modes import Personality

TAKE_OFF = item(0, 22, up_m=5.0)
BEFORE, AFTER = item(0, 16, 6.0, 0.0, 5.0), item(0, 16, 12.0, 0.0, 5.0)
STAY = item(0, 17, 12.0, 0.0, 5.0)
TERRAIN = 10


def ardupilot(*items: PlanItem) -> Flight:
    """Started; numbered here, in the order given."""
    return started("ardupilot", *items)


def texts(flight: Flight) -> list[str]:
    return [event.text for event in flight.seen if isinstance(event, StatusText)]


def arrives(flight: Flight, *seqs: int) -> None:
    def there() -> bool:
        flight.seen += flight.vehicle.events()
        return reached(flight)[-len(seqs) :] == list(seqs)

    flight.fly(90.0, there)


# ------------------------------------------------------------------- servos and relays


def test_a_servo_is_set_when_the_mission_comes_to_it() -> None:
    flight = ardupilot(TAKE_OFF, BEFORE, item(0, 183, p1=9, p2=1900), AFTER, STAY)
    arrives(flight, 0)
    assert flight.vehicle.servos_us[8] == 0
    arrives(flight, 1)
    flight.fly(0.2)
    assert flight.vehicle.servos_us[8] == 1900
    assert "Mission: 3 SetServo" in texts(flight)


def test_a_servo_is_moved_to_and_fro_so_often() -> None:
    flight = ardupilot(TAKE_OFF, BEFORE, item(0, 184, p1=10, p2=1800, p3=2, p4=1.0), STAY)
    arrives(flight, 1)
    seen = []
    for _ in range(30):
        flight.fly(0.1)
        seen.append(flight.vehicle.servos_us[9])
    switched = [now for last, now in zip([0, *seen], seen, strict=False) if now != last]
    assert switched == [1800, 1500, 1800, 1500]
    assert sum(each == 1800 for each in seen) == pytest.approx(10, abs=2), "half a second each"


def test_a_relay_is_switched() -> None:
    flight = ardupilot(
        TAKE_OFF, item(0, 181, p1=0, p2=1), BEFORE, item(0, 181, p1=0, p2=0), AFTER, STAY
    )
    assert flight.vehicle.relays == (1, 0)
    arrives(flight, 0)
    flight.fly(0.3)
    assert flight.vehicle.relays == (1, 1)
    arrives(flight, 2)
    flight.fly(0.3)
    assert flight.vehicle.relays == (1, 0)


def test_commands_do_the_same_as_the_items() -> None:
    """Recorded: 183 on output 9 and 181 on relay 0 ACCEPTED.  Motors' outputs: from memory."""
    flight = Flight("ardupilot").boot()
    vehicle = flight.vehicle
    assert vehicle.set_servo(9, 1500) is Result.ACCEPTED
    assert vehicle.servos_us[8] == 1500
    assert vehicle.set_servo(1, 1900) is Result.FAILED
    assert vehicle.set_servo(17, 1900) is Result.FAILED
    assert vehicle.set_relay(0, 1) is Result.ACCEPTED
    assert vehicle.relays == (1, 1)
    assert vehicle.set_relay(1, 1) is Result.FAILED
    assert vehicle.repeat_relay(0, 1, 1.0) is Result.ACCEPTED
    assert vehicle.relays == (1, 0)
    flight.fly(0.7)
    assert vehicle.relays == (1, 1)
    assert "ServoRelayEvent: Channel 1 is already in use" in texts(flight)
    vehicle.reboot()
    assert vehicle.servos_us == (0,) * 16
    assert vehicle.relays == (1, 0)


# --------------------------------------------------------------------------- jump tags


def test_a_jump_leads_to_its_tag_and_so_often() -> None:
    flight = ardupilot(
        TAKE_OFF, item(0, 600, p1=7), BEFORE, AFTER, item(0, 601, p1=7, p2=1), item(0, 20)
    )
    arrives(flight, 0, 2, 3, 2, 3)
    flight.fly(60.0, lambda: not flight.vehicle.armed)
    assert reached(flight).count(2) == 2


def test_a_jump_to_a_tag_that_there_is_not_ends_the_mission() -> None:
    flight = ardupilot(TAKE_OFF, BEFORE, item(0, 601, p1=8, p2=-1), AFTER)
    arrives(flight, 1)
    flight.fly(1.0)
    assert flight.vehicle.mission_state == 5
    assert 3 not in reached(flight)


# -------------------------------------------------------------- payloads: place and wait


@pytest.mark.parametrize(("most_m", "least_up_m"), [(2.0, 3.0), (0.0, 0.0)])
def test_a_payload_is_brought_down_and_the_vehicle_comes_up_again(
    most_m: float, least_up_m: float
) -> None:
    """Down by param 1, or to the ground; then on."""
    flight = ardupilot(TAKE_OFF, item(0, 94, 6.0, 0.0, 5.0, p1=most_m), AFTER, STAY)
    arrives(flight, 0)
    lowest_m = 5.0

    def placed() -> bool:
        nonlocal lowest_m
        lowest_m = min(lowest_m, flight.up_m)
        flight.seen += flight.vehicle.events()
        return reached(flight)[-1:] == [1]

    flight.fly(60.0, placed)
    assert lowest_m == pytest.approx(least_up_m, abs=0.5)
    assert flight.up_m == pytest.approx(5.0, abs=0.6)
    assert flight.vehicle.armed
    arrives(flight, 2)


@pytest.mark.parametrize("command", [211, 42600])
def test_px4_waits_for_a_payload_that_never_answers(command: int) -> None:
    """Stored by PX4 1.14.3 (C8_upload_item_kinds); that it waits MIS_PD_TO is from memory."""
    flight = started("px4", TAKE_OFF, BEFORE, item(2, command, frame=2, p1=1), AFTER, STAY)
    arrives(flight, 1)
    begun_ns = flight.vehicle.time_ns
    arrives(flight, 2)
    assert (flight.vehicle.time_ns - begun_ns) / 1e9 == pytest.approx(5.0, abs=0.3)
    arrives(flight, 3)


@pytest.mark.parametrize("command", [208, 211, 218, 42600])
def test_ardupilot_flies_on_past_equipment_that_there_is_not(command: int) -> None:
    flight = ardupilot(TAKE_OFF, BEFORE, item(0, command, frame=2, p1=1), AFTER, STAY)
    arrives(flight, 1, 3)
    name = {208: "Parachute", 211: "Gripper", 218: "AuxFunction", 42600: "Winch"}[command]
    assert f"Mission: 3 {name}" in texts(flight)
    assert not [text for text in texts(flight) if "equipment" in text]


# ---------------------------------------------------------------------------- guided


def test_a_mission_waits_for_guidance_as_long_as_its_limits_say() -> None:
    flight = ardupilot(
        TAKE_OFF, BEFORE, item(0, 222, frame=2, p1=4, p4=0), item(0, 92, frame=2, p1=1), AFTER
    )
    arrives(flight, 1)
    begun_ns = flight.vehicle.time_ns
    arrives(flight, 3)
    assert (flight.vehicle.time_ns - begun_ns) / 1e9 == pytest.approx(4.0, abs=0.3)
    arrives(flight, 4)


def test_without_limits_it_waits_for_ever_and_0_waits_for_nothing() -> None:
    flight = ardupilot(
        TAKE_OFF, item(0, 92, frame=2, p1=0), BEFORE, item(0, 92, frame=2, p1=1), AFTER
    )
    arrives(flight, 0, 1, 2)
    flight.fly(60.0)
    assert reached(flight) == [0, 1, 2]


# --------------------------------------------------------------------------- terrain


def test_a_mission_above_terrain_is_stored_and_not_armed_for() -> None:
    """Stored with frame 10 (C8_upload_item_kinds); the words are from memory."""
    flight = Flight("ardupilot").boot()
    plan = numbered("ardupilot", TAKE_OFF, item(1, 16, 6.0, 0.0, 5.0, frame=TERRAIN))
    assert flight.vehicle.check_plan(plan) is None
    flight.vehicle.load_plan(plan)
    flight.vehicle.set_mode_kind("guided")
    assert flight.vehicle.arm(False) is Result.FAILED
    flight.fly(0.1)
    assert "Arm: waiting for terrain data" in texts(flight)


def test_in_flight_an_item_above_terrain_brings_the_vehicle_home() -> None:
    """Nothing is known of the terrain: the failsafe acts, as from memory of ArduCopter."""
    flight = Flight("ardupilot").boot()
    flight.vehicle.set_mode_kind("guided")
    flight.vehicle.arm(False)
    flight.vehicle.take_off(5.0)
    flight.fly(15.0, lambda: flight.up_m > 4.8)
    plan = numbered("ardupilot", BEFORE, item(1, 16, 12.0, 0.0, 5.0, frame=TERRAIN), AFTER)
    flight.vehicle.load_plan(plan)
    assert flight.vehicle.mission_start(0, 0) is Result.ACCEPTED
    flight.fly(30.0, lambda: flight.vehicle.mode_name == "RTL")
    assert "Failsafe: Terrain data missing" in texts(flight)
    assert flight.vehicle.mission_current == 2
    flight.fly(60.0, lambda: not flight.vehicle.armed)


@either
def test_what_each_of_the_two_stores(personality: Personality) -> None:
    """C8_upload_item_kinds of both recordings."""
    flight = Flight(personality)
    for command in (92, 94, 181, 182, 183, 184, 208, 211, 218, 222, 600, 601, 42600):
        plan = numbered(personality, TAKE_OFF, item(1, command, 6.0, 0.0, 5.0, p1=1, p2=1))
        stored = flight.vehicle.check_plan(plan) is None
        assert stored is (personality == "ardupilot" or command in (211, 42600)), command
    for frame in (10, 11):
        plan = numbered(personality, TAKE_OFF, item(1, 16, 6.0, 0.0, 5.0, frame=frame))
        assert (flight.vehicle.check_plan(plan) is None) is (personality == "ardupilot")
