"""Goals that are not given in the local frame: from where it is, as its nose points, on the map."""

from __future__ import annotations

import math

import pytest

from gcs import ipc
from gcs.audit.audit import audit
from gcs.audit.messages import Tape
from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.gate.states import State
from gcs.record.writer import Recorder
from gcs.session import inputs
from tests.loopback.flight import HOMES, Flight, Personality
from tests.loopback.observed import START_NS

UP_M = 3.0
TURNED_DEG = 2.5
"""[arrival] yaw_deg, and what the nose may sway between two reports."""
REPLACE = parse_policy('retarget = "replace"', "replace.toml")
METRES_PER_DEGREE = math.radians(6_371_000.0)
"""Of latitude, on PX4's sphere; ArduPilot's is 0.1 % more."""


def asked(flight: Flight, word: str = "goto", **fields: object) -> int:
    flight.last_id += 1
    ask = ipc.Ask(flight.last_id, word, **fields)  # type: ignore[arg-type]
    flight.feed(inputs.OperatorLine(1, ask))
    return flight.last_id


def flown(flight: Flight, word: str = "goto", **fields: object) -> tuple[float, ...]:
    """The goal as its verdict tells, once it is reached."""
    number = asked(flight, word, **fields)
    assert flight.done(number) == "complete"
    goal_enu = flight.verdicts(number)[0].goal_enu
    assert goal_enu is not None
    goal = tuple(metres or 0.0 for metres in goal_enu)
    assert math.dist(flight.truth_enu(), goal) <= DEFAULT.arrival.max_radius_m
    return goal


def reported_enu(flight: Flight) -> tuple[float, float, float]:
    assert flight.session.telemetry is not None
    assert flight.session.telemetry.pos_ned is not None
    north, east, down = flight.session.telemetry.pos_ned
    return (east, north, -down)


def nose_deg(flight: Flight) -> float:
    assert flight.session.telemetry is not None
    assert flight.session.telemetry.yaw_rad is not None
    return math.degrees(flight.session.telemetry.yaw_rad) % 360.0


def test_a_move_counts_from_where_the_vehicle_is_reported(personality: Personality) -> None:
    flight = Flight(personality).hovering(UP_M)
    east, north, up = reported_enu(flight)
    assert flown(flight, move_enu=(2.0, -1.0, 1.0)) == pytest.approx(
        (east + 2.0, north - 1.0, up + 1.0), abs=1e-5
    )


def test_forward_is_where_its_nose_points(personality: Personality) -> None:
    """Nose to the east: forward is east, right is south."""
    flight = Flight(personality).hovering(UP_M)
    before = flown(flight, "heading", yaw_deg=90.0)
    assert nose_deg(flight) == pytest.approx(90.0, abs=TURNED_DEG), "complete when it has turned"
    east, north, up = reported_enu(flight)
    assert (east, north, up) == pytest.approx(before, abs=0.6)
    goal = flown(flight, move_body=(3.0, 1.0, 0.5))
    assert goal == pytest.approx((east + 3.0, north - 1.0, up + 0.5), abs=0.2)
    assert math.dist(goal, (east, north, up)) == pytest.approx(math.hypot(3.0, 1.0, 0.5), abs=1e-4)


def test_forward_amid_a_turn_is_where_the_nose_turns_to(personality: Personality) -> None:
    flight = Flight(personality, policy=REPLACE).hovering(UP_M)
    turn = asked(flight, "heading", yaw_deg=-90.0)
    flight.run(0.7)
    assert abs(nose_deg(flight) - 270.0) > 30.0
    east, north, up = reported_enu(flight)
    assert flown(flight, move_body=(3.0, 0.0, 0.0)) == pytest.approx(
        (east - 3.0, north, up), abs=1e-5
    )
    assert flight.outcome(turn) == "superseded SUPERSEDED"
    assert nose_deg(flight) == pytest.approx(270.0, abs=TURNED_DEG)


def test_of_a_vehicle_that_tells_no_heading_the_place_alone_counts() -> None:
    flight = Flight().hovering(UP_M)
    flight.attitudes_lost = True
    flight.run(1.5)
    number = asked(flight, "heading", yaw_deg=170.0)
    flight.run(1.0)
    assert flight.outcome(number) == "complete"


def test_a_heading_keeps_the_place_that_it_hovers_at(personality: Personality) -> None:
    flight = Flight(personality).hovering(UP_M)
    goal = flown(flight, goal_enu=(2.0, 2.0, UP_M))
    for yaw_deg in (45.0, -90.0, 180.0):
        assert flown(flight, "heading", yaw_deg=yaw_deg) == goal, "it does not wander"
    assert flight.setpoints()[-1].yaw_rad == pytest.approx(math.pi, abs=1e-6)


def test_a_heading_on_the_way_keeps_the_goal() -> None:
    flight = Flight(policy=REPLACE).hovering(UP_M)
    flight.goto(9.0, 0.0, UP_M)
    flight.until(lambda: flight.is_in(State.MOVING), 1.0)
    number = asked(flight, "heading", yaw_deg=90.0)
    assert flight.done(number) == "complete"
    assert flight.verdicts(number)[0].goal_enu == (9.0, 0.0, UP_M)


@pytest.mark.parametrize("amsl", [False, True])
def test_a_place_on_the_map(personality: Personality, amsl: bool) -> None:
    home = HOMES[personality]
    flight = Flight(personality).hovering(UP_M)
    goal = (home.lat_deg + 5e-5, home.lon_deg - 4e-5, 4.0 + (home.alt_amsl_m if amsl else 0.0))
    east, north, up = flown(flight, goal_global=goal, amsl=amsl)
    assert north == pytest.approx(5e-5 * METRES_PER_DEGREE, abs=0.05)
    scale = math.cos(math.radians(home.lat_deg))
    assert east == pytest.approx(-4e-5 * METRES_PER_DEGREE * scale, abs=0.05)
    assert up == pytest.approx(4.0, abs=0.1)


