"""COMMAND_ACK and REQUEST_MESSAGE as the real autopilots answer them, row for row.

The rows are those of commands_px4.json and commands_arducopter.json, copied beside this file.
They name a command by a label; what was sent for each label is in `SENT`, from memory where the
record does not say.  `ON_PURPOSE` is what this vehicle answers otherwise, and why.
"""

from __future__ import annotations

import json
from math import nan
from pathlib import Path
from typing import Final

import pytest

from tests.unit.vehicle_services.fake_vehicle import S, acks, long
from tests.unit.vehicle_services.flown_vehicle import Flown, in_the_air, on_the_ground
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire import messages as m

pytestmark = pytest.mark.slow  # a vehicle flies

Asked = m.CommandLong | m.CommandInt
Row = tuple[Personality, str, str, str]

RESULTS: Final = {
    "ACCEPTED": Result.ACCEPTED,
    "TEMP_REJ": Result.TEMPORARILY_REJECTED,
    "DENIED": Result.DENIED,
    "UNSUPPORTED": Result.UNSUPPORTED,
    "FAILED": Result.FAILED,
    "no ack": None,
}
HERE_E7: Final = (473977420, 85455940)


def located(command: int, frame: int, p2: float = 0.0, height: float = 493.0) -> m.CommandInt:
    return m.CommandInt(-1.0, p2, 0.0, nan, *HERE_E7, height, command, 1, 1, frame, 0, 0)


def component(asked: m.CommandLong, number: int) -> m.CommandLong:
    return asked._replace(target_component=number)


COMMON: Final[dict[str, Asked]] = {
    "192 reposition long": long(192, -1, 1, 0, nan, 47.397742, 8.545594, 493.0),
    "192 int frame BODY_NED(8)": located(192, 8),
    "192 int frame MISSION(2)": located(192, 2),
    "193 pause": long(193, 0),
    "193 continue": long(193, 1),
    "178 speed -5": long(178, 1, -5, -1),
    "178 speed 3": long(178, 1, 3, -1),
    "115 yaw": long(115, 90, 20, 1, 0),
    "186 chalt": long(186, 8, 3),
    "34 orbit": long(34, 5, 1, 0, nan, nan, nan, nan),
    "2000 image": long(2000, 0, 0, 1),
    "2001 imagestop": long(2001),
    "2500 video": long(2500),
    "203 digicam": long(203, 0, 0, 0, 0, 1),
    "530 cam mode": long(530, 0, 0),
    "521 caminfo": long(521, 1),
    "1000 gimbal": long(1000, -10, 0, nan, nan, 0, 0, 0),
    "205 mount": long(205, -10, 0, 0, 0, 0, 0, 2),
    "401 prearm": long(401),
    "420 inject failure gps ok": long(420, 4, 0, 0),
    "224 set mission cur": long(224, 0),
    "224 set cur 99": long(224, 99),
    "187 actuator": long(187, 0, nan, nan, nan, nan, nan, 0),
    "310 actuator test": long(310, 0, 1, 0, 0, 33),
    "84 vtol takeoff": long(84, 0, 0, 0, nan, nan, nan, 493.0),
    "3000 transition": long(3000, 3),
    "211 gripper": long(211, 1, 0),
    "206 trigdist": long(206, 10, 0, 1),
    "218 aux": long(218, 9, 2),
    "183 servo": long(183, 9, 1500),
    "245 storage": long(245, 1),
    "511 no": long(511, 0, 1e6),
    "93 navdelay": long(93, 1),
    "400 arm comp 25": component(long(400, 1), 25),
    "400 disarm broadcast comp0": component(long(400, 0, target=0), 0),
    "185 termination 0": long(185, 0),
    "207 fence enable": long(207, 1),
    "207 fence disable": long(207, 0),
    "209 motor test": long(209, 1, 0, 5, 1, 1),
    "246 reboot comp cam": long(246, 0, 0, 1, 100),
    "241 calib none": long(241),
    "300 mission_start none": long(300),
    "519 protocol": long(519, 1),
    "511 unknown 9999": long(511, 9999, 1e6),
    "arm try 1": long(400, 1),
    "takeoff in air": long(22, 0, 0, 0, nan, nan, nan, 489.0),
    "22 takeoff disarmed": long(22, 0, 0, 0, 0, 0, 0, 5),
    "disarm in air": long(400, 0),
    "offboard without stream": long(176, 1, 6),
    "21 land disarmed": long(21, 0, 0, 0, nan, nan, nan, nan),
    "20 rtl disarmed": long(20),
    "land": long(21, 0, 0, 0, nan, nan, nan, nan),
    "176 mode OFFBOARD": long(176, 1, 6),
    "176 mode RTL": long(176, 1, 4, 5),
    "176 mode MISSION": long(176, 1, 4, 4),
    "176 mode bogus": long(176, 1, 99),
    "176 mode bogussub": long(176, 1, 4, 99),
    "176 mode AUTO": long(176, 1, 3),
}
TAKE_OFF_AGAIN: Final = long(22, 0, 0, 0, 0, 0, 0, 5)

# After "218 aux" the recorded PX4 had landed and disarmed: these rows of "air" are of the ground.
LANDED: Final = {"245 storage", "511 no", "93 navdelay", "400 disarm broadcast comp0"}

