"""Every mission item that is to be flown to at once (`current` 2) is decided by the gate by itself.

MAVProxy's `guided`, DroneKit's `simple_goto`; what is said of each is one MISSION_ACK.  Whatever
the same client has asked for before, an item is no repetition of it: where the vehicle flies to is
its own truth.
"""

from __future__ import annotations

from typing import Any

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from tests.loopback.bridged import VEHICLE, BridgedFlight, Client, north_of_home, take_off
from tests.loopback.copies import fly_or_copy
from tests.loopback.flight import Personality
from tests.loopback.plan_clients import PlanFlight
from tests.loopback.test_orbits import ORBIT

ACCEPTED, DENIED = dialect.MAV_MISSION_ACCEPTED, dialect.MAV_MISSION_DENIED
ABOVE_HOME_INT, WAYPOINT = 6, 16
UP_M = 5.0
LANDING_MODES = {"px4": ((4, 5), (4, 6)), "ardupilot": ((6, 0), (9, 0))}
"""SET_MODE of a return and of a landing: main and sub mode, or custom mode."""


def flying(personality: Personality, retarget: str) -> tuple[PlanFlight, Client]:
    """Taken off by a client, hovering at home."""
    policy = parse_policy(f'retarget = "{retarget}"', "retarget.toml")
    flight = PlanFlight(personality, policy=policy)
    fly_or_copy(flight, ("guided items", personality, retarget), lambda: take_off(flight))
    return flight, flight.clients[1]


def item(flight: BridgedFlight, north_m: float) -> Any:
    """MISSION_ITEM_INT with `current` 2."""
    lat, lon, _ = north_of_home(flight, north_m)
    return dialect.MAVLink_mission_item_int_message(
        *VEHICLE,
        0,
        ABOVE_HOME_INT,
        WAYPOINT,
        2,
        *(0, 0, 0, 0, 0),
        round(lat * 1e7),
        round(lon * 1e7),
        UP_M,
    )


def sends(client: Client, north_m: float, after_s: float = 1.0) -> list[int]:
    """What it is answered within that time."""
    before = len(client.messages("MISSION_ACK"))
    client.send(item(client.flight, north_m))
    client.flight.run(after_s)
    return [ack.type for ack in client.messages("MISSION_ACK")[before:]]


def flies_to(flight: BridgedFlight, north_m: float) -> None:
    flight.until(lambda: flight.is_in(State.HOVERING), 40)
    assert flight.truth_enu()[1] == pytest.approx(north_m, abs=1.0)


def refused(flight: BridgedFlight) -> list[str]:
    return [one.code for one in flight.decisions("refused")]


def test_an_item_replaces_the_goal_that_is_flown_to_where_the_policy_says_so() -> None:
    flight, client = flying("ardupilot", "replace")
    assert sends(client, 30) == [ACCEPTED]
    assert sends(client, -30) == [ACCEPTED]
    flies_to(flight, -30)


def test_an_item_outside_the_fence_is_denied_before_the_one_before_is_decided() -> None:
    """A goal waits for the gate's next tick, and the next one supersedes it."""
    flight, client = flying("ardupilot", "replace")
    assert sends(client, 30, after_s=0.0) == []
    assert sends(client, 200) == [DENIED, DENIED]
    assert refused(flight) == ["OUTSIDE_FENCE"]
    flies_to(flight, 0)


@pytest.mark.parametrize(("retarget", "code"), [("refuse", "BUSY"), ("replace", "OUTSIDE_FENCE")])
def test_an_item_outside_the_fence_is_denied_while_a_goal_is_flown_to(
    retarget: str, code: str
) -> None:
    flight, client = flying("ardupilot", retarget)
    assert sends(client, 30, after_s=0.2) == [ACCEPTED]
    assert sends(client, 200) == [DENIED]
    assert refused(flight) == [code]
    assert code in client.texts()


def test_an_item_outside_the_fence_is_denied_while_an_orbit_is_flown() -> None:
    """The client has flown another orbit before."""
    flight, client = flying("ardupilot", "replace")
    for radius_m in (5.0, 8.0):
        assert client.ask(ORBIT, radius_m, 1.0, 0.0, 0.0, *[float("nan")] * 3) == ACCEPTED
        flight.beating(2.0)
    assert sends(client, 300) == [DENIED]
    assert refused(flight) == ["OUTSIDE_FENCE"]


@pytest.mark.parametrize("landing", [0, 1])
def test_an_item_after_a_mode_that_is_flown_is_decided(
    personality: Personality, landing: int
) -> None:
    """SET_MODE has no acknowledgement, and is no item."""
    flight, client = flying(personality, "refuse")
    main, sub = LANDING_MODES[personality][landing]
    mode = main << 16 | sub << 24 if personality == "px4" else main
    client.send(dialect.MAVLink_set_mode_message(VEHICLE[0], 1, mode))
    flight.until(lambda: flight.is_in((State.RETURNING, State.LANDING)[landing]), 5)
    assert sends(client, 30) == [DENIED]
    assert len(refused(flight)) == 1
    assert refused(flight)[0] in client.texts()


def test_the_same_item_again_is_answered_and_not_asked_twice() -> None:
    flight, client = flying("ardupilot", "replace")
    assert sends(client, 30, after_s=0.0) == []
    assert sends(client, 30) == [ACCEPTED], "the first is not decided yet, and answers both"
    assert sends(client, 30) == [ACCEPTED]
    assert [one.word for one in flight.decisions("accepted")].count("goto") == 1
    flies_to(flight, 30)


def test_of_three_items_at_once_the_last_is_flown_to() -> None:
    """It is the same as the first, and something else was asked for since."""
    flight, client = flying("ardupilot", "replace")
    for north_m in (30, -30):
        assert sends(client, north_m, after_s=0.0) == []
    assert sends(client, 30) == [DENIED, DENIED, ACCEPTED]
    flies_to(flight, 30)
