"""A fix that is lost, a vehicle that refuses to arm, a bug in the middle of a flight."""

from __future__ import annotations

from msgspec import structs

from gcs.exit_codes import ExitCode
from gcs.gate.condition import Condition, Severity
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.states import State
from gcs.session import inputs
from gcs.session.effects import Finish, Transmit
from tests.loopback.flight import Flight, Personality
from vehicle_sim.simulation.fault_script import fault_of

# ------------------------------------------------------------------------------
# A GPS that is lost in flight: the gate knows it at once, and stops what it flies.


def test_a_lost_fix_stops_the_flight_long_before_the_vehicle_s_own_failsafe(
    personality: Personality,
) -> None:
    """autopilots.md, defect 10: a go-to went on for 6 to 8 s by dead-reckoned positions."""
    flight = Flight(personality).hovering(5.0)
    goal = flight.goto(60.0, 0.0, 5.0)
    flight.run(2.0)
    assert flight.is_in(State.MOVING)
    lost = fault_of("gps_lost", {}, "script")
    assert flight.world.inject(lost, 1)
    flight.run(1.5)
    assert flight.outcome(goal) == "aborted SEVERITY"
    assert Condition.GPS_LOST in flight.conditions
    assert any(line.startswith("HOLD: gps_lost: ") for line in flight.lines("state_and_safety"))
    assert flight.done(flight.goto(1.0, 0.0, 5.0)) in ("refused SEVERITY", "refused HOLDING")


def test_on_the_ground_it_does_not_arm_until_the_fix_is_back(personality: Personality) -> None:
    flight = Flight(personality).connected()
    lost = fault_of("gps_lost", {}, "script")
    assert flight.world.inject(lost, 1)
    flight.run(1.5)
    assert flight.done(flight.say("arm")) == "refused SEVERITY"
    back = lost.ended()
    assert back is not None
    assert flight.world.inject(back, 1)
    flight.until(lambda: not flight.conditions or flight.vehicle.armable, 30.0)
    flight.until(lambda: Condition.GPS_LOST not in flight.conditions, 30.0)
    flight.run(5.0)
    flight.do("arm")


# ------------------------------------------------------------------------------
# What a vehicle has against being armed, in the operator's answer.

LENIENT = structs.replace(
    DEFAULT,
    severities={
        **DEFAULT.severities,
        Condition.GPS_LOST: Severity.CAUTION,
        Condition.ESTIMATOR_UNRELIABLE: Severity.CAUTION,
    },
)
"""The gate lets an arm through that the vehicle itself refuses."""


def test_arducopter_s_reason_is_told_though_it_comes_after_the_answer() -> None:
    flight = Flight("ardupilot", params={"BATT_FS_LOW_ACT": 2, "BATT_LOW_VOLT": 30.0})
    flight.run(6.0)
    ask = flight.say("arm")
    assert flight.done(ask) == "aborted VEHICLE_REFUSED"
    (ended,) = flight.endings(ask)
    assert ended.sentence == "the vehicle refused arming (FAILED): Battery 1 low voltage failsafe"


def test_px4_s_reason_is_told_from_its_events() -> None:
    """It says nothing in words: the health and arming report does."""
    flight = Flight("px4", policy=LENIENT).connected()
    assert flight.world.inject(fault_of("gps_lost", {}, "script"), 1)
    flight.run(10.0)
    ask = flight.say("arm")
    assert flight.done(ask) == "aborted VEHICLE_REFUSED"
    (ended,) = flight.endings(ask)
    assert ended.sentence.startswith("the vehicle refused arming (TEMPORARILY_REJECTED): ")
    assert "No valid global position estimate" in ended.sentence


# ------------------------------------------------------------------------------
# A bug in the middle of a flight: the vehicle is told to hold before the link goes.


def test_a_fault_on_the_clock_in_flight_holds_the_vehicle(personality: Personality) -> None:
    flight = Flight(personality).hovering(2.0)
    flight.goto(20.0, 0.0, 2.0)
    flight.run(1.0)
    assert flight.is_in(State.MOVING)
    fault_ns = flight.now_ns
    effects = flight.fault(inputs.Wake(), "ZeroDivisionError: a bug")
    sent = [effect.data for effect in effects if isinstance(effect, Transmit)]
    (finish,) = [effect for effect in effects if isinstance(effect, Finish)]
    assert finish.exit_code == ExitCode.BUG
    for data in sent:
        flight.up.send(data, fault_ns)
    flight.recorder = None  # a station that has ended records nothing
    flight.vehicle_silent = True  # the link is gone: nobody listens, nobody speaks
    flight.finish = None
    flight.run(0.2)
    assert flight.vehicle.mode_name in ("AUTO.LOITER", "BRAKE")
