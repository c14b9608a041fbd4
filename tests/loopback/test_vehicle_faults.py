"""The vehicle fails, not the link's bytes: what the ground station sees of it, and what it does.

The gate's promises are watched all the while (`watched.py`); the truth is the vehicle's own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from msgspec import structs

from gcs import ipc
from gcs.gate.condition import Condition, Severity
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Policy
from gcs.gate.states import Control, State
from tests.loopback.checked_flight import CheckedFlight
from tests.loopback.flight import Personality
from vehicle_sim.plant.sensors import SensorGrade
from vehicle_sim.simulation.fault_script import AnyFault, fault_of

ORIGIN = 49  # GPS_GLOBAL_ORIGIN
REQUEST_MESSAGE = 512


@contextmanager
def under_way(
    personality: Personality,
    seed: int = 1,
    params: dict[str, float] | None = None,
    policy: Policy = DEFAULT,
) -> Iterator[tuple[CheckedFlight, int]]:
    """On its way to a goal twelve metres to the east; the number of that request."""
    flight = CheckedFlight(personality, seed=seed, params=params, policy=policy)
    with flight.witness.listening(flight.policy):
        flight.hovering(6.0)
        flight.run(5.0)
        goal = flight.goto(12.0, 0.0, 6.0)
        flight.run(1.0)
        assert flight.is_in(State.MOVING)
        yield flight, goal


def strike(flight: CheckedFlight, kind: str, **keys: object) -> AnyFault:
    fault = fault_of(kind, keys, "script")
    assert flight.world.inject(fault, 1)
    return fault


def mend(flight: CheckedFlight, fault: AnyFault) -> None:
    end = fault.ended()
    assert end is not None
    assert flight.world.inject(end, 1)


def severities(flight: CheckedFlight, since_ns: int) -> set[str]:
    return {
        event.severity
        for event, time_ns in zip(flight.events, flight.event_times_ns, strict=True)
        if isinstance(event, ipc.StateEvent) and time_ns >= since_ns
    }


@pytest.mark.parametrize("seed", [1, 3, 5])
def test_gps_lost_is_the_vehicles_landing_and_the_station_lets_it(
    personality: Personality, seed: int
) -> None:
    """Where it drifts without GPS is chance: 4 to 12 m by the seed, and by when it was lost.

    Nothing corrects the accelerometer's bias any more: of three standard deviations, integrated
    twice until it stands, it is what a sound estimator drifts at most.
    """
    with under_way(personality, seed) as (flight, goal):
        at_enu = flight.truth_enu()
        strike(flight, "gps_lost")
        struck_ns = flight.now_ns
        flight.run(7.0)
        assert flight.is_in(State.LANDING)
        assert flight.session.gate.control is Control.NONE
        assert Condition.VEHICLE_FAILSAFE_ACTIVE in flight.conditions
        assert flight.session.gate.severity >= Severity.CAUTION
        assert flight.outcome(goal) == "aborted SEVERITY"
        assert Condition.GPS_LOST in flight.conditions
        since_ns = flight.now_ns
        flight.until(lambda: flight.is_in(State.GROUNDED), 60.0)
        assert flight.setpoints(since_ns) == [], "nobody steers a vehicle that steers itself"
        east_m, north_m, up_m = flight.truth_enu()
        blind_s = (flight.now_ns - struck_ns) / 1e9
        most_m = 0.5 * 3.0 * SensorGrade().accel_bias_m_s2 * blind_s**2
        assert math.hypot(east_m - at_enu[0], north_m - at_enu[1]) < most_m
        assert blind_s < 25.0, "down from 6 m without hovering about"
        assert up_m < 0.1


def test_a_large_glitch_is_a_hold_before_the_position_jumps() -> None:
    """ArduCopter's estimator says that it does not believe its GPS; 4.5 to 6 s later it does."""
    with under_way("ardupilot") as (flight, goal):
        assert flight.done(goal) == "complete"
        at_enu = flight.truth_enu()
        strike(flight, "gps_glitch", offset_ned_m=[60, 0, 0])
        flight.run(2.0)
        assert flight.is_in(State.HOLDING)
        assert Condition.ESTIMATOR_UNRELIABLE in flight.conditions
        assert flight.vehicle.mode_name == "BRAKE"
        assert math.dist(flight.truth_enu(), at_enu) < 2.0


def test_a_large_glitch_is_an_estimator_reset_and_a_hold() -> None:
    """Where the policy lets the estimator's own doubt pass, the jump of the position is a hold."""
    severities = {**DEFAULT.severities, Condition.ESTIMATOR_UNRELIABLE: Severity.CAUTION}
    lenient = structs.replace(DEFAULT, severities=severities)
    with under_way("ardupilot", policy=lenient) as (flight, goal):
        assert flight.done(goal) == "complete"
        at_enu = flight.truth_enu()
        struck_ns = flight.now_ns
        strike(flight, "gps_glitch", offset_ned_m=[60, 0, 0])
        flight.until(lambda: flight.is_in(State.HOLDING), 7.0)
        assert 4.5 < (flight.now_ns - struck_ns) / 1e9 < 6.0
        jumped_ns = flight.now_ns
        flight.run(10.0)
        assert flight.vehicle.mode_name == "BRAKE"
        held = {setpoint.pos_ned for setpoint in flight.setpoints(jumped_ns)}
        assert len(held) == 1, "one place to hold, on the new map"
        assert math.dist(flight.truth_enu(), at_enu) < 2.0, "a goal on the old map is not flown"


