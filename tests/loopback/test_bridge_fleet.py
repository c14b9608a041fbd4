"""Several vehicles behind one bridge: each is flown by its own system id, and by nobody else's."""

from __future__ import annotations

import math

import msgspec
import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs import ipc
from gcs.gate.condition import Condition, Severity
from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from gcs.report import AttachmentItem, DecisionItem
from gcs.station.fleet.separation import Separation
from tests.loopback.bridged import ARRIVES_M, BRIDGE
from tests.loopback.fleet import (
    ACCEPTED,
    ARM,
    DENIED,
    LAND,
    REPOSITION,
    Fleet,
)


def test_both_are_met_and_told() -> None:
    flight = Fleet()
    client = flight.join()
    flight.all_connected()
    assert {one.message.get_srcSystem() for one in client.heard} == {1, 2}
    status = flight.of(ipc.BridgeStatus)[-1]
    assert [(each.vehicle, each.name, each.state) for each in status.vehicles] == [
        (1, "1/1 px4 quadrotor", "GROUNDED"),
        (2, "2/1 ardupilot quadrotor", "GROUNDED"),
    ]


@pytest.mark.parametrize("links", [1, 2])
def test_one_client_flies_both_by_their_system_ids(links: int) -> None:
    flight = Fleet(links=links)
    client = flight.all_flying()
    flight.send_to(client, 1, 8, 0, 5)
    flight.send_to(client, 2, 0, 12, 7)
    flight.until(flight.each(lambda n: flight.state_of(n) is State.MOVING), 2)
    flight.until(flight.each(lambda n: flight.state_of(n) is State.HOVERING))
    assert flight.place_enu(1) == pytest.approx((8, 0, 5), abs=ARRIVES_M["px4"])
    assert flight.place_enu(2) == pytest.approx((0, 12, 7), abs=ARRIVES_M["px4"])
    acks = [(ack.get_srcSystem(), ack.result) for ack in client.acks(REPOSITION)]
    assert acks == [(1, ACCEPTED), (2, ACCEPTED)]


def test_a_goal_for_one_never_moves_the_other() -> None:
    flight = Fleet()
    client = flight.all_flying()
    for sysid in (1, 2):
        flight.run(0.01)  # what comes from here on is later than the end of what was before
        before, since_ns = flight.place_enu(3 - sysid), flight.now_ns
        flight.send_to(client, sysid, 0, 10, 5)
        flight.reaches(sysid, State.MOVING, 2)
        flight.reaches(sysid, State.HOVERING)
        client.beat()
        assert flight.place_enu(sysid)[1] == pytest.approx(10, abs=ARRIVES_M["px4"])
        assert flight.place_enu(3 - sysid) == pytest.approx(before, abs=ARRIVES_M["px4"])
        decided = flight.recorded(DecisionItem, since_ns)
        assert {item.vehicle for item in decided if item.word == "goto"} == {sysid}


def test_a_goal_outside_the_fence_is_refused_in_the_name_of_the_one_that_it_was_for() -> None:
    flight = Fleet()
    client = flight.all_flying()
    flight.send_to(client, 2, 0, 400, 5)
    flight.run(0.5)
    (ack,) = client.acks(REPOSITION)
    assert (ack.get_srcSystem(), ack.result) == (2, DENIED)
    assert [(flight.state_of(n)) for n in (1, 2)] == [State.HOVERING] * 2


def test_a_landing_for_all_lands_both() -> None:
    flight = Fleet()
    client = flight.all_flying()
    client.command(LAND, target=(0, 0))
    flight.until(flight.each(lambda n: flight.state_of(n) is State.LANDING), 2)
    flight.run(0.5)
    answers = [(ack.get_srcSystem(), ack.result) for ack in client.acks(LAND)]
    assert sorted(answers) == [(1, ACCEPTED), (2, ACCEPTED)]
    flight.until(flight.each(lambda n: not flight.vehicles[n].armed), 60)


