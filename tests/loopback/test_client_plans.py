"""Missions from any client: verified whole, on board, answered once; nothing else gets there."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import pytest
from msgspec import structs
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.policy.parse import DEFAULT
from gcs.gate.states import State
from gcs.wire.codec import decode
from gcs.wire.messages import CommandLong, MissionClearAll
from tests.loopback.bridged import VEHICLE, joined
from tests.loopback.flight import HOMES, PERSONALITIES, Personality
from tests.loopback.lossy_link import Weather
from tests.loopback.plan_clients import (
    ACCEPTED,
    AMSL,
    FENCE,
    NORTH_DEG,
    RALLY,
    RALLY_POINT,
    UPLOADS,
    DroneKit,
    Mavsdk,
    PlanFlight,
    PlanItem,
    Pymavlink,
    Upload,
    mission,
)
from tests.loopback.stranger import stranger_fences
from vehicle_sim.autopilot.interface import PlanItem as OnBoard

DENIED, DENIED_COMMAND = 14, 2
ARM, MISSION_START, PAUSE, FENCE_CORNER, ALL = 400, 300, 193, 5001, 255
FAR_E7 = 90_000
"""A kilometre north."""
SQUARE = ((20.0, 0.0, 10.0), (20.0, 20.0, 10.0), (0.0, 20.0, 10.0))
BEYOND = ((20.0, 0.0, 10.0), (400.0, 0.0, 10.0), (500.0, 20.0, 10.0))


def connected(personality: Personality) -> PlanFlight:
    flight = PlanFlight(personality)
    flight.join()
    flight.connected()
    return flight


@pytest.mark.parametrize("personality", PERSONALITIES)
@pytest.mark.parametrize("kind", UPLOADS)
def test_each_client_s_mission_is_on_board_and_acknowledged_once(
    kind: type[Upload], personality: Personality
) -> None:
    flight = connected(personality)
    upload = kind(flight, flight.clients[1], mission(personality, *SQUARE))
    assert upload.ended() == "complete"
    flight.run(5.0)
    assert upload.acks == [ACCEPTED]
    assert [item.command for item in flight.vehicle.plan] == [item.command for item in upload.items]
    tolerance = 10 if kind is DroneKit else 0  # float degrees: a metre
    for ours, theirs in zip(flight.vehicle.plan[1:-1], upload.items[1:-1], strict=True):
        assert abs(ours.x - round(theirs.lat_deg * 1e7)) <= 20 * tolerance
        assert ours.z == theirs.alt_m


@pytest.mark.parametrize("personality", PERSONALITIES)
@pytest.mark.parametrize("kind", UPLOADS)
def test_a_mission_that_leaves_the_fence_never_reaches_the_vehicle(
    kind: type[Upload], personality: Personality
) -> None:
    flight = connected(personality)
    before = flight.vehicle.plan
    upload = kind(flight, flight.clients[1], mission(personality, *BEYOND))
    assert upload.ended() == f"refused {DENIED}"
    flight.run(5.0)
    assert upload.acks == [DENIED]
    assert flight.vehicle.plan == before
    assert not flight.to_vehicle("MISSION_COUNT")
    assert not flight.to_vehicle("MISSION_ITEM_INT")
    said = flight.clients[1].texts()
    assert "item 3" in said
    assert "item 4" in said, "every finding is told"
    (decision,) = flight.decisions("refused")
    assert decision.word == "mission_upload"
    assert decision.code in ("OUTSIDE_FENCE", "LEG_LEAVES_FENCE", "TOO_FAR")


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_a_mission_put_on_board_past_the_bridge_is_verified_before_it_starts(
    personality: Personality,
) -> None:
    """It was there before this station came."""
    flight = PlanFlight(personality)
    other = connected(personality)
    Mavsdk(other, other.clients[1], mission(personality, *SQUARE)).ended()
    good = other.vehicle.plan
    client = flight.join()
    flight.connected()
    away = tuple(replace(item, x=item.x + FAR_E7) if item.x else item for item in good)
    for plan, starts in ((away, False), (good, True)):
        flight.vehicle.load_plan(plan)
        assert client.ask(ARM, 1) == ACCEPTED
        client.command(MISSION_START)
        flight.beating(5.0)
        assert flight.is_in(State.FLYING_MISSION) is starts


def good_and_bad_plan() -> tuple[PlanFlight, tuple[OnBoard, ...], tuple[OnBoard, ...]]:
    """A PX4 with a client and nothing on board; a mission that clears, and one that leaves."""
    other = connected("px4")
    Mavsdk(other, other.clients[1], mission("px4", *SQUARE)).ended()
    good = other.vehicle.plan
    away = tuple(replace(item, x=item.x + FAR_E7) if item.x else item for item in good)
    return connected("px4"), good, away


def never_armed(flight: PlanFlight) -> None:
    """Not by the bridge, and not for a moment."""
    flight.beating(5.0)
    commands = [decode(frame) for frame in flight.to_vehicle("COMMAND_LONG")]
    assert ARM not in [each.command for each in commands if isinstance(each, CommandLong)]
    assert not flight.vehicle.armed


def test_a_mission_start_of_a_disarmed_px4_arms_only_what_has_cleared() -> None:
    """PX4's MISSION_START arms, too: what is on board is verified before the motors run."""
    flight, good, away = good_and_bad_plan()
    client = flight.clients[1]
    assert client.ask(MISSION_START) == DENIED_COMMAND
    assert "NO_MISSION" in client.texts()
    never_armed(flight)
    flight.vehicle.load_plan(away)
    assert client.ask(MISSION_START) == DENIED_COMMAND
    assert "item " in client.texts()
    never_armed(flight)
    flight.vehicle.load_plan(good)
    assert client.ask(MISSION_START) == ACCEPTED
    flight.until(lambda: flight.is_in(State.FLYING_MISSION), 10.0)
    asked = [one.word for one in flight.decisions("accepted")]
    assert asked[-3:] == ["mission_check", "arm", "mission_start"]