def test_px4s_own_failsafe_comes_before_the_reset() -> None:
    with under_way("px4") as (flight, goal):
        assert flight.done(goal) == "complete"
        at_enu = flight.truth_enu()
        strike(flight, "gps_glitch", offset_ned_m=[60, 0, 0])
        flight.run(12.0)
        assert "LANDING" in flight.states()
        assert flight.is_in(State.EXTERNAL)
        assert flight.session.gate.control is Control.NONE
        # Without sticks PX4 comes down; what counts is that it does not follow the jump.
        assert math.dist(flight.truth_enu()[:2], at_enu[:2]) < 5.0


@pytest.mark.parametrize("by_s", [7.0, -4.0])
def test_a_clock_that_jumps_is_a_hold_and_the_origin_is_asked_for_again(
    personality: Personality, by_s: float
) -> None:
    with under_way(personality) as (flight, goal):
        since_ns = flight.now_ns
        fault = strike(flight, "clock_jump", by_s=by_s)
        flight.run(3.0)
        assert flight.outcome(goal) == "aborted ESTIMATOR_RESET"
        assert flight.is_in(State.HOLDING)
        mend(flight, fault)
        flight.run(4.0)
        assert flight.is_in(State.HOLDING)
        # Only a clock that goes back looks like another boot, after which nothing is known.
        asked = flight.sent_commands(REQUEST_MESSAGE, since_ns)
        assert any(b"\x00\x00\x44\x42" in sent.data for sent in asked), "REQUEST_MESSAGE 49"
        assert Condition.ORIGIN_MISSING not in flight.conditions
        assert flight.done(flight.say("resume")) == "complete"
        assert flight.done(flight.goto(3.0, 0.0, 6.0)) == "complete"


def test_a_reboot_in_flight_is_the_end_of_the_flight_and_it_can_fly_again(
    personality: Personality,
) -> None:
    with under_way(personality) as (flight, goal):
        strike(flight, "reboot")
        flight.run(0.5)
        assert flight.outcome(goal) == "taken over NOT_ARMED"
        assert flight.is_in(State.GROUNDED)
        since_ns = flight.now_ns
        flight.run(6.0)
        assert flight.setpoints(since_ns) == []
        assert flight.truth_enu()[2] < 0.1
        assert Condition.ORIGIN_MISSING not in flight.conditions, "asked for again, and told"
        # It moved when it fell, and lies on its back; a second start sets it on its feet.
        strike(flight, "reboot")
        flight.run(4.0)
        flight.until(lambda: flight.vehicle.armable)
        flight.do("arm")
        flight.do("takeoff", up_m=3.0)
        assert flight.is_in(State.HOVERING)


def test_a_link_that_is_out_is_stale_then_no_vehicle_then_somebody_elses(
    personality: Personality,
) -> None:
    # As delivered PX4 would come down meanwhile, and be too low to be taken over.
    holds = {"COM_OBL_RC_ACT": 5.0} if personality == "px4" else None
    with under_way(personality, params=holds) as (flight, goal):
        fault = strike(flight, "link", out=True)
        flight.run(1.3)
        assert flight.is_in(State.STALE)
        flight.run(0.7)
        assert flight.outcome(goal) == "aborted STALE"
        flight.run(4.0)
        assert flight.is_in(State.NO_VEHICLE)
        since_ns = flight.now_ns
        mend(flight, fault)
        flight.run(3.0)
        assert flight.is_in(State.EXTERNAL)
        assert flight.setpoints(since_ns) == [], "nothing moves until somebody asks for it"
        assert flight.done(flight.say("control")) == "complete"
        assert flight.is_in(State.HOVERING)


def test_a_link_that_loses_delays_and_doubles_brings_it_to_its_goals(
    personality: Personality,
) -> None:
    with under_way(personality) as (flight, goal):
        strike(flight, "link", loss=0.1, duplicate=0.2, reorder=0.1, delay_s=0.03, jitter_s=0.05)
        assert flight.done(goal) == "complete"
        assert flight.done(flight.goto(0.0, 5.0, 5.0)) == "complete"
        assert flight.done(flight.say("land"), 60.0) == "complete"
        flight.all_answered()


def test_a_dead_motor_is_held_against_and_ends_on_the_ground(personality: Personality) -> None:
    with under_way(personality) as (flight, goal):
        strike(flight, "motor", motor=2)
        flight.run(10.0)
        assert (flight.outcome(goal) or "").startswith("aborted")
        assert flight.truth_enu()[2] < 0.5
        # Then a PX4's own failsafe may take over, if it falls over far enough.
        assert State.HOLDING.name in flight.states()
        assert personality == "px4" or flight.is_in(State.GROUNDED)


def test_a_lost_cell_sends_it_home_by_the_stations_own_severity() -> None:
    """PX4 is set to tell only (COM_LOW_BAT_ACT 0); the policy does not leave it at that."""
    with under_way("px4") as (flight, goal):
        flight.vehicle.parameters.set("COM_LOW_BAT_ACT", 0)
        since_ns = flight.now_ns
        strike(flight, "battery", cells=1)
        flight.run(1.0)
        assert Condition.BATTERY_CRITICAL in flight.conditions
        assert "RETURN" in severities(flight, since_ns)
        assert flight.outcome(goal) == "aborted SEVERITY"
        flight.until(lambda: flight.is_in(State.GROUNDED), 90.0)
        east_m, north_m, _ = flight.truth_enu()
        assert math.hypot(east_m, north_m) < 2.0


def test_wind_and_a_wrong_compass_do_not_cost_the_goal(personality: Personality) -> None:
    with under_way(personality) as (flight, goal):
        strike(flight, "wind", wind_ned_m_s=[6, -4, 0], gust_m_s=1.0)
        strike(flight, "mag", offset_gauss=[0, 0.04, 0])
        assert flight.done(goal) == "complete"
        assert math.dist(flight.truth_enu(), (12.0, 0.0, 6.0)) < 2.0
        assert flight.done(flight.say("land"), 60.0) == "complete"
