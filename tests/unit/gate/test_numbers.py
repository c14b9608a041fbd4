"""Numbers of the gate's words, where they are recorded, sent or compared: they must never change.

States and log levels have theirs from the lab and from foxglove.Log, landed states from MAVLink
(MAV_LANDED_STATE of common.xml); a severity's is its place in the order.
"""

from __future__ import annotations

import pytest

from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import Level, Say, Transition
from gcs.gate.inputs import ConditionChanged, LandedSeen, PositionSeen
from gcs.gate.policy.parse import parse_policy
from gcs.gate.refusal import Code
from gcs.gate.requests import Arm, TakeControl, TakePhoto
from gcs.gate.states import FlightMode, LandedState, State
from tests.unit.gate.script import MS, SECOND, Script, policy
from tests.unit.gate.situations import UP, lead_to

STATES = {
    "NO_VEHICLE": 4,
    "STALE": 5,
    "GROUNDED": 6,
    "TAKING_OFF": 7,
    "HOVERING": 1,
    "MOVING": 3,
    "TAKING_PICTURE": 9,
    "FLYING_MISSION": 10,
    "RETURNING": 11,
    "LANDING": 12,
    "HOLDING": 13,
    "EXTERNAL": 14,
}
"""Those that a flight can be in between two inputs; the record has the number of each."""

WORDS = ("nominal", "caution", "hold", "return", "land", "terminate")
"""Severities in ascending order."""


@pytest.mark.parametrize(("name", "number"), list(STATES.items()))
def test_a_state_is_recorded_with_its_number(name: str, number: int) -> None:
    script = Script(policy("default"))
    lead_to(State[name], script)
    assert (script.gate.state.name, int(script.gate.state)) == (name, number)


def test_every_state_has_a_number_of_its_own() -> None:
    assert {s.name: int(s) for s in State} == STATES | {"VERIFYING": 2, "STREAMING": 8}


def test_so_is_the_flight_of_somebody_who_takes_over() -> None:
    """A mode that we did not command, while we stream."""
    script = Script(policy("default")).take_control(UP)
    script.heartbeat(FlightMode.OTHER)
    assert (script.all(Transition)[-1].after.name, int(script.gate.state)) == ("EXTERNAL", 14)


@pytest.mark.parametrize(
    ("number", "name", "state"),
    [
        (1, "ON_GROUND", State.GROUNDED),
        (2, "IN_AIR", State.EXTERNAL),
        (3, "TAKEOFF", State.EXTERNAL),
        (4, "LANDING", State.EXTERNAL),
    ],
)
def test_a_landed_state_is_read_by_mavlinks_number(number: int, name: str, state: State) -> None:
    script = Script(policy("default"))
    script.armed, script.landed = True, LandedState(number)
    script.connect()
    script.feed(LandedSeen(LandedState(number)))
    assert script.gate.state is state
    assert LandedState(number).name == name


@pytest.mark.parametrize(("number", "word"), list(enumerate(WORDS)))
def test_a_severity_is_its_place_in_the_order(number: int, word: str) -> None:
    """A request that it refuses says which it was."""
    script = Script(parse_policy(f'severities.battery_low = "{word}"', "my.toml")).connect()
    script.feed(ConditionChanged(Condition.BATTERY_LOW, True))
    assert script.gate.severity.name == word.upper()
    refusal = script.verdict(script.ask(Arm())).refusal
    if script.gate.severity < Severity.HOLD:
        assert refusal is None
    else:
        assert refusal is not None
        assert refusal.numbers == (("severity", float(number)),)


def test_what_is_said_has_the_numbers_of_foxglove_log() -> None:
    script = Script(policy("default")).take_control(UP)
    script.goto(500.0, 0.0, UP)
    script.tick()
    script.now_ns += 5 * SECOND
    script.heartbeat()
    script.feed(PositionSeen((140.0, 0.0, -UP), (12.0, 0.0, 0.0), script.now_ns // MS))
    said = {say.text.split()[0]: int(say.level) for say in script.all(Say)}
    assert (said["Current"], said["Refused"], said["Brake:"]) == (2, 3, 4)


def test_the_levels_in_order() -> None:
    assert [level.name for level in sorted(Level)] == [
        "DEBUG",
        "INFO",
        "WARNING",
        "ERROR",
        "FATAL",
    ]
    assert [int(level) for level in Level] == [1, 2, 3, 4, 5]


def test_a_refusal_for_an_old_position_has_its_age_and_the_most_it_may_have() -> None:
    script = Script(policy("default")).fly(UP)
    script.now_ns += 2 * SECOND
    script.heartbeat()
    refusal = script.verdict(script.ask(TakeControl())).refusal
    assert refusal is not None
    assert refusal.code is Code.STALE
    numbers = dict(refusal.numbers)
    assert numbers["position_age_s"] == pytest.approx(2.05, abs=0.1)
    assert numbers["max_age_s"] == policy("default").position_age_s


def test_a_refusal_while_a_goal_is_flown_has_the_goal() -> None:
    script = Script(policy("default")).take_control(UP)
    script.goto(8.0, 3.0, UP)
    script.tick()
    refusal = script.verdict(script.ask(TakePhoto())).refusal
    assert refusal is not None
    assert refusal.code is Code.BUSY
    names = ("goal_east_m", "goal_north_m", "goal_up_m")
    assert refusal.numbers == tuple(zip(names, (8.0, 3.0, UP), strict=True))
