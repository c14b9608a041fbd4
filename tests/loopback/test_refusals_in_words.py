"""What a vehicle has against being armed, in the operator's answer."""

from __future__ import annotations

from msgspec import structs

from gcs.gate.condition import Condition, Severity
from gcs.gate.policy.parse import DEFAULT
from tests.loopback.flight import Flight
from vehicle_sim.simulation.fault_script import fault_of

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
