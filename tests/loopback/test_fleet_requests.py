"""Several vehicles behind one bridge: plans, the station's operators, the record, the end."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs import ipc
from gcs.audit.audit import audit
from gcs.audit.messages import Tape
from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from gcs.record.writer import Recorder
from gcs.report import FsaItem
from gcs.session import inputs
from gcs.wire.codec import decode
from gcs.wire.messages import CommandLong
from tests.loopback.bridged import Client
from tests.loopback.fleet import ACCEPTED, ARM, LAND, Fleet
from tests.loopback.flight import Flight
from tests.loopback.observed import START_NS
from tests.loopback.plan_clients import PlanItem, mission

ASKS = ("MISSION_REQUEST", "MISSION_REQUEST_INT")


def brings(flight: Fleet, client: Client, plans: dict[int, list[PlanItem]]) -> dict[int, int]:
    """The client sends each vehicle its plan, at the same time; the MISSION_ACK of each."""
    read = len(client.heard)
    for sysid, items in plans.items():
        client.send(dialect.MAVLink_mission_count_message(sysid, 1, len(items), 0))
    results: dict[int, int] = {}

    def answered() -> bool:
        nonlocal read
        for heard in client.heard[read:]:
            message, sysid = heard.message, heard.message.get_srcSystem()
            if message.get_type() in ASKS:
                item = plans[sysid][message.seq]
                place = (round(item.lat_deg * 1e7), round(item.lon_deg * 1e7), item.alt_m)
                head = (sysid, 1, message.seq, item.frame, item.command, int(message.seq == 0), 1)
                client.send(
                    dialect.MAVLink_mission_item_int_message(*head, *item.params, *place, 0)
                )
            elif message.get_type() == "MISSION_ACK":
                results[sysid] = message.type
        read = len(client.heard)
        return len(results) == len(plans)

    flight.until(answered, 30)
    return results


def test_each_vehicle_gets_its_own_plan_at_the_same_time() -> None:
    flight = Fleet(("px4", "px4"))
    client = flight.join()
    flight.all_connected()
    plans = {1: mission("px4", (10, 0, 10)), 2: mission("px4", (0, 40, 10), (10, 40, 10))}
    assert brings(flight, client, plans) == {1: ACCEPTED, 2: ACCEPTED}
    assert [flight.met(n).missions.total for n in (1, 2)] == [3, 4]
    on_board = [len(flight.vehicles[n].plan) for n in (1, 2)]
    assert on_board == [3, 4]


# -------------------------------------------------------------------------------- operators


def say(flight: Fleet, ask: ipc.Ask, client: int = 2) -> list[ipc.VerdictEvent]:
    """An operator of the station's socket asks; the verdicts that come of it at once."""
    before = len(flight.of(ipc.VerdictEvent))
    flight.feed(inputs.OperatorLine(client, ask))
    flight.run(0.2)
    return flight.of(ipc.VerdictEvent)[before:]


def with_operator() -> Fleet:
    """All fly, and an operator has joined by the station's socket."""
    flight = Fleet()
    flight.all_flying()
    flight.feed(inputs.OperatorJoined(2, "gcs abort"))
    return flight


def test_an_operator_s_stop_reaches_every_vehicle_that_flies() -> None:
    flight = with_operator()
    (verdict,) = say(flight, ipc.Ask(7, "abort"))
    assert (verdict.id, verdict.outcome) == (7, "accepted")
    assert [flight.state_of(n) for n in (1, 2)] == [State.HOLDING] * 2


def test_a_stop_is_not_asked_of_a_vehicle_on_the_ground() -> None:
    flight = Fleet()
    client = flight.join()
    flight.all_connected()
    flight.take_off(client, 2)
    flight.feed(inputs.OperatorJoined(2, "gcs abort"))
    (verdict,) = say(flight, ipc.Ask(7, "hold"))
    assert (verdict.id, verdict.outcome) == (7, "accepted")
    assert [flight.state_of(n) for n in (1, 2)] == [State.GROUNDED, State.HOLDING]


def test_a_stop_is_sent_to_a_lost_vehicle_too_and_the_other_one_answers() -> None:
    flight = with_operator()
    flight.silent = {1}
    flight.beating(3)
    assert flight.state_of(1) is State.STALE
    sent = len(flight.to_vehicle())
    (verdict,) = say(flight, ipc.Ask(7, "abort"))
    assert (verdict.id, verdict.outcome) == (7, "accepted")
    assert flight.state_of(2) is State.HOLDING
    commands = [decode(each) for each in flight.to_vehicle()[sent:]]
    targets = {each.target_system for each in commands if isinstance(each, CommandLong)}
    assert targets == {1, 2}


