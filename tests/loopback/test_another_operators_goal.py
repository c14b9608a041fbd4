"""With `retarget = "replace"` a client replaces its own goal, and not one of who had control."""

from __future__ import annotations

from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from tests.loopback.bridged import north_of_home, take_off
from tests.loopback.flight import Personality
from tests.loopback.plan_clients import PlanFlight

ACCEPTED, TEMPORARILY_REJECTED = 0, 1
CONTROL, REPOSITION = 32100, 192
REPLACE = parse_policy('retarget = "replace"', "replace.toml")


def test_who_takes_control_is_told_that_anothers_goal_is_flown(personality: Personality) -> None:
    flight = PlanFlight(personality, policy=REPLACE)
    take_off(flight)
    (one,) = flight.clients.values()
    lat, lon, alt = north_of_home(flight, 30)
    one.fly_to(lat, lon, alt + 5)
    flight.until(lambda: flight.is_in(State.MOVING), 3)
    other = flight.join(246)
    assert other.ask(CONTROL, 1, 1) == ACCEPTED
    other.fly_to(lat, lon, alt + 10)
    flight.beating(1.0)
    assert [ack.result for ack in other.acks(REPOSITION)] == [TEMPORARILY_REJECTED]
    assert "BUSY: another operator's request is flown: MOVING" in other.texts()
    assert "hold it first" in other.texts()
    assert flight.is_in(State.MOVING)
