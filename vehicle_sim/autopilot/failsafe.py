"""The vehicle's own last resorts: what it does by itself about the battery and the silence.

Each parameter value maps to an action in a literal table; the autopilot carries it out.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, IntEnum

from vehicle_sim.autopilot.interface import Power
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters import Parameters, Quantity


class Action(Enum):
    """What to do.  POSITION, ALTITUDE, MANUAL, HOLD, RETURN and LAND are modes by meaning."""

    WARN = "warn"
    POSITION = "position"
    ALTITUDE = "altitude"
    MANUAL = "manual"
    HOLD = "hold"
    RETURN = "return"
    LAND = "land"
    TERMINATE = "terminate"
    DISARM = "disarm"


class Charge(IntEnum):
    """How full the battery is, worse upwards."""

    FINE = 0
    LOW = 1
    CRITICAL = 2
    EMERGENCY = 3


@dataclass(frozen=True, slots=True)
class Failsafe:
    """One that has just struck: what to do, the sentence for it, and its MAV_SEVERITY."""

    action: Action
    text: str
    severity: int


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

_STATION_LOSS: dict[Personality, tuple[str, dict[int, Action]]] = {
    "px4": (
        "NAV_DLL_ACT",
        {
            1: Action.HOLD,
            2: Action.RETURN,
            3: Action.LAND,
            5: Action.TERMINATE,
            6: Action.DISARM,
        },
    ),
    "ardupilot": ("FS_GCS_ENABLE", {1: Action.RETURN, 5: Action.LAND}),
}

_BATTERY: dict[Personality, dict[Charge, tuple[str, dict[int, Action]]]] = {
    "px4": {
        Charge.LOW: ("COM_LOW_BAT_ACT", {}),
        Charge.CRITICAL: ("COM_LOW_BAT_ACT", {2: Action.LAND, 3: Action.RETURN}),
        Charge.EMERGENCY: ("COM_LOW_BAT_ACT", {2: Action.LAND, 3: Action.LAND}),
    },
    "ardupilot": {
        Charge.LOW: (
            "BATT_FS_LOW_ACT",
            {1: Action.LAND, 2: Action.RETURN, 5: Action.TERMINATE},
        ),
        Charge.CRITICAL: (
            "BATT_FS_CRT_ACT",
            {1: Action.LAND, 2: Action.RETURN, 5: Action.TERMINATE},
        ),
        Charge.EMERGENCY: ("BATT_FS_CRT_ACT", {}),
    },
}


def charge_of(parameters: Parameters, power: Power, remaining: float) -> Charge:
    """Where the battery stands by the personality's thresholds; `remaining` is 0..1."""
    get = parameters.get
    if parameters.personality == "px4":
        if remaining < get("BAT_EMERGEN_THR"):
            return Charge.EMERGENCY
        if remaining < get("BAT_CRIT_THR"):
            return Charge.CRITICAL
        return Charge.LOW if remaining < get("BAT_LOW_THR") else Charge.FINE
    left_mah = get("BATT_CAPACITY") - power.consumed_mah
    if power.voltage_v < get("BATT_CRT_VOLT") or left_mah < get("BATT_CRT_MAH"):
        return Charge.CRITICAL
    if power.voltage_v < get("BATT_LOW_VOLT") or left_mah < get("BATT_LOW_MAH"):
        return Charge.LOW
    return Charge.FINE


class Failsafes:
    """Remembers what has struck, so that each is told and acted on once."""

    __slots__ = ("_parameters", "_station_ns", "charge", "station_lost")

    def __init__(self, parameters: Parameters) -> None:
        self._parameters = parameters
        self._station_ns: int | None = None
        self.station_lost = False
        self.charge = Charge.FINE

    def station_heard(self, wall_ns: int) -> None:
        self._station_ns = wall_ns
        self.station_lost = False

    def check(self, power: Power, remaining: float, wall_ns: int) -> Failsafe | None:
        """What strikes now, the worse first; called while armed."""
        parameters = self._parameters
        charge = charge_of(parameters, power, remaining)
        if charge > self.charge:
            self.charge = charge
            name, actions = _BATTERY[parameters.personality][charge]
            action = actions.get(int(parameters.get(name)), Action.WARN)
            return Failsafe(action, f"Battery {charge.name.lower()}: {action.value}", 4)
        if self._station_ns is None or self.station_lost:
            return None
        name, actions = _STATION_LOSS[parameters.personality]
        wanted = actions.get(int(parameters.get(name)))
        if wanted is None:
            return None
        if wall_ns - self._station_ns < int(parameters.si(Quantity.STATION_LOSS_S) * 1e9):
            return None
        self.station_lost = True
        return Failsafe(wanted, f"Ground station lost: {wanted.value}", 2)