@pytest.mark.parametrize(
    ("fields", "outcome"),
    [
        ({"move_enu": (500.0, 0.0, 0.0)}, "refused OUTSIDE_FENCE"),
        ({"move_body": (0.0, 0.0, 500.0)}, "refused TOO_HIGH"),
        ({"goal_global": (0.0, 0.0, 3.0)}, "refused TOO_FAR"),
        ({"goal_global": (91.0, 0.0, 3.0)}, "refused BAD_PARAMETER"),
        ({"goal_global": (None, None, 3.0)}, "refused NON_FINITE"),
        ({"move_enu": (0.0, None, 0.0)}, "refused NON_FINITE"),
        ({"move_enu": (0.0, 0.0, 0.0), "goal_enu": (0.0, 0.0, 3.0)}, "refused BAD_REQUEST"),
        ({"move_enu": (0.0, 0.0, 0.0), "move_body": (0.0, 0.0, 0.0)}, "refused BAD_REQUEST"),
        ({}, "refused BAD_REQUEST"),
        ({"word": "heading"}, "refused BAD_REQUEST"),
    ],
)
def test_what_is_refused_is_checked_the_same(fields: dict[str, object], outcome: str) -> None:
    flight = Flight().hovering(UP_M)
    ask = ipc.Ask(99, **{"word": "goto", **fields})  # type: ignore[arg-type]
    flight.feed(inputs.OperatorLine(1, ipc.Check(ask)))
    checked = flight.of(ipc.Checked)[-1]
    assert f"{checked.outcome} {checked.code}" == outcome
    number = asked(flight, **{"word": "goto", **fields})  # type: ignore[arg-type]
    assert flight.done(number) == outcome
    assert flight.state is State.HOVERING


def test_without_a_vehicle_nothing_is_settled() -> None:
    flight = Flight()
    assert flight.done(asked(flight, move_enu=(1.0, 0.0, 0.0))) == "refused NO_VEHICLE"


def test_the_audit_finds_every_goal_where_it_was_settled(monkeypatch: pytest.MonkeyPatch) -> None:
    tape = Tape()
    new = staticmethod(lambda: Recorder.without_file(tape, START_NS))
    monkeypatch.setattr(Flight, "new_recorder", new)
    flight = Flight().hovering(UP_M)
    flown(flight, move_enu=(2.0, -1.0, 1.0), yaw_deg=45.0)
    flown(flight, "heading", yaw_deg=90.0)
    assert flight.done(asked(flight, "speed", speed_m_s=1.5)) == "complete"
    flown(flight, move_body=(2.0, 0.0, 0.0))
    home = HOMES["px4"]
    flown(flight, goal_global=(home.lat_deg, home.lon_deg, 3.0))
    result = audit(tape.take(), tape.attachments, "test", "")
    assert result.good, (result.notes, result.first[:5])
    assert result.compared["frame sent"] > 250


def fastest_m_s(flight: Flight, **goal: object) -> float:
    """Of the truth, on the way to a goal."""
    number, fastest = asked(flight, "goto", **goal), 0.0
    while flight.outcome(number) is None:
        flight.run(0.1)
        fastest = max(fastest, math.hypot(*flight.vehicle.truth.v_ned))
    assert flight.outcome(number) == "complete"
    return fastest


def test_the_next_legs_are_flown_at_the_speed_that_was_asked_for(personality: Personality) -> None:
    flight = Flight(personality).hovering(UP_M)
    assert fastest_m_s(flight, goal_enu=(25.0, 0.0, UP_M)) > 4.0
    assert flight.done(asked(flight, "speed", speed_m_s=1.5)) == "complete"
    assert fastest_m_s(flight, goal_enu=(0.0, 12.0, UP_M)) == pytest.approx(1.5, abs=0.35)
    assert fastest_m_s(flight, move_enu=(4.0, 0.0, 8.0)) == pytest.approx(1.5, abs=0.35)
    one_leg = fastest_m_s(flight, goal_enu=(16.0, 12.0, UP_M), speed_m_s=3.0)
    assert one_leg == pytest.approx(3.0, abs=0.6)
    assert fastest_m_s(flight, goal_enu=(4.0, 12.0, UP_M)) == pytest.approx(1.5, abs=0.35)


@pytest.mark.parametrize(
    ("speed_m_s", "code"),
    [(12.01, "POLICY"), (0.05, "POLICY"), (0.0, "POLICY"), (-1.0, "POLICY"), (None, "NON_FINITE")],
)
def test_a_speed_beyond_the_policy_is_refused_not_clamped(
    speed_m_s: float | None, code: str
) -> None:
    """PX4's legs are flown at 12 m/s at most, by the default policy."""
    flight = Flight().hovering(UP_M)
    number = asked(flight, "speed", speed_m_s=speed_m_s)
    assert flight.done(number) == f"refused {code}"
    assert flight.verdicts(number)[0].numbers["max_speed_m_s"] == 12.0
    if speed_m_s is not None:
        goal = (3.0, 0.0, UP_M)
        assert flight.done(asked(flight, goal_enu=goal, speed_m_s=speed_m_s)) == f"refused {code}"


def test_a_slow_leg_has_the_time_that_it_takes() -> None:
    flight = Flight().hovering(UP_M)
    flight.done(asked(flight, "speed", speed_m_s=0.2))
    assert flight.done(asked(flight, goal_enu=(14.0, 0.0, UP_M)), 300.0) == "complete"
