"""PX4's events interface, against what PX4 1.14.3 was recorded to send.

Rows are of scenarios_px4.json: `mavlink_events` of its scenarios and its `event_catalogue`.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import pytest

from tests.unit.vehicle_services.fake_vehicle import HEALTHY, Bench, S, long, of
from vehicle_sim.autopilot.interface import FenceState, StatusText
from vehicle_sim.services.events.events import FIRST_SEQUENCE, KEPT
from vehicle_sim.services.events.health_report import Checked, report
from vehicle_sim.services.events.px4_events import Modes, event_of
from vehicle_sim.services.stream_sets import POSITION_ONLY, same_on_all
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd

GROUND: Final = m.Heartbeat(0, 6, 8, 0, 4, 3)
SUMMARY, HEALTH = 27825120, 18691879
OFFBOARD_MODE, LOITER, POSCTL = 0x60000, 0x3040000, 0x30000


def events(heard: list[m.Message]) -> list[m.Event]:
    return of(heard, m.Event)


def told(event: m.Event) -> tuple[int, int, str]:
    """Id, log levels and arguments, without the zeros behind them."""
    return event.id, event.log_levels, event.arguments.rstrip(b"\0").hex()


# ------------------------------------------------------------- the event that goes with a text

TEXTS: Final = [
    ("Armed by external command", 26266355, 0x66, "04"),
    ("Disarmed by external command", 32794487, 0x66, "04"),
    ("Disarmed by landing", 32794487, 0x66, "06"),
    ("Disarmed by auto preflight disarming", 32794487, 0x66, "07"),
    ("Takeoff detected", 21054825, 0x66, ""),
    ("Landing detected", 26622124, 0x66, ""),
    ("Switching to AUTO_MISSION is currently not available", 27280279, 0x62, "0000040403"),
    ("Switching to OFFBOARD is currently not available", 27280279, 0x62, "0000060007"),
    ("Mission start denied! No valid mission", 23844490, 0x62, ""),
    ("Takeoff to 5.0 meters above home", 31928670, 0x66, "0000a040"),
    ("Mission finished, landed", 24580612, 0x66, ""),
    ("Mission finished, loitering", 21455606, 0x66, ""),
    ("No valid mission available, loitering", 20167372, 0x93, ""),
    ("DO JUMP repetitions completed.", 26093318, 0x66, ""),
    ("Mission item index out of bound, index: 50, max: 3.", 18740064, 0x33, "320003"),
    ("IGN MISSION_ITEM: Invalid item", 33469040, 0x33, ""),
    ("Geofence violation for waypoint 2", 19608877, 0x63, "02"),
    ("RTL HOME activated", 18121339, 0x66, ""),
    ("RTL: landing at home position.", 27934633, 0x66, ""),
    ("RTL: climb to 39 m (7 m above destination)", 25988105, 0x66, "2700000007"),
    ("RTL: return at 40 m (7 m above destination)", 32911184, 0x66, "2800000007"),
    ("RTL: descend to 39 m (7 m above destination)", 28905952, 0x66, "2700000007"),
    ("RTL: land at destination", 16962474, 0x66, ""),
    ("Connection to ground station lost", 27571288, 0x64, ""),
    ("GCS connection regained", 31011876, 0x66, ""),
    ("Pilot took over using sticks", 17738815, 0x66, ""),
    ("command denied during calibration: 241", 22511653, 0x63, "f1"),
    ("Failsafe activated, triggering Hold", 31382480, 0x42, "0000060005"),
    ("Failsafe activated, triggering RTL", 31382480, 0x42, "0000060006"),
    ("Failsafe activated, triggering Land", 31382480, 0x42, "0000060007"),
    ("Failsafe activated", 31382480, 0x42, "0000060002"),
    ("Failsafe activated, triggering RTL in 5 seconds", 21279712, 0x42, "000006000605"),
    ("Failsafe activated, triggering Land in 5 seconds", 21279712, 0x42, "000006000705"),
]
"""Text, id, log levels, arguments as recorded; the failsafes' mode before was OFFBOARD, the one
without an action ended in POSCTL."""


@pytest.mark.parametrize(("text", "number", "levels", "arguments"), TEXTS)
def test_a_text_has_its_event(text: str, number: int, levels: int, arguments: str) -> None:
    event = event_of(text, Modes(now=POSCTL, before=OFFBOARD_MODE))
    assert event is not None
    assert (event.id, event.log_levels) == (number, levels)
    assert event.arguments.rstrip(b"\0").hex() == arguments


def test_a_text_of_which_no_event_is_known_has_none() -> None:
    assert event_of("Preflight Fail: something else", Modes(0, 0)) is None
    assert event_of("Landing detected twice", Modes(0, 0)) is None


# ---------------------------------------------------------------------------------- the report

MANUAL = (17231145, 0x44, "ffffffff07")
NO_OFFBOARD = (19865031, 0x33, "0040000014")
NO_MISSION = (17154777, 0x66, "0800000014")
NO_LOCAL = (30612409, 0x33, "3c007e0014")
NO_GLOBAL = (26788467, 0x33, "3800000014")
FENCE = (29908441, 0x33, "ffffffff1402")
GOOD = (HEALTH, 0x88, "000a180228")

REPORTS: Final = {
    "offboard signal, no mission": (
        Checked(offboard=True),
        ("000000000080000000f07bfffff07bffff", NO_MISSION, MANUAL, GOOD),
    ),
    "mission, no offboard signal": (
        Checked(mission=True),
        ("000000100080000000f83bfffff83bffff", NO_OFFBOARD, MANUAL, GOOD),
    ),
    "ready": (
        Checked(),
        ("000000100080000000f03bfffff03bffff", NO_MISSION, NO_OFFBOARD, MANUAL, GOOD),
    ),
    "beyond the fence": (
        Checked(within_fence=False),
        ("00000010008000000000000000f03bffff", NO_MISSION, NO_OFFBOARD, MANUAL, FENCE, GOOD),
    ),
    "beyond the fence under OFFBOARD": (
        Checked(within_fence=False, offboard=True),
        ("00000010008000000000000000f07bffff", NO_MISSION, MANUAL, FENCE, GOOD),
    ),
    "no station though NAV_DLL_ACT wants one": (
        Checked(station=False, station_needed=True),
        (
            "00001010008000000000000000f03bffff",
            *(NO_MISSION, NO_OFFBOARD, MANUAL),
            (23579003, 0x33, "ffffffff0c"),
            (HEALTH, 0x88, "000a080228"),
        ),
    ),
    "a mode that cannot be armed in": (
        Checked(mode_to_arm_in=False),
        (
            "000000100080000000d00bc3fff03bffff",
            (18648929, 0x66, "20303c0014"),
            *(NO_MISSION, NO_OFFBOARD, MANUAL, GOOD),
        ),
    ),
    "no position": (
        Checked(local_position=False, global_position=False),
        (
            "000000100080000000c03b81ffc03b81ff",
            *(NO_LOCAL, NO_GLOBAL, NO_MISSION, NO_OFFBOARD, MANUAL, GOOD),
        ),
    ),
    "velocity unstable": (
        Checked(velocity=False, local_position=False, global_position=False),
        (
            "000000120080000000c02b81ffc03b81ff",
            (25679424, 0x33, "3ed07e0011"),
            *(NO_LOCAL, NO_GLOBAL, NO_MISSION, NO_OFFBOARD, MANUAL, GOOD),
        ),
    ),
    "no attitude and no GPS": (
        Checked(attitude=False, local_position=False, global_position=False, gps=False),
        (
            "000000100080000000c02b81ffc02b81ff",
            (27227279, 0x22, "3ed07e0014"),
            *(NO_LOCAL, NO_GLOBAL, NO_MISSION, NO_OFFBOARD, MANUAL),
            (HEALTH, 0x88, "0002180228"),
        ),
    ),
    "right after boot, without a station": (
        Checked(
            attitude=False, local_position=False, global_position=False, gps=False, station=False
        ),
        (
            "000000100080000000c02b81ffc02b81ff",
            (27227279, 0x22, "3ed07e0014"),
            *(NO_LOCAL, NO_GLOBAL, NO_MISSION, NO_OFFBOARD, MANUAL),
            (23579003, 0x66, "ffffffff0c"),
            (HEALTH, 0x88, "0002080228"),
        ),
    ),
}
"""Each distinct report of the 61 scenarios: what was wrong, then the summary and the events."""


@pytest.mark.parametrize("name", REPORTS)
def test_a_report_is_the_recorded_one(name: str) -> None:
    checked, (summary, *rest) = REPORTS[name]
    made = [
        (event.id, event.log_levels, event.arguments.rstrip(b"\0").hex())
        for event in report(checked)
    ]
    assert [(number, levels) for number, levels, _ in made[:1]] == [(SUMMARY, 0x88)]
    assert report(checked)[0].arguments.hex() == summary
    assert made[1:] == rest


def test_with_sticks_nothing_is_said_about_manual_control() -> None:
    made = report(Checked(mission=True, offboard=True, sticks=True))
    assert [event.id for event in made] == [SUMMARY, HEALTH]
    assert made[0].arguments.hex() == "00" + "00" * 8 + "ff" * 8


# ---------------------------------------------------------------------------------- the wire


def test_the_first_report_comes_two_seconds_after_boot_and_then_what_has_changed() -> None:
    """boot_to_ready: reports at 2.3 s and later, at least 2 s apart; sequence from 65526 on."""
    bench = Bench()
    bench.send(GROUND)
    assert events(bench.advance(2 * S)) == []
    first = events(bench.advance(S // 5))
    assert [event.sequence for event in first] == [65526, 65527, 65528, 65529, 65530]
    assert told(first[0]) == (SUMMARY, 0x88, "000000100080000000f03bfffff03bffff")
    assert 2_080 <= first[0].event_time_boot_ms < 2_100
    assert events(bench.advance(2 * S)) == []
    bench.vehicle.mission_state = 2
    second = events(bench.advance(S))
    assert [event.id for event in second] == [SUMMARY, NO_OFFBOARD[0], MANUAL[0], HEALTH]
    bench.vehicle.mission_state = 1
    assert events(bench.advance(S)) == [], "2 s apart"
    assert len(events(bench.advance(2 * S))) == 5


def test_the_report_is_of_what_the_vehicle_has() -> None:
    bench = Bench()
    bench.send(m.Heartbeat(0, 18, 8, 0, 4, 3))
    bench.vehicle.health = replace(HEALTHY, position_ok=False, gps_ok=False)
    bench.vehicle.fence_state = FenceState(True, True, True, 1, 2, 0)
    bench.vehicle.custom_mode = 6 << 24 | 4 << 16
    heard = [told(event) for event in events(bench.advance(3 * S))]
    assert {number for number, _, _ in heard} >= {NO_LOCAL[0], NO_GLOBAL[0], FENCE[0], 18648929}
    assert (23579003, 0x66, "ffffffff0c") in heard
    assert heard[-1] == (HEALTH, 0x88, "0002080228")


def test_a_setpoint_stream_and_a_station_count_while_they_are_heard() -> None:
    bench = Bench()
    goal = m.SetPositionTargetLocalNed(0, 0.0, 0.0, -5.0, *(0.0,) * 8, 0b110111111000, 1, 1, 1)
    for _ in range(25):
        bench.send(GROUND)
        bench.send(goal)
        heard = bench.advance(S // 10)
    assert NO_OFFBOARD not in map(told, events(heard))
    heard = bench.advance(3 * S)
    assert NO_OFFBOARD in map(told, events(heard))
    assert 23579003 not in {event.id for event in events(heard)}
    assert 23579003 in {event.id for event in events(bench.advance(10 * S))}


def test_run_prearm_checks_is_answered_with_a_report_in_any_case() -> None:
    """L1: after RUN_PREARM_CHECKS one report, at once."""
    bench = Bench()
    bench.send(GROUND)
    bench.advance(3 * S)
    heard = events(bench.send(long(Cmd.RUN_PREARM_CHECKS, 0)))
    assert [told(event)[0] for event in heard] == [
        *(SUMMARY, NO_MISSION[0], NO_OFFBOARD[0], MANUAL[0], HEALTH)
    ]


def test_an_event_stands_beside_the_text() -> None:
    bench = Bench()
    bench.send(GROUND)
    bench.vehicle.pending.append(StatusText(6, "Armed by external command"))
    heard = bench.advance(S)
    texts = [each.text.rstrip(b"\0") for each in of(heard, m.Statustext)]
    assert texts == [b"Armed by external command\t"]
    assert [told(event) for event in events(heard)] == [(26266355, 0x66, "04")]


def test_events_can_be_asked_for_again_and_what_is_gone_is_said_so() -> None:
    """L2: REQUEST_EVENT 0..3 with 45 as the oldest of 20: one RESPONSE_EVENT_ERROR each."""
    bench = Bench()
    bench.send(GROUND)
    sent: list[m.Event] = []
    for _ in range(KEPT + 3):
        bench.vehicle.pending.append(StatusText(6, "Takeoff detected"))
        sent += events(bench.advance(S // 100))
    assert [event.sequence for event in sent] == [
        (FIRST_SEQUENCE + turn) & 0xFFFF for turn in range(KEPT + 3)
    ]
    oldest = sent[3].sequence
    heard = bench.send(m.RequestEvent(sent[1].sequence, sent[4].sequence, 1, 1))
    errors = of(heard, m.ResponseEventError)
    assert errors == [
        m.ResponseEventError(sent[1].sequence, oldest, 255, 190, 0),
        m.ResponseEventError(sent[2].sequence, oldest, 255, 190, 0),
    ]
    assert events(heard) == sent[3:5]
    heard = bench.send(m.RequestEvent(0, 65535, 1, 1))
    assert len(of(heard, m.ResponseEventError)) <= 256


def test_the_last_sequence_is_told_every_three_seconds() -> None:
    bench = Bench()
    bench.send(GROUND)
    heard = of(bench.advance(30 * S), m.CurrentEventSequence)
    assert len(heard) == 10
    assert heard[0] == m.CurrentEventSequence(65530, 0)


@pytest.mark.parametrize("number", [410, 411, 412, 413])
def test_the_interfaces_messages_are_not_to_be_requested(number: int) -> None:
    """K1_small_services: REQUEST_MESSAGE 410 to 413 DENIED."""
    heard = Bench().send(long(Cmd.REQUEST_MESSAGE, number))
    assert [each.result for each in of(heard, m.CommandAck)] == [2]


def test_ardupilot_and_a_fleet_of_positions_have_no_events() -> None:
    sparse = same_on_all(POSITION_ONLY)
    for bench in (Bench("ardupilot"), Bench("px4", stream_sets=sparse)):
        bench.send(GROUND)
        bench.vehicle.pending.append(StatusText(6, "Takeoff detected"))
        heard = bench.advance(10 * S) + bench.send(m.RequestEvent(0, 3, 1, 1))
        assert not {type(each) for each in heard} & {m.Event, m.ResponseEventError}
