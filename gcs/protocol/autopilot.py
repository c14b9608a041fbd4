"""What the autopilots call their modes, and how each wants to be asked: one row an autopilot.

Sources: PX4 `px4_custom_mode.h` and `Commander.cpp`, ArduCopter `mode.h` and `GCS_Mavlink.cpp`,
MAVLink common for the commands.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import Enum
from types import MappingProxyType
from typing import assert_never

from gcs.gate.effects import CommandKind
from gcs.gate.states import FlightMode
from gcs.protocol.effects import Address
from gcs.wire.ids import Cmd, MavAutopilot, MavType, ModeFlag
from gcs.wire.messages import CommandLong

FORCE_DISARM = 21196.0
"""param2 of COMPONENT_ARM_DISARM that disarms in the air too (MAVLink common)."""
IGNORED = math.nan
"""A parameter that PX4 is to choose itself."""


class ParamEncoding(Enum):
    """How an integer travels in the float of PARAM_VALUE and PARAM_SET."""

    BYTEWISE = "bytewise"
    CAST = "cast"


class CannotCommandError(Exception):
    """This autopilot cannot be asked for that; the message says why, for the operator."""


@dataclass(frozen=True, slots=True)
class Mode:
    """A mode by the autopilot's own name."""

    name: str
    custom_mode: int
    """HEARTBEAT.custom_mode."""
    meaning: FlightMode


@dataclass(frozen=True, slots=True)
class WantedCommand:
    """What the operator or the gate wants, with the numbers that some kinds need."""

    kind: CommandKind
    up_m: float = 0.0
    """TAKE_OFF: metres above the take-off point."""
    ground_amsl_m: float | None = None
    """TAKE_OFF: the take-off point above mean sea level, which px4 needs."""
    mode_name: str = ""
    """SET_MODE: in any case of letters."""
    photo_seq: int = 1
    """PHOTO: counts up, so that a repeated command takes no second picture."""
    mission_seq: int | None = None
    """START_MISSION: the item to begin at; None: the first."""


def _px4(main: int, sub: int = 0) -> int:
    return main << 16 | sub << 24


_M = FlightMode

_PX4_MODES = (
    Mode("MANUAL", _px4(1), _M.OTHER),
    Mode("ALTCTL", _px4(2), _M.OTHER),
    Mode("POSCTL", _px4(3), _M.OTHER),
    Mode("POSCTL.ORBIT", _px4(3, 1), _M.OTHER),
    Mode("POSCTL.SLOW", _px4(3, 2), _M.OTHER),
    Mode("AUTO.READY", _px4(4, 1), _M.OTHER),
    Mode("AUTO.TAKEOFF", _px4(4, 2), _M.TAKEOFF),
    Mode("AUTO.LOITER", _px4(4, 3), _M.HOLD),
    Mode("AUTO.MISSION", _px4(4, 4), _M.MISSION),
    Mode("AUTO.RTL", _px4(4, 5), _M.RETURN),
    Mode("AUTO.LAND", _px4(4, 6), _M.LAND),
    Mode("AUTO.FOLLOW_TARGET", _px4(4, 8), _M.OTHER),
    Mode("AUTO.PRECLAND", _px4(4, 9), _M.LAND),
    Mode("ACRO", _px4(5), _M.OTHER),
    Mode("OFFBOARD", _px4(6), _M.GUIDED),
    Mode("STABILIZED", _px4(7), _M.OTHER),
    Mode("TERMINATION", _px4(10), _M.OTHER),
)

_ARDUCOPTER_MODES = (
    Mode("STABILIZE", 0, _M.OTHER),
    Mode("ACRO", 1, _M.OTHER),
    Mode("ALT_HOLD", 2, _M.OTHER),
    Mode("AUTO", 3, _M.MISSION),
    Mode("GUIDED", 4, _M.GUIDED),
    Mode("LOITER", 5, _M.HOLD),
    Mode("RTL", 6, _M.RETURN),
    Mode("CIRCLE", 7, _M.OTHER),
    Mode("LAND", 9, _M.LAND),
    Mode("DRIFT", 11, _M.OTHER),
    Mode("SPORT", 13, _M.OTHER),
    Mode("FLIP", 14, _M.OTHER),
    Mode("AUTOTUNE", 15, _M.OTHER),
    Mode("POSHOLD", 16, _M.OTHER),
    Mode("BRAKE", 17, _M.HOLD),
    Mode("THROW", 18, _M.OTHER),
    Mode("AVOID_ADSB", 19, _M.OTHER),
    Mode("GUIDED_NOGPS", 20, _M.OTHER),
    Mode("SMART_RTL", 21, _M.RETURN),
    Mode("FLOWHOLD", 22, _M.OTHER),
    Mode("FOLLOW", 23, _M.OTHER),
    Mode("ZIGZAG", 24, _M.OTHER),
    Mode("SYSTEMID", 25, _M.OTHER),
    Mode("AUTOROTATE", 26, _M.OTHER),
    Mode("AUTO_RTL", 27, _M.RETURN),
    Mode("TURTLE", 28, _M.OTHER),
)


