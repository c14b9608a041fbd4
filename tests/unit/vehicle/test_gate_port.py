"""Between session and gate: what the gate is asked, what becomes of its answer, and its fence."""

from __future__ import annotations

from typing import TypeVar

import pytest
from msgspec import structs

from gcs.frames import Vec3
from gcs.gate import inputs
from gcs.gate.condition import Condition
from gcs.gate.effects import Level, Ruling, Say, SwitchedFence, Transition, Verdict
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.zonespec import CircleSpec
from gcs.gate.requests import GoTo, Land
from gcs.gate.states import FlightMode, LandedState, State
from gcs.protocol.autopilot import ARDUPILOT
from gcs.session.work import (
    GATE_ANSWERED,
    CheckStart,
    GateInput,
    GiveVerdict,
    Log,
    PlaceFence,
    Work,
    condition,
)
from gcs.vehicle.gate_port import GatePort
from gcs.vehicle.talk.telemetry import Telemetry
from tests.unit.station import told
from tests.unit.station.vehicles import HOME, SECOND_NS, vehicle

W = TypeVar("W")
LOCAL = structs.replace(
    DEFAULT, fence=(CircleSpec(name="here", radius_m=20.0, frame="local", ceiling_up_m=30.0),)
)


def of(kind: type[W], work: list[Work]) -> list[W]:
    return [item for item in work if isinstance(item, kind)]