def test_a_stop_while_the_mission_is_checked_keeps_the_vehicle_disarmed() -> None:
    flight, good, _ = good_and_bad_plan()
    client = flight.clients[1]
    flight.vehicle.load_plan(good)
    client.command(MISSION_START)
    client.command(PAUSE, 0)
    never_armed(flight)
    assert client.acks(MISSION_START)[-1].result != ACCEPTED


LOSSY = Weather(loss=0.25, delay_s=(0.001, 0.004))
LONG = 500
LONG_S = 120.0
SEEDS = range(1, 11)


def long_mission(personality: Personality) -> list[PlanItem]:
    """A take-off, a spiral within 60 m of home, a return: 500 items with ArduPilot's home."""
    many = LONG - len(mission(personality))
    places = ((math.cos(0.1 * n), math.sin(0.1 * n), 0.1 * n) for n in range(many))
    return mission(personality, *((r * north, r * east, 10.0) for north, east, r in places))


@pytest.mark.parametrize("personality", PERSONALITIES)
@pytest.mark.parametrize(
    "seed", [pytest.param(n, marks=[] if n == 1 else [pytest.mark.soak]) for n in SEEDS]
)
@pytest.mark.thorough
def test_five_hundred_items_cross_two_links_that_lose_a_quarter(
    seed: int, personality: Personality
) -> None:
    """Complete within two minutes, or refused whole; a client that keeps on gets its ACK."""
    flight, client = joined(
        PlanFlight(personality, seed=seed, vehicle_weather=LOSSY, client_weather=LOSSY)
    )
    before = flight.vehicle.plan
    upload = Pymavlink(flight, client, long_mission(personality))
    result = upload.ended(LONG_S)
    print(f"{personality} seed {seed}: {result}, {upload.took_s:.1f} s")
    assert len(flight.vehicle.plan) == (LONG if result == "complete" else len(before))


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_two_clients_read_the_plan_one_after_the_other_and_the_station_in_between(
    personality: Personality,
) -> None:
    flight = connected(personality)
    first, second = flight.clients[1], flight.join(255, 190)
    assert Mavsdk(flight, first, mission(personality, *SQUARE)).ended() == "complete"
    many = len(flight.vehicle.plan)
    flight.say("station_take")
    for client in (first, second):
        client.send(dialect.MAVLink_mission_request_list_message(*VEHICLE, 0))
    flight.run(0.1)
    assert [count.count for count in first.messages("MISSION_COUNT")] == [many]
    assert not second.messages("MISSION_COUNT")
    assert "another client reads" in second.texts()
    flight.do("mission_download")
    for seq in range(many):
        first.send(dialect.MAVLink_mission_request_int_message(*VEHICLE, seq, 0))
        flight.run(0.05)
    first.send(dialect.MAVLink_mission_ack_message(*VEHICLE, ACCEPTED, 0))
    second.send(dialect.MAVLink_mission_request_list_message(*VEHICLE, 0))
    flight.run(0.1)
    assert [item.seq for item in first.messages("MISSION_ITEM_INT")] == [*range(many)]
    assert [count.count for count in second.messages("MISSION_COUNT")] == [many]
    assert not second.messages("MISSION_ITEM_INT"), "answers go to whom they are for"


def square_fence(personality: Personality) -> list[PlanItem]:
    """An inclusion polygon of four corners, 60 m from home."""
    home = HOMES[personality]
    return [
        PlanItem(
            FENCE_CORNER,
            home.lat_deg + 60.0 * north * NORTH_DEG,
            home.lon_deg + 60.0 * east * NORTH_DEG,
            frame=AMSL,
            params=(4.0, 0.0, 0.0, 0.0),
            kind=FENCE,
        )
        for north, east in ((1, 1), (1, -1), (-1, -1), (-1, 1))
    ]


def rally_point(personality: Personality) -> list[PlanItem]:
    home = HOMES[personality]
    return [PlanItem(RALLY_POINT, home.lat_deg + 20.0 * NORTH_DEG, home.lon_deg, 15.0, kind=RALLY)]


