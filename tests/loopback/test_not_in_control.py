"""What is flown for one client is no success of another one, who is refused and recorded."""

from __future__ import annotations

from gcs.gate.states import State
from tests.loopback.bridged import Client, north_of_home, take_off
from tests.loopback.flight import Personality
from tests.loopback.plan_clients import Mavsdk, PlanFlight, mission

ACCEPTED, TEMPORARILY_REJECTED = 0, 1
ARM, SET_MODE, MISSION_START, REPOSITION, CONTROL = 400, 176, 300, 192, 32100
MISSION_MODE = {"px4": (129.0, 4.0, 4.0), "ardupilot": (129.0, 3.0, 0.0)}
SQUARE = ((20.0, 0.0, 10.0), (20.0, 20.0, 10.0), (0.0, 20.0, 10.0))


def flown_mission(personality: Personality) -> tuple[PlanFlight, Client, Client]:
    """A mission of the first client is flown; the second one is only there."""
    flight = PlanFlight(personality)
    one = flight.join()
    flight.connected()
    assert Mavsdk(flight, one, mission(personality, *SQUARE)).ended() == "complete"
    assert one.ask(ARM, 1) == ACCEPTED
    assert one.ask(MISSION_START) == ACCEPTED
    flight.until(lambda: flight.is_in(State.FLYING_MISSION), 10.0)
    return flight, one, flight.join(246)


def refused_words(flight: PlanFlight) -> list[str]:
    refused = [item for item in flight.decisions("refused") if item.code == "OTHER_OPERATOR"]
    return [item.word for item in refused]


def test_the_mission_of_another_client_cannot_be_started(personality: Personality) -> None:
    flight, one, other = flown_mission(personality)
    assert other.ask(MISSION_START) == TEMPORARILY_REJECTED
    assert other.ask(SET_MODE, *MISSION_MODE[personality]) == TEMPORARILY_REJECTED
    assert refused_words(flight) == ["mission_start", "mission_start"]
    assert "OTHER_OPERATOR" in other.texts()
    assert one.ask(SET_MODE, *MISSION_MODE[personality]) == ACCEPTED, "it is so already"
    assert flight.is_in(State.FLYING_MISSION)


def test_who_has_lost_control_cannot_start_its_own_mission_again(personality: Personality) -> None:
    flight, one, other = flown_mission(personality)
    assert other.ask(CONTROL, 1, 1) == ACCEPTED
    assert one.ask(MISSION_START) == TEMPORARILY_REJECTED
    assert refused_words(flight) == ["mission_start"]
    assert flight.is_in(State.FLYING_MISSION), "flown on for the other one"


def test_the_goal_of_another_client_cannot_be_asked_for(personality: Personality) -> None:
    flight = PlanFlight(personality)
    take_off(flight)
    (one,) = flight.clients.values()
    lat, lon, alt = north_of_home(flight, 30)
    one.fly_to(lat, lon, alt + 5)
    flight.until(lambda: flight.is_in(State.MOVING), 3)
    other = flight.join(246)
    other.fly_to(lat, lon, alt + 5)
    flight.beating(1.0)
    assert [ack.result for ack in other.acks(REPOSITION)] == [TEMPORARILY_REJECTED]
    assert refused_words(flight) == ["goto"]
    one.fly_to(lat, lon, alt + 5)
    flight.beating(0.5)
    assert {ack.result for ack in one.acks(REPOSITION)} == {ACCEPTED}
