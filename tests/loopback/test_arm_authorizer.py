"""A PX4 that asks before it arms, and a station that answers: whoever wants it armed.

Source of what the vehicle does: PX4's ArmAuthorization.cpp, as vehicle-sim plays it.
"""

from __future__ import annotations

import struct

from pymavlink.dialects.v20 import all as dialect

from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.gate.policy.policy import Policy
from gcs.gate.states import State
from gcs.session import inputs
from tests.loopback import pymavlink_decoder
from tests.loopback.bridged import BridgedFlight
from tests.loopback.flight import MISSIONS, Flight
from tests.loopback.stranger import stranger, stranger_fences, stranger_uploads
from vehicle_sim.autopilot.firmware import Firmware

ARM, AUTHORIZATION = 400, 3001
ACCEPTED, DENIED = 0, 2
GUARDED = {
    "COM_ARM_AUTH_REQ": 1.0,
    "COM_ARM_AUTH_ID": 255.0,
    "COM_ARM_AUTH_MET": 0.0,
    "GF_ACTION": 2.0,
    "GF_MAX_HOR_DIST": 100.0,
    "GF_MAX_VER_DIST": 40.0,
}


def guarded(policy: Policy = DEFAULT, firmware: Firmware | None = None, **params: float) -> Flight:
    """Heard for so long that a PX4 1.14, which tells nothing of a mission that it has not, was
    asked whether it has one: else its first arming is denied."""
    flight = Flight("px4", policy=policy, params=GUARDED | params, firmware=firmware).connected()
    flight.run(4.0)
    return flight


def stranger_arms(flight: Flight) -> None:
    stranger(flight, dialect.MAVLink_command_long_message(1, 1, ARM, 0, 1, 0, 0, 0, 0, 0, 0))
    flight.run(1.5)


def answers(flight: Flight) -> list[tuple[int, int, int]]:
    """Result, progress and result_param2 of what we answered, as pymavlink reads them."""
    seen = [pymavlink_decoder.read(sent.data) for sent in flight.sent]
    acks = [m for m in seen if m.get_type() == "COMMAND_ACK" and m.command == AUTHORIZATION]
    assert all((m.target_system, m.target_component) == (1, 1) for m in acks)
    return [(m.result, m.progress, m.result_param2) for m in acks]


def test_what_the_gate_arms_it_authorizes() -> None:
    flight = guarded()
    flight.do("arm")
    assert answers(flight) == [(ACCEPTED, 10, 10)]
    flight.do("takeoff", up_m=2.0)
    assert flight.is_in(State.HOVERING)


def test_another_station_may_arm_it_where_the_gate_would() -> None:
    flight = guarded()
    stranger_arms(flight)
    assert answers(flight) == [(ACCEPTED, 10, 10)]
    assert flight.vehicle.armed


def test_in_two_steps_the_second_request_is_granted() -> None:
    flight = guarded(COM_ARM_AUTH_MET=1.0)
    armed = []
    for _ in range(2):
        stranger_arms(flight)
        armed.append(flight.vehicle.armed)
    assert armed == [False, True]
    assert len(answers(flight)) == 1


def denied(flight: Flight, *words: str) -> None:
    stranger_arms(flight)
    assert not flight.vehicle.armed
    assert answers(flight)[-1] == (DENIED, 1, 1)  # NONE: the reason is told in words
    (line,) = [each for each in flight.lines("state_and_safety") if "may not arm" in each]
    for word in words:
        assert word in line


def test_a_fence_that_does_nothing_is_named() -> None:
    denied(guarded(GF_ACTION=1.0), "geofence breach", "GF_ACTION = 1")


def test_a_breach_action_that_px4_does_not_know_is_named() -> None:
    denied(guarded(GF_ACTION=77.0), "geofence breach", "GF_ACTION = 77")


def test_no_fence_on_board_is_named() -> None:
    denied(guarded(GF_MAX_HOR_DIST=0.0), "geofence", "GF_MAX_HOR_DIST")


def test_a_fence_that_was_uploaded_does_for_the_radius() -> None:
    flight = guarded(firmware="1.15", GF_MAX_HOR_DIST=0.0)
    stranger_fences(flight, 70.0)
    flight.run(2.0)
    stranger_arms(flight)
    assert answers(flight) == [(ACCEPTED, 10, 10)]
    told = [line for line in flight.lines("link") if "to stay in" in line]
    assert "uploaded: 1 to stay in, 0 to stay out of, up to 99 m from home" in told[-1]


def test_one_that_is_wider_than_the_policys_does_not() -> None:
    flight = guarded(firmware="1.15", GF_MAX_HOR_DIST=0.0)
    stranger_fences(flight, 300.0)
    flight.run(2.0)
    denied(flight, "GF_MAX_HOR_DIST", "up to 424 m from home, the policy's is 150 m")


