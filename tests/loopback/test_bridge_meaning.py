"""What MAVSDK, DroneKit, MAVProxy, QGroundControl and scripts send to move a vehicle, flown through
the gate.

The sequences are those that were seen of MAVSDK 4.1.0, MAVProxy 1.8.75 and pymavlink 2.4.50, or as
a client's source has them (from memory: QGroundControl).
"""

from __future__ import annotations

import math

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from tests.loopback.bridged import (
    ACCEPTED,
    ARM,
    ARRIVES_M,
    TAKE_OFF,
    VEHICLE,
    BridgedFlight,
    Client,
    joined,
    north_of_home,
    take_off,
)
from tests.loopback.copies import fly_or_copy
from tests.loopback.flight import PERSONALITIES, Personality
from tests.loopback.plan_clients import PlanFlight, Pymavlink, mission

SET_MODE, REPOSITION, PAUSE = 176, 192, 193
MISSION_START, CONDITION_YAW = 300, 115
GUIDED = {"px4": (29.0, 6.0), "ardupilot": (1.0, 4.0)}
NAN = math.nan

both = pytest.mark.parametrize("personality", PERSONALITIES)


def flying(personality: Personality) -> tuple[PlanFlight, Client]:
    """Armed and taken off by a client, hovering at home."""
    flight = PlanFlight(personality)
    fly_or_copy(flight, (PlanFlight, personality), lambda: take_off(flight))
    return flight, flight.clients[1]


def arrives(flight: BridgedFlight, north_m: float) -> None:
    flight.until(lambda: flight.is_in(State.MOVING), 3)
    flight.until(lambda: flight.is_in(State.HOVERING), 30)
    assert flight.truth_enu()[1] == pytest.approx(north_m, abs=ARRIVES_M[flight.personality])


@both
def test_a_client_that_holds_flies_on_with_its_next_goal(personality: Personality) -> None:
    """MAVSDK's `hold`, then `goto_location`: on ArduPilot it asks for GUIDED first."""
    flight, client = flying(personality)
    hold = (129.0, 4.0, 3.0) if personality == "px4" else (129.0, 17.0, 0.0)
    assert client.ask(SET_MODE, *hold) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOLDING))
    if personality == "ardupilot":
        assert client.ask(SET_MODE, 129.0, 4.0) == ACCEPTED
    client.fly_to(*north_of_home(flight, 10, 5))
    arrives(flight, 10)
    assert [ack.result for ack in client.acks(REPOSITION)] == [ACCEPTED]


@both
def test_a_goal_that_is_refused_lifts_no_hold(personality: Personality) -> None:
    """Somebody who looks on has stopped it; the client in control clicks beyond the fence."""
    flight, client = flying(personality)
    other = flight.join(246, 190)
    flight.run(1.5)
    assert other.ask(PAUSE, 0) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOLDING))
    client.fly_to(*north_of_home(flight, 400, 5))
    flight.beating(3.0)
    assert [ack.result for ack in client.acks(REPOSITION)] == [dialect.MAV_RESULT_DENIED]
    assert "OUTSIDE_FENCE" in client.texts() or "TOO_FAR" in client.texts()
    assert flight.is_in(State.HOLDING)
    client.fly_to(*north_of_home(flight, 10, 5))
    arrives(flight, 10)


@both
def test_guided_takes_it_out_of_a_hold(personality: Personality) -> None:
    flight, client = flying(personality)
    assert client.ask(PAUSE, 0) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOLDING))
    guided = (29.0, 6.0) if personality == "px4" else (1.0, 4.0)
    assert client.ask(SET_MODE, *guided, within_s=10) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOVERING))


@both
def test_a_mission_that_was_held_goes_on_from_its_first_item(personality: Personality) -> None:
    """Pause and continue: the client reads that it begins anew."""
    flight, client = flying(personality)
    places = ((20.0, 0.0, 10.0), (20.0, 20.0, 10.0), (0.0, 20.0, 10.0))
    assert Pymavlink(flight, client, mission(personality, *places)).ended() == "complete"
    assert client.ask(MISSION_START, within_s=20) == ACCEPTED
    telemetry = flight.session.telemetry
    assert telemetry is not None
    second = 2 if personality == "px4" else 3
    while (telemetry.mission_seq or 0) <= second:
        flight.beating(1.0)
    assert client.ask(PAUSE, 0) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOLDING), 3)
    assert client.ask(PAUSE, 1, within_s=20) == ACCEPTED
    flight.until(lambda: flight.is_in(State.FLYING_MISSION), 3)
    flight.run(1.5)
    assert telemetry.mission_seq is not None
    assert telemetry.mission_seq < second
    assert "begins anew" in client.texts()
    assert client.ask(PAUSE, 0) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOLDING), 3)
    assert client.ask(SET_MODE, *GUIDED[personality], within_s=10) == ACCEPTED
    client.fly_to(*north_of_home(flight, 10, 8))
    flight.until(lambda: flight.is_in(State.MOVING), 3)
    assert client.ask(PAUSE, 0) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOLDING), 3)
    assert client.ask(PAUSE, 1, within_s=10) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOVERING), 3)


