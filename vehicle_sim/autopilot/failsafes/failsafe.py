"""The vehicle's own failsafes, as tables: which parameter value means which action.

What triggers them is found by `failsafe_checks.py` and `failure_detector.py`; what they do is
carried out by `autopilot/failsafe_actions.py`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, IntEnum, auto
from typing import TypeAlias

from vehicle_sim.autopilot.interface import Power
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters


class Action(Enum):
    """What to do, worse downwards: of two that strike the worse wins (PX4's own order).

    The values from POSITION to LAND are modes by meaning.  DESCEND is a landing without a
    position: level, wherever the wind takes it.
    """

    WARN = "warn"
    POSITION = "position"
    ALTITUDE = "altitude"
    MANUAL = "manual"
    HOLD = "hold"
    BRAKE = "brake"
    RETURN = "return"
    LAND = "land"
    DESCEND = "descend"
    DISARM = "disarm"
    TERMINATE = "terminate"


RANK = {action: rank for rank, action in enumerate(Action)}


class Cause(Enum):
    """Why; each strikes by itself, and is told and acted on once until it has gone."""

    BATTERY = auto()
    STATION = auto()
    STICKS = auto()
    FENCE = auto()
    POSITION = auto()
    SETPOINTS = auto()
    ATTITUDE = auto()
    MOTOR = auto()


@dataclass(frozen=True, slots=True)
class Failsafe:
    """One that has just struck: what to do, the sentence for it, and its MAV_SEVERITY.

    `delayed`: PX4 holds for COM_FAIL_ACT_T first, so that the operator can take over.
    """

    cause: Cause
    action: Action
    text: str
    severity: int
    delayed: bool = False


_PX4_ACTION_WORDS = {
    Action.POSITION: "Position mode",
    Action.ALTITUDE: "Altitude mode",
    Action.MANUAL: "Stabilized mode",
    Action.HOLD: "Hold",
    Action.RETURN: "RTL",
    Action.LAND: "Land",
    Action.DESCEND: "Descend",
    Action.DISARM: "Disarm",
    Action.TERMINATE: "Terminate",
}


def activated(action: Action, cause: str = "") -> str:
    """What PX4 says when a failsafe acts (events of commander's failsafe framework)."""
    due = f" due to {cause}" if cause else ""
    if action is Action.WARN:
        return f"Failsafe activated{due}"
    return f"Failsafe activated{due}, triggering {_PX4_ACTION_WORDS[action]}"


# --------------------------------------------------------------------------- actions by parameter


@dataclass(frozen=True, slots=True, eq=False)
class Choice:
    """The parameter that says what is done about a cause, and what each of its values means."""

    parameter: str
    actions: dict[int, Action]

    def of(self, parameters: Parameters) -> Action | None:
        """None: nothing."""
        return self.actions.get(int(parameters.get(self.parameter)))


OFFBOARD_LOSS: dict[int, Action] = {
    0: Action.POSITION,
    1: Action.ALTITUDE,
    2: Action.MANUAL,
    3: Action.RETURN,
    4: Action.LAND,
    5: Action.HOLD,
    6: Action.TERMINATE,
    7: Action.DISARM,
}
"""COM_OBL_RC_ACT."""

MOTOR_FAILURE: dict[int, Action] = {
    0: Action.WARN,
    1: Action.HOLD,
    2: Action.LAND,
    3: Action.RETURN,
    4: Action.TERMINATE,
}
"""COM_ACT_FAIL_ACT."""


class Charge(IntEnum):
    """How full the battery is, worse upwards."""

    FINE = 0
    LOW = 1
    CRITICAL = 2
    EMERGENCY = 3


Thresholds: TypeAlias = tuple[tuple[Charge, str], ...]
"""Below which parameter's value the battery is how empty, the worst first."""

REMAINING: Thresholds = (
    (Charge.EMERGENCY, "BAT_EMERGEN_THR"),
    (Charge.CRITICAL, "BAT_CRIT_THR"),
    (Charge.LOW, "BAT_LOW_THR"),
)
"""PX4's, of the charge that is left (0..1)."""
VOLTAGE: Thresholds = ((Charge.CRITICAL, "BATT_CRT_VOLT"), (Charge.LOW, "BATT_LOW_VOLT"))
"""ArduPilot's, of the voltage; 0 = off."""
CAPACITY: Thresholds = ((Charge.CRITICAL, "BATT_CRT_MAH"), (Charge.LOW, "BATT_LOW_MAH"))
"""ArduPilot's, of the charge that is left [mAh]; 0 = off."""


def highest(parameters: Parameters, thresholds: Thresholds) -> float:
    """Down to this the battery is fine."""
    return max(parameters.get(name) for _, name in thresholds)


def _below(parameters: Parameters, thresholds: Thresholds, value: float) -> Charge:
    for charge, name in thresholds:
        if value < parameters.get(name):
            return charge
    return Charge.FINE


def charge_of(parameters: Parameters, power: Power, remaining: float) -> Charge:
    """Where the battery stands by the personality's thresholds; `remaining` is 0..1."""
    return _CHARGE_OF[parameters.personality](parameters, power, remaining)


def _px4_charge(parameters: Parameters, power: Power, remaining: float) -> Charge:
    return _below(parameters, REMAINING, remaining)


def _copter_charge(parameters: Parameters, power: Power, remaining: float) -> Charge:
    return max(by_voltage(parameters, power), by_capacity(parameters, power))


_CHARGE_OF: dict[Personality, Callable[[Parameters, Power, float], Charge]] = {
    "px4": _px4_charge,
    "ardupilot": _copter_charge,
}


def _measured(parameters: Parameters) -> bool:
    return parameters.get("BATT_MONITOR") != 0


def by_voltage(parameters: Parameters, power: Power) -> Charge:
    """By ArduPilot's thresholds of the voltage."""
    return _below(parameters, VOLTAGE, power.voltage_v) if _measured(parameters) else Charge.FINE


def by_capacity(parameters: Parameters, power: Power) -> Charge:
    """By ArduPilot's thresholds of the charge left."""
    if not _measured(parameters):
        return Charge.FINE
    left_mah = parameters.get("BATT_CAPACITY") - power.consumed_mah
    return _below(parameters, CAPACITY, left_mah)
