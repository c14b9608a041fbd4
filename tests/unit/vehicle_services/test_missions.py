"""The mission protocol: lost, repeated and late messages, and the old plan kept whole."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

from tests.unit.vehicle_services.fake_vehicle import MS, Bench, S, of
from vehicle_sim.autopilot.interface import MissionReached
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import MissionResult, MissionType

WAYPOINT = 16


def count(number: int, kind: int = MissionType.MISSION) -> m.MissionCount:
    return m.MissionCount(number, 1, 1, kind)


def item(
    seq: int, command: int = WAYPOINT, kind: int = 0, frame: int = 6, z: float = 5.0, p1: float = 0
) -> m.MissionItemInt:
    return m.MissionItemInt(
        p1, 0, 0, math.nan, 473977420 + seq, 85455940, z, seq, command, 1, 1, frame, 0, 1, kind
    )


def asked_for(heard: list[m.Message]) -> list[tuple[str, int]]:
    """What the vehicle asks for, and how."""
    return [
        (type(each).__name__, each.seq)
        for each in heard
        if isinstance(each, m.MissionRequest | m.MissionRequestInt)
    ]


def results(heard: list[m.Message]) -> list[int]:
    return [each.type for each in of(heard, m.MissionAck)]


def upload(bench: Bench, items: list[m.MissionItemInt], kind: int = 0) -> list[m.Message]:
    heard = bench.send(count(len(items), kind))
    for each in items:
        heard = bench.send(each)
    return heard


def test_px4_asks_for_item_0_the_old_way_and_for_the_rest_as_int() -> None:
    bench = Bench("px4")
    assert asked_for(bench.send(count(3))) == [("MissionRequest", 0)]
    assert asked_for(bench.send(item(0))) == [("MissionRequestInt", 1)]
    assert asked_for(bench.send(item(1))) == [("MissionRequestInt", 2)]
    assert results(bench.send(item(2))) == [MissionResult.ACCEPTED]
    assert [each.seq for each in bench.vehicle.plan] == [0, 1, 2]


def test_ardupilot_asks_for_all_items_the_old_way() -> None:
    bench = Bench("ardupilot")
    assert asked_for(bench.send(count(2))) == [("MissionRequest", 0)]
    assert asked_for(bench.send(item(0))) == [("MissionRequest", 1)]
    assert results(bench.send(item(1))) == [MissionResult.ACCEPTED]


def test_a_lost_item_is_asked_for_again_and_again_then_the_upload_is_given_up() -> None:
    bench = Bench("px4")
    upload(bench, [item(0)])
    before = bench.vehicle.plan
    bench.send(count(2))
    bench.send(item(0, WAYPOINT, z=9.0))
    heard = bench.advance(300 * MS)
    assert asked_for(heard) == [("MissionRequestInt", 1)]
    heard = bench.advance(6 * S)
    assert len(asked_for(heard)) == 19
    assert results(heard) == [MissionResult.OPERATION_CANCELLED]
    assert bench.vehicle.plan == before, "the old plan is whole"
    assert asked_for(bench.advance(2 * S)) == []


def test_ardupilot_asks_again_once_a_second() -> None:
    bench = Bench("ardupilot")
    bench.send(count(2))
    assert len(asked_for(bench.advance(3500 * MS))) == 3


def test_time_outs_of_the_other_side_run_on_wall_time() -> None:
    bench = Bench("px4", speedup=Fraction(10))
    bench.send(count(1))
    assert asked_for(bench.advance(240 * MS)) == []
    assert len(asked_for(bench.advance(20 * MS))) == 1


def test_items_that_come_twice_or_out_of_order_are_answered_with_the_one_that_is_wanted() -> None:
    bench = Bench("px4")
    bench.send(count(3))
    bench.send(item(0))
    assert asked_for(bench.send(item(0))) == [("MissionRequestInt", 1)]
    assert asked_for(bench.send(item(2))) == [("MissionRequestInt", 1)]
    bench.send(item(1))
    assert results(bench.send(item(2))) == [MissionResult.ACCEPTED]
    assert [each.seq for each in bench.vehicle.plan] == [0, 1, 2]


def test_the_final_ack_is_lost_and_the_last_item_brings_it_again() -> None:
    bench = Bench("px4")
    upload(bench, [item(0), item(1)])
    assert results(bench.send(item(1))) == [MissionResult.ACCEPTED]
    bench.advance(16 * S)
    assert results(bench.send(item(1))) == [MissionResult.ERROR], "by now it is a stray"


def test_an_item_that_cannot_be_flown_is_named_and_the_old_plan_stays() -> None:
    bench = Bench("px4")
    upload(bench, [item(0)])
    before = bench.vehicle.plan
    heard = upload(bench, [item(0), item(1, command=82)])
    assert results(heard) == [MissionResult.UNSUPPORTED]
    (text,) = [each.text for each in of(heard, m.Statustext)]
    assert text.startswith(b"item 1: ")
    assert bench.vehicle.plan == before


def test_nothing_is_swapped_before_the_last_item() -> None:
    bench = Bench("px4")
    bench.send(count(2))
    bench.send(item(0))
    assert bench.vehicle.plan == ()


def test_a_second_client_must_wait_and_the_first_may_start_over() -> None:
    bench = Bench("px4")
    bench.send(count(2), system=255)
    assert results(bench.send(count(1), system=250)) == [MissionResult.DENIED]
    assert results(bench.send(m.MissionClearAll(1, 1, 0), system=250)) == [MissionResult.DENIED]
    assert asked_for(bench.send(count(1), system=255)) == [("MissionRequest", 0)]
    assert results(bench.send(item(0), system=255)) == [MissionResult.ACCEPTED]


def test_an_empty_upload_clears() -> None:
    bench = Bench("px4")
    upload(bench, [item(0)])
    assert results(bench.send(count(0))) == [MissionResult.ACCEPTED]
    assert bench.vehicle.plan == ()


@pytest.mark.parametrize(
    ("kind", "command"), [(MissionType.FENCE, 5001), (MissionType.RALLY, 5100)]
)
def test_fence_and_rally_points_are_kept_apart_from_the_mission(kind: int, command: int) -> None:
    bench = Bench("px4")
    upload(bench, [item(0)])
    heard = upload(bench, [item(seq, command, kind, p1=3) for seq in range(3)], kind)
    assert results(heard) == [MissionResult.ACCEPTED]
    told = bench.send(m.MissionRequestList(1, 1, kind))
    assert [each.count_ for each in of(told, m.MissionCount)] == [3]
    assert len(bench.vehicle.plan) == 1
    assert results(upload(bench, [item(0, WAYPOINT, kind)], kind)) == [MissionResult.UNSUPPORTED]
    bench.send(m.MissionClearAll(1, 1, MissionType.ALL))
    told = bench.send(m.MissionRequestList(1, 1, kind))
    assert [each.count_ for each in of(told, m.MissionCount)] == [0]
    assert not bench.vehicle.plan


@pytest.mark.parametrize(
    ("bad", "result", "why"),
    [
        (
            item(0, 5001, MissionType.FENCE, p1=2.0),
            MissionResult.INVALID_PARAM1,
            b"item 0: polygon",
        ),
        (item(0, 5004, MissionType.FENCE, frame=1, p1=9.0), MissionResult.UNSUPPORTED_FRAME, b""),
        (item(0, 5001, MissionType.FENCE, p1=3.0), MissionResult.ERROR, b"item 0: the polygon"),
        (item(0, 5100, MissionType.RALLY, frame=2), MissionResult.UNSUPPORTED_FRAME, b"item 0"),
    ],
)
def test_a_fence_that_makes_no_sense_is_refused_whole_and_the_old_one_stays(
    bad: m.MissionItemInt, result: int, why: bytes
) -> None:
    bench = Bench("px4")
    good = [item(0, 5003, MissionType.FENCE, p1=50.0)]
    upload(bench, good, MissionType.FENCE)
    heard = upload(bench, [bad], bad.mission_type)
    assert results(heard) == [result]
    (text,) = [each.text for each in of(heard, m.Statustext)]
    assert text.startswith(why)
    told = bench.send(m.MissionRequestList(1, 1, MissionType.FENCE))
    assert [each.count_ for each in of(told, m.MissionCount)] == [1]
    assert len(bench.vehicle.named("load_fence")) == 1


def test_types_and_numbers_beyond_all_measure_are_refused() -> None:
    bench = Bench("px4")
    assert results(bench.send(count(1, 77))) == [MissionResult.UNSUPPORTED]
    assert results(bench.send(count(5000))) == [MissionResult.NO_SPACE]
    # behaviour.json: MISSION_REQUEST_INT out of range is PX4's MISSION_ACK 1.
    assert results(bench.send(m.MissionRequestInt(0, 1, 1))) == [MissionResult.ERROR]


def test_the_id_of_a_plan_is_the_same_in_ack_count_and_mission_current() -> None:
    bench = Bench("px4", firmware="1.15")
    (ack,) = of(upload(bench, [item(0)]), m.MissionAck)
    (told,) = of(bench.send(m.MissionRequestList(1, 1)), m.MissionCount)
    current = next(each for each in bench.advance(1 * S) if isinstance(each, m.MissionCurrent))
    assert ack.opaque_id == told.opaque_id == current.mission_id != 0


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_the_recorded_firmware_numbers_no_plans(personality: Personality) -> None:
    """px4_1_14_flight.tlog and arducopter_4_7_flight.tlog: MISSION_ACK of 3 bytes, MISSION_CURRENT
    of 6."""
    bench = Bench(personality)
    (ack,) = of(upload(bench, [item(0)]), m.MissionAck)
    asked = m.CommandLong(m.IDS[m.MissionCurrent], 0, 0, 0, 0, 0, 0, 512, 1, 1, 0)
    current = next(
        each
        for each in [*bench.send(asked), *bench.advance(1 * S)]
        if isinstance(each, m.MissionCurrent)
    )
    assert (ack.opaque_id, current.mission_id) == (0, 0)


def test_px4_gives_items_back_as_it_got_them_in_int_form() -> None:
    bench = Bench("px4")
    upload(bench, [item(0, frame=3)])
    for asked in (m.MissionRequestInt(0, 1, 1), m.MissionRequest(0, 1, 1)):
        (back,) = bench.send(asked)
        assert isinstance(back, m.MissionItemInt)
        assert (back.x, back.y, back.z, back.frame) == (473977420, 85455940, 5.0, 6)


def test_ardupilot_puts_home_at_item_0_and_answers_the_old_request_in_floats() -> None:
    bench = Bench("ardupilot")
    upload(bench, [item(0), item(1), item(2, command=20)])
    (home,) = bench.send(m.MissionRequestInt(0, 1, 1))
    assert isinstance(home, m.MissionItemInt)
    assert (home.frame, home.x, home.z) == (0, 473977420, 488.0)
    (first,) = bench.send(m.MissionRequest(1, 1, 1))
    assert isinstance(first, m.MissionItem)
    assert first.frame == 3
    assert first.x == pytest.approx(47.3977421, abs=1e-5)
    (back,) = bench.send(m.MissionRequestInt(2, 1, 1))
    assert isinstance(back, m.MissionItemInt)
    assert back.frame == 0


def test_ardupilot_gives_home_even_where_there_is_no_mission() -> None:
    """`MissionItemProtocol_Waypoints::get_item`; DroneKit asks for it after a count of 0."""
    bench = Bench("ardupilot")
    bench.send(m.Heartbeat(0, 6, 8, 0, 4, 3))
    (told,) = bench.send(m.MissionRequestList(1, 1))
    assert isinstance(told, m.MissionCount)
    assert told.count_ == 0
    (home,) = bench.send(m.MissionRequest(0, 1, 1))
    assert isinstance(home, m.MissionItem)
    assert (home.seq, home.command, home.z) == (0, WAYPOINT, 488.0)
    assert results(bench.send(m.MissionRequest(1, 1, 1))) == [MissionResult.INVALID_SEQUENCE]
    fence = m.MissionRequest(0, 1, 1, MissionType.FENCE)
    assert results(bench.send(fence)) == [MissionResult.INVALID_SEQUENCE]
    assert results(Bench("px4").send(m.MissionRequest(0, 1, 1))) == [MissionResult.ERROR]


def test_float_items_are_stored_to_a_ten_millionth_of_a_degree() -> None:
    bench = Bench("ardupilot")
    bench.send(count(1))
    bench.send(m.MissionItem(0, 0, 0, 0, 47.5, 8.5, 10.0, 0, WAYPOINT, 1, 1, 3, 0, 1))
    assert (bench.vehicle.plan[0].x, bench.vehicle.plan[0].y) == (475000000, 85000000)


def test_a_float_item_without_a_place_ends_the_upload() -> None:
    bench = Bench("ardupilot")
    bench.send(count(1))
    heard = bench.send(m.MissionItem(0, 0, 0, 0, math.nan, 8.5, 10.0, 0, WAYPOINT, 1, 1, 3, 0, 1))
    assert results(heard) == [MissionResult.INVALID]
    assert asked_for(bench.advance(3 * S)) == []


def test_set_current_is_answered_with_mission_current_or_refused() -> None:
    bench = Bench("px4")
    upload(bench, [item(0), item(1)])
    heard = bench.send(m.MissionSetCurrent(1, 1, 1))
    assert [each.seq for each in of(heard, m.MissionCurrent)] == [1]
    heard = bench.send(m.MissionSetCurrent(9, 1, 1))
    assert results(heard) == [MissionResult.INVALID_SEQUENCE]


def test_simple_goto_of_dronekit_flies_on_ardupilot() -> None:
    bench = Bench("ardupilot")
    guided = m.MissionItem(0, 0, 0, 0, 47.397742, 8.545594, 20.0, 0, WAYPOINT, 1, 1, 3, 2, 0)
    assert results(bench.send(guided)) == [MissionResult.ACCEPTED]
    ((pos_ned, *_),) = bench.vehicle.named("reposition")
    assert pos_ned == pytest.approx((0.0, 0.0, -20.0), abs=0.5)
    assert bench.vehicle.plan == ()


@pytest.mark.parametrize(("personality", "times"), [("px4", 11), ("ardupilot", 1)])
def test_an_item_that_was_reached_is_told_as_often_as_the_autopilot_does(
    personality: str, times: int
) -> None:
    bench = Bench("px4" if personality == "px4" else "ardupilot")
    bench.send(m.Heartbeat(0, 6, 8, 0, 4, 3))
    bench.vehicle.pending.append(MissionReached(3))
    reached = of(bench.advance(3 * S), m.MissionItemReached)
    assert [each.seq for each in reached] == [3] * times
