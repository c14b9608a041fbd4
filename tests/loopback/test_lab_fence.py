"""The lab's checkpoints about its cage, and about which way is up: L12, L13, L18."""

from __future__ import annotations

import pytest

from gcs.frames import enu_from_ned, ned_from_enu
from gcs.gate.states import State
from tests.loopback.flight import PERSONALITIES, Flight, Personality, lab_policy

both_personalities = pytest.mark.parametrize("personality", PERSONALITIES)
Vec3 = tuple[float, float, float]


@both_personalities
@pytest.mark.parametrize(
    ("goal_enu", "expected"),
    [
        ((5.0, 5.0, 2.0), "complete"),
        ((-5.0, -5.0, 2.0), "complete"),
        ((5.01, 0.0, 1.0), "refused OUTSIDE_FENCE"),
        ((0.0, -5.01, 1.0), "refused OUTSIDE_FENCE"),
        ((0.0, 0.0, 2.01), "refused OUTSIDE_FENCE"),
        ((0.0, 0.0, -0.1), "refused OUTSIDE_FENCE"),
    ],
)
def test_L12_the_cage_of_5_5_2_has_inclusive_bounds(
    personality: Personality, goal_enu: Vec3, expected: str
) -> None:
    flight = Flight(personality, policy=lab_policy()).hovering(1.0)
    ask = flight.goto(*goal_enu)
    assert flight.done(ask) == expected
    flight.run(1.0)
    assert flight.is_in(State.HOVERING)
    flown = [enu_from_ned(setpoint.pos_ned) for setpoint in flight.setpoints()]
    assert (goal_enu in flown) == (expected == "complete")
    assert all(abs(e) <= 5.0 and abs(n) <= 5.0 and 0.0 <= u <= 2.0 for e, n, u in flown)
    [verdict] = flight.verdicts(ask)
    if verdict.outcome == "refused":
        assert verdict.zone == "cage"
        assert verdict.numbers


def test_L13_what_the_fence_refused_is_flown_only_when_sent_again_without_it() -> None:
    flight = Flight(policy=lab_policy()).hovering(1.0)
    goal_enu = (7.0, 0.0, 1.0)
    assert flight.done(flight.goto(*goal_enu)) == "refused OUTSIDE_FENCE"
    assert flight.done(flight.say("fence", on=False)) == "complete"
    flight.run(0.1)
    since_ns = flight.now_ns
    flight.run(5.0)
    assert flight.states(since_ns) == []
    assert (0.0, 7.0, -1.0) not in {setpoint.pos_ned for setpoint in flight.setpoints()}
    assert flight.done(flight.goto(*goal_enu)) == "complete"
    flight.run(4.0)  # a PX4 that is sent the bare goal flies past it, and back
    assert flight.truth_enu()[0] == pytest.approx(7.0, abs=0.5)


def test_L13_the_default_policy_has_no_switch() -> None:
    flight = Flight().hovering(2.0)
    assert flight.done(flight.say("fence", on=False)) == "refused POLICY"
    assert flight.done(flight.goto(500.0, 0.0, 2.0)).startswith("refused")


EAST_NORTH_UP_TO_WIRE: dict[Vec3, Vec3] = {
    # east, north, up           x (north), y (east), z (down)
    (1.0, 0.0, 1.0): (0.0, 1.0, -1.0),
    (-1.0, 0.0, 1.0): (0.0, -1.0, -1.0),
    (0.0, 1.0, 1.0): (1.0, 0.0, -1.0),
    (0.0, -1.0, 1.0): (-1.0, 0.0, -1.0),
    (0.0, 0.0, 2.0): (0.0, 0.0, -2.0),
    (0.0, 0.0, 1.0): (0.0, 0.0, -1.0),
}


def test_L18_each_axis_is_on_the_wire_as_the_table_says() -> None:
    flight = Flight(policy=lab_policy()).hovering(1.0)
    for goal_enu, wire_ned in EAST_NORTH_UP_TO_WIRE.items():
        assert flight.done(flight.goto(*goal_enu)) == "complete"
        flight.run(0.2)
        sent = flight.setpoints(flight.now_ns - 60_000_000)[-1]
        assert sent.pos_ned == wire_ned
        assert enu_from_ned(sent.pos_ned) == goal_enu
        assert enu_from_ned(ned_from_enu(goal_enu)) == goal_enu
        flight.run(3.0)
        # By its own position: the truth is off by the error of its GPS receiver.
        assert enu_from_ned(flight.vehicle.estimate.pos_ned) == pytest.approx(goal_enu, abs=0.3)
