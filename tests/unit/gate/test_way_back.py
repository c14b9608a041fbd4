"""A vehicle that is outside: `resume` flies it back to the nearest place inside, slowly."""

from __future__ import annotations

import math

import pytest
import shapely

from gcs.frames import Vec3, enu_from_ned
from gcs.gate.airspace.questions.back_inside import ROOM_M, WayBack
from gcs.gate.airspace.zones import Zone
from gcs.gate.condition import Condition
from gcs.gate.effects import CommandKind, OutcomeKind, Ruling
from gcs.gate.geometry import Circle, Polygon
from gcs.gate.inputs import ConditionChanged
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code
from gcs.gate.requests import Hold, Resume, TakeControl
from gcs.gate.states import Control, FlightMode, State
from tests.unit.gate.airspace import OUTER, STILL, TOWER, around, at
from tests.unit.gate.script import Script, policy

L_SHAPE = Zone(
    "L",
    True,
    Polygon(((-60.0, -60.0), (60.0, -60.0), (60.0, 0.0), (0.0, 0.0), (0.0, 60.0), (-60.0, 60.0))),
    0.0,
    50.0,
)
STRIP = Zone(
    "strip", True, Polygon(((-90.0, -5.0), (90.0, -5.0), (90.0, 9.0), (-90.0, 9.0))), 0.0, 50.0
)
KEPT_M = DEFAULT.margin_h_m + ROOM_M
UP = 20.0


@pytest.mark.parametrize(
    ("zones", "place", "east_m", "north_m", "up_m"),
    [
        ((OUTER,), (155.0, 0.0, UP), 150.0 - KEPT_M, 0.0, UP),
        ((OUTER,), (0.0, -149.0, UP), 0.0, -150.0 + KEPT_M, UP),  # inside, nearer than may be
        ((OUTER,), (20.0, 0.0, 51.0), 20.0, 0.0, 50.0 - DEFAULT.margin_v_m - ROOM_M),
        ((L_SHAPE,), (10.0, 20.0, UP), 0.0 - KEPT_M, 20.0, UP),  # the notch: the nearer arm
        ((L_SHAPE,), (70.0, 70.0 - 80.0, UP), 60.0 - KEPT_M, -10.0, UP),
        ((OUTER, TOWER), (21.0, 0.0, 5.0), 20.0 - KEPT_M, 0.0, 5.0),  # in an exclusion zone
        ((OUTER, STRIP), (0.0, 12.0, UP), 0.0, 9.0 - KEPT_M, UP),
    ],
)
def test_to_the_nearest_place_inside(
    zones: tuple[Zone, ...], place: Vec3, east_m: float, north_m: float, up_m: float
) -> None:
    found = around(*zones).way_back(at(*place), STILL)
    assert isinstance(found, WayBack), found
    assert enu_from_ned(found.to_ned) == pytest.approx((east_m, north_m, up_m), abs=1e-6)
    assert dict(found.evidence)["way_back_m"] == pytest.approx(
        math.dist(place, (east_m, north_m, up_m)), abs=1e-6
    )


def test_past_a_corner_it_keeps_the_margin_from_both_sides() -> None:
    box = shapely.box(-60.0, -60.0, 60.0, 60.0)
    zone = Zone("box", True, Polygon(((-60, -60), (60, -60), (60, 60), (-60, 60))), 0.0, 50.0)
    for place in ((63.0, 64.0, UP), (59.5, 59.0, UP), (75.0, 61.0, UP)):
        found = around(zone).way_back(at(*place), STILL)
        assert isinstance(found, WayBack), found
        east, north, _ = enu_from_ned(found.to_ned)
        assert box.exterior.distance(shapely.Point(east, north)) >= KEPT_M - 1e-6
        assert box.contains(shapely.Point(east, north))


