"""Each number that is written down by hand is the dialect's."""

from __future__ import annotations

import sys
from enum import IntEnum
from subprocess import run

import pytest

from gcs.wire import ids
from gcs.wire.dialect import ENUMS, MESSAGES_BY_NAME

ENUM_OF: dict[type[IntEnum], tuple[str, str]] = {
    ids.Cmd: ("MAV_CMD", "MAV_CMD_"),
    ids.Result: ("MAV_RESULT", "MAV_RESULT_"),
    ids.MavFrame: ("MAV_FRAME", "MAV_FRAME_"),
    ids.MissionType: ("MAV_MISSION_TYPE", "MAV_MISSION_TYPE_"),
    ids.MissionResult: ("MAV_MISSION_RESULT", "MAV_MISSION_"),
    ids.MissionState: ("MISSION_STATE", "MISSION_STATE_"),
    ids.ModeFlag: ("MAV_MODE_FLAG", "MAV_MODE_FLAG_"),
    ids.MavState: ("MAV_STATE", "MAV_STATE_"),
    ids.MavAutopilot: ("MAV_AUTOPILOT", "MAV_AUTOPILOT_"),
    ids.MavType: ("MAV_TYPE", "MAV_TYPE_"),
    ids.Severity: ("MAV_SEVERITY", "MAV_SEVERITY_"),
    ids.Landed: ("MAV_LANDED_STATE", "MAV_LANDED_STATE_"),
    ids.ParamType: ("MAV_PARAM_TYPE", "MAV_PARAM_TYPE_"),
    ids.ParamError: ("MAV_PARAM_ERROR", "MAV_PARAM_ERROR_"),
    ids.GpsFix: ("GPS_FIX_TYPE", "GPS_FIX_TYPE_"),
    ids.DataStream: ("MAV_DATA_STREAM", "MAV_DATA_STREAM_"),
    ids.Component: ("MAV_COMPONENT", "MAV_COMP_ID_"),
    ids.TypeMask: ("POSITION_TARGET_TYPEMASK", "POSITION_TARGET_TYPEMASK_"),
    ids.Capability: ("MAV_PROTOCOL_CAPABILITY", "MAV_PROTOCOL_CAPABILITY_"),
}


@pytest.mark.parametrize("enum", ENUM_OF, ids=lambda enum: enum.__name__)
def test_an_enum_matches_the_dialect(enum: type[IntEnum]) -> None:
    name, prefix = ENUM_OF[enum]
    theirs = {entry.name: entry.value for entry in ENUMS[name].entries}
    for member in enum:
        short = member.name.removeprefix("FIX_") if enum is ids.GpsFix else member.name
        assert theirs[prefix + short] == member.value


def test_message_ids_match_the_dialect() -> None:
    for member in ids.MsgId:
        assert MESSAGES_BY_NAME[member.name].msgid == member.value


def test_no_enum_is_left_out_of_this_test() -> None:
    defined = {
        thing
        for thing in vars(ids).values()
        if isinstance(thing, type) and issubclass(thing, IntEnum) and thing is not IntEnum
    }
    assert defined == {*ENUM_OF, ids.MsgId}


@pytest.mark.parametrize(
    ("modules", "absent"),
    [
        ("gcs.wire.codec, gcs.shell.sockets, gcs.protocol.mission", "pymavlink.mavutil"),
        ("gcs.wire.messages, gcs.protocol.mission", "pymavlink"),
        ("gcs.wire.ids, gcs.protocol.autopilot, gcs.protocol.command", "pymavlink"),
    ],
)
def test_importing_loads_no_more_than_it_must(modules: str, absent: str) -> None:
    program = f"import sys, {modules}; sys.exit({absent!r} in sys.modules)"
    assert run([sys.executable, "-c", program], check=False).returncode == 0