def test_one_that_is_taken_away_does_no_more() -> None:
    flight = guarded(firmware="1.15", GF_MAX_HOR_DIST=0.0)
    stranger_fences(flight, 70.0)
    flight.run(2.0)
    stranger(flight, dialect.MAVLink_mission_clear_all_message(1, 1, 1))
    flight.run(1.0)
    denied(flight, "GF_MAX_HOR_DIST")


def test_a_severity_is_named() -> None:
    policy = parse_policy('severities.vehicle_failsafe_weak = "hold"', "my.toml")
    denied(guarded(policy, NAV_DLL_ACT=0.0), "severity is HOLD", "vehicle_failsafe_weak")


def test_a_record_that_failed_is_named_where_the_policy_wants_one() -> None:
    flight = guarded(parse_policy("arm_requires_recording = true", "my.toml"))
    flight.feed(inputs.RecorderChanged(False, "", "the disk is full"))
    denied(flight, "nothing is recorded")


def test_a_mission_that_was_verified_speaks_not_against_it() -> None:
    flight = guarded()
    flight.do("mission_upload", path=str(MISSIONS / "demo.toml"))
    flight.run(3.0)
    stranger_arms(flight)
    assert answers(flight) == [(ACCEPTED, 10, 10)]


def test_a_mission_past_the_gate_is_named() -> None:
    flight = guarded()
    stranger_uploads(flight, 3)
    denied(flight, "the mission on board (3 items) was not verified")


def test_what_was_found_in_a_mission_past_the_gate_is_named() -> None:
    """The first of its findings, as long as that mission is on board: by its number, which PX4
    gives since 1.15 (from memory)."""
    flight = guarded(firmware="1.15")
    stranger_uploads(flight, 4)
    assert flight.done(flight.say("mission_check"), 5.0).startswith("refused")
    refused = next(line for line in flight.lines("mission") if "mission_check: refused" in line)
    finding = refused.partition(": refused ")[2].partition(": ")[2]
    assert finding.startswith("item ")
    denied(flight, "the mission on board (4 items)", finding)
    flight.run(5.0)
    stranger_arms(flight)
    assert finding in flight.lines("state_and_safety")[-1]
    stranger_uploads(flight, 4, north_e7=8000)
    stranger_arms(flight)
    assert "was not verified" in flight.lines("state_and_safety")[-1]


def test_another_mission_in_the_place_of_the_verified_one_is_named() -> None:
    """By its number, which PX4 gives since 1.15 (from memory)."""
    flight = guarded(firmware="1.15")
    flight.do("mission_upload", path=str(MISSIONS / "demo.toml"))
    flight.run(3.0)
    stranger_uploads(flight, _items_on_board(flight))
    denied(flight, "another mission of as many items")


def _items_on_board(flight: Flight) -> int:
    (count,) = [
        message
        for message in stranger(flight, dialect.MAVLink_mission_request_list_message(1, 1, 0))
        if message.get_type() == "MISSION_COUNT"
    ]
    return int(count.count)


def test_without_a_request_nothing_is_answered() -> None:
    flight = guarded(COM_ARM_AUTH_ID=10.0)
    stranger_arms(flight)
    assert answers(flight) == []
    assert not flight.vehicle.armed


def test_a_client_that_arms_in_vain_is_answered_once_and_at_once() -> None:
    """It is not asked for again and again until its time is over: the station itself denied it."""
    flight = BridgedFlight("px4")
    for name, value in (GUARDED | {"GF_ACTION": 1.0}).items():
        flight.vehicle.parameters.set(name, value)
    client = flight.join()
    flight.connected()
    flight.run(2.0)
    asked_ns = flight.now_ns
    client.command(ARM, 1.0)
    flight.beating(8.0)
    assert not flight.vehicle.armed
    acks = [heard for heard in client.heard if heard.message.get_type() == "COMMAND_ACK"]
    (ack,) = [heard for heard in acks if heard.message.command == ARM]
    assert ack.message.result != ACCEPTED
    assert ack.time_ns - asked_ns < 1_000_000_000
    assert len([line for line in flight.told() if "may not arm" in line]) == 1
    assert client.texts().count("may not arm") == 1
    assert client.texts().count("arm: aborted") == 1, "not once more as the gate's line"


def test_after_a_denial_the_next_arming_is_asked_for_as_ever() -> None:
    flight = guarded(GF_ACTION=1.0)
    assert flight.done(flight.say("arm"), 1.0) == "aborted VEHICLE_REFUSED"
    (two,) = struct.unpack("<f", struct.pack("<i", 2))
    stranger(flight, dialect.MAVLink_param_set_message(1, 1, b"GF_ACTION", two, 6))
    flight.run(2.0)
    flight.do("arm")