def test_an_arming_for_all_is_judged_for_each() -> None:
    """One is in the air: it is armed; the other one, on the ground, arms."""
    flight = Fleet()
    client = flight.join()
    flight.all_connected()
    client.command(*ARM, target=(0, 1))
    flight.until(flight.each(lambda n: bool(flight.vehicles[n].armed)), 10)
    flight.run(1)
    answered = [(ack.get_srcSystem(), ack.result) for ack in client.acks(ARM[0])]
    assert sorted(answered) == [(1, ACCEPTED), (2, ACCEPTED)]


def test_a_vehicle_that_is_not_the_target_is_shown_and_not_commanded() -> None:
    flight = Fleet(config=msgspec.structs.replace(BRIDGE, target_sysid=1))
    client = flight.join()
    flight.run(5)
    shown = {beat.get_srcSystem() for beat in client.messages("HEARTBEAT")}
    assert {1, 2} <= shown
    sent = len(flight.sent)
    client.command(LAND, target=(2, 1))
    client.command(LAND, target=(2, 1))
    flight.run(0)
    assert len(flight.sent) == sent
    answered = [(ack.get_srcSystem(), ack.result) for ack in client.acks(LAND)]
    assert answered == [(2, DENIED), (2, DENIED)]
    assert client.texts().count("refused: system 2 is not this bridge's: --target 1") == 1
    client.command(LAND, target=(3, 1))
    flight.run(0)
    assert "there is no system 3 here (heard: system 1)" in client.texts()
    assert len(client.acks(LAND)) == 2


def test_who_plays_either_vehicle_is_not_believed() -> None:
    flight = Fleet()
    flight.all_flying()
    for sysid in (1, 2):
        telemetry = flight.met(sysid).telemetry
        assert telemetry is not None
        position = telemetry.pos_ned
        liar = flight.join(sysid, 1)
        liar.send(dialect.MAVLink_local_position_ned_message(10**9, 500, 0, -5, 0, 0, 0))
        assert telemetry.pos_ned == position
        assert any(f"it calls itself {sysid}/1" in text for text in flight.told())


def test_what_is_harmless_and_for_all_goes_out_once_on_each_link() -> None:
    for links in (1, 2):
        flight = Fleet(links=links)
        client = flight.join()
        flight.all_connected()
        before = len(flight.to_vehicle("PARAM_REQUEST_READ"))
        client.send(dialect.MAVLink_param_request_read_message(0, 0, b"NO_SUCH", -1))
        assert len(flight.to_vehicle("PARAM_REQUEST_READ")) - before == links


def test_one_that_is_lost_does_not_disturb_the_other() -> None:
    flight = Fleet()
    client = flight.all_flying()
    flight.silent = {1}
    flight.beating(5)
    assert flight.state_of(1) in (State.STALE, State.NO_VEHICLE)
    assert flight.state_of(2) is State.HOVERING
    flight.send_to(client, 2, 0, 10, 5)
    flight.reaches(2, State.MOVING, 2)
    flight.reaches(2, State.HOVERING)
    assert flight.place_enu(2)[1] == pytest.approx(10, abs=ARRIVES_M["px4"])
    flight.silent = set()
    flight.beating(3)
    assert flight.state_of(1) in (State.HOLDING, State.EXTERNAL, State.HOVERING)


@pytest.mark.parametrize("stale", [1, 2])
def test_one_without_positions_does_not_disturb_the_other(stale: int) -> None:
    flight = Fleet()
    client = flight.all_flying()
    flight.without_positions = {stale}
    flight.beating(3)
    other = 3 - stale
    assert flight.state_of(stale) is not State.HOVERING
    assert flight.state_of(other) is State.HOVERING
    flight.send_to(client, other, 0, 10, 5)
    flight.reaches(other, State.MOVING, 2)


def test_a_client_that_goes_silent_in_control_is_held_for_with_both() -> None:
    flight = Fleet()
    flight.all_flying()
    flight.run(12)
    assert [flight.state_of(n) for n in (1, 2)] == [State.HOLDING] * 2