def grounded(port: GatePort, telemetry: Telemetry, now_ns: int = SECOND_NS) -> None:
    """Met, and standing on the ground at the local origin."""
    port.meet(telemetry, now_ns)
    for given in (
        inputs.HeartbeatSeen(False, FlightMode.HOLD, "AUTO.LOITER"),
        inputs.LandedSeen(LandedState.ON_GROUND),
        inputs.PositionSeen((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1000),
    ):
        port.handle(given, now_ns)
    assert port.gate.state is State.GROUNDED


# ------------------------------------------------------------------------------- the gate


def test_before_a_vehicle_is_heard_everything_is_refused() -> None:
    port = GatePort(DEFAULT, 0)
    assert port.gate.state is State.NO_VEHICLE
    work = port.handle(inputs.Requested(1, "operator", Land()), 0)
    (verdict,) = of(Verdict, work)
    assert verdict.ruling is Ruling.REFUSED


def test_the_gate_s_answer_is_whole_before_anything_that_the_session_adds() -> None:
    port = GatePort(DEFAULT, 0)
    port.meet(vehicle(), 0)
    work = port.handle(inputs.HomeSeen((0.0, 0.0, 0.0)), SECOND_NS)
    assert work[-2:] == [GATE_ANSWERED, PlaceFence()]
    for given in (inputs.Tick(0), inputs.LandedSeen(LandedState.ON_GROUND)):
        assert port.handle(given, SECOND_NS)[-1] == GATE_ANSWERED


@pytest.mark.parametrize(
    ("name", "kept"),
    [(Condition.VEHICLE_FAILSAFE_WEAK, "a fence is off"), (Condition.GPS_POOR, "all is off")],
)
def test_what_is_weak_in_the_vehicle_is_told_anew_when_it_is_something_else(
    name: Condition, kept: str
) -> None:
    port = GatePort(DEFAULT, 0)
    for text in ("all is off", "a fence is off", "a fence is off"):
        port.handle(inputs.ConditionChanged(name, True, text), 0)
    assert dict(port.gate.reasons) == {name: kept}
    assert not of(Say, port.handle(inputs.ConditionChanged(name, True, kept), 0)), "no news"


def test_a_new_vehicle_has_a_new_gate_and_what_was_wrong_still_is() -> None:
    port = GatePort(DEFAULT, 0)
    port.handle(inputs.ConditionChanged(Condition.RECORDER_FAILED, True, "disk full"), 0)
    work = port.meet(vehicle(ARDUPILOT), SECOND_NS)
    assert work == [
        GateInput(inputs.ClimbEndSeen(0.0)),
        condition(Condition.RECORDER_FAILED, True, "disk full"),
    ]
    assert port.gate.memory.autopilot == "ardupilot"
    assert list(port.gate.conditions) == []
    for item in of(GateInput, work):
        port.handle(item.given, SECOND_NS)
    assert list(port.gate.conditions) == [Condition.RECORDER_FAILED]


def test_a_condition_reaches_the_gate_when_it_changes_and_only_then() -> None:
    port = GatePort(DEFAULT, 0)
    low = inputs.ConditionChanged(Condition.BATTERY_LOW, True, "14 % are left")
    over = inputs.ConditionChanged(Condition.BATTERY_LOW, False, "")
    assert port.handle(over, 0) == [GATE_ANSWERED]
    assert len(port.handle(low, 0)) > 1
    assert port.handle(low, 0) == [GATE_ANSWERED]
    port.handle(over, 0)
    assert list(port.gate.conditions) == []


def test_a_goal_s_verdict_carries_the_goal_and_the_numbers() -> None:
    request = GoTo((1.0, 2.0, -3.0))
    verdict = Verdict(7, "operator", request, Ruling.ACCEPTED, None, None, (("m", 1.5),))
    (decide,) = GatePort(DEFAULT, 0).tell(verdict, 1)
    assert decide == GiveVerdict(7, Ruling.ACCEPTED, None, (("m", 1.5),), (1.0, 2.0, -3.0))


def test_another_request_s_verdict_has_no_goal() -> None:
    verdict = Verdict(7, "operator", Land(), Ruling.ACCEPTED, None, (9.0, 9.0, -9.0))
    (decide,) = GatePort(DEFAULT, 0).tell(verdict, 1)
    assert isinstance(decide, GiveVerdict)
    assert decide.goal_ned is None


def test_what_the_gate_says_is_a_line_and_its_transition_is_told() -> None:
    port = GatePort(DEFAULT, 0)
    (line,) = port.tell(Say(Level.WARNING, "words"), 1)
    assert isinstance(line, Log)
    assert (line.level, line.text) == (Level.WARNING, "words")
    gate = port.gate
    moved = Transition(State.GROUNDED, State.HOLDING, "abort", gate.control, gate.severity)
    work = port.tell(moved, 1)
    assert told.states(work) == ["HOLDING"]


# ------------------------------------------------------------------------------ the fence


def placed(port: GatePort, telemetry: Telemetry | None) -> inputs.VerifierChanged:
    """The verifier that the gate is handed."""
    work = port.place_fence(telemetry)
    (changed,) = [item.given for item in of(GateInput, work)]
    assert isinstance(changed, inputs.VerifierChanged)
    return changed


def test_without_a_vehicle_there_is_no_place_for_a_fence() -> None:
    assert GatePort(DEFAULT, 0).place_fence(None) == []


def test_a_fence_around_home_stands_once_home_is_known() -> None:
    port, telemetry = GatePort(DEFAULT, 0), vehicle()
    assert placed(port, telemetry).verifier.zones == ()
    telemetry.home_ned = (10.0, 20.0, -2.0)
    (zone,) = placed(port, telemetry).verifier.zones
    assert zone.inclusion
    assert zone.shape.centre_en == (20.0, 10.0)  # type: ignore[union-attr]
    assert zone.shape.radius_m == 150.0  # type: ignore[union-attr]
    assert (zone.floor_up_m, zone.ceiling_up_m) == (2.0, 52.0)


def test_the_fence_is_shown_and_recorded_wherever_it_is_placed() -> None:
    port, telemetry = GatePort(DEFAULT, 0), vehicle()
    telemetry.home_ned, telemetry.origin = (0.0, 0.0, 0.0), HOME
    kinds = [type(item).__name__ for item in port.place_fence(telemetry)]
    assert sorted(kinds) == ["GateInput", "Record", "Record", "ToScreens"]
    assert placed(port, telemetry).verifier.autopilot == "px4"


def test_a_fence_that_was_switched_off_stays_off_until_it_is_switched_on() -> None:
    port, telemetry = GatePort(DEFAULT, 0), vehicle()
    assert placed(port, telemetry).verifier.fence_on
    assert port.tell(SwitchedFence(False), 1) == [PlaceFence()]
    assert not placed(port, telemetry).verifier.fence_on
    assert not placed(port, telemetry).verifier.fence_on
    port.tell(SwitchedFence(True), 1)
    assert placed(port, telemetry).verifier.fence_on


def test_after_an_estimator_reset_the_fence_is_placed_anew() -> None:
    port, telemetry = GatePort(DEFAULT, 0), vehicle()
    port.meet(telemetry, 0)
    jumped = inputs.PositionSeen((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1, reset=True)
    assert PlaceFence() in port.handle(jumped, SECOND_NS)
    steady = inputs.PositionSeen((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 2)
    assert PlaceFence() not in port.handle(steady, SECOND_NS)


# ------------------------------------------------------------------------------ the start


@pytest.mark.parametrize(("pos_ned", "bad"), [((0.0, 19.0, 0.0), False), ((0.0, 21.0, 0.0), True)])
def test_a_vehicle_that_stands_outside_of_the_fence_is_a_bad_start(
    pos_ned: Vec3, bad: bool
) -> None:
    port, telemetry = GatePort(LOCAL, 0), vehicle()
    grounded(port, telemetry)
    port.place_fence(telemetry)
    port.check_start(CheckStart(pos_ned))
    assert (port.bad_start is not None) is bad


def test_the_margin_is_for_goals_and_not_for_where_a_vehicle_stands() -> None:
    port, telemetry = GatePort(LOCAL, 0), vehicle()
    grounded(port, telemetry)
    port.place_fence(telemetry)
    port.check_start(CheckStart((0.0, 19.9, 0.0)))
    assert LOCAL.margin_h_m == 2.0
    assert port.bad_start is None


def test_the_start_is_looked_at_once() -> None:
    port, telemetry = GatePort(LOCAL, 0), vehicle()
    grounded(port, telemetry)
    port.place_fence(telemetry)
    port.check_start(CheckStart((0.0, 0.0, 0.0)))
    port.check_start(CheckStart((0.0, 90.0, 0.0)))
    assert port.bad_start is None
    seen = inputs.PositionSeen((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 2000)
    assert of(CheckStart, port.handle(seen, SECOND_NS)) == []


def test_until_the_fence_stands_the_start_is_looked_at_again() -> None:
    port, telemetry = GatePort(DEFAULT, 0), vehicle()
    grounded(port, telemetry)
    port.place_fence(telemetry)
    port.check_start(CheckStart((0.0, 900.0, 0.0)))
    assert port.bad_start is None
    telemetry.home_ned = (0.0, 0.0, 0.0)
    port.place_fence(telemetry)
    port.check_start(CheckStart((0.0, 900.0, 0.0)))
    assert port.bad_start is not None


def test_in_the_air_there_is_no_start() -> None:
    port, telemetry = GatePort(LOCAL, 0), vehicle()
    grounded(port, telemetry)
    port.place_fence(telemetry)
    port.handle(inputs.HeartbeatSeen(True, FlightMode.OTHER, "POSCTL"), SECOND_NS)
    port.handle(inputs.LandedSeen(LandedState.IN_AIR), SECOND_NS)
    assert port.gate.state is State.EXTERNAL
    port.check_start(CheckStart((0.0, 90.0, 0.0)))
    assert port.bad_start is None


# ------------------------------------------------------------------- outside of the fence


def breached(port: GatePort, east_m: float) -> bool | None:
    """What a position there tells the gate: outside, inside again, or nothing new."""
    seen = inputs.PositionSeen((0.0, east_m, -5.0), (0.0, 0.0, 0.0), 2000)
    told_now: bool | None = None
    for item in of(GateInput, port.handle(seen, 2 * SECOND_NS)):
        changed = item.given
        if isinstance(changed, inputs.ConditionChanged):
            assert changed.condition is Condition.FENCE_BREACHED
            told_now = changed.active
            port.handle(changed, 2 * SECOND_NS)
    return told_now


def flying_port() -> GatePort:
    port, telemetry = GatePort(LOCAL, 0), vehicle()
    grounded(port, telemetry)
    telemetry.home_ned = (0.0, 0.0, 0.0)
    for item in of(GateInput, port.place_fence(telemetry)):
        port.handle(item.given, SECOND_NS)
    return port


def test_a_vehicle_that_flies_outside_is_a_condition_until_it_is_inside() -> None:
    port = flying_port()
    port.handle(inputs.HeartbeatSeen(True, FlightMode.HOLD, "AUTO.LOITER"), SECOND_NS)
    port.handle(inputs.LandedSeen(LandedState.IN_AIR), SECOND_NS)
    assert breached(port, 19.0) is None
    assert breached(port, 20.3) is None, "the position may be wrong by half a metre"
    assert breached(port, 20.6) is True
    assert Condition.FENCE_BREACHED in port.gate.conditions
    assert breached(port, 25.0) is None
    assert breached(port, 20.3) is None, "not inside for certain"
    assert breached(port, 19.9) is False
    assert list(port.gate.conditions) == []


def test_a_vehicle_that_stands_outside_does_not_fly_there() -> None:
    port = flying_port()
    assert breached(port, 30.0) is None


def test_a_vehicle_that_lands_outside_flies_there_no_longer() -> None:
    port = flying_port()
    port.handle(inputs.HeartbeatSeen(True, FlightMode.LAND, "AUTO.LAND"), SECOND_NS)
    port.handle(inputs.LandedSeen(LandedState.IN_AIR), SECOND_NS)
    assert breached(port, 30.0) is True
    port.handle(inputs.LandedSeen(LandedState.ON_GROUND), SECOND_NS)
    port.handle(inputs.HeartbeatSeen(False, FlightMode.LAND, "AUTO.LAND"), SECOND_NS)
    assert port.gate.state is State.GROUNDED
    assert breached(port, 30.0) is False
