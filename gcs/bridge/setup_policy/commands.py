"""Commands that change a vehicle's set-up: which key of the policy each stands under."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Literal, TypeAlias

from gcs.gate.policy.policy import BridgeRules
from gcs.wire.dialect import ENUMS
from gcs.wire.messages import CommandInt, CommandLong

Key: TypeAlias = Literal[
    "fence", "home", "origin", "calibration", "reboot", "termination", "parameters", "downloads"
]


@dataclass(frozen=True, slots=True)
class CommandRow:
    """`key` is the policy's, in `[bridge]`; None: never, whatever the policy says.

    `what` begins the sentence of a refusal.
    """

    name: str
    key: Key | None
    what: str


_ROWS: Final = (
    CommandRow("DO_SET_HOME", "home", "moving home"),
    CommandRow("DO_SET_GLOBAL_ORIGIN", "origin", "moving the origin of the local frame"),
    CommandRow("DO_FENCE_ENABLE", "fence", "switching the vehicle's own fence"),
    CommandRow("PREFLIGHT_CALIBRATION", "calibration", "calibrating"),
    CommandRow("PREFLIGHT_SET_SENSOR_OFFSETS", "calibration", "setting the offsets of sensors"),
    CommandRow("DO_START_MAG_CAL", "calibration", "calibrating the compass"),
    CommandRow("DO_ACCEPT_MAG_CAL", "calibration", "taking over a calibration of the compass"),
    CommandRow("DO_CANCEL_MAG_CAL", "calibration", "ending a calibration of the compass"),
    CommandRow("FIXED_MAG_CAL", "calibration", "calibrating the compass"),
    CommandRow("FIXED_MAG_CAL_FIELD", "calibration", "calibrating the compass"),
    CommandRow("FIXED_MAG_CAL_YAW", "calibration", "calibrating the compass"),
    CommandRow("ACCELCAL_VEHICLE_POS", "calibration", "calibrating the accelerometer"),
    CommandRow("PREFLIGHT_REBOOT_SHUTDOWN", "reboot", "rebooting or shutting down"),
    CommandRow("DO_FLIGHTTERMINATION", "termination", "ending the flight by stopping the motors"),
    CommandRow("PREFLIGHT_STORAGE", "parameters", "setting parameters back to defaults"),
    CommandRow("LOGGING_START", "downloads", "sending the log as it is written"),
    CommandRow("INJECT_FAILURE", None, "making something fail"),
    CommandRow("PREFLIGHT_UAVCAN", None, "configuring what is on the CAN bus"),
)

_NUMBERS: Final = {
    entry.name.removeprefix("MAV_CMD_"): entry.value for entry in ENUMS["MAV_CMD"].entries
}

ROWS: Final[Mapping[int, CommandRow]] = MappingProxyType({_NUMBERS[r.name]: r for r in _ROWS})
"""By MAV_CMD."""

_READ_OR_WRITE: Final = frozenset({0, 1})
"""Read from storage, write to it; 2 and above set defaults, or erase."""


def storage_keeps(message: CommandLong | CommandInt) -> bool:
    """Whether PREFLIGHT_STORAGE changes nothing: neither parameters (param1) nor the mission
    (param2), and begins no log (param3)."""
    stored = (message.param1, message.param2)
    return _READ_OR_WRITE.issuperset(stored) and message.param3 == 0


def choice_of(key: Key, rules: BridgeRules) -> str:
    """What the policy says at `key`."""
    match key:
        case "fence":
            return rules.fence
        case "home":
            return rules.home
        case "origin":
            return rules.origin
        case "calibration":
            return rules.calibration
        case "reboot":
            return rules.reboot
        case "termination":
            return rules.termination
        case "parameters":
            return rules.parameters
        case "downloads":
            return rules.downloads