def test_an_operator_s_stop_of_one_vehicle_leaves_the_other() -> None:
    flight = with_operator()
    (verdict,) = say(flight, ipc.Ask(7, "abort", vehicle=2))
    assert verdict.outcome == "accepted"
    assert [flight.state_of(n) for n in (1, 2)] == [State.HOVERING, State.HOLDING]


def test_a_request_for_a_vehicle_that_is_not_there_is_refused() -> None:
    flight = with_operator()
    (verdict,) = say(flight, ipc.Ask(7, "abort", vehicle=9))
    assert (verdict.outcome, verdict.code) == ("refused", "NO_VEHICLE")
    assert verdict.sentence == "no such vehicle is heard here; there are: 1, 2"


def test_an_abort_of_an_operation_is_for_the_vehicle_that_does_it() -> None:
    flight = Fleet()
    client = flight.all_flying()
    for sysid in (1, 2):
        flight.send_to(client, sysid, 0, 30, 5)
    flight.run(0.5)
    running = [op for op in flight.of(ipc.Operation) if op.state == "running"]
    (second,) = [op for op in running if op.asked.word == "goto" and op.asked.vehicle == 2]
    flight.feed(inputs.OperatorJoined(2, "gcs abort"))
    (verdict,) = say(flight, ipc.Ask(7, "abort", operation=second.id))
    assert verdict.outcome == "accepted"
    assert [flight.state_of(n) for n in (1, 2)] == [State.MOVING, State.HOLDING]


def test_the_screens_of_operators_show_the_first_vehicle_alone() -> None:
    flight = with_operator()
    flight.run(0.01)  # what comes from here on is later than the last take-off
    before_ns = flight.now_ns
    say(flight, ipc.Ask(7, "land", vehicle=2))
    flight.run(1)
    assert flight.states(before_ns) == []
    moves = [item for item in flight.recorded(FsaItem, before_ns) if item.before != item.state]
    assert {item.sysid for item in moves} == {2}
    assert moves[0].state == "LANDING"


# ------------------------------------------------------------------------------- the fence

YARD = """
[[fence]]
name = "yard"
kind = "circle"
frame = "geographic"
centre = [47.397742, 8.545594]
radius_m = 60.0
"""


def test_one_that_stands_outside_does_not_keep_the_other_from_flying() -> None:
    flight = Fleet(("px4", "px4"), policy=parse_policy(YARD, "test"), apart_m=300.0)
    client = flight.join()
    flight.all_connected()
    assert flight.finish is None
    told = [line for line in flight.lines("link") if "stands outside" in line]
    assert [line.split(":")[0] for line in told] == ["vehicle 2"]
    flight.take_off(client, 1)
    assert flight.ask(client, 2, *ARM) != ACCEPTED or flight.ask(client, 2, 22) != ACCEPTED
    flight.run(5)
    assert flight.place_enu(2)[2] < 0.3


# ------------------------------------------------------------------------------ the record


@pytest.fixture
def tape(monkeypatch: pytest.MonkeyPatch) -> Tape:
    """What the test's flight is recorded on."""
    tape = Tape()
    recorder = Recorder.without_file(tape, START_NS)
    monkeypatch.setattr(Flight, "new_recorder", lambda _flight: recorder)
    return tape


def test_the_record_of_two_vehicles_is_audited_without_a_difference(tape: Tape) -> None:
    flight = Fleet()
    client = flight.all_flying()
    flight.send_to(client, 1, 8, 0, 5)
    flight.send_to(client, 2, 0, 400, 7)
    client.send(dialect.MAVLink_param_request_read_message(0, 0, b"NO_SUCH", -1))
    flight.beating(6)
    flight.silent = {1}
    flight.beating(3)
    client.command(LAND, target=(0, 0))
    flight.beating(3)
    flight.say_leave()
    flight.run(4)
    result = audit(tape.take(), tape.attachments, "test", "")
    assert result.good, (result.notes, result.first[:5])
    moved = {item.sysid for item in flight.recorded(FsaItem)}
    assert moved == {1, 2}


@pytest.mark.thorough
@pytest.mark.parametrize("sysid", [1, 2])
def test_a_changed_byte_of_either_vehicle_s_frames_is_found(tape: Tape, sysid: int) -> None:
    """The audit does both vehicles again, so what either did otherwise would show."""
    flight = Fleet()
    flight.all_flying()
    flight.run(1)
    stored = list(tape.take())
    number = next(
        n
        for n in reversed(range(len(stored)))
        if stored[n].topic.endswith("LOCAL_POSITION_NED") and f"/{sysid}/" in stored[n].topic
    )
    message = stored[number]
    data = bytearray(message.data)
    data[-10] ^= 0x40
    stored[number] = message._replace(data=bytes(data))
    result = audit(stored, tape.attachments, "test", "")
    assert not result.good
