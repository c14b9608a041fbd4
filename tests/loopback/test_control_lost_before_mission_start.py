"""Control that another client takes while the start of a mission is prepared."""

from __future__ import annotations

from gcs.gate.states import State
from tests.loopback.flight import Personality
from tests.loopback.lossy_link import Weather
from tests.loopback.plan_clients import ACCEPTED, Mavsdk, PlanFlight, mission
from tests.loopback.test_set_current import ARM, MISSION_START, square

REQUEST_OPERATOR_CONTROL = 32100
SLOW = Weather(delay_s=(0.1, 0.1))


def test_who_has_lost_control_meanwhile_starts_no_mission(personality: Personality) -> None:
    flight = PlanFlight(personality, vehicle_weather=SLOW)
    first, second = flight.join(), flight.join(246)
    flight.connected()
    items = mission(personality, *square(personality))
    assert Mavsdk(flight, first, items).ended() == "complete", first.texts()
    assert first.ask(ARM, 1) == ACCEPTED
    first.command(MISSION_START)
    flight.run(0.3)
    second.command(REQUEST_OPERATOR_CONTROL, 1, 1)
    flight.beating(8.0)
    (refused,) = flight.decisions("refused")
    assert (refused.word, refused.code) == ("mission_start", "OTHER_OPERATOR")
    assert not flight.is_in(State.FLYING_MISSION)
    assert first.acks(MISSION_START)[-1].result != ACCEPTED
