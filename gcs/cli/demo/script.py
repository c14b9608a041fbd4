"""The demo's flight as a table: what is asked, what is said about it, what must come of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import msgspec

from gcs import request_words
from gcs.config import SimConfig, StationConfig
from gcs.exit_codes import ExitCode
from gcs.operator.conversation import TrackedRequest
from gcs.operator.dialogue import Dialogue
from gcs.operator.errors import ExitError
from gcs.operator.line_parser import parse_line
from gcs.request_words import SendRequests

STEP_WAIT_S: Final = 40.0
COMPLETE: Final = "complete"
ABORTED: Final = "aborted OPERATOR"
BUSY: Final = "refused BUSY"
OUTSIDE: Final = "refused OUTSIDE_FENCE"
IN_THE_WAY: Final = "refused LEG_LEAVES_FENCE"

POLICY: Final = "demo"
MISSION: Final = "yard.toml"
FAILSAFES_ON: Final[Mapping[str, Mapping[str, float]]] = MappingProxyType(
    {
        "px4": MappingProxyType(
            {
                "NAV_DLL_ACT": 2.0,
                "GF_MAX_HOR_DIST": 37.0,
                "GF_MAX_VER_DIST": 12.0,
                "RTL_RETURN_ALT": 10.0,
            }
        ),
        "ardupilot": MappingProxyType(
            {
                "FS_GCS_ENABLE": 1.0,
                "BATT_FS_LOW_ACT": 2.0,
                "FENCE_ENABLE": 1.0,
                "FENCE_RADIUS": 37.0,
                "FENCE_ALT_MAX": 12.0,
                "RTL_ALT": 1000.0,
            }
        ),
    }
)
"""What the vehicle has switched off as delivered, or wider than the demo's fence: the station would
warn of it all the time."""

LOOK_S: Final = 1.6
"""How long the flight stands still after a refusal and an abort, for those who watch it later."""


@dataclass(frozen=True, slots=True)
class Step:
    """One request.  `{mission}` in the line stands for the mission file.

    `vehicle`: of a fleet, the one that it is for.  Where `wait` is False the next step follows the
    verdict, while this one is still under way.  Before the next step `pause_s` pass, of the
    vehicle's time.  A step that has something to `say` opens a paragraph: it begins when everything
    before has ended.
    """

    line: str
    expect: str = COMPLETE
    say: str = ""
    wait: bool = True
    pause_s: float = 0.0
    vehicle: int = 0


SCRIPT: Final[tuple[Step, ...]] = (
    Step("arm", say="Motors on, and up: a take-off takes control and ends in a hover."),
    Step("takeoff 3"),
    Step("control"),
    Step("goto 12 0 4", say="A goal in the yard, verified before it is flown."),
    Step(
        "goto 12 16 5",
        IN_THE_WAY,
        "The mast stands in the straight way: refused.  So round it.",
        pause_s=LOOK_S,
    ),
    Step("goto 2 8 6"),
    Step(
        "goto 60 8 5",
        OUTSIDE,
        "A goal outside the fence: it never reaches the vehicle.",
        pause_s=LOOK_S,
    ),
    Step(
        "photo",
        say="Taking a picture: a move that arrives meanwhile is refused.",
        wait=False,
        pause_s=0.4,
    ),
    Step("goto 2 0 5", BUSY, pause_s=LOOK_S),
    Step(
        "goto 9 18 5",
        ABORTED,
        "A longer move; another one on top of it is refused; then an abort.",
        wait=False,
        pause_s=1.2,
    ),
    Step("goto 0 0 4", BUSY, pause_s=0.8),
    Step("abort", pause_s=LOOK_S),
    Step("resume", say="After an abort the vehicle holds until an explicit resume."),
    Step("mission upload {mission}", say="A mission file: verified whole, uploaded, read back."),
    Step("mission start"),
    Step(
        "goto 22 0 4",
        say="Towards the fence: at each moment no faster than a stop still fits.",
    ),
    Step("land", say="Down again."),
    Step("disarm"),
)


def station_config(autopilot: str, log_dir: str, timeout_s: float) -> StationConfig:
    """The demo's station, with a vehicle of its own whose failsafes are all on."""
    return StationConfig(
        sim=SimConfig(autopilot=autopilot, params=dict(FAILSAFES_ON[autopilot])),
        policy_path=POLICY,
        log_dir=log_dir,
        name="demo",
        connect_timeout_s=timeout_s,
    )


