"""Every command that moves a vehicle, and what the gate makes of it: one literal row each.

Sources: MAVLink common.xml; PX4 1.14 (`Commander.cpp`, `navigator_main.cpp`,
`mavlink_receiver.cpp`) and ArduCopter 4.5 to 4.7 (`GCS_Mavlink.cpp`); where a row says "recorded",
a real PX4 1.14.3 or ArduCopter 4.7 did it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias

from gcs.bridge.translate import mission_commands as mission
from gcs.bridge.translate import modes, orbits
from gcs.bridge.translate import motion_commands as motion
from gcs.bridge.translate.command import Command
from gcs.bridge.translate.meaning import Meaning, Seen
from gcs.wire.ids import Cmd

Translate: TypeAlias = Callable[[Command, Seen], Meaning]


@dataclass(frozen=True, slots=True)
class CommandRow:
    """What one command means to each autopilot, and the same in words for `docs/bridge.md`."""

    px4: Translate
    ardupilot: Translate
    says: str


def _same(translate: Translate, says: str) -> CommandRow:
    return CommandRow(translate, translate, says)


_ROI: Final = _same(
    mission.region_of_interest, "forwarded: it turns the nose or the camera, and moves nothing"
)

COMMANDS: Final[Mapping[int, CommandRow]] = {
    Cmd.COMPONENT_ARM_DISARM: _same(
        motion.arm_or_disarm,
        "arm, never past the vehicle's checks; disarm; p2 21196: forced disarm, which the gate "
        "allows by policy and asked for twice",
    ),
    Cmd.NAV_TAKEOFF: CommandRow(
        motion.take_off_px4,
        motion.take_off_ardupilot,
        "take-off where it stands. PX4: p7 above sea level, NaN or too low: its own default "
        "height; a place more than 5 m away is refused; disarmed: kept for 10 s, flown when the "
        "same client arms. ArduPilot: p7 above home, places ignored",
    ),
    Cmd.NAV_LAND: _same(motion.land, "land where it is; a place is ignored, as both do"),
    Cmd.NAV_RETURN_TO_LAUNCH: _same(motion.return_home, "rtl, if the way home is clear"),
    Cmd.DO_SET_MODE: _same(
        modes.do_set_mode,
        "by the mode: see the table of modes. PX4, disarmed: the mode of a verified mission is "
        "forwarded, and flown when the same client arms within 10 s",
    ),
    Cmd.DO_SET_STANDARD_MODE: _same(
        motion.standard_mode,
        "safe recovery: rtl; mission, land, take-off: as those modes; the others are refused",
    ),
    Cmd.NAV_GUIDED_ENABLE: _same(motion.guided_enable, "1: as OFFBOARD or GUIDED; 0: hold"),
    Cmd.NAV_LOITER_UNLIM: _same(motion.loiter, "hold where it is; a place is ignored"),
    Cmd.DO_REPOSITION: CommandRow(
        motion.reposition_px4,
        motion.reposition_ardupilot,
        "goto; with the flag to change the mode also after a hold (resume, then goto). PX4: only "
        "with that flag; NaN keeps a coordinate, all NaN: hold; p4 is the heading. ArduPilot: "
        "COMMAND_INT only, every coordinate given, no heading. p1 (speed) and p3 (radius) are "
        "not flown",
    ),
    Cmd.DO_CHANGE_ALTITUDE: CommandRow(
        motion.change_altitude_px4,
        mission.of_no_use,
        "PX4: goto straight up or down, p2 is the frame of p1. ArduPilot: refused, as it does",
    ),
    Cmd.DO_ORBIT: _same(
        orbits.orbit,
        "orbit, also after a hold (resume, then orbit): the circle, the way to it and the room to "
        "stop in are verified, then the station flies it as a stream, on an ArduPilot too. NaN: "
        "as it is flown already, else 10 m, 1 m/s, about where it is: see orbits",
    ),
    Cmd.CONDITION_YAW: CommandRow(
        mission.of_no_use,
        motion.condition_yaw,
        "PX4: refused, as it does. ArduPilot: goto where it is or flies to, with that heading",
    ),
    Cmd.DO_PAUSE_CONTINUE: _same(
        motion.pause_or_continue,
        "pause: hold; continue: the mission that was stopped, from its first item, else resume "
        "(a goal is gone)",
    ),
    Cmd.OVERRIDE_GOTO: _same(
        motion.override_goto, "hold here: hold; continue: as above; another place is refused"
    ),
    Cmd.DO_GO_AROUND: _same(mission.go_around, "refused: hold breaks a landing off"),
    Cmd.MISSION_START: CommandRow(
        mission.mission_start_px4,
        mission.mission_start_ardupilot,
        "mission start, from the first item or where it was set to begin. PX4: p1 above 0 sets "
        "that, in the air; disarmed: mission_check, arm, then start",
    ),
    Cmd.DO_SET_MISSION_CURRENT: _same(
        mission.do_set_mission_current,
        "`mission_set_current`: the next start in the air begins there, verified from where it "
        "is. While the mission is flown: hold, resume, `mission_set_current`, mission start",
    ),
    Cmd.DO_LAND_START: _same(
        mission.do_land_start,
        "DO_SET_MISSION_CURRENT to the mission's one DO_LAND_START item, then mission start",
    ),
    Cmd.DO_CHANGE_SPEED: _same(
        mission.change_speed,
        "forwarded up to the vehicle's own speed (MPC_XY_CRUISE, WP_SPD); refused in a mission, "
        "and on ArduPilot for climb and descent",
    ),
    Cmd.DO_SET_ROI_LOCATION: _ROI,
    Cmd.DO_SET_ROI_WPNEXT_OFFSET: _ROI,
    Cmd.DO_SET_ROI_NONE: _ROI,
    Cmd.DO_SET_ROI_SYSID: _ROI,
    Cmd.DO_SET_ROI: _ROI,
}


def meaning_of_command(command: Command, seen: Seen) -> Meaning:
    """A command without a row is refused: the classification should not have sent it here."""
    row = COMMANDS.get(command.number)
    if row is None:
        return mission.not_to_be_judged(command, seen)
    translate = row.px4 if seen.autopilot.mode_in_two_parts else row.ardupilot
    return translate(command, seen)
