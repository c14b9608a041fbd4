"""Mode changes, return, pause, speed, camera, silence of the station, battery."""

from __future__ import annotations

from math import nan, pi

import pytest

from tests.unit.autopilot.flight import Flight
from vehicle_sim.autopilot.interface import (
    Geodetic,
    ImageCaptured,
    Landed,
    Result,
    Setpoint,
    SpeedType,
)
from vehicle_sim.autopilot.modes import KINDS, MODES, Behaviour, Flag, Personality, by_number

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)
S = 1_000_000_000


@pytest.mark.parametrize(
    ("personality", "name", "number"),
    [
        ("px4", "MANUAL", 65536),
        ("px4", "POSCTL", 196608),
        ("px4", "OFFBOARD", 393216),
        ("px4", "AUTO.TAKEOFF", 33816576),
        ("px4", "AUTO.LOITER", 50593792),
        ("px4", "AUTO.MISSION", 67371008),
        ("px4", "AUTO.RTL", 84148224),
        ("px4", "AUTO.LAND", 100925440),
        ("ardupilot", "STABILIZE", 0),
        ("ardupilot", "GUIDED", 4),
        ("ardupilot", "BRAKE", 17),
    ],
)
def test_custom_modes_have_the_autopilots_numbers(
    personality: Personality, name: str, number: int
) -> None:
    assert MODES[personality][name].custom_mode == number
    mode = by_number(personality, number)
    assert mode is not None
    assert mode.name == name


@either
def test_the_mode_tables_are_total(personality: Personality) -> None:
    modes = MODES[personality]
    assert len({mode.custom_mode for mode in modes.values()}) == len(modes)
    assert set(KINDS[personality].values()) <= set(modes)
    other = {
        "px4": {Behaviour.CIRCLE},
        "ardupilot": {Behaviour.TAKEOFF, Behaviour.ORBIT},
    }
    wanted = set(Behaviour) - other[personality]
    assert {mode.behaviour for mode in modes.values()} == wanted
    assert all(mode.flags & Flag.CUSTOM_MODE_ENABLED for mode in modes.values())


@either
def test_a_mode_that_does_not_exist_is_refused(personality: Personality) -> None:
    flight = Flight(personality).boot()
    refused = {"px4": Result.TEMPORARILY_REJECTED, "ardupilot": Result.FAILED}
    assert flight.vehicle.set_mode(1, 99 << 24 | 4 << 16) is refused[personality]
    assert flight.vehicle.set_mode(0, 0) is Result.UNSUPPORTED
    assert flight.vehicle.set_mode_kind("sideways") is Result.UNSUPPORTED


@either
def test_a_mission_mode_without_a_mission_is_refused(personality: Personality) -> None:
    flight = Flight.hovering(personality, 3.0)
    refused = {"px4": Result.TEMPORARILY_REJECTED, "ardupilot": Result.FAILED}
    assert flight.vehicle.set_mode_kind("mission") is refused[personality]
    denied = {"px4": Result.DENIED, "ardupilot": Result.FAILED}
    assert flight.vehicle.mission_start(0, 0) is denied[personality]


@pytest.mark.parametrize("kind", ["manual", "altitude", "position"])
def test_px4_takes_no_manual_mode_in_the_air_without_sticks(kind: str) -> None:
    """B4: TEMPORARILY_REJECTED; on the ground it is entered, and does not arm."""
    flight = Flight.hovering("px4", 5.0)
    assert flight.vehicle.set_mode_kind(kind) is Result.TEMPORARILY_REJECTED
    flight = Flight("px4").boot()
    assert flight.vehicle.set_mode_kind(kind) is Result.ACCEPTED
    assert flight.vehicle.arm(False) is Result.TEMPORARILY_REJECTED


@pytest.mark.parametrize("kind", ["manual", "altitude", "position"])
def test_ardupilots_manual_modes_without_sticks_keep_the_height(kind: str) -> None:
    flight = Flight.hovering("ardupilot", 5.0)
    assert flight.vehicle.set_mode_kind(kind) is Result.ACCEPTED
    flight.fly(10.0)
    assert flight.up_m == pytest.approx(5.0, abs=0.4)
    assert flight.speed_m_s < 0.6