@dataclass(frozen=True, slots=True)
class Autopilot:
    """How one autopilot names its modes and wants to be asked."""

    name: str
    mav_autopilot: int
    """MAV_AUTOPILOT, HEARTBEAT.autopilot."""
    modes: tuple[Mode, ...]
    mode_of_meaning: Mapping[FlightMode, str]
    """The one mode of each meaning that this station sends, or that its command leads to."""
    param_encoding: ParamEncoding
    mode_in_two_parts: bool
    """DO_SET_MODE takes main and sub mode (px4), or custom_mode as it is (ardupilot)."""
    takeoff_above_sea: bool
    """NAV_TAKEOFF's altitude is above mean sea level (px4), or above home (ardupilot)."""
    blank: float
    """What an unused position parameter is to be filled with."""
    arms_in: str = ""
    """A mode in which it can be armed."""
    climb_ends_within_m: float = 0.0
    """How far below its height the vehicle may end a take-off, before its parameter is read."""
    commanded: bool = True
    """Whether this program knows how to command it; its reports are shown and recorded anyway."""


PX4 = Autopilot(
    name="px4",
    mav_autopilot=MavAutopilot.PX4,
    modes=_PX4_MODES,
    mode_of_meaning=MappingProxyType(
        {
            _M.HOLD: "AUTO.LOITER",
            _M.GUIDED: "OFFBOARD",
            _M.MISSION: "AUTO.MISSION",
            _M.RETURN: "AUTO.RTL",
            _M.LAND: "AUTO.LAND",
        }
    ),
    param_encoding=ParamEncoding.BYTEWISE,
    mode_in_two_parts=True,
    takeoff_above_sea=True,
    blank=IGNORED,
    arms_in="AUTO.LOITER",
    climb_ends_within_m=0.8,  # NAV_MC_ALT_RAD
)

ARDUPILOT = Autopilot(
    name="ardupilot",
    mav_autopilot=MavAutopilot.ARDUPILOTMEGA,
    modes=_ARDUCOPTER_MODES,
    # BRAKE, as LOITER obeys the sticks.
    mode_of_meaning=MappingProxyType(
        {
            _M.HOLD: "BRAKE",
            _M.GUIDED: "GUIDED",
            _M.MISSION: "AUTO",
            _M.RETURN: "RTL",
            _M.LAND: "LAND",
        }
    ),
    param_encoding=ParamEncoding.CAST,
    mode_in_two_parts=False,
    takeoff_above_sea=False,
    blank=0.0,
    arms_in="GUIDED",
)

GENERIC = Autopilot(
    name="of an unknown kind",
    mav_autopilot=MavAutopilot.GENERIC,
    modes=(),
    mode_of_meaning=MappingProxyType({}),
    param_encoding=ParamEncoding.CAST,
    mode_in_two_parts=False,
    takeoff_above_sea=False,
    blank=0.0,
    commanded=False,
)
"""An autopilot that we do not know: its reports are shown, every command to it is refused."""

_NO_MODES: Mapping[FlightMode, str] = MappingProxyType({})

PX4_OTHER = replace(
    PX4,
    # px4_custom_mode.h is one for all of PX4's vehicles; what a mode does differs.
    modes=tuple(replace(mode, meaning=_M.OTHER) for mode in _PX4_MODES),
    mode_of_meaning=_NO_MODES,
    commanded=False,
)
ARDUPILOT_OTHER = replace(ARDUPILOT, modes=(), mode_of_meaning=_NO_MODES, commanded=False)
"""Fixed wings, rovers, boats, helicopters: ArduPlane's and Rover's modes have other numbers."""

MULTIROTORS = frozenset(
    {
        MavType.QUADROTOR,
        MavType.COAXIAL,
        MavType.HEXAROTOR,
        MavType.OCTOROTOR,
        MavType.TRICOPTER,
        MavType.DODECAROTOR,
        MavType.DECAROTOR,
        MavType.GENERIC_MULTIROTOR,
    }
)

_BY_MAV_AUTOPILOT: Mapping[int, tuple[Autopilot, Autopilot]] = {
    MavAutopilot.PX4: (PX4, PX4_OTHER),
    MavAutopilot.ARDUPILOTMEGA: (ARDUPILOT, ARDUPILOT_OTHER),
}


def autopilot_of(mav_autopilot: int, mav_type: int) -> Autopilot:
    """The row for HEARTBEAT.autopilot and HEARTBEAT.type, GENERIC if there is none."""
    multirotor, other = _BY_MAV_AUTOPILOT.get(mav_autopilot, (GENERIC, GENERIC))
    return multirotor if mav_type in MULTIROTORS else other