FLEET: Final = 3
APART: Final = "refused OTHER_VEHICLE"
FLEET_SCRIPT: Final[tuple[Step, ...]] = (
    *(
        step
        for number in range(1, FLEET + 1)
        for step in (
            Step("arm", say=f"Vehicle {number} up." if number > 1 else "Up.", vehicle=number),
            Step("takeoff 5", vehicle=number),
        )
    ),
    Step("goto 20 0 5", say="They start 10 m from each other: apart.", wait=False, vehicle=2),
    Step("goto 0 20 5", vehicle=3),
    Step(
        "goto 20 20 5",
        say="Vehicle 1 flies north-east, and vehicle 2 would cross its way: refused.",
        wait=False,
        vehicle=1,
    ),
    Step("goto -5 15 5", APART, pause_s=LOOK_S, vehicle=2),
    Step("goto 20 0 15", say="Ten metres higher it may.", vehicle=2),
    Step("goto -5 15 15", vehicle=2),
    *(
        Step("land", say="Down again." if number == 1 else "", wait=False, vehicle=number)
        for number in range(1, FLEET + 1)
    ),
    Step("disarm", say="Motors off.", vehicle=1),
)
"""Each goal in its vehicle's own frame; vehicle 2 starts 10 m east of vehicle 1, vehicle 3 10 m
north of it."""


def fleet_config(autopilot: str, log_dir: str, timeout_s: float) -> StationConfig:
    """It flies all that it meets."""
    higher = {"px4": "GF_MAX_VER_DIST", "ardupilot": "FENCE_ALT_MAX"}[autopilot]
    failsafes = {**FAILSAFES_ON[autopilot], higher: 30.0}
    return StationConfig(
        fleet=True,
        sim=SimConfig(autopilot=autopilot, params=failsafes, count=FLEET),
        log_dir=log_dir,
        name="fleet",
        connect_timeout_s=timeout_s,
    )


def wait_for_fleet(dialogue: Dialogue, timeout_s: float) -> None:
    """Until every vehicle tells where it stands.  Raises ExitError."""

    def all_there() -> bool:
        met = dialogue.bridge.vehicles if dialogue.bridge else []
        return sum(each.pos_enu is not None for each in met) == FLEET

    dialogue.wait_until(all_there, timeout_s)
    if not all_there():
        raise ExitError(ExitCode.NO_VEHICLE, f"not all {FLEET} vehicles were heard")


@dataclass(slots=True)
class Flown:
    """A step and what became of it."""

    step: Step
    request: TrackedRequest

    @property
    def came_to(self) -> str:
        """`complete`, `refused BUSY`, `aborted OPERATOR`, ..., in the words of `expect`."""
        verdict, outcome = self.request.verdict, self.request.outcome
        if outcome is not None:
            code = "" if outcome.ended == COMPLETE else outcome.code
            return f"{outcome.ended} {code}".rstrip()
        if verdict is None:
            return "no answer"
        if verdict.outcome == "accepted":
            return "not completed"
        return f"{verdict.outcome} {verdict.code}".rstrip()

    @property
    def as_expected(self) -> bool:
        return self.came_to == self.step.expect


def wait_for_all(dialogue: Dialogue, flown: Sequence[Flown]) -> None:
    """Wait until every request is settled."""
    for one in flown:
        dialogue.wait_settled(one.request, STEP_WAIT_S)


def perform(dialogue: Dialogue, step: Step, mission_path: str) -> Flown:
    """Send its request and wait as the step says."""
    line = parse_line(step.line.format(mission=f'"{mission_path}"'))
    assert line is not None
    assert isinstance(line.action, SendRequests)
    (asked,) = line.action.requests
    label = f"vehicle {step.vehicle}: {request_words.label(asked)}" if step.vehicle else ""
    request = dialogue.send(msgspec.structs.replace(asked, vehicle=step.vehicle), label)
    if step.wait:
        dialogue.wait_settled(request, STEP_WAIT_S)
    else:
        dialogue.wait_until(lambda: request.verdict is not None, STEP_WAIT_S)
    if step.pause_s:
        _pause(dialogue, step.pause_s)
    return Flown(step, request)


def _pause(dialogue: Dialogue, seconds: float) -> None:
    """By the station's clock, which runs faster where the simulation does."""
    start_ns = _time_ns(dialogue)
    end_ns = start_ns + round(seconds * 1e9)
    dialogue.wait_until(lambda: _time_ns(dialogue) >= end_ns, STEP_WAIT_S)


def _time_ns(dialogue: Dialogue) -> int:
    return 0 if dialogue.snapshot is None else dialogue.snapshot.time_ns
