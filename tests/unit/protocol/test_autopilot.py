"""What each autopilot is asked with, number by number."""

from __future__ import annotations

import math

import pytest

from gcs.gate.effects import CommandKind
from gcs.gate.states import FlightMode
from gcs.protocol.autopilot import (
    ARDUPILOT,
    GENERIC,
    PX4,
    Autopilot,
    CannotCommandError,
    WantedCommand,
    autopilot_of,
    command_long_for,
    mode_named,
    mode_of,
)
from gcs.protocol.effects import Address
from gcs.wire.codec import encode
from gcs.wire.ids import Cmd, MavAutopilot, MavType
from gcs.wire.messages import CommandLong

TARGET = Address(3, 1)
CUSTOM = 0x81
NAN = math.nan

SET_MODE, TAKE_OFF = Cmd.DO_SET_MODE, Cmd.NAV_TAKEOFF


def params(command: CommandLong) -> list[float]:
    found = [command.param1, command.param2, command.param3, command.param4]
    return [*found, command.param5, command.param6, command.param7]


def equal(left: list[float], right: list[float]) -> bool:
    pairs = zip(left, right, strict=True)
    return all(a == b or (math.isnan(a) and math.isnan(b)) for a, b in pairs)


@pytest.mark.parametrize(
    ("who", "wanted", "command", "expected"),
    [
        (PX4, WantedCommand(CommandKind.HOLD), Cmd.DO_SET_MODE, [1, 4, 3]),
        (ARDUPILOT, WantedCommand(CommandKind.HOLD), Cmd.DO_SET_MODE, [1, 17]),
        (PX4, WantedCommand(CommandKind.GUIDED), Cmd.DO_SET_MODE, [1, 6, 0]),
        (ARDUPILOT, WantedCommand(CommandKind.GUIDED), Cmd.DO_SET_MODE, [1, 4]),
        (PX4, WantedCommand(CommandKind.SET_MODE, mode_name="posctl"), SET_MODE, [1, 3, 0]),
        (
            ARDUPILOT,
            WantedCommand(CommandKind.SET_MODE, mode_name="Loiter"),
            Cmd.DO_SET_MODE,
            [1, 5],
        ),
        (PX4, WantedCommand(CommandKind.ARM), Cmd.COMPONENT_ARM_DISARM, [1]),
        (PX4, WantedCommand(CommandKind.DISARM), Cmd.COMPONENT_ARM_DISARM, [0]),
        (PX4, WantedCommand(CommandKind.FORCE_DISARM), Cmd.COMPONENT_ARM_DISARM, [0, 21196]),
        (
            PX4,
            WantedCommand(CommandKind.TAKE_OFF, up_m=2.5, ground_amsl_m=488.0),
            Cmd.NAV_TAKEOFF,
            [0, 0, 0, NAN, NAN, NAN, 490.5],
        ),
        (
            ARDUPILOT,
            WantedCommand(CommandKind.TAKE_OFF, up_m=2.5),
            Cmd.NAV_TAKEOFF,
            [0] * 6 + [2.5],
        ),
        (PX4, WantedCommand(CommandKind.LAND), Cmd.NAV_LAND, [0, 0, 0, NAN, NAN, NAN, 0]),
        (ARDUPILOT, WantedCommand(CommandKind.LAND), Cmd.NAV_LAND, [0]),
        (ARDUPILOT, WantedCommand(CommandKind.RETURN), Cmd.NAV_RETURN_TO_LAUNCH, [0]),
        (PX4, WantedCommand(CommandKind.START_MISSION), Cmd.MISSION_START, [0]),
        (PX4, WantedCommand(CommandKind.PHOTO, photo_seq=4), Cmd.IMAGE_START_CAPTURE, [0, 0, 1, 4]),
    ],
)
def test_an_order_becomes_this_command(
    who: Autopilot, wanted: WantedCommand, command: Cmd, expected: list[float]
) -> None:
    asked = command_long_for(who, wanted, TARGET)
    assert (asked.target_system, asked.target_component) == (3, 1)
    assert asked.command == command
    assert equal(params(asked), [float(p) for p in expected] + [0.0] * (7 - len(expected)))
    encode(asked)


@pytest.mark.parametrize("who", [PX4, ARDUPILOT])
@pytest.mark.parametrize("kind", CommandKind)
def test_there_is_a_command_for_every_kind(who: Autopilot, kind: CommandKind) -> None:
    wanted = WantedCommand(kind, up_m=1.0, ground_amsl_m=0.0, mode_name="land")
    assert encode(command_long_for(who, wanted, TARGET))


@pytest.mark.parametrize("kind", CommandKind)
def test_an_unknown_autopilot_is_asked_for_nothing(kind: CommandKind) -> None:
    with pytest.raises(CannotCommandError, match="multirotors with PX4 or ArduPilot only"):
        command_long_for(GENERIC, WantedCommand(kind), TARGET)


