"""A client's velocity stream, flown: whatever it asks for, the vehicle's truth stays inside.

The fence is a box of 110 m about home, from the ground to 40 m.  The client streams at 20 Hz, as
MAVSDK does.
"""

from __future__ import annotations

import math

import pytest

from gcs import ipc
from gcs.frames import Vec3
from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from gcs.report import DecisionItem
from gcs.session.inputs import OperatorGone, OperatorJoined, OperatorLine
from tests.loopback.flight import PERSONALITIES, Flight, Personality
from vehicle_sim.simulation.fault_script import fault_of

HALF_M, CEILING_M = 55.0, 40.0
POLICY = f"""
[[fence]]
name = "box"
kind = "box"
frame = "home"
east_m = [-{HALF_M}, {HALF_M}]
north_m = [-{HALF_M}, {HALF_M}]
floor_up_m = 0.0
ceiling_up_m = {CEILING_M}
"""
UP_M = 15.0
PERIOD_S = 0.05
POSITION_ONLY, VELOCITY_ONLY = 3576, 3527
"""POSITION_TARGET_TYPEMASK."""

KINDS = pytest.mark.parametrize("kind", PERSONALITIES)


def flight_of(kind: Personality) -> Flight:
    return Flight(kind, policy=parse_policy(POLICY, "my.toml")).hovering(UP_M)


def sample(flight: Flight, v_enu: Vec3, client: int = 1) -> None:
    flight.feed(OperatorLine(client, ipc.Stream(v_enu=v_enu)))


def stream(flight: Flight, v_enu: Vec3, seconds: float) -> float:
    """How far outside the vehicle was at the most while it was sent this; negative: inside."""
    outside_m = -math.inf
    for _ in range(round(seconds / PERIOD_S)):
        sample(flight, v_enu)
        flight.run(PERIOD_S)
        east_m, north_m, up_m = flight.truth_enu()
        beside_m = max(abs(east_m), abs(north_m)) - HALF_M
        outside_m = max(outside_m, beside_m, up_m - CEILING_M, -up_m)
    return outside_m


def blow(flight: Flight, east_m_s: float, north_m_s: float) -> None:
    wind = {"wind_ned_m_s": [north_m_s, east_m_s, 0.0], "gust_m_s": 1.0}
    assert flight.world.inject(fault_of("wind", wind, "script"), 1)


def told(flight: Flight) -> list[str]:
    return [event.code or event.outcome for event in flight.of(ipc.StreamVerdictEvent)]


def speed_m_s(flight: Flight) -> float:
    body = flight.vehicle.blocks.body
    return math.hypot(body.vel_e, body.vel_n, body.vel_d)


@KINDS
@pytest.mark.parametrize(
    "v_enu",
    [(10.0, 0.0, 0.0), (0.0, -10.0, 0.0), (-6.0, 8.0, 0.0), (0.0, 0.0, 3.0), (0.0, 0.0, -2.0)],
    ids=["east", "south", "north-west", "up", "down"],
)
def test_full_speed_straight_at_the_fence_is_held_and_flown_back(
    kind: Personality, v_enu: Vec3
) -> None:
    flight = flight_of(kind)
    outside_m = stream(flight, v_enu, 18.0)
    assert outside_m < 0.0
    assert flight.is_in(State.STREAMING)
    assert told(flight) == ["accepted", "CANNOT_STOP"]
    assert speed_m_s(flight) < 0.5
    held = flight.truth_enu()
    back = (-v_enu[0] / 2, -v_enu[1] / 2, -v_enu[2] / 2)
    assert stream(flight, back, 4.0) < 0.0
    assert told(flight) == ["accepted", "CANNOT_STOP", "accepted"]
    flown = [now - before for now, before in zip(flight.truth_enu(), held, strict=True)]
    along_m = sum(a * b for a, b in zip(flown, back, strict=True)) / math.hypot(*back)
    assert along_m > 0.5 * 3.5 * math.hypot(*back)


@pytest.mark.slow
@KINDS
@pytest.mark.parametrize("v_enu", [(10.0, 0.0, 0.0), (7.0, 7.0, 0.0)], ids=["east", "corner"])
def test_in_a_wind_towards_the_fence_as_well(kind: Personality, v_enu: Vec3) -> None:
    flight = flight_of(kind)
    blow(flight, 8.0, 8.0)
    assert stream(flight, v_enu, 16.0) < 0.0
    assert told(flight)[:2] == ["accepted", "CANNOT_STOP"]