@either
def test_return_climbs_goes_home_and_lands(personality: Personality) -> None:
    flight = Flight.hovering(personality, 5.0)
    flight.vehicle.reposition((25.0, -10.0, -5.0), None, None)
    flight.fly(12.0)
    assert flight.off((25.0, -10.0, -5.0)) < 0.5
    name, up_m, unit = ("RTL_RETURN_ALT", 12.0, 1.0)
    if personality == "ardupilot":
        name, unit = "RTL_ALT", 100.0
    flight.vehicle.parameters.set(name, up_m * unit)
    assert flight.vehicle.return_home() is Result.ACCEPTED
    flight.fly(8.0, lambda: flight.up_m > up_m - 0.4)
    assert flight.off((25.0, -10.0, -up_m)) < 1.0
    highest = 0.0
    for _ in range(400):
        flight.fly(0.2)
        highest = max(highest, flight.up_m)
        if not flight.vehicle.armed:
            break
    assert not flight.vehicle.armed
    assert highest < up_m + 0.5
    assert flight.off((0.0, 0.0, 0.0)) < 0.6


@either
def test_the_last_metres_of_a_return_are_a_landing(personality: Personality) -> None:
    flight = Flight.hovering(personality, 5.0)
    name = "RTL_RETURN_ALT" if personality == "px4" else "RTL_ALT"
    flight.vehicle.parameters.set(name, 6.0 if personality == "px4" else 600.0)
    if personality == "px4":
        flight.vehicle.parameters.set("RTL_CONE_ANG", 0)  # else it does not climb over home
    flight.vehicle.return_home()
    flight.fly(1.0)
    assert flight.landed() is Landed.IN_AIR
    flight.fly(30.0, lambda: flight.landed() is Landed.LANDING)
    flight.fly(30.0, lambda: flight.landed() is Landed.ON_GROUND)


@either
def test_asked_to_hold_on_the_way_to_a_reposition_goal_it_stops(personality: Personality) -> None:
    flight = Flight.hovering(personality, 5.0)
    flight.vehicle.reposition((60.0, 0.0, -5.0), None, None)
    flight.fly(4.0)
    north, speed = flight.pos[0], flight.speed_m_s
    assert flight.vehicle.set_mode_kind("hold") is Result.ACCEPTED
    flight.fly(1.0 + speed * 0.8)
    assert flight.speed_m_s < 0.25
    assert flight.pos[0] < north + speed * 0.8 + speed * speed / (2.0 * 1.5)


def test_pause_and_resume() -> None:
    """PX4 1.14 knows neither (commands_px4.json: 193 UNSUPPORTED)."""
    flight = Flight.hovering("ardupilot", 5.0)
    assert flight.vehicle.resume() is Result.FAILED
    assert flight.vehicle.pause() is Result.ACCEPTED
    flight.fly(2.0)
    assert flight.speed_m_s < 0.25
    assert flight.vehicle.resume() is Result.ACCEPTED
    other = Flight.hovering("px4", 5.0)
    assert other.vehicle.pause() is other.vehicle.resume() is Result.UNSUPPORTED


@either
def test_speed_changes_and_goes_back(personality: Personality) -> None:
    flight = Flight.hovering(personality, 5.0)
    ground = SpeedType.GROUND
    assert flight.vehicle.change_speed(ground, -3.0) is Result.DENIED
    flight.vehicle.reposition((60.0, 0.0, -5.0), None, None)
    assert flight.vehicle.change_speed(ground, 1.5) is Result.ACCEPTED
    flight.fly(4.0)
    assert flight.speed_m_s == pytest.approx(1.5, abs=0.2)
    flight.vehicle.change_speed(ground, None)
    flight.fly(5.0)
    cruise_m_s = {"px4": 5.0, "ardupilot": 10.0}[personality]
    assert flight.speed_m_s == pytest.approx(cruise_m_s, abs=0.3)


@either
def test_altitude_changes_above_home(personality: Personality) -> None:
    flight = Flight.hovering(personality, 5.0)
    assert flight.vehicle.change_altitude(8.0) is Result.ACCEPTED
    flight.fly(6.0)
    assert flight.off((0.0, 0.0, -8.0)) < 0.4


@either
def test_the_nose_turns_the_way_it_was_told(personality: Personality) -> None:
    flight = Flight.hovering(personality, 5.0)
    assert flight.vehicle.condition_yaw(0.5 * pi, False, 1.0, -1) is Result.ACCEPTED
    flight.fly(2.0)
    assert pi < flight.vehicle.estimate.heading_rad < 2.0 * pi  # the long way round
    flight.fly(6.0)
    assert flight.vehicle.estimate.heading_rad == pytest.approx(0.5 * pi, abs=0.05)
    flight.vehicle.condition_yaw(0.5, True, 0.0, 1)
    flight.fly(4.0)
    assert flight.vehicle.estimate.heading_rad == pytest.approx(0.5 * pi + 0.5, abs=0.05)


