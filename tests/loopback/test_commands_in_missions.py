"""What a client may not command, its missions do not carry, through the whole bridge."""

from __future__ import annotations

from dataclasses import replace

import pytest

from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from tests.loopback.flight import PERSONALITIES, Personality
from tests.loopback.plan_clients import (
    ACCEPTED,
    DO_JUMP,
    NO_PLACE,
    Mavsdk,
    PlanFlight,
    PlanItem,
    mission,
)

COMMAND_DENIED, MISSION_DENIED = 2, 14
ARM, MISSION_START, FENCE_ENABLE, PHOTO = 400, 300, 207, 203
SQUARE = ((20.0, 0.0, 10.0), (20.0, 20.0, 10.0), (0.0, 20.0, 10.0))

pytestmark = pytest.mark.parametrize("personality", PERSONALITIES)


def connected(personality: Personality, bridge: str = "") -> PlanFlight:
    flight = PlanFlight(personality, policy=parse_policy(f"[bridge]\n{bridge}\n", "my.toml"))
    flight.join()
    flight.connected()
    return flight


def carrying(personality: Personality, command: int, *params: float) -> list[PlanItem]:
    """A square, and before its return a command."""
    items = mission(personality, *SQUARE)
    p1, p2, p3, p4 = (*params, 0.0, 0.0, 0.0, 0.0)[:4]
    return [*items[:-1], PlanItem(command, frame=NO_PLACE, params=(p1, p2, p3, p4)), items[-1]]


def test_a_mission_that_switches_the_fence_off_never_reaches_the_vehicle(
    personality: Personality,
) -> None:
    flight = connected(personality)
    client, before = flight.clients[1], flight.vehicle.plan
    for uploads in (1, 2):
        upload = Mavsdk(flight, client, carrying(personality, FENCE_ENABLE, 0.0))
        assert upload.ended() == f"refused {MISSION_DENIED}"
        flight.run(0.5)
        told = client.texts().count("item 5 (DO_FENCE_ENABLE): switching the vehicle's own fence")
        assert told == uploads, "of each upload"
    assert "bridge.fence" in client.texts()
    assert client.ask(FENCE_ENABLE, 0) == COMMAND_DENIED
    assert flight.vehicle.plan == before
    assert not flight.to_vehicle("MISSION_COUNT")
    assert [each.code for each in flight.decisions("refused")] == ["POLICY"] * 3


def test_what_the_policy_denies_by_its_name_is_denied_in_a_mission_too(
    personality: Personality,
) -> None:
    denied = connected(personality, 'extra_denied = ["DO_DIGICAM_CONTROL"]')
    client = denied.clients[1]
    upload = Mavsdk(denied, client, carrying(personality, PHOTO))
    assert upload.ended() == f"refused {MISSION_DENIED}"
    denied.run(0.5)
    assert "item 5 (DO_DIGICAM_CONTROL): the policy denies it by its name" in client.texts()
    assert client.ask(PHOTO) == COMMAND_DENIED
    assert client.texts().count("bridge.extra_denied") == 2
    flight = connected(personality)
    upload = Mavsdk(flight, flight.clients[1], carrying(personality, PHOTO))
    assert upload.ended() == "complete"


def test_a_mission_that_was_put_on_board_past_the_bridge_and_switches_it_does_not_start(
    personality: Personality,
) -> None:
    flight = connected(personality)
    client = flight.clients[1]
    assert Mavsdk(flight, client, mission(personality, *SQUARE)).ended() == "complete"
    good = flight.vehicle.plan
    other = connected(personality)
    switch = replace(good[-2], command=FENCE_ENABLE, frame=NO_PLACE, x=0, y=0, z=0.0)
    other.vehicle.load_plan((*good[:-2], switch, good[-1]))
    client = other.clients[1]
    assert client.ask(ARM, 1) == ACCEPTED
    client.command(MISSION_START)
    other.beating(5.0)
    assert not other.is_in(State.FLYING_MISSION)
    assert "(DO_FENCE_ENABLE): switching the vehicle's own fence" in client.texts()


def test_a_mission_that_repeats_for_ever_is_on_board_and_its_client_is_told(
    personality: Personality,
) -> None:
    flight = connected(personality)
    client = flight.clients[1]
    first = 1 if personality == "ardupilot" else 0
    upload = Mavsdk(flight, client, carrying(personality, DO_JUMP, first + 1.0, -1.0))
    assert upload.ended() == "complete"
    assert "warning: item 5 (DO_JUMP): repeats for ever" in client.texts()