@pytest.mark.parametrize("personality", PERSONALITIES)
@pytest.mark.parametrize("plan", [square_fence, rally_point])
def test_a_fence_and_rally_points_are_refused_unless_the_policy_lets_them(
    plan: Callable[[Personality], list[PlanItem]], personality: Personality
) -> None:
    flight = connected(personality)
    upload = Mavsdk(flight, flight.clients[1], plan(personality))
    assert upload.ended() == f"refused {DENIED}"
    assert not flight.to_vehicle("MISSION_COUNT")
    assert flight.decisions("refused")[-1].code == "POLICY"


@pytest.mark.parametrize("personality", PERSONALITIES)
@pytest.mark.parametrize("plan", [square_fence, rally_point])
def test_where_the_policy_lets_them_they_are_on_board_whole(
    plan: Callable[[Personality], list[PlanItem]], personality: Personality
) -> None:
    rules = structs.replace(DEFAULT.bridge, fence="forward", rally="forward")
    flight, client = joined(PlanFlight(personality, policy=structs.replace(DEFAULT, bridge=rules)))
    items = plan(personality)
    upload = Mavsdk(flight, client, items)
    assert upload.ended() == "complete"
    client.send(dialect.MAVLink_mission_request_list_message(*VEHICLE, items[0].kind))
    flight.run(0.2)
    assert [count.count for count in client.messages("MISSION_COUNT")] == [len(items)]
    client.send(dialect.MAVLink_mission_clear_all_message(*VEHICLE, ALL))
    flight.run(1.0)
    client.send(dialect.MAVLink_mission_request_list_message(*VEHICLE, items[0].kind))
    flight.run(0.2)
    assert [count.count for count in client.messages("MISSION_COUNT")][-1] == 0


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_all_plans_at_once_are_not_cleared_where_the_fence_must_stay(
    personality: Personality,
) -> None:
    flight = PlanFlight(personality)
    client = flight.join()
    stranger_fences(flight, 100.0)
    flight.connected()
    client.send(dialect.MAVLink_mission_clear_all_message(*VEHICLE, ALL))
    flight.run(1.0)
    assert [ack.type for ack in client.messages("MISSION_ACK")] == [DENIED]
    assert not flight.to_vehicle("MISSION_CLEAR_ALL")


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_all_plans_at_once_are_the_mission_where_there_is_nothing_else(
    personality: Personality,
) -> None:
    """A client that repeats it meanwhile is answered once, by the type that it asked for."""
    flight = connected(personality)
    client = flight.clients[1]
    assert Mavsdk(flight, client, mission(personality, *SQUARE)).ended() == "complete"
    flight.run(2.0)
    for _ in range(2):
        client.send(dialect.MAVLink_mission_clear_all_message(*VEHICLE, ALL))
    flight.run(1.0)
    acks = [(ack.type, ack.mission_type) for ack in client.messages("MISSION_ACK")]
    assert acks == [(ACCEPTED, 0), (ACCEPTED, ALL)], client.texts()
    assert flight.vehicle.plan == ()
    cleared = [decode(frame) for frame in flight.to_vehicle("MISSION_CLEAR_ALL")]
    assert [each.mission_type for each in cleared if isinstance(each, MissionClearAll)] == [0]
    assert [one.word for one in flight.decisions("complete")][-1] == "mission_clear"


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_who_is_not_in_control_brings_no_mission(personality: Personality) -> None:
    flight = connected(personality)
    first, second = flight.clients[1], flight.join(255, 190)
    assert Mavsdk(flight, first, mission(personality, *SQUARE)).ended() == "complete"
    before = flight.vehicle.plan
    upload = Mavsdk(flight, second, mission(personality, (10.0, 0.0, 10.0)))
    assert upload.ended() == f"refused {DENIED}"
    assert "OTHER_OPERATOR" in second.texts()
    assert flight.vehicle.plan == before


CANCELLED = 15
FREE = structs.replace(
    DEFAULT, bridge=structs.replace(DEFAULT.bridge, fence="forward", rally="forward")
)


class Silent(Upload):
    """It sends its count, and nothing else."""

    def hear(self, message: object) -> None:
        pass

    def late(self) -> None:
        pass


def test_an_upload_that_is_given_up_for_another_one_is_ended_and_on_the_record() -> None:
    """A script that begins the next plan before it has the answer of the one before."""
    flight, client = joined(PlanFlight("px4", policy=FREE))
    abandoned = Silent(flight, client, mission("px4", *SQUARE))
    flight.run(0.3)
    rally = Mavsdk(flight, client, rally_point("px4"))
    flight.run(0.1)
    assert abandoned.acks == [CANCELLED]
    assert "mission: given up after 0 of 5 items" in client.texts()
    (decision,) = flight.decisions("refused")
    assert (decision.word, decision.code) == ("mission_count", "SUPERSEDED")
    assert rally.ended() == "complete"
    flight.run(20.0)
    assert abandoned.acks == [CANCELLED]
    assert rally.acks == [ACCEPTED]