@either
def test_flights_asked_for_on_the_ground_move_nothing(personality: Personality) -> None:
    """As recorded they are ACCEPTED there; ArduCopter's pause is FAILED."""
    flight = Flight(personality).boot()
    vehicle = flight.vehicle
    assert vehicle.reposition((1.0, 0.0, -2.0), None, None) is Result.ACCEPTED
    assert vehicle.change_altitude(3.0) is Result.ACCEPTED
    assert vehicle.condition_yaw(1.0, False, 1.0, 0) is Result.ACCEPTED
    unknown = personality == "px4"
    assert vehicle.pause() is (Result.UNSUPPORTED if unknown else Result.FAILED)
    flight.fly(5.0)
    assert flight.landed() is Landed.ON_GROUND
    assert not vehicle.armed


@either
def test_a_picture_takes_its_exposure_and_tells_where_it_was(personality: Personality) -> None:
    flight = Flight.hovering(personality, 5.0)
    assert flight.vehicle.capture_image(0.0, 1) is Result.ACCEPTED
    flight.fly(1.9)
    assert flight.capturing()
    assert flight.vehicle.capture_image(0.0, 1) is Result.TEMPORARILY_REJECTED
    flight.fly(0.3)
    assert not flight.capturing()
    assert flight.vehicle.images_captured == 1
    (picture,) = [event for event in flight.seen if isinstance(event, ImageCaptured)]
    assert picture.index == 0
    assert picture.alt_rel_m == pytest.approx(-flight.vehicle.truth.pos_ned[2], abs=0.4)


def test_a_series_of_pictures_keeps_its_interval_and_can_be_stopped() -> None:
    flight = Flight("px4").boot()
    flight.vehicle.parameters.set("CAM_EXPOSURE_S", 0.1)
    flight.vehicle.capture_image(1.0, 0)
    flight.fly(4.5)
    assert flight.vehicle.images_captured == 5
    flight.vehicle.stop_capture()
    flight.fly(3.0)
    assert flight.vehicle.images_captured == 5


def test_flying_empties_the_battery_at_a_believable_rate() -> None:
    flight = Flight.hovering("px4", 5.0)
    before = flight.vehicle.power.consumed_mah
    flight.fly(30.0)
    drain_a = (flight.vehicle.power.consumed_mah - before) * 3.6 / 30.0
    assert 12.0 < drain_a < 22.0
    assert 14.0 < flight.vehicle.power.voltage_v < 16.8


def test_home_moves_when_told_and_at_arming() -> None:
    flight = Flight("px4").boot()
    there = Geodetic(47.3978, 8.5456, 488.0)
    assert flight.vehicle.set_home(there) is Result.ACCEPTED
    home = flight.vehicle.home
    assert home is not None
    assert home.lat_deg == pytest.approx(there.lat_deg, abs=1e-9)
    assert flight.vehicle.set_home(Geodetic(nan, 8.0, 400.0)) is Result.DENIED
    flight.vehicle.arm(False)
    home_ned = flight.vehicle.home_pos_ned
    assert home_ned is not None
    assert max(map(abs, home_ned)) < 0.3


def test_the_same_seed_and_inputs_fly_the_same_bytes() -> None:
    def fly(seed: int, curious: bool) -> bytes:
        flight = Flight("px4", seed).airborne(4.0)
        flight.stream(Setpoint(pos_ned=(2.0, 1.0, -4.0)), 1.2)
        flight.vehicle.set_mode_kind("guided")
        for _ in range(40):
            flight.stream(Setpoint(pos_ned=(2.0, 1.0, -4.0)), 0.05)
            if curious:
                assert flight.vehicle.estimate.gps_ok
        return flight.vehicle.state_bytes()

    assert fly(1, False) == fly(1, True)
    assert fly(1, False) != fly(2, False)


@either
def test_a_copy_of_a_hover_flies_on_as_a_vehicle_that_flew_there(personality: Personality) -> None:
    """What `Flight.hovering` rests on; no copy is seen by the next one either."""
    flights = [Flight.hovering(personality), Flight.hovering(personality)]
    flights.append(Flight(personality).airborne())
    ends = []
    for flight in flights:
        flight.stream(Setpoint(pos_ned=(2.0, 1.0, -4.0)), 1.2)
        assert flight.vehicle.set_mode_kind("land") is Result.ACCEPTED
        flight.fly(4.0)
        ends.append((flight.vehicle.state_bytes(), flight.seen))
    assert ends[0] == ends[1] == ends[2]