@both
def test_a_heading_that_is_flown_already_asks_for_nothing(personality: Personality) -> None:
    """PX4: DO_REPOSITION with a heading, twice; ArduPilot: CONDITION_YAW."""
    flight, client = flying(personality)
    for _ in range(2):
        if personality == "px4":
            lat, lon, alt = north_of_home(flight, 20)
            client.fly_to(lat, lon, alt + 5, yaw_rad=1.0)
        else:
            client.command(CONDITION_YAW, 90.0, 0.0, 0.0, 0.0)
        flight.run(2.5)
    assert [one.word for one in flight.decisions("accepted")].count("goto") == 1
    assert not flight.decisions("refused")


@both
def test_a_second_hold_within_two_seconds_is_a_hold(personality: Personality) -> None:
    """It was let go on between."""
    flight, client = flying(personality)
    assert client.ask(PAUSE, 0) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOLDING))
    assert client.ask(PAUSE, 1, within_s=10) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOVERING))
    client.command(PAUSE, 0)
    flight.until(lambda: flight.is_in(State.HOLDING), 3)


@both
def test_a_client_who_is_not_in_control_does_not_stop_a_return(personality: Personality) -> None:
    """It asks for OFFBOARD or GUIDED, which is a hold and more."""
    flight, client = flying(personality)
    assert client.ask(20) == ACCEPTED
    flight.until(lambda: flight.is_in(State.RETURNING), 3)
    other = flight.join(255, 190)
    guided = (29.0, 6.0) if personality == "px4" else (1.0, 4.0)
    other.ask(SET_MODE, *guided)
    flight.run(0.2)
    assert "OTHER_OPERATOR" in other.texts()
    assert flight.state in (State.RETURNING, State.LANDING)
    assert client.ask(SET_MODE, *guided, within_s=10) == ACCEPTED, "the one in control may"
    flight.until(lambda: flight.is_in(State.HOVERING), 10)


@both
def test_speeds_up_to_the_vehicles_own(personality: Personality) -> None:
    """MAVSDK's `set_current_speed`: 1, 2 m/s, -1."""
    flight, client = flying(personality)
    assert client.ask(178, 1.0, 2.0, -1.0) == ACCEPTED
    assert len([frame for frame in flight.to_vehicle("COMMAND_LONG") if frame.sysid == 245]) == 1


def velocity(v_ned: tuple[float, float, float], frame: int = 1) -> object:
    """SET_POSITION_TARGET_LOCAL_NED with MAVSDK's masks: 0x9c7 with a yaw, 0x5c7 with a yaw rate in
    the body frame."""
    mask = 0x9C7 if frame == 1 else 0x5C7
    return dialect.MAVLink_set_position_target_local_ned_message(
        0, *VEHICLE, frame, mask, 0, 0, 0, *v_ned, 0, 0, 0, 0, 0
    )


@both
@pytest.mark.parametrize("frame", [1, 8])
def test_mavsdks_offboard_velocity(personality: Personality, frame: int) -> None:
    """20 Hz of it, then OFFBOARD or GUIDED, which it is in already."""
    flight, client = flying(personality)
    before = flight.truth_enu()
    for _ in range(60):
        client.send(velocity((1.0, 0.0, 0.0), frame))
        flight.run(0.05)
    assert flight.state is State.STREAMING
    guided = (129.0, 6.0) if personality == "px4" else (129.0, 4.0)
    assert client.ask(SET_MODE, *guided, within_s=1) == ACCEPTED
    moved = math.dist(flight.truth_enu()[:2], before[:2])
    assert 1.0 < moved < 4.0
    assert client.ask(PAUSE, 0) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOLDING), 5)


# ------------------------------------------------------------------------------- ArduPilot


def test_dronekits_simple_goto() -> None:
    """MISSION_ITEM with `current` 2, above home."""
    flight, client = flying("ardupilot")
    lat, lon, _ = north_of_home(flight, 10)
    client.send(
        dialect.MAVLink_mission_item_message(*VEHICLE, 0, 3, 16, 2, 0, 0, 0, 0, 0, lat, lon, 6.0)
    )
    arrives(flight, 10)
    assert flight.truth_enu()[2] == pytest.approx(6, abs=0.7)
    assert [ack.type for ack in client.messages("MISSION_ACK")] == [ACCEPTED]


@pytest.mark.parametrize("form", ["mission item", "position", "reposition"])
def test_dronekits_simple_goto_at_95_percent_of_its_take_off(form: str) -> None:
    """Its scripts take off and wait for 95 % of the height; then they send a goal once."""
    flight, client = joined(
        PlanFlight("ardupilot", policy=parse_policy('retarget = "replace"', "clients.toml"))
    )
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    assert client.ask(TAKE_OFF, 0, 0, 0, 0, 0, 0, 10.0) == ACCEPTED
    flight.until(lambda: flight.truth_enu()[2] > 9.5, 30)
    assert flight.is_in(State.TAKING_OFF)
    lat, lon, alt = north_of_home(flight, 10)
    if form == "mission item":
        client.send(
            dialect.MAVLink_mission_item_message(
                *VEHICLE, 0, 3, 16, 2, 0, 0, 0, 0, 0, lat, lon, 10.0
            )
        )
    elif form == "position":
        client.send(
            dialect.MAVLink_set_position_target_local_ned_message(
                0, *VEHICLE, 1, 0xDF8, 10.0, 0.0, -10.0, 0, 0, 0, 0, 0, 0, 0, 0
            )
        )
    else:
        client.fly_to(lat, lon, alt + 10)
    arrives(flight, 10)
    assert flight.truth_enu()[2] == pytest.approx(10, abs=0.7)
    assert [one.word for one in flight.decisions("refused")] == []