def test_a_take_off_above_an_unknown_ground_is_refused() -> None:
    with pytest.raises(CannotCommandError, match="not known yet"):
        command_long_for(PX4, WantedCommand(CommandKind.TAKE_OFF, up_m=2.0), TARGET)


def test_a_mode_that_does_not_exist_is_refused_with_those_that_do() -> None:
    with pytest.raises(CannotCommandError, match=r"no mode 'warp'.*AUTO\.LOITER"):
        command_long_for(PX4, WantedCommand(CommandKind.SET_MODE, mode_name="warp"), TARGET)


@pytest.mark.parametrize("who", [PX4, ARDUPILOT])
def test_names_and_numbers_of_modes_lead_to_each_other(who: Autopilot) -> None:
    for mode in who.modes:
        assert mode_of(who, CUSTOM, mode.custom_mode) == mode
        assert mode_named(who, mode.name.lower()) == mode
    assert len({mode.custom_mode for mode in who.modes}) == len(who.modes)
    assert len({mode.name for mode in who.modes}) == len(who.modes)


@pytest.mark.parametrize(
    ("who", "name", "number", "meaning"),
    [
        (PX4, "AUTO.LOITER", 0x03040000, FlightMode.HOLD),
        (PX4, "AUTO.TAKEOFF", 0x02040000, FlightMode.TAKEOFF),
        (PX4, "OFFBOARD", 0x00060000, FlightMode.GUIDED),
        (PX4, "AUTO.PRECLAND", 0x09040000, FlightMode.LAND),
        (ARDUPILOT, "BRAKE", 17, FlightMode.HOLD),
        (ARDUPILOT, "SMART_RTL", 21, FlightMode.RETURN),
        (ARDUPILOT, "AUTO", 3, FlightMode.MISSION),
    ],
)
def test_a_heartbeat_says_this_mode(
    who: Autopilot, name: str, number: int, meaning: FlightMode
) -> None:
    mode = mode_of(who, CUSTOM, number)
    assert (mode.name, mode.meaning) == (name, meaning)


def test_a_mode_nobody_listed_is_flown_by_somebody_else() -> None:
    assert mode_of(PX4, CUSTOM, 99 << 16).meaning is FlightMode.OTHER
    assert mode_of(GENERIC, CUSTOM, 4).meaning is FlightMode.OTHER
    assert mode_of(ARDUPILOT, 0, 4).meaning is FlightMode.OTHER


def test_the_last_part_of_a_name_is_enough() -> None:
    assert mode_named(PX4, "loiter") == mode_named(PX4, "AUTO.LOITER")
    assert mode_named(PX4, "auto") is None


def test_personalities_are_told_by_the_heartbeat() -> None:
    assert autopilot_of(MavAutopilot.PX4, MavType.QUADROTOR) is PX4
    assert autopilot_of(MavAutopilot.ARDUPILOTMEGA, MavType.HEXAROTOR) is ARDUPILOT
    assert autopilot_of(77, MavType.QUADROTOR) is GENERIC


@pytest.mark.parametrize("kind", list(CommandKind))
@pytest.mark.parametrize(
    ("mav_autopilot", "mav_type"),
    [
        (MavAutopilot.ARDUPILOTMEGA, MavType.FIXED_WING),
        (MavAutopilot.ARDUPILOTMEGA, MavType.GROUND_ROVER),
        (MavAutopilot.ARDUPILOTMEGA, MavType.SURFACE_BOAT),
        (MavAutopilot.ARDUPILOTMEGA, MavType.HELICOPTER),
        (MavAutopilot.PX4, MavType.FIXED_WING),
        (MavAutopilot.PX4, MavType.VTOL_QUADROTOR),
        (MavAutopilot.PX4, 250),
    ],
)
def test_what_is_no_multirotor_is_never_asked_with_a_multirotor_s_numbers(
    kind: CommandKind, mav_autopilot: int, mav_type: int
) -> None:
    """station.md, bug 3: HOLD left as mode 17, which is QSTABILIZE on a plane."""
    autopilot = autopilot_of(mav_autopilot, mav_type)
    with pytest.raises(CannotCommandError, match="multirotors"):
        command_long_for(autopilot, WantedCommand(kind, ground_amsl_m=0.0), TARGET)


@pytest.mark.parametrize("custom_mode", range(30))
def test_a_plane_s_modes_are_not_read_as_a_copter_s(custom_mode: int) -> None:
    """FBWA (5) was read as LOITER, ACRO (4) as GUIDED."""
    plane = autopilot_of(MavAutopilot.ARDUPILOTMEGA, MavType.FIXED_WING)
    mode = mode_of(plane, CUSTOM, custom_mode)
    assert (mode.name, mode.meaning) == (f"MODE_{custom_mode}", FlightMode.OTHER)


def test_px4_s_modes_have_one_name_and_a_plane_s_no_meaning() -> None:
    plane = autopilot_of(MavAutopilot.PX4, MavType.FIXED_WING)
    mode = mode_of(plane, CUSTOM, 0x0304_0000)
    assert (mode.name, mode.meaning) == ("AUTO.LOITER", FlightMode.OTHER)
