"""A mission for which the battery does not last: through the bridge, and when it starts."""

from __future__ import annotations

import pytest

from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from tests.loopback.flight import HOMES, Personality
from tests.loopback.plan_clients import ACCEPTED, NO_PLACE, Mavsdk, PlanFlight, PlanItem, mission

DENIED, DENIED_COMMAND = 14, 2
TAKE_OFF, DO_JUMP, MISSION_START, ARM = 22, 177, 300, 400
SQUARE = ((20.0, 0.0, 10.0), (20.0, 20.0, 10.0), (0.0, 20.0, 10.0))


def connected(personality: Personality, endurance_s: float) -> PlanFlight:
    policy = parse_policy(f"battery.endurance_s = {endurance_s}", "my.toml")
    flight = PlanFlight(personality, policy=policy)
    flight.join()
    flight.connected()
    return flight


def test_it_never_reaches_the_vehicle_and_its_client_reads_why(personality: Personality) -> None:
    flight = connected(personality, 60.0)
    client = flight.clients[1]
    upload = Mavsdk(flight, client, mission(personality, *SQUARE))
    assert upload.ended() == f"refused {DENIED}"
    assert not flight.to_vehicle("MISSION_COUNT")
    (decision,) = flight.decisions("refused")
    assert decision.code == "BATTERY_REACH"
    assert (decision.numbers["battery_lasts_s"] or 0.0) == pytest.approx(0.85 * 60.0, rel=0.05)
    assert "the battery is low after" in client.texts()


def test_what_repeats_for_ever_is_refused_and_what_repeats_once_is_flown(
    personality: Personality,
) -> None:
    flight = connected(personality, 600.0)
    client = flight.clients[1]
    again = PlanItem(DO_JUMP, frame=NO_PLACE, params=(1.0, -1.0, 0.0, 0.0))
    items = mission(personality, *SQUARE)
    upload = Mavsdk(flight, client, [*items[:-1], again, items[-1]])
    assert upload.ended() == f"refused {DENIED}"
    assert "repeats for ever" in client.texts()
    once = PlanItem(DO_JUMP, frame=NO_PLACE, params=(1.0, 1.0, 0.0, 0.0))
    assert Mavsdk(flight, client, [*items[:-1], once, items[-1]]).ended() == "complete"
    assert client.ask(ARM, 1) == ACCEPTED
    client.command(MISSION_START)
    flight.until(lambda: flight.is_in(State.FLYING_MISSION), 10.0)


def test_at_its_start_the_charge_that_is_left_then_counts(personality: Personality) -> None:
    """A battery that just lasts for it on the ground does not after two minutes of hovering."""
    flight = connected(personality, 600.0)
    often = PlanItem(DO_JUMP, frame=NO_PLACE, params=(1.0, 6.0, 0.0, 0.0))
    square = mission(personality, *SQUARE)
    items = [*square[:-1], often, square[-1]]
    assert Mavsdk(flight, flight.clients[1], items).ended() == "complete"
    (takes_s,) = (d.numbers["flight_s"] for d in flight.decisions("accepted") if d.numbers)
    assert takes_s is not None

    flight = connected(personality, takes_s / 0.85 + 1.0)
    client = flight.clients[1]
    assert Mavsdk(flight, client, items).ended() == "complete"
    assert client.ask(ARM, 1) == ACCEPTED
    nan = float("nan")
    above_m = HOMES[personality].alt_amsl_m if personality == "px4" else 0.0
    client.command(TAKE_OFF, 0, 0, 0, nan, nan, nan, above_m + 10.0)
    flight.until(lambda: flight.is_in(State.HOVERING), 30.0)
    flight.beating(120.0)
    assert client.ask(MISSION_START) == DENIED_COMMAND
    assert "are left of" in client.texts()
    assert not flight.is_in(State.FLYING_MISSION)
