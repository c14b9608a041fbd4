"""A vehicle that is flown to another place while the start of its mission is prepared.

The way to the first item is verified from where the vehicle is.  Then the vehicle is brought to
that item, which takes seconds where its MISSION_CURRENT gets lost; a go-to in that time is flown.
"""

from __future__ import annotations

import math

from msgspec import structs
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.policy.parse import DEFAULT
from gcs.gate.states import State
from gcs.wire.frame import Frame, split
from tests.loopback.bridged import VEHICLE, Client
from tests.loopback.flight import HOMES, Personality
from tests.loopback.plan_clients import ACCEPTED, Mavsdk, PlanFlight, mission
from tests.loopback.test_set_current import FIELD, MAST, flown, seq, shown, square, wait

ARM, SET_MODE, MISSION_START = 400, 176, 300
HELD: dict[Personality, tuple[int, int]] = {"px4": (4, 3), "ardupilot": (17, 0)}
GUIDED: dict[Personality, tuple[int, int]] = {"px4": (6, 0), "ardupilot": (4, 0)}
VERIFIED_FROM: dict[Personality, tuple[float, float]] = {"px4": (45.0, 36.0), "ardupilot": (45, 12)}
"""East and north, on the other side of the mast: the way to the first item is clear.  That item is
the take-off at home for a PX4, and for an ArduCopter, which is in the air, the first waypoint."""
BEHIND_THE_MAST: dict[Personality, tuple[float, float]] = {"px4": (42, 18), "ardupilot": (40, 0)}
"""The way from there leads through the mast; the way to there is clear."""
CLEAR: dict[Personality, tuple[float, float]] = {"px4": (45.0, 39.0), "ardupilot": (45.0, 16.0)}


class LosesCurrent(PlanFlight):
    """MISSION_CURRENT gets lost as long as `current_lost`."""

    current_lost = False

    def _without_lost(self, data: bytes) -> bytes:
        data = super()._without_lost(data)
        if not self.current_lost:
            return data
        frames = (item for item in split(data) if isinstance(item, Frame))
        return b"".join(frame.raw for frame in frames if frame.name != "MISSION_CURRENT")


def send_to(flight: PlanFlight, east_m: float, north_m: float) -> None:
    """DO_REPOSITION, 10 m above home."""
    shorter = math.cos(math.radians(HOMES[flight.personality].lat_deg))
    place = mission(flight.personality, (north_m, east_m / shorter, 10.0))[-2]
    lat, lon = round(place.lat_deg * 1e7), round(place.lon_deg * 1e7)
    command = dialect.MAV_CMD_DO_REPOSITION
    flight.clients[1].send(
        dialect.MAVLink_command_int_message(
            *VEHICLE, 6, command, 0, 0, -1, 1, 0, math.nan, lat, lon, 10.0
        )
    )


def flown_to(flight: PlanFlight, east_m: float, north_m: float) -> None:
    send_to(flight, east_m, north_m)
    wait(flight, lambda: flight.is_in(State.MOVING), 2.0)
    wait(flight, lambda: flight.is_in(State.HOVERING), 40.0)
    assert math.dist(flight.truth_enu()[:2], (east_m, north_m)) < 1.0


def start_in_preparation(personality: Personality) -> tuple[LosesCurrent, Client]:
    """A mission that was stopped on its way, and whose start is verified from beside the mast."""
    flight = LosesCurrent(personality, policy=structs.replace(DEFAULT, fence=(FIELD, MAST)))
    client = flight.join()
    flight.connected()
    items = mission(personality, *square(personality))
    assert Mavsdk(flight, client, items).ended() == "complete", client.texts()
    assert client.ask(ARM, 1) == ACCEPTED
    flown(flight)
    client.command(SET_MODE, 1, *HELD[personality])
    wait(flight, lambda: flight.is_in(State.HOLDING), 4.0)
    client.command(SET_MODE, 1, *GUIDED[personality])
    wait(flight, lambda: flight.is_in(State.HOVERING), 4.0)
    flight.beating(2.0)
    assert shown(flight) == seq(personality, 2)
    flown_to(flight, 45.0, 36.0)
    if personality == "ardupilot":
        flown_to(flight, *VERIFIED_FROM[personality])
    flight.current_lost = True
    client.command(MISSION_START)
    flight.run(0.4)
    assert not flight.decisions("refused"), client.texts()
    return flight, client


def test_no_mission_begins_by_a_way_that_was_verified_from_elsewhere(
    personality: Personality,
) -> None:
    flight, client = start_in_preparation(personality)
    flown_to(flight, *BEHIND_THE_MAST[personality])
    flight.current_lost = False
    nearest_m = math.inf
    for _ in range(150):
        client.beat()
        flight.run(0.1)
        nearest_m = min(nearest_m, math.dist(flight.truth_enu()[:2], MAST.centre))
    assert nearest_m > MAST.radius_m
    assert not flight.is_in(State.FLYING_MISSION)
    (refused,) = flight.decisions("refused")
    assert refused.word == "mission_start"
    assert "mast" in client.texts()


def test_a_way_that_is_clear_from_there_too_is_flown(personality: Personality) -> None:
    flight, _ = start_in_preparation(personality)
    flown_to(flight, *CLEAR[personality])
    flight.current_lost = False
    wait(flight, lambda: flight.is_in(State.FLYING_MISSION), 15.0)
    assert not flight.decisions("refused")
