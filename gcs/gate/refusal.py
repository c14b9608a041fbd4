"""The reason of a refusal: a code, a sentence, the numbers, and the zone of the fence."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Code(StrEnum):
    """Why a request was refused or ended otherwise than complete."""

    BUSY = "BUSY"
    NO_VEHICLE = "NO_VEHICLE"
    STALE = "STALE"
    NO_POSITION = "NO_POSITION"
    NOT_IN_CONTROL = "NOT_IN_CONTROL"
    CONTROL_PENDING = "CONTROL_PENDING"
    NOT_ARMED = "NOT_ARMED"
    NOT_FLYING = "NOT_FLYING"
    ALREADY_FLYING = "ALREADY_FLYING"
    HOLDING = "HOLDING"
    NON_FINITE = "NON_FINITE"
    OUTSIDE_FENCE = "OUTSIDE_FENCE"
    INSIDE_EXCLUSION = "INSIDE_EXCLUSION"
    TOO_CLOSE = "TOO_CLOSE"
    TOO_HIGH = "TOO_HIGH"
    TOO_LOW = "TOO_LOW"
    TOO_FAR = "TOO_FAR"
    LEG_LEAVES_FENCE = "LEG_LEAVES_FENCE"
    CANNOT_STOP = "CANNOT_STOP"
    NO_ORIGIN = "NO_ORIGIN"
    RTL_BLOCKED = "RTL_BLOCKED"
    NO_MISSION = "NO_MISSION"
    BAD_MISSION = "BAD_MISSION"
    BAD_PARAMETER = "BAD_PARAMETER"
    SEVERITY = "SEVERITY"
    RECORDER_DOWN = "RECORDER_DOWN"
    POLICY = "POLICY"
    UNSUPPORTED = "UNSUPPORTED"
    IN_AIR = "IN_AIR"
    VEHICLE_REFUSED = "VEHICLE_REFUSED"
    NO_ANSWER = "NO_ANSWER"
    DEADLINE = "DEADLINE"
    OPERATOR = "OPERATOR"
    OPERATOR_LOST = "OPERATOR_LOST"
    FENCE_BREACH = "FENCE_BREACH"
    ESTIMATOR_RESET = "ESTIMATOR_RESET"
    HOME_MOVED = "HOME_MOVED"
    MODE_CHANGED = "MODE_CHANGED"
    VEHICLE_FAILSAFE = "VEHICLE_FAILSAFE"
    SUPERSEDED = "SUPERSEDED"
    LINK_LOST = "LINK_LOST"
    SEVERAL_VEHICLES = "SEVERAL_VEHICLES"
    UNSUPPORTED_VEHICLE = "UNSUPPORTED_VEHICLE"
    OTHER_OPERATOR = "OTHER_OPERATOR"
    NOT_RUNNING = "NOT_RUNNING"
    BATTERY_REACH = "BATTERY_REACH"
    OTHER_VEHICLE = "OTHER_VEHICLE"
    PREFLIGHT = "PREFLIGHT"
    NOT_ON_BOARD = "NOT_ON_BOARD"
    OWN_RULE = "OWN_RULE"
    OWN_RULE_FAILED = "OWN_RULE_FAILED"


@dataclass(frozen=True, slots=True)
class Refusal:
    """The reason of a refusal: a code for programs, a sentence for people, and the numbers.

    `numbers` are (name, value) pairs that the refusal was decided on, with the unit at the end of
    the name.  `zone` is the zone of the fence that refuses; empty where none does.
    """

    code: Code
    sentence: str
    numbers: tuple[tuple[str, float], ...] = ()
    zone: str = ""