def type_name(mav_type: int) -> str:
    """MAV_TYPE in words: "quadrotor", "fixed wing"."""
    try:
        return MavType(mav_type).name.lower().replace("_", " ")
    except ValueError:
        return f"vehicle of type {mav_type}"


def mode_of(autopilot: Autopilot, base_mode: int, custom_mode: int) -> Mode:
    """The mode of a heartbeat; one that is not in the table is flown by somebody else."""
    if not base_mode & ModeFlag.CUSTOM_MODE_ENABLED:
        return Mode(f"BASE_{base_mode}", custom_mode, _M.OTHER)
    for mode in autopilot.modes:
        if mode.custom_mode == custom_mode:
            return mode
    return Mode(f"MODE_{custom_mode}", custom_mode, _M.OTHER)


def mode_named(autopilot: Autopilot, name: str) -> Mode | None:
    """By the autopilot's own name, in any case; "loiter" finds AUTO.LOITER as well."""
    wanted = name.upper()
    for mode in autopilot.modes:
        if wanted in (mode.name, mode.name.rpartition(".")[2]):
            return mode
    return None


def command_long_for(autopilot: Autopilot, wanted: WantedCommand, target: Address) -> CommandLong:
    """`wanted` as this autopilot understands it.  Raises CannotCommandError."""
    if not autopilot.commanded:
        raise CannotCommandError("this station flies multirotors with PX4 or ArduPilot only")
    blank = autopilot.blank
    match wanted.kind:
        case CommandKind.HOLD:
            return _set_mode(autopilot, autopilot.mode_of_meaning[_M.HOLD], target)
        case CommandKind.GUIDED:
            return _set_mode(autopilot, autopilot.mode_of_meaning[_M.GUIDED], target)
        case CommandKind.SET_MODE:
            return _set_mode(autopilot, wanted.mode_name, target)
        case CommandKind.ARM:
            return _command(target, Cmd.COMPONENT_ARM_DISARM, 1.0)
        case CommandKind.DISARM:
            return _command(target, Cmd.COMPONENT_ARM_DISARM, 0.0)
        case CommandKind.FORCE_DISARM:
            return _command(target, Cmd.COMPONENT_ARM_DISARM, 0.0, FORCE_DISARM)
        case CommandKind.TAKE_OFF:
            height_m = _takeoff_height_m(autopilot, wanted)
            place = (0.0, 0.0, 0.0, blank, blank, blank, height_m)
            return _command(target, Cmd.NAV_TAKEOFF, *place)
        case CommandKind.LAND:
            return _command(target, Cmd.NAV_LAND, 0.0, 0.0, 0.0, blank, blank, blank, 0.0)
        case CommandKind.RETURN:
            return _command(target, Cmd.NAV_RETURN_TO_LAUNCH)
        case CommandKind.START_MISSION:
            # ArduCopter denies a start with an item, and begins at the one it was set to.
            named = wanted.mission_seq if autopilot.mode_in_two_parts else None
            return _command(target, Cmd.MISSION_START, float(named or 0))
        case CommandKind.PHOTO:
            camera, interval_s, count = 0.0, 0.0, 1.0
            shot = (camera, interval_s, count, float(wanted.photo_seq))
            return _command(target, Cmd.IMAGE_START_CAPTURE, *shot)
        case _:
            assert_never(wanted.kind)


def _set_mode(autopilot: Autopilot, name: str, target: Address) -> CommandLong:
    mode = mode_named(autopilot, name)
    if mode is None:
        names = ", ".join(mode.name for mode in autopilot.modes)
        raise CannotCommandError(f"{autopilot.name} has no mode {name!r}; it has: {names}")
    flags = float(ModeFlag.CUSTOM_MODE_ENABLED)
    if autopilot.mode_in_two_parts:
        main, sub = mode.custom_mode >> 16 & 0xFF, mode.custom_mode >> 24
        return _command(target, Cmd.DO_SET_MODE, flags, float(main), float(sub))
    return _command(target, Cmd.DO_SET_MODE, flags, float(mode.custom_mode))


def _takeoff_height_m(autopilot: Autopilot, wanted: WantedCommand) -> float:
    if not autopilot.takeoff_above_sea:
        return wanted.up_m
    if wanted.ground_amsl_m is None:
        raise CannotCommandError(
            f"{autopilot.name} takes off to a height above mean sea level, and that of the "
            "ground is not known yet"
        )
    return wanted.ground_amsl_m + wanted.up_m


def _command(target: Address, command: Cmd, *params: float) -> CommandLong:
    p1, p2, p3, p4, p5, p6, p7 = params + (0.0,) * (7 - len(params))
    return CommandLong(
        param1=p1,
        param2=p2,
        param3=p3,
        param4=p4,
        param5=p5,
        param6=p6,
        param7=p7,
        command=command,
        target_system=target.sysid,
        target_component=target.compid,
        confirmation=0,
    )
