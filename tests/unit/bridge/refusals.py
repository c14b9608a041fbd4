"""What clients must not do: one table, played before the bridge alone (`test_refusals.py`) and
before the whole station with a vehicle behind it (tests/loopback/test_refusals.py).

Each row is refused with a code, recorded, answered in the way of its protocol and told in words,
and nothing of it reaches the vehicle.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

from pymavlink.dialects.v20 import all as dialect

from gcs.plan.model import AutopilotName
from gcs.wire.ids import Cmd

NAN = math.nan
CAMERA, NOBODY = 100, 77
DEG_M = 111_319.5
BOTH: tuple[AutopilotName, ...] = ("px4", "ardupilot")
REJECTED, DENIED, UNSUPPORTED = (("COMMAND_ACK", result) for result in (1, 2, 3))
PLAN_DENIED, NOT_PERMITTED = ("MISSION_ACK", 14), ("PARAM_ERROR", 3)
NAK = ("FILE_TRANSFER_PROTOCOL", 129)


@dataclass(frozen=True, slots=True)
class Home:
    """Of the vehicle that the table is played to."""

    personality: AutopilotName
    lat: float
    lon: float
    amsl_m: float


Sends: TypeAlias = Callable[[Home], Any]


@dataclass(frozen=True, slots=True)
class Refused:
    """`sends`: pymavlink's message.  `asks`: the word of which the gate gives the verdict; "" where
    the bridge refuses by itself.  `answer`: a kind of message, and its result."""

    name: str
    sends: Sends
    code: str
    answer: tuple[str, int] | None
    says: str = ""
    asks: str = ""
    who: tuple[AutopilotName, ...] = BOTH
    by_another: bool = False
    """By a client who is not in control."""


def command(number: int, *params: float, compid: int = 1) -> Sends:
    filled = params + (0.0,) * (7 - len(params))
    return lambda _: dialect.MAVLink_command_long_message(1, compid, number, 0, *filled)


def at(number: int, frame: int, *params: float, north_m: float = 0.0) -> Sends:
    """COMMAND_INT, 6 m above home."""

    def message(home: Home) -> Any:
        place = (round((home.lat + north_m / DEG_M) * 1e7), round(home.lon * 1e7))
        filled = params + (0.0,) * (4 - len(params))
        head = (1, 1, frame, number, 0, 0)
        return dialect.MAVLink_command_int_message(*head, *filled, *place, home.amsl_m + 6.0)

    return message


def reposition(north_m: float, heading: float) -> Sends:
    return at(Cmd.DO_REPOSITION, 0, -1, 1, 0, heading, north_m=north_m)


def made(kind: str, *fields: Any) -> Sends:
    """pymavlink's message of that name."""
    return lambda _: getattr(dialect, f"MAVLink_{kind}_message")(*fields)


def orbit(*params: float) -> Sends:
    return command(Cmd.DO_ORBIT, *params, *(NAN,) * (7 - len(params)))


def fence_off(home: Home) -> Any:
    name, kind = {"px4": (b"GF_ACTION", 6), "ardupilot": (b"FENCE_ENABLE", 2)}[home.personality]
    return dialect.MAVLink_param_set_message(1, 1, name, 0.0, kind)


def sets_free_one(home: Home) -> Any:
    name, kind = {"px4": (b"SDLOG_MODE", 6), "ardupilot": (b"LOG_DISARMED", 2)}[home.personality]
    return dialect.MAVLink_param_set_message(1, 1, name, 0.0, kind)


def sticks_mode(home: Home) -> Any:
    """POSCTL, ALT_HOLD."""
    main = {"px4": 3.0, "ardupilot": 2.0}[home.personality]
    return command(Cmd.DO_SET_MODE, 1.0, main)(home)


def guided_item(home: Home) -> Any:
    """DroneKit's `simple_goto`, 200 m north."""
    place = (home.lat + 200 / DEG_M, home.lon, 6.0)
    return dialect.MAVLink_mission_item_message(1, 1, 0, 3, 16, 2, 0, 0, 0, 0, 0, *place)


def removal(_: Home) -> Any:
    head = struct.pack("<HBBBBBxI", 7, 0, 8, 1, 0, 0, 0)
    payload = list((head + b"/").ljust(251, b"\0"))
    return dialect.MAVLink_file_transfer_protocol_message(0, 1, 1, payload)


def hidden_disarm(version: int) -> Sends:
    """A vehicle that loses one byte of the tune would take it: a forced disarm."""
    disarm = dialect.MAVLink_command_long_message(1, 1, 400, 0, 0, 21196, 0, 0, 0, 0, 0)
    mav = dialect.MAVLink(None, srcSystem=245, srcComponent=190)
    hidden = bytes(disarm.pack(mav, force_mavlink1=version == 1))
    return made("play_tune", 1, 1, b"MFT200L8", hidden + b"L8")


def by_policy(
    name: str, sends: Sends, answer: tuple[str, int] | None = None, says: str = ""
) -> Refused:
    return Refused(name, sends, "POLICY", answer, says)


def no_orbit(says: str, *circle: float) -> Refused:
    """The station refuses it."""
    return Refused(f"orbit: {says}", orbit(*circle), "UNSUPPORTED", UNSUPPORTED, says, "orbit")