def test_one_client_is_in_control_of_both() -> None:
    flight = Fleet()
    client = flight.all_flying()
    second = flight.join(255, 190)
    flight.send_to(second, 2, 0, 10, 5)
    flight.run(0.3)
    assert "OTHER_OPERATOR" in second.texts()
    assert flight.ask(second, 2, LAND) == ACCEPTED, "stops are everybody's"
    assert flight.state_of(1) is State.HOVERING
    assert not client.acks(LAND)


def test_at_the_end_both_are_held() -> None:
    flight = Fleet()
    client = flight.all_flying()
    for sysid in (1, 2):
        flight.send_to(client, sysid, 0, 30, 5)
    flight.run(1)
    assert flight.each(lambda n: flight.state_of(n) is State.MOVING)()
    flight.say_leave()
    flight.until(lambda: flight.finish is not None, 5)
    assert flight.finish is not None
    assert flight.finish.sentence.startswith("vehicle 1 is STILL FLYING in")
    assert "; vehicle 2 is STILL FLYING in" in flight.finish.sentence
    assert flight.each(lambda n: flight.state_of(n) is State.HOLDING)()
    kept = {item.name for item in flight.recorded(AttachmentItem)}
    assert {"parameters.json", "fence.json", "parameters-2.json", "fence-2.json"} <= kept


def too_close(flight: Fleet) -> list[bool]:
    return [Condition.TOO_CLOSE in flight.gate(n).conditions for n in (1, 2)]


def least_distance_m(flight: Fleet, seconds: float) -> float:
    """How near they really come in that time; heartbeats go on."""
    least_m = math.inf
    for _ in range(round(seconds * 10)):
        flight.beating(0.1)
        (x1, y1, z1), (x2, y2, z2) = flight.place_enu(1), flight.place_enu(2)
        least_m = min(least_m, math.dist((x1, y1, z1), (x2 + flight.apart_m, y2, z2)))
    return least_m


def flown_at_each_other(policy: str, patch: pytest.MonkeyPatch) -> tuple[Fleet, float]:
    """Both fly to the place between them, at one height; how near they have come.

    Their goals are not compared, as little as what a mission or a stream flies."""
    patch.setattr(Separation, "why_not", lambda *_: None)
    flight = Fleet(("px4", "px4"), policy=parse_policy(policy, "test"), apart_m=60.0)
    client = flight.all_flying()
    assert too_close(flight) == [False, False]
    flight.send_to(client, 1, 30, 0, 5)
    flight.send_to(client, 2, -30, 0, 5)
    return flight, least_distance_m(flight, 15)


def test_two_that_fly_at_each_other_are_stopped_where_the_policy_says_hold(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    flight, least_m = flown_at_each_other('severities.too_close = "hold"', monkeypatch)
    assert [flight.state_of(n) for n in (1, 2)] == [State.HOLDING] * 2
    assert least_m > 5.0
    assert too_close(flight) == [False, False], "both rest, and are far enough from each other"
    told = [line for line in flight.lines("state_and_safety") if "too_close" in line]
    assert any(line.startswith("vehicle 1: ") and "vehicle 2: " in line for line in told), told


def test_by_default_they_are_only_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same flight without the policy's hold: they meet, so the test above can fail."""
    flight, least_m = flown_at_each_other("", monkeypatch)
    assert least_m < 5.0
    assert too_close(flight) == [True, True]
    assert all(flight.gate(n).severity is Severity.CAUTION for n in (1, 2))


def test_a_vehicle_on_the_ground_is_too_close_to_nobody() -> None:
    flight = Fleet(apart_m=3.0)
    client = flight.join()
    flight.all_connected()
    flight.take_off(client, 1)
    flight.beating(1)
    assert too_close(flight) == [False, False]
    flight.take_off(client, 2)
    flight.beating(1)
    assert too_close(flight) == [True, True], "each by its own map, and yet in one place"
    flight.silent = {2}
    flight.beating(3)
    assert Condition.TOO_CLOSE not in flight.gate(1).conditions, "one that is lost is not compared"
