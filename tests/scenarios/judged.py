"""Why our vehicle differs where it does: every known difference has a judgement here."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from enum import Enum
from typing import Final

from vehicle_sim.autopilot.modes import Personality


class Judgement(Enum):
    """What a difference comes from."""

    SIMULATOR = "of the recorded simulator, not of the autopilot"
    AIRFRAME = "another airframe: it climbs, flies and lands in other times"
    UNTOLD = "the recording does not tell what was sent, or what was seen between two heartbeats"
    RACE = "two parts of PX4 answer, and either may be first"
    NOT_BUILT = "not built"


@dataclass(frozen=True)
class Judged:
    """`lines` is a pattern of what follows the scenario's name in a difference."""

    personality: Personality
    scenarios: str
    lines: str
    judgement: Judgement
    why: str


_J = Judgement
JUDGED: Final = (
    # ------------------------------------------------------------------------------- PX4
    Judged("px4", "A[125]_", r"\d landed: .*", _J.AIRFRAME, "lifts off a second earlier"),
    Judged("px4", "B[12]_", "text: RTL: .*", _J.AIRFRAME, "has come elsewhere by the same stick"),
    Judged("px4", "B1_", "text: Disarmed by landing", _J.AIRFRAME, "comes down from 5 m, not 2"),
    Judged("px4", "B2_", r"\d (mode|armed|landed): .*", _J.AIRFRAME, "comes down from 7 m, not 5"),
    Judged("px4", "B3_", "7 landed: .*", _J.AIRFRAME, "is down from 3 m already"),
    Judged("px4", "B3_", "text: Failsafe activated, .*", _J.AIRFRAME, "the delay that came back"
           " in a few seconds is rounded to another one"),
    Judged("px4", "B4_", r"\d mode: .*", _J.UNTOLD, "HOLD lay between two heartbeats"),
    Judged("px4", "D1_", "1 COMMAND_LONG .*", _J.RACE, "the shaken calibration still ran"),
    Judged("px4", "D[25]_", ".* MAV_CMD_PREFLIGHT_CALIBRATION: .*", _J.RACE,
           "the commander says TEMPORARILY_REJECTED, the procedure DENIED or ACCEPTED"),
    Judged("px4", "D2_", "text: command denied .*", _J.RACE, "said as long as the command stands"),
    Judged("px4", "D2_", r"text: (\[cal\] progress|motion, retrying).*", _J.SIMULATOR,
           "the last of 20 tries with a noisy gyroscope"),
    Judged("px4", "D[167]_|H6_", "text: Preflight Fail: .*(unstable|error)", _J.SIMULATOR,
           "the simulated estimator's velocity wanders at rest, and after a fall"),
    Judged("px4", "G1b_|G5_", "text: Failsafe activated", _J.NOT_BUILT,
           "said once more, just after arming with what was wrong before"),
    Judged("px4", "G3_", r"6 (mode|armed): .*", _J.AIRFRAME, "has landed and disarmed already"),
    # ------------------------------------------------------------------------- ArduCopter
    Judged("ardupilot", "", "text: SIM Hit ground .*", _J.SIMULATOR, "SITL's own"),
    Judged("ardupilot", "C2_", "(4 landed: .*|text: Disarming motors)", _J.AIRFRAME,
           "is still coming down from the return"),
    Judged("ardupilot", "D2_", ".*", _J.SIMULATOR,
           "SITL's GPS is not healthy for a while after the gyroscopes were calibrated"),
    Judged("ardupilot", "D3_", "text: (ArduCopter|3d12|Frame).*", _J.AIRFRAME,
           "another build, board and frame"),
    Judged("ardupilot", "F2c_|F4_", "4 mode: .*", _J.NOT_BUILT,
           "AVOID_ENABLE: velocities that lead out of the fence are stopped before it"),
    Judged("ardupilot", "F9b_action_3", "6 mode: .*", _J.NOT_BUILT, "SMART_RTL"),
    Judged("ardupilot", "F9b_action_5", "text: Fence breach cleared", _J.AIRFRAME,
           "is not back within the fence yet"),
    Judged("ardupilot", "G7_", ".*", _J.SIMULATOR, "SITL's copter drops with 9.7 V from 14 m"),
    Judged("ardupilot", "G8_", "8 landed: .*", _J.AIRFRAME, "is over its home already"),
    Judged("ardupilot", "H8_", "3 COMMAND_LONG .*", _J.SIMULATOR, "SITL dies of a NaN"),
    Judged("ardupilot", "I1_", "text: Disarming motors", _J.AIRFRAME, "is still coming down"),
)  # fmt: skip


def judged(personality: Personality, scenario: str, difference: str) -> list[Judged]:
    """Every judgement that fits a line of `known_differences`."""
    line = difference.removeprefix(f"{scenario} ")
    return [
        row
        for row in JUDGED
        if row.personality == personality
        and re.match(row.scenarios, scenario)
        and re.fullmatch(row.lines, line)
    ]


def by_judgement(personality: Personality, found: dict[str, list[str]]) -> Counter[Judgement]:
    """How many differences each judgement has, of those that have one."""
    rows = (judged(personality, name, line)[:1] for name, lines in found.items() for line in lines)
    return Counter(row[0].judgement for row in rows if row)