def meaningless(code: str, answer: tuple[str, int], says: str, *circle: float) -> Refused:
    return Refused(f"orbit: {says}", orbit(*circle), code, answer, says)


def anothers(name: str, sends: Sends, answer: tuple[str, int], asks: str = "") -> Refused:
    return Refused(name, sends, "OTHER_OPERATOR", answer, asks=asks, by_another=True)


A_FIX = (0, 0, 0, 0, 0, 3, 1, 1, 500.0, 1, 1, 0, 0, 0, 1, 1, 1, 10)
ON_GROUND = [
    by_policy("home", command(179, 1), DENIED),
    by_policy("termination", command(185, 1), DENIED),
    by_policy("fence off", command(207), DENIED),
    by_policy("motor test", command(209, 1), DENIED),
    by_policy("reset of parameters", command(245, 2), DENIED),
    by_policy("reboot", command(246, 1), DENIED),
    by_policy("a failure", command(420, 1), DENIED),
    by_policy("the fence's parameter", fence_off, NOT_PERMITTED, "is guarded"),
    by_policy("removal of a file", removal, NAK),
    by_policy("origin", made("set_gps_global_origin", 1, 473977420, 85455940, 488000)),
    by_policy("home", made("set_home_position", 1, 1, 1, 1, 0, 0, 0, [1, 0, 0, 0], 0, 0, 0)),
    by_policy("signing", made("setup_signing", 1, 1, [7] * 32, 1)),
    by_policy("fence point", made("fence_point", 1, 1, 0, 4, 47.0, 8.0)),
    by_policy("rally point", made("rally_point", 1, 1, 0, 1, 1, 1, 20, 0, 0, 0)),
    by_policy("corrections", made("gps_rtcm_data", 0, 3, [1] * 180)),
    by_policy("fence", made("mission_count", 1, 1, 3, 1), PLAN_DENIED),
    by_policy("rally points", made("mission_count", 1, 1, 3, 2), PLAN_DENIED),
    by_policy("a command in a tune", hidden_disarm(1), None, "a whole message stands in its bytes"),
    by_policy("of MAVLink 2", hidden_disarm(2), None, "a whole message stands in its bytes"),
    Refused(
        "arming of a component that nobody heard",
        command(400, 1, compid=NOBODY),
        "UNSUPPORTED",
        UNSUPPORTED,
        "there is no component 77 of system 1",
    ),
    Refused(
        "arming of a camera",
        command(400, 1, compid=CAMERA),
        "UNSUPPORTED",
        UNSUPPORTED,
        "component 100 flies nothing",
    ),
    Refused("orbit", orbit(10, 2), "NOT_FLYING", REJECTED, "NOT_FLYING", asks="orbit"),
    anothers("a free parameter, of another", sets_free_one, NOT_PERMITTED),
    anothers("calibration, of another", command(241, 1), REJECTED),
]
IN_AIR = [
    Refused("a goal outside the fence", reposition(200, NAN), "OUTSIDE_FENCE", DENIED, asks="goto"),
    Refused(
        "a guided item outside the fence",
        guided_item,
        "OUTSIDE_FENCE",
        PLAN_DENIED,
        asks="goto",
        who=("ardupilot",),
    ),
    Refused("a heading", reposition(10, math.inf), "NON_FINITE", DENIED, who=("px4",)),
    Refused("a heading", reposition(10, -math.inf), "NON_FINITE", DENIED, who=("px4",)),
    by_policy("a speed", command(178, 1, 12, -1), DENIED, "vehicle's own"),
    by_policy("a mode of the sticks", sticks_mode, DENIED, "bridge.manual_modes"),
    no_orbit("a circle of 1.0 m", 1, 2),
    no_orbit("a circle of 2000.0 m", 2000, 2),
    no_orbit("a speed above 0", 10, 0),
    no_orbit("a speed above 0", 10, -2),
    no_orbit("no negative turns", 10, 2, 0, -1),
    meaningless("UNSUPPORTED", UNSUPPORTED, "the sticks turn", 10, 2, 4),
    meaningless("UNSUPPORTED", UNSUPPORTED, "yaw behaviour 9", 10, 2, 9),
    meaningless("NON_FINITE", DENIED, "infinite", math.inf, 2),
    meaningless("NON_FINITE", DENIED, "infinite", 10, math.inf),
    Refused("orbit above terrain", at(Cmd.DO_ORBIT, 10, 10, 2), "UNSUPPORTED", UNSUPPORTED),
    Refused("orbit in a local frame", at(Cmd.DO_ORBIT, 1, 10, 2), "UNSUPPORTED", UNSUPPORTED),
    by_policy("GPS_INPUT", made("gps_input", *A_FIX), says="It feeds the estimator"),
    by_policy("HIL_GPS", made("hil_gps", 0, 3, 1, 1, 1, 70, 70, 0, 0, 0, 0, 0, 14)),
    by_policy("vision", made("vision_position_estimate", 0, 1, 0, 0, 0, 0, 0)),
    Refused(
        "a take-off, of another",
        command(22, 0, 0, 0, 0, 0, 0, 5),
        "OTHER_OPERATOR",
        REJECTED,
        "MAV_CMD_REQUEST_OPERATOR_CONTROL takes it over",
        asks="takeoff",
        by_another=True,
    ),
    anothers("an orbit, of another", orbit(5, 1), REJECTED, asks="orbit"),
]
