"""A setpoint on the wire: what the standard says of each field, read by pymavlink."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from gcs.gate.attitude import Attitude, HoverThrust
from gcs.gate.permit import Permit, issue
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.station.links import Links
from gcs.vehicle.setpoints import attitude_target, setpoint
from tests.unit.station import wire
from tests.unit.station.vehicles import SECOND_NS, vehicle

START_NS = 5 * SECOND_NS
IGNORE_ALL_BUT_POSITION = 3576
"""POSITION_TARGET_TYPEMASK: bits 3 to 8, 10 and 11 (bit 9 would make accelerations forces)."""
IGNORE_ALL_BUT_POSITION_AND_YAW = 2552


def on_the_wire(
    pos_ned: tuple[float, float, float], yaw_rad: float | None, now_ns: int
) -> wire.Message:
    return sent_of(issue(pos_ned, yaw_rad, now_ns, "a test"))


def sent_of(permit: Permit) -> wire.Message:
    message = setpoint(vehicle(), permit, START_NS, permit.issued_ns)
    (sent,) = wire.sent(Links(255, 190, count=1).send(0, message, permit.issued_ns))
    return sent


def test_a_position_without_a_heading_ignores_everything_else() -> None:
    sent = on_the_wire((1.5, -2.5, -3.5), None, START_NS)
    assert sent.get_type() == "SET_POSITION_TARGET_LOCAL_NED"
    assert (sent.x, sent.y, sent.z) == (1.5, -2.5, -3.5)
    assert sent.type_mask == IGNORE_ALL_BUT_POSITION
    assert sent.coordinate_frame == 1  # MAV_FRAME_LOCAL_NED
    assert (sent.target_system, sent.target_component) == (1, 1)
    rest = (sent.vx, sent.vy, sent.vz, sent.afx, sent.afy, sent.afz, sent.yaw, sent.yaw_rate)
    assert rest == (0.0,) * 8


def test_a_heading_is_sent_with_its_bit_cleared() -> None:
    sent = on_the_wire((0.0, 0.0, -1.0), 0.5, START_NS)
    assert sent.type_mask == IGNORE_ALL_BUT_POSITION_AND_YAW
    assert sent.yaw == 0.5


def test_a_heading_of_north_is_a_heading() -> None:
    sent = on_the_wire((0.0, 0.0, -1.0), 0.0, START_NS)
    assert sent.type_mask == IGNORE_ALL_BUT_POSITION_AND_YAW


@pytest.mark.parametrize(
    ("asked", "mask"),
    [
        ({"v_ned": (1.0, 2.0, -3.0)}, 3527),
        ({"v_ned": (1.0, 2.0, -3.0), "yaw_rate_rad_s": 0.0}, 1479),
        ({"v_ned": (1.0, 2.0, -3.0), "a_ned": (0.0, 0.0, 0.0)}, 3079),
        ({"a_ned": (0.0, 0.0, 0.5)}, 3135),
    ],
)
def test_a_sample_of_a_stream_ignores_what_it_does_not_ask_for(
    asked: dict[str, tuple[float, float, float]], mask: int
) -> None:
    """POSITION_TARGET_TYPEMASK: 1 to 4 position, 8 to 32 velocity, 64 to 256 acceleration, 1024
    yaw, 2048 yaw rate; 512 (accelerations are forces) is never set."""
    permit = issue(None, None, START_NS, "a test", **asked)  # type: ignore[arg-type]
    (sent,) = wire.sent(
        Links(255, 190, count=1).send(0, setpoint(vehicle(), permit, START_NS, START_NS), START_NS)
    )
    assert sent.type_mask == mask
    assert (sent.vx, sent.vy, sent.vz) == asked.get("v_ned", (0.0, 0.0, 0.0))
    assert (sent.afx, sent.afy, sent.afz) == asked.get("a_ned", (0.0, 0.0, 0.0))
    assert (sent.x, sent.y, sent.z, sent.yaw, sent.yaw_rate) == (0.0,) * 5


def test_a_position_with_a_velocity_and_a_yaw_rate() -> None:
    permit = issue(
        (1.0, 2.0, -3.0), None, START_NS, "a test", v_ned=(0.5, 0.0, 0.0), yaw_rate_rad_s=0.25
    )
    (sent,) = wire.sent(
        Links(255, 190, count=1).send(0, setpoint(vehicle(), permit, START_NS, START_NS), START_NS)
    )
    assert sent.type_mask == 64 + 128 + 256 + 1024
    assert (sent.x, sent.vx, sent.yaw_rate) == (1.0, 0.5, 0.25)


@pytest.mark.parametrize("name", ["v_ned", "a_ned"])
def test_a_velocity_that_is_no_number_never_leaves(name: str) -> None:
    permit = issue(None, None, START_NS, "a test", **{name: (0.0, math.nan, 0.0)})  # type: ignore[arg-type]
    with pytest.raises(PermissionError):
        setpoint(vehicle(), permit, START_NS, START_NS)


def test_its_clock_counts_milliseconds_of_the_session_in_32_bits() -> None:
    assert on_the_wire((0.0, 0.0, 0.0), None, START_NS + 1_234_999_999).time_boot_ms == 1234
    long_ns = START_NS + (2**32 + 5) * 1_000_000
    assert on_the_wire((0.0, 0.0, 0.0), None, long_ns).time_boot_ms == 5


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_position_that_is_no_number_never_leaves(axis: int, bad: float) -> None:
    pos = [0.0, 0.0, 0.0]
    pos[axis] = bad
    with pytest.raises(PermissionError):
        on_the_wire((pos[0], pos[1], pos[2]), None, START_NS)


@pytest.mark.parametrize("off_ns", [1, -1, SECOND_NS])
def test_a_permit_of_another_moment_moves_nothing(off_ns: int) -> None:
    permit = issue((0.0, 0.0, 0.0), None, START_NS + off_ns, "a test")
    with pytest.raises(PermissionError):
        setpoint(vehicle(), permit, START_NS, START_NS)


def test_a_permit_for_a_command_is_none_for_a_place() -> None:
    with pytest.raises(PermissionError):
        setpoint(vehicle(), issue(None, None, START_NS, "a test"), START_NS, START_NS)


LEANS = Attitude((0.6, 0.0, -0.8, 0.0), 0.25, HoverThrust(0.5))


def attitude_on_the_wire(autopilot: Autopilot, permit: Permit) -> wire.Message:
    message = attitude_target(vehicle(autopilot), permit, START_NS, START_NS + 1_500_000_000)
    (sent,) = wire.sent(Links(255, 190, count=1).send(0, message, permit.issued_ns))
    return sent


@pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT], ids=lambda a: a.name)
@pytest.mark.parametrize("rate_rad_s", [None, 0.25])
def test_an_attitude_on_the_wire(autopilot: Autopilot, rate_rad_s: float | None) -> None:
    """ATTITUDE_TARGET_TYPEMASK: 1, 2, 4 ignore the rates of roll, pitch and yaw.  PX4 takes a yaw
    rate alone, ArduCopter all three or none (from memory)."""
    now_ns = START_NS + 1_500_000_000
    permit = issue(None, None, now_ns, "a test", yaw_rate_rad_s=rate_rad_s, attitude=LEANS)
    sent = attitude_on_the_wire(autopilot, permit)
    assert sent.q == pytest.approx([0.6, 0.0, -0.8, 0.0])
    assert (sent.thrust, sent.time_boot_ms) == (0.25, 1500)
    assert (sent.body_roll_rate, sent.body_pitch_rate) == (0.0, 0.0)
    assert sent.body_yaw_rate == (rate_rad_s or 0.0)
    with_rate = 3 if autopilot is PX4 else 0
    assert sent.type_mask == (7 if rate_rad_s is None else with_rate)


@pytest.mark.parametrize(
    "permit",
    [
        issue(None, None, START_NS, "a test"),
        issue(None, None, START_NS + 1, "a test", attitude=LEANS),
        issue((0.0, 0.0, 0.0), None, START_NS, "a test", attitude=LEANS),
        issue(None, 0.0, START_NS, "a test", attitude=LEANS),
        issue(None, None, START_NS, "a test", v_ned=(0.0, 0.0, 0.0), attitude=LEANS),
        issue(None, None, START_NS, "a test", yaw_rate_rad_s=math.nan, attitude=LEANS),
        issue(None, None, START_NS, "a test", attitude=replace(LEANS, thrust=math.nan)),
    ],
)
def test_an_attitude_leaves_by_a_permit_of_now_for_it_alone(permit: Permit) -> None:
    with pytest.raises(PermissionError):
        attitude_target(vehicle(), permit, START_NS, START_NS)


def test_an_attitude_is_no_setpoint_of_a_position() -> None:
    permit = issue(None, None, START_NS, "a test", attitude=LEANS)
    with pytest.raises(PermissionError):
        setpoint(vehicle(), permit, START_NS, START_NS)