@pytest.mark.parametrize("times", [1, 3, 40])
def test_a_position_target_is_flown_to_its_end_however_often_it_is_sent(times: int) -> None:
    """A script sends it once, three times to be sure, or ten times a second for a while (pymavlink,
    type_mask 0xdf8); ArduPilot flies on to it all the same."""
    flight, client = flying("ardupilot")
    message = dialect.MAVLink_set_position_target_local_ned_message(
        0, *VEHICLE, 1, 0xDF8, 12.0, 0.0, -6.0, 0, 0, 0, 0, 0, 0, 0, 0
    )
    for _ in range(times):
        client.send(message)
        flight.run(0.1)
    flight.until(lambda: flight.is_in(State.HOVERING), 30)
    assert flight.truth_enu()[1] == pytest.approx(12, abs=1.0)
    assert [one.word for one in flight.decisions("accepted")].count("goto") == 1


def test_a_position_that_moves_is_a_stream() -> None:
    """MAVROS's setpoint_position along a line, 20 Hz."""
    flight, client = flying("ardupilot")
    for step in range(80):
        client.send(
            dialect.MAVLink_set_position_target_local_ned_message(
                0, *VEHICLE, 1, 0xDF8, 0.05 * step, 0.0, -5.0, 0, 0, 0, 0, 0, 0, 0, 0
            )
        )
        flight.run(0.05)
    assert flight.state is State.STREAMING
    assert flight.truth_enu()[1] > 2.0


def test_qgroundcontrols_change_of_height() -> None:
    """SET_POSITION_TARGET_LOCAL_NED in LOCAL_OFFSET_NED, type_mask 0xFFF8 (from memory)."""
    flight, client = flying("ardupilot")
    up_m = flight.truth_enu()[2]
    client.send(
        dialect.MAVLink_set_position_target_local_ned_message(
            0, *VEHICLE, 7, 0xFFF8, 0, 0, -3.0, 0, 0, 0, 0, 0, 0, 0, 0
        )
    )
    flight.until(lambda: flight.is_in(State.MOVING), 3)
    flight.until(lambda: flight.is_in(State.HOVERING), 30)
    assert flight.truth_enu()[2] == pytest.approx(up_m + 3, abs=0.7)


def test_loiter_is_held_in_brake_and_the_client_reads_why() -> None:
    flight, client = flying("ardupilot")
    assert client.ask(SET_MODE, 1.0, 5.0) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOLDING))
    assert "held in BRAKE instead" in client.texts()


# ------------------------------------------------------------------------------------- PX4


def test_qgroundcontrols_pause() -> None:
    """DO_REPOSITION with nothing but the flag to change the mode (from memory)."""
    flight, client = flying("px4")
    client.fly_to(*north_of_home(flight, 40, 5))
    flight.until(lambda: flight.is_in(State.MOVING), 3)
    assert client.ask(REPOSITION, -1.0, 1.0, 0.0, NAN, NAN, NAN, NAN) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOLDING), 3)
    assert flight.truth_enu()[1] < 30


def test_a_mission_mode_that_was_refused_before_arming_is_not_flown_after_it() -> None:
    """QGroundControl (from memory) asks a PX4 for the mission mode, and arms then: nothing is kept,
    and the client reads what to do.  The take-off is kept: see `test_takeoff_then_arm.py`."""
    flight, client = joined(BridgedFlight("px4"))
    mission_mode = client.ask(SET_MODE, 29.0, 4.0, 4.0, within_s=10)
    assert mission_mode == dialect.MAV_RESULT_TEMPORARILY_REJECTED
    assert "arm it first" in client.texts()
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    flight.beating(5.0)
    assert flight.is_in(State.GROUNDED)
    assert client.ask(TAKE_OFF, 0, 0, 0, NAN, NAN, NAN, NAN) == ACCEPTED


def test_mavsdks_take_off_height() -> None:
    """PARAM_SET MIS_TAKEOFF_ALT, then a take-off without a height (seen of MAVSDK 4.1.0)."""
    flight, client = joined(BridgedFlight("px4"))
    client.send(dialect.MAVLink_param_set_message(*VEHICLE, b"MIS_TAKEOFF_ALT", 4.0, 9))
    flight.run(0.5)
    assert client.ask(ARM, 1, *[NAN] * 6, within_s=10) == ACCEPTED
    assert client.ask(TAKE_OFF, *[NAN] * 7) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOVERING), 30)
    assert flight.truth_enu()[2] == pytest.approx(4, abs=0.7)
