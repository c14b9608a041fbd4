"""Plans over bad links and from clients of all kinds: whole, or not at all."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from tests.unit.vehicle_services.fake_vehicle import HOME, MS, Bench, FakeVehicle, S, of
from tests.unit.vehicle_services.lossy_upload import (
    ACCEPTED,
    BAD_LINK,
    PATIENCE,
    upload,
    waypoints,
)
from tests.unit.vehicle_services.test_missions import asked_for, count, item, results
from vehicle_sim.autopilot.firmware import Firmware
from vehicle_sim.autopilot.interface import PlanItem
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.effects import Client
from vehicle_sim.services.missions.plan_items import as_ardupilot_gives_back, from_float, to_float
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.simulation.impairment import Impairment
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd, MissionResult, MissionType

pytestmark = pytest.mark.slow  # a vehicle flies

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)
OLD = tuple(PlanItem(seq, 6, 16, 0.0, 0.0, 0.0, 0.0, 1, 1, 5.0, 1) for seq in range(3))
BAD_COMMAND = 82  # what the stand-in for the autopilot does not fly


# --------------------------------------------------------------------------- 500 items, 30 %


@either
@pytest.mark.parametrize("who", PATIENCE)
@pytest.mark.parametrize("seed", range(6))
def test_500_items_over_a_bad_link_arrive_whole(
    personality: Personality, who: str, seed: int
) -> None:
    outcome = upload(personality, PATIENCE[who], seed, waypoints(500))
    assert outcome.stored == 500
    assert outcome.result in (ACCEPTED, None), "the ack may get lost, but it never lies"
    assert not outcome.busy
    assert outcome.sent < 12 * 500, "repeated requests do not multiply"
    if PATIENCE[who].repeats_item and PATIENCE[who].tries > 5:
        assert outcome.result == ACCEPTED


@either
@pytest.mark.parametrize("who", PATIENCE)
@pytest.mark.parametrize("seed", range(6))
def test_over_a_link_that_is_too_bad_the_old_plan_stays_whole(
    personality: Personality, who: str, seed: int
) -> None:
    vehicle = FakeVehicle()
    vehicle.plan = OLD
    dead = replace(BAD_LINK, loss=0.9)
    patience = replace(PATIENCE[who], tries=min(PATIENCE[who].tries, 60))
    outcome = upload(personality, patience, seed, waypoints(500), dead, vehicle)
    assert vehicle.plan == OLD
    assert outcome.result in (MissionResult.OPERATION_CANCELLED, MissionResult.ERROR, None)
    assert outcome.gave_up or outcome.result is not None
    assert not outcome.busy, "the vehicle has given up too"


@either
def test_500_items_of_which_one_is_bad_are_refused_whole(personality: Personality) -> None:
    vehicle = FakeVehicle()
    vehicle.plan = OLD
    items = waypoints(500)
    items[437] = items[437]._replace(command=BAD_COMMAND)
    outcome = upload(personality, PATIENCE["dogged"], 3, items, vehicle=vehicle)
    assert outcome.result == MissionResult.UNSUPPORTED
    assert vehicle.plan == OLD


@pytest.mark.parametrize(("personality", "most"), [("px4", 2000), ("ardupilot", 724)])
def test_a_full_plan_takes_one_request_an_item_and_one_more_item_has_no_space(
    personality: Personality, most: int
) -> None:
    clear = Impairment(delay_ns=1 * MS)
    outcome = upload(personality, PATIENCE["mavsdk"], 1, waypoints(most), clear)
    assert (outcome.stored, outcome.sent) == (most, most + 1)
    refused = upload(personality, PATIENCE["mavsdk"], 1, waypoints(most + 1), clear)
    assert (refused.stored, refused.result) == (0, MissionResult.NO_SPACE)


def test_fence_and_rally_have_their_own_room() -> None:
    bench = Bench("px4")
    assert results(bench.send(count(65, MissionType.FENCE))) == [MissionResult.NO_SPACE]
    assert results(bench.send(count(33, MissionType.RALLY))) == [MissionResult.NO_SPACE]
    assert asked_for(bench.send(count(64, MissionType.FENCE))) == [("MissionRequest", 0)]


# ------------------------------------------------------------------------ frames that repeat


def test_a_count_that_the_network_repeats_does_not_start_over() -> None:
    bench = Bench("px4")
    bench.send(count(3), sequence=7)
    bench.send(item(0))
    assert asked_for(bench.send(count(3), sequence=7)) == [("MissionRequestInt", 1)]
    bench.send(item(1))
    assert results(bench.send(item(2))) == [MissionResult.ACCEPTED]
    late = bench.send(count(3), sequence=7)
    assert results(late) == [MissionResult.ACCEPTED], "that upload is over, and well"
    assert asked_for(bench.advance(2 * S)) == []


def test_a_new_count_starts_over_whatever_was_sent_before() -> None:
    bench = Bench("px4")
    bench.send(count(3))
    bench.send(item(0, z=9.0))
    assert asked_for(bench.send(count(2))) == [("MissionRequest", 0)]
    bench.send(item(0, z=4.0))
    bench.send(item(1, z=4.0))
    assert [each.z for each in bench.vehicle.plan] == [4.0, 4.0]


def test_the_same_number_much_later_is_another_frame() -> None:
    bench = Bench("px4")
    bench.send(count(1), sequence=7)
    bench.send(item(0, z=9.0))
    bench.advance(4 * S)
    assert asked_for(bench.send(count(1), sequence=7)) == [("MissionRequest", 0)]


def test_an_early_item_that_comes_again_after_the_end_is_no_error() -> None:
    bench = Bench("px4")
    bench.send(count(2))
    bench.send(item(0))
    bench.send(item(1))
    assert results(bench.send(item(0))) == []
    assert results(bench.send(item(1))) == [MissionResult.ACCEPTED]


def test_two_clients_upload_one_after_the_other() -> None:
    bench = Bench("px4")
    bench.send(count(2), system=255)
    assert results(bench.send(count(1), system=250)) == [MissionResult.DENIED]
    bench.send(item(0), system=255)
    assert results(bench.send(item(0, z=9.0), system=250)) == [MissionResult.ERROR]
    assert results(bench.send(item(1), system=255)) == [MissionResult.ACCEPTED]
    assert asked_for(bench.send(count(1), system=250)) == [("MissionRequest", 0)]


# ----------------------------------------------------------------------------- partial lists


def test_mavproxy_changes_single_items_of_ardupilots_mission() -> None:
    bench = Bench("ardupilot")
    bench.vehicle.plan = OLD
    heard = bench.send(m.MissionWritePartialList(1, 2, 1, 1))
    assert asked_for(heard) == [("MissionRequest", 1)]
    assert asked_for(bench.send(item(1, z=50.0))) == [("MissionRequest", 2)]
    assert results(bench.send(item(2, z=60.0))) == [MissionResult.ACCEPTED]
    assert [each.z for each in bench.vehicle.plan] == [5.0, 50.0, 60.0]
    assert [each.seq for each in bench.vehicle.plan] == [0, 1, 2]


def test_a_partial_list_may_append_and_must_fit() -> None:
    bench = Bench("ardupilot")
    bench.vehicle.plan = OLD
    bench.send(m.MissionWritePartialList(3, 3, 1, 1))
    assert results(bench.send(item(3, z=50.0))) == [MissionResult.ACCEPTED]
    assert len(bench.vehicle.plan) == 4
    for first, last in ((-1, 0), (2, 1), (3, 5)):
        heard = bench.send(m.MissionWritePartialList(first, last, 1, 1))
        assert results(heard) == [MissionResult.ERROR]
    assert len(bench.vehicle.plan) == 4


def test_a_partial_list_that_is_bad_or_stalls_leaves_the_plan_whole() -> None:
    bench = Bench("ardupilot")
    bench.vehicle.plan = OLD
    bench.send(m.MissionWritePartialList(1, 1, 1, 1))
    assert results(bench.send(item(1, BAD_COMMAND))) == [MissionResult.UNSUPPORTED]
    bench.send(m.MissionWritePartialList(1, 1, 1, 1))
    assert results(bench.advance(30 * S)) == [MissionResult.OPERATION_CANCELLED]
    assert bench.vehicle.plan == OLD


def test_px4_does_not_know_partial_lists() -> None:
    bench = Bench("px4")
    bench.vehicle.plan = OLD
    heard = bench.send(m.MissionWritePartialList(1, 1, 1, 1))
    assert asked_for(heard) == []
    assert results(heard) == []


# ------------------------------------------------------------------------- what comes back


def test_numbers_that_are_no_place_are_not_scaled() -> None:
    shutter = m.MissionItem(0, 0, 0, 0, 1.0, 0.0, 0.0, 1, 203, 1, 1, 2, 0, 1)
    stored = from_float(shutter)
    assert stored is not None
    assert stored.x == 1
    client = Client(0, 255, 190)
    assert to_float(stored, client, 0).x == 1.0
    back = as_ardupilot_gives_back(stored, None)
    assert (back.frame, to_float(back, client, 0).x) == (0, 1.0)


@pytest.mark.parametrize(("sent", "back"), [(0.0, 1.0), (1.0, 1.0), (math.nan, 1.0), (-1.0, -1.0)])
def test_ardupilot_keeps_the_sign_of_a_landings_heading(sent: float, back: float) -> None:
    """As ArduCopter 4.7 gave four NAV_LAND back."""
    stored = PlanItem(3, 3, Cmd.NAV_LAND, 0.0, 0.0, 0.0, sent, 1, 1, 0.0, 1)
    assert as_ardupilot_gives_back(stored, None).p4 == back


@pytest.mark.parametrize(
    ("command", "frame", "comes_back_in"),
    [(16, 6, 3), (20, 6, 0), (93, 6, 0), (112, 3, 0), (178, 2, 0), (195, 6, 3), (201, 3, 3)],
)
def test_ardupilot_gives_frames_back_its_own_way(
    command: int, frame: int, comes_back_in: int
) -> None:
    stored = PlanItem(2, frame, command, 1.0, 0.0, -1.0, math.nan, 7, 8, 9.0, 1)
    assert as_ardupilot_gives_back(stored, HOME).frame == comes_back_in


def test_ardupilot_keeps_only_the_parameters_that_it_uses() -> None:
    stored = PlanItem(2, 3, 16, 3.0, 2.0, -1.0, math.nan, 7, 8, 9.0, 1)
    back = as_ardupilot_gives_back(stored, HOME)
    assert (back.p1, back.p2, back.p3, back.p4) == (3.0, 0.0, 0.0, 0.0)
    assert (back.x, back.y, back.z) == (7, 8, 9.0)


def test_ardupilot_does_not_count_home_among_the_items_of_mission_current() -> None:
    told: tuple[tuple[Personality, Firmware, int], ...] = (
        ("px4", "1.14", 0),  # which tells its item alone
        ("px4", "1.15", 3),
        ("ardupilot", "4.7", 2),
    )
    for personality, firmware, total in told:
        bench = Bench(personality, firmware=firmware)
        bench.vehicle.plan = OLD
        heard = bench.send(m.MissionSetCurrent(1, 1, 1))
        assert [each.total for each in of(heard, m.MissionCurrent)] == [total]


def test_every_personality_says_how_much_it_keeps_of_every_kind() -> None:
    for profile in PROFILES.values():
        assert set(profile.plan_max) == {
            MissionType.MISSION,
            MissionType.FENCE,
            MissionType.RALLY,
        }