CAMERA: Final = "a camera is part of this vehicle; real autopilots have one on another component"
FAULTS: Final = "failures can be injected into both, without a simulator's parameters"
ON_PURPOSE: Final[dict[tuple[Personality, str], str]] = {
    ("px4", "2000 image"): CAMERA,
    ("px4", "2001 imagestop"): CAMERA,
    ("px4", "530 cam mode"): CAMERA,
    ("px4", "521 caminfo"): CAMERA,
    ("ardupilot", "2000 image"): CAMERA,
    ("ardupilot", "530 cam mode"): CAMERA,
    ("ardupilot", "521 caminfo"): CAMERA,
    ("px4", "420 inject failure gps ok"): FAULTS,
    ("ardupilot", "420 inject failure gps ok"): FAULTS,
    ("px4", "84 vtol takeoff"): "the mode that it changes to is not flown here",
    ("ardupilot", "400 arm comp 25"): "in the air: the recorded one had been disarmed and had not"
    " settled; on the ground it agrees",
    ("ardupilot", "400 disarm broadcast comp0"): "the recorded ack is that of another state than"
    " its label says: a disarmed vehicle accepts",
}
ON_THE_GROUND_ALIKE: Final = {("ardupilot", "400 arm comp 25")}


def recorded(personality: Personality) -> tuple[list[list[str]], list[tuple[int, str, str, str]]]:
    path = Path(__file__).parent / f"real_acks_{personality}.json"
    rows = json.loads(path.read_text(encoding="ascii"))
    return rows["commands"], rows["requests"]


def rows_of(personality: Personality) -> list[Row]:
    return [(personality, row[0], row[1], row[2]) for row in recorded(personality)[0]]


def in_stage(personality: Personality, stage: str, what: str) -> Flown:
    landed = personality == "px4" and what in LANDED
    if stage in ("air", "flight", "land") and not landed:
        return in_the_air(personality)
    return on_the_ground(personality)


def differs(personality: Personality, stage: str, what: str) -> bool:
    alike = stage == "ground" and (personality, what) in ON_THE_GROUND_ALIKE
    return (personality, what) in ON_PURPOSE and not alike


@pytest.mark.parametrize(
    ("personality", "stage", "what", "real"),
    [*rows_of("px4"), *rows_of("ardupilot")],
    ids=lambda part: part if isinstance(part, str) else None,
)
def test_a_command_is_answered_as_by_the_real_one(
    personality: Personality, stage: str, what: str, real: str
) -> None:
    bench = in_stage(personality, stage, what)
    asked = COMMON[what]
    if what == "takeoff in air" and personality == "ardupilot":
        asked = TAKE_OFF_AGAIN
    answered = bench.result(asked) == RESULTS[real]
    assert answered is not differs(personality, stage, what)


TEXTS: Final = [
    (personality, row[0], row[1], text)
    for personality in ("px4", "ardupilot")
    for row in recorded(personality)[0]
    if len(row) > 3
    for text in row[3]
]
UNSAID: Final = {
    "SIM Hit ground at 2.447183 m/s": "ArduPilot's simulator says it, not the autopilot",
    "Disarmed by landing\t": "of a landing that was under way when 218 was sent",
    "Using minimum takeoff altitude: 2.50 m\t": "the take-off in the air changes nothing here",
}


@pytest.mark.parametrize(
    ("personality", "stage", "what", "text"), [row for row in TEXTS if row[3] not in UNSAID]
)
def test_a_command_is_followed_by_the_real_ones_text(
    personality: Personality, stage: str, what: str, text: str
) -> None:
    bench = in_stage(personality, stage, what)
    heard = bench.send(COMMON[what]) + bench.advance(2 * S)
    assert text in bench.texts(heard)


# ------------------------------------------------------------------------- REQUEST_MESSAGE

CAMERA_MESSAGES: Final[dict[Personality, set[int]]] = {
    "px4": {259, 260, 262},
    "ardupilot": {259, 260, 261, 262, 263},
}
NOT_BUILT: Final[dict[Personality, set[int]]] = {
    # COMPONENT_INFORMATION
    "px4": {395},
    # AHRS2, AHRS, SCALED_IMU2, TERRAIN_REPORT: sensors and a terrain that there are not;
    # ATTITUDE_TARGET, POSITION_TARGET_LOCAL_NED: no target on the ground.
    "ardupilot": {83, 85, 116, 136, 163, 178},
}
EARLY: Final = {32}
"""The recorded ArduCopter had no position yet; this vehicle has one after half a second."""
STREAMED: Final[dict[Personality, set[int]]] = {"px4": {77, 83, 85}, "ardupilot": {77}}
"""What PX4 denied came all the same, as a stream or as the ack itself."""


@pytest.mark.slow
@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_messages_are_to_be_had_as_from_the_real_one(personality: Personality) -> None:
    bench = on_the_ground(personality)
    differing: set[int] = set()
    for number, _, result, sent in recorded(personality)[1]:
        asked = long(512, number)
        heard = bench.send(asked)
        ((_, told),) = acks(heard)
        came = any(m.IDS[type(each)] == number for each in heard)
        alike = number in STREAMED[personality] or came is (sent == "sent")
        if told != RESULTS[result] or not alike:
            differing.add(number)
        bench.advance(4 * S)
    assert differing == NOT_BUILT[personality] | CAMERA_MESSAGES[personality] | (
        EARLY if personality == "ardupilot" else set()
    )