@pytest.mark.parametrize(
    ("zones", "place", "v_ned", "code"),
    [
        # a tower between it and the nearest place inside
        (
            (Zone("yard", True, Circle((0.0, 0.0), 50.0)),
             Zone("hut", False, Polygon(((51.0, -9.0), (55.0, -9.0), (55.0, 9.0), (51.0, 9.0))))),
            (58.0, 0.0, UP), STILL, Code.LEG_LEAVES_FENCE,
        ),
        ((OUTER,), (155.0, 0.0, UP), (0.0, 1.2, 0.0), Code.CANNOT_STOP),  # it is to be held first
        ((OUTER,), (math.nan, 0.0, UP), STILL, Code.NON_FINITE),
        # nothing inside is wide enough for the margin
        ((Zone("slit", True, Circle((0.0, 0.0), 1.5)),), (9.0, 0.0, UP), STILL, Code.TOO_CLOSE),
    ],
)  # fmt: skip
def test_where_no_way_clears_none_is_offered(
    zones: tuple[Zone, ...], place: Vec3, v_ned: Vec3, code: Code
) -> None:
    found = around(*zones).way_back(at(*place), v_ned)
    assert not isinstance(found, WayBack)
    assert found.code is code


def outside(autopilot: str = "px4") -> Script:
    """Held 5 m outside the circle of 150 m, and the station knows it."""
    script = Script(policy("default"), autopilot=autopilot).fly(UP)
    script.ask(Hold())
    script.heartbeat(FlightMode.HOLD)
    script.at(155.0, 0.0, UP)
    script.feed(ConditionChanged(Condition.FENCE_BREACHED, True))
    assert script.gate.state is State.HOLDING
    script.forget()
    return script


def moves(script: Script, east_m: float, speed_m_s: float) -> None:
    """To its next report, a tick later."""
    script.pos_ned, script.v_ned = at(east_m, 0.0, UP), at(speed_m_s, 0.0, 0.0)
    script.tick()


def test_other_requests_are_refused_and_say_so() -> None:
    script = outside()
    refused = script.verdict(script.goto(0.0, 0.0, UP)).refusal
    assert refused is not None
    assert refused.code is Code.OUTSIDE_FENCE
    assert "possible: resume (it flies back to (147.50 E, 0.00 N, 20.00 U))" in refused.sentence


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_resume_flies_it_back_slowly(autopilot: str) -> None:
    script = outside(autopilot)
    resume = script.ask(Resume())
    script.wait(1.5)
    script.heartbeat(FlightMode.GUIDED)
    assert script.outcome(resume).kind is OutcomeKind.COMPLETE
    assert (script.gate.state, script.gate.control) == (State.HOVERING, Control.OURS)
    here_m = 155.0
    while here_m > 147.5:
        here_m = max(147.5, here_m - 0.05)
        script.forget()
        moves(script, here_m, -1.0)
        if here_m < 149.5:
            script.feed(ConditionChanged(Condition.FENCE_BREACHED, False))
        [(_, (east_m, _, _))] = script.setpoints()
        assert 147.5 - 1e-4 <= east_m <= here_m + 1e-4
        assert here_m <= 150.0 or here_m - east_m < 1.5, "faster than a crawl"
        assert script.gate.state is State.HOVERING
    script.wait(1.0)
    goal = script.goto(100.0, 0.0, UP)
    script.tick()
    assert script.verdict(goal).ruling is Ruling.ACCEPTED


def test_one_that_drifts_out_on_its_way_is_held_at_once() -> None:
    script = outside()
    script.ask(Resume())
    script.wait(1.5)
    script.heartbeat(FlightMode.GUIDED)
    script.forget()
    moves(script, 155.2, 0.9)
    assert script.gate.state is State.HOLDING
    assert CommandKind.HOLD in script.commands()


def test_what_else_is_wrong_still_forbids_it() -> None:
    script = outside()
    script.feed(ConditionChanged(Condition.ESTIMATOR_UNRELIABLE, True))
    assert script.refusal(script.ask(Resume())) is Code.SEVERITY
    script.feed(ConditionChanged(Condition.ESTIMATOR_UNRELIABLE, False))
    assert script.verdict(script.ask(Resume())).ruling is Ruling.ACCEPTED


def test_it_is_the_way_out_of_the_hands_of_another_too() -> None:
    script = Script(policy("default")).fly(UP)
    script.at(155.0, 0.0, UP)
    assert script.gate.state is State.EXTERNAL
    assert script.verdict(script.ask(TakeControl())).ruling is Ruling.ACCEPTED
    script.tick()
    [(_, (east_m, _, _)), *_] = script.setpoints()
    assert 147.5 <= east_m < 155.0