@pytest.mark.parametrize("kind", ["px4", "ardupilot"])
def test_a_client_that_falls_silent_is_held_and_its_stream_is_over(kind: Personality) -> None:
    flight = flight_of(kind)
    stream(flight, (4.0, 0.0, 0.0), 3.0)
    silent_ns = flight.now_ns
    assert {s.type_mask for s in flight.setpoints(silent_ns - 2 * 10**9)} == {VELOCITY_ONLY}
    flight.run(0.4)
    assert flight.setpoints(silent_ns)[-1].type_mask == VELOCITY_ONLY
    flight.run(0.2)
    assert flight.setpoints(silent_ns)[-1].type_mask == POSITION_ONLY
    assert told(flight) == ["accepted", "DEADLINE"]
    flight.run(4.0)
    assert flight.is_in(State.STREAMING)
    assert speed_m_s(flight) < 0.5
    flight.run(0.6)
    assert flight.is_in(State.HOVERING)


def test_a_stream_is_asked_for_and_ended() -> None:
    flight = flight_of("px4")
    begun = flight.say("stream_begin")
    stream(flight, (0.0, 3.0, 0.0), 3.0)
    assert flight.outcome(begun) is None
    ended = flight.say("stream_end")
    assert (flight.outcome(begun), flight.outcome(ended)) == ("complete", "complete")
    assert flight.is_in(State.HOVERING)
    flight.run(4.0)
    assert flight.truth_enu()[1] == pytest.approx(9.0, abs=3.0)


def test_one_who_is_not_in_control_streams_nothing_and_is_told_once() -> None:
    flight = flight_of("px4")
    flight.feed(OperatorJoined(2, "another"))
    since_ns = flight.now_ns
    for _ in range(40):
        sample(flight, (1.0, 0.0, 0.0), client=2)
        flight.run(PERIOD_S)
    assert told(flight) == ["OTHER_OPERATOR"]
    assert flight.is_in(State.HOVERING)
    assert {s.type_mask for s in flight.setpoints(since_ns)} == {POSITION_ONLY}


def test_verdicts_are_on_the_record() -> None:
    flight = flight_of("px4")
    stream(flight, (1.0, 0.0, 0.0), 0.5)
    stream(flight, (11.0, 0.0, 0.0), 0.5)
    kept = [item for item in flight.recorded(DecisionItem) if item.phase == "stream"]
    assert [(item.word, item.outcome, item.code) for item in kept] == [
        ("stream", "accepted", ""),
        ("stream", "refused", "POLICY"),
    ]
    asked = {"asked_v_east_m_s": 11.0, "asked_v_north_m_s": 0.0, "asked_v_up_m_s": 0.0}
    assert kept[1].numbers == {**asked, "asked": 11.0, "max_speed_h_m_s": 10.0}


def decisions(flight: Flight) -> list[DecisionItem]:
    return [item for item in flight.recorded(DecisionItem) if item.phase == "stream"]


def test_the_end_of_refused_samples_is_on_the_record_too() -> None:
    """One decision where they begin, one where they stop; not one a sample."""
    flight = flight_of("px4")
    stream(flight, (11.0, 0.0, 0.0), 2.0)
    flight.run(7.0)
    kept = decisions(flight)
    assert [(item.outcome, item.code) for item in kept] == [
        ("refused", "POLICY"),
        ("ended", "POLICY"),
    ]
    assert kept[1].numbers == {"refused_samples": 40.0}
    assert kept[1].sentence == "40 samples were refused, none for 5 s"


def test_samples_of_one_who_is_not_in_control_are_on_the_record_too() -> None:
    flight = flight_of("px4")
    flight.feed(OperatorJoined(2, "another"))
    for _ in range(40):
        sample(flight, (1.0, 0.0, 0.0), client=2)
        flight.run(PERIOD_S)
    flight.feed(OperatorGone(2, "the connection was closed"))
    begun, ended = decisions(flight)
    assert (begun.source, begun.outcome, begun.code) == ("operator 2", "refused", "OTHER_OPERATOR")
    assert begun.numbers["asked_v_east_m_s"] == 1.0
    assert (ended.outcome, ended.numbers) == ("ended", {"refused_samples": 40.0})
