"""Another item of the mission: from a client in flight, or before a start in the air.

The way from where the vehicle is to that item is verified as a start is; nothing else gets there.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from msgspec import structs

from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Policy
from gcs.gate.policy.zonespec import CircleSpec
from gcs.gate.states import State
from tests.loopback.bridged import Client, joined
from tests.loopback.flight import HOMES, Personality
from tests.loopback.plan_clients import ACCEPTED, NORTH_DEG, Mavsdk, PlanFlight, mission
from vehicle_sim.autopilot.firmware import Firmware

ARM, TAKE_OFF, MISSION_START, SET_CURRENT = 400, 22, 300, 224
DENIED = 2
SQUARE = ((40.0, 0.0, 10.0), (40.0, 40.0, 10.0), (0.0, 40.0, 10.0))
FAR_CORNER = (40.0, 40.0)
"""East and north; the diagonal from the first waypoint to the last one passes 28 m beside it."""
MAST = CircleSpec(3.0, (28.0, 12.0), name="mast", inclusion=False)
"""On the diagonal from the first waypoint to the last one; 8 m and more beside the square's sides
and the ways home from its corners."""
EAST_40_M: dict[Personality, float] = {
    name: 40.0 * NORTH_DEG / math.cos(math.radians(home.lat_deg)) for name, home in HOMES.items()
}
"""40 m east, in degrees of longitude."""
FIELD = CircleSpec(90.0, (0.0, 0.0), name="field", inclusion=True)


def square(personality: Personality) -> list[tuple[float, float, float]]:
    """For `mission`, whose degrees of longitude are as long as those of latitude."""
    shorter = math.cos(math.radians(HOMES[personality].lat_deg))
    return [(north_m, east_m / shorter, up_m) for north_m, east_m, up_m in SQUARE]


def seq(personality: Personality, item: int) -> int:
    """MAVLink's number of an item, counted from 0; home is ArduPilot's first."""
    return item + (personality == "ardupilot")


def with_square(
    personality: Personality, policy: Policy = DEFAULT, firmware: Firmware | None = None
) -> PlanFlight:
    flight, client = joined(PlanFlight(personality, policy=policy, firmware=firmware))
    assert (
        Mavsdk(flight, client, mission(personality, *square(personality))).ended() == "complete"
    ), client.texts()
    assert client.ask(ARM, 1) == ACCEPTED
    return flight


def hovering(flight: PlanFlight) -> Client:
    """10 m above home."""
    client, nan = flight.clients[1], math.nan
    on_px4 = flight.personality == "px4"
    client.command(TAKE_OFF, 0, 0, 0, nan, nan, nan, 10.0 + on_px4 * HOMES["px4"].alt_amsl_m)
    wait(flight, lambda: flight.is_in(State.HOVERING), 30.0)
    flight.beating(3.0)  # until it is shown that it is under control
    return client


def flown(flight: PlanFlight) -> PlanFlight:
    """On its way from its first waypoint to the second."""
    flight.clients[1].command(MISSION_START)
    second = seq(flight.personality, 2)
    wait(flight, lambda: flight.is_in(State.FLYING_MISSION), 10.0)
    wait(flight, lambda: shown(flight) == second, 60.0)
    return flight


def wait(flight: PlanFlight, true: Callable[[], bool], within_s: float) -> None:
    """Let time pass, while the client lives on, until it is so."""
    for _ in range(round(5 * within_s)):
        if true():
            return
        flight.clients[1].beat()
        flight.run(0.2)
    raise AssertionError(f"not within {within_s} s: {flight.told()}")


def shown(flight: PlanFlight) -> int:
    """What MISSION_CURRENT told the client last."""
    latest = (one.message for one in reversed(flight.clients[1].heard))
    return next((int(one.seq) for one in latest if one.get_type() == "MISSION_CURRENT"), -1)


def least_m(flight: PlanFlight, place: tuple[float, float], seconds: float) -> float:
    """How near the truth comes to a place, while the client lives on."""
    nearest_m = math.inf
    for _ in range(round(10 * seconds)):
        flight.clients[1].beat()
        flight.run(0.1)
        nearest_m = min(nearest_m, math.dist(flight.truth_enu()[:2], place))
    return nearest_m


def test_a_mission_that_is_flown_goes_on_at_the_item_that_a_client_names(
    personality: Personality,
) -> None:
    flight = flown(with_square(personality))
    client = flight.clients[1]
    last = seq(personality, 3)
    assert client.ask(SET_CURRENT, last, within_s=20.0) == ACCEPTED
    wait(flight, lambda: shown(flight) == last, 5.0)
    assert flight.is_in(State.FLYING_MISSION)
    assert least_m(flight, FAR_CORNER, 20.0) > 8.0
    asked = [one.word for one in flight.decisions("accepted")][-4:]
    assert asked == ["hold", "resume", "mission_set_current", "mission_start"]


def test_the_way_to_the_item_is_verified_from_where_the_vehicle_stopped(
    personality: Personality,
) -> None:
    flight = flown(with_square(personality, structs.replace(DEFAULT, fence=(FIELD, MAST))))
    client = flight.clients[1]
    assert client.ask(SET_CURRENT, seq(personality, 3), within_s=20.0) == DENIED
    assert "mast" in client.texts()
    assert least_m(flight, MAST.centre, 20.0) > MAST.radius_m
    assert not flight.is_in(State.FLYING_MISSION)


def test_an_item_that_is_not_there_stops_nothing(personality: Personality) -> None:
    flight = flown(with_square(personality))
    assert flight.clients[1].ask(SET_CURRENT, 9) == DENIED
    assert flight.is_in(State.FLYING_MISSION)
    assert "there is no item 9" in flight.clients[1].texts()


def test_before_a_start_in_the_air_it_says_where_the_mission_begins_once(
    personality: Personality,
) -> None:
    """After that start, one that follows begins at the first item again."""
    flight = with_square(personality)
    client = hovering(flight)
    last, first = seq(personality, 3), seq(personality, 1)
    assert client.ask(SET_CURRENT, last) == ACCEPTED
    assert flight.is_in(State.HOVERING)
    client.command(MISSION_START)
    wait(flight, lambda: flight.is_in(State.FLYING_MISSION), 10.0)
    assert least_m(flight, FAR_CORNER, 2.0) > 8.0
    assert shown(flight) == last
    client.command(17)  # NAV_LOITER_UNLIM: hold
    wait(flight, lambda: flight.is_in(State.HOLDING), 10.0)
    client.command(MISSION_START)
    wait(flight, lambda: flight.is_in(State.FLYING_MISSION), 10.0)
    wait(flight, lambda: shown(flight) <= first, 10.0)


def test_item_0_is_the_first_item_and_is_answered_at_once(personality: Personality) -> None:
    """Item 0 is home for an ArduPilot, which goes on to the item after it."""
    flight = with_square(personality)
    client = hovering(flight)
    assert client.ask(SET_CURRENT, seq(personality, 2), within_s=3.0) == ACCEPTED
    assert client.ask(SET_CURRENT, 0, within_s=3.0) == ACCEPTED
    flight.beating(1.5)
    assert shown(flight) == seq(personality, 0)
    assert client.ask(MISSION_START, within_s=5.0) == ACCEPTED
    assert flight.is_in(State.FLYING_MISSION)


def test_an_arducopter_that_flies_its_mission_begins_it_anew_by_item_0() -> None:
    flight = flown(with_square("ardupilot"))
    client = flight.clients[1]
    assert client.ask(SET_CURRENT, 0, within_s=8.0) == ACCEPTED
    wait(flight, lambda: flight.is_in(State.FLYING_MISSION), 3.0)
    assert shown(flight) in (1, 2)


def test_on_the_ground_a_mission_begins_with_its_first_item(personality: Personality) -> None:
    flight = with_square(personality)
    client = flight.clients[1]
    assert client.ask(SET_CURRENT, seq(personality, 3)) != ACCEPTED
    assert "on the ground a mission begins with its first item" in client.texts()
    assert client.ask(SET_CURRENT, seq(personality, 0)) == ACCEPTED
    assert not flight.is_in(State.FLYING_MISSION)


def test_an_arducopter_may_begin_anew_by_its_own_setting_so_all_of_it_must_clear(
    personality: Personality,
) -> None:
    """MIS_RESTART 1: whatever item it was set to, it begins at the first, here behind the mast."""
    flight = with_square(personality, structs.replace(DEFAULT, fence=(FIELD, MAST)))
    client = hovering(flight)
    home = HOMES[personality]
    client.fly_to(home.lat_deg, home.lon_deg + EAST_40_M[personality], home.alt_amsl_m + 10.0)
    wait(flight, lambda: math.dist(flight.truth_enu()[:2], (40.0, 0.0)) < 1.0, 30.0)
    wait(flight, lambda: flight.is_in(State.HOVERING), 10.0)
    assert client.ask(SET_CURRENT, seq(personality, 3)) == ACCEPTED
    started = client.ask(MISSION_START, within_s=20.0)
    if personality == "px4":
        assert started == ACCEPTED
    else:
        assert started == DENIED
        assert "mast" in client.texts()
