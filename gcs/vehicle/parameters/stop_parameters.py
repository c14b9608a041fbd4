"""Parameters that the vehicle stops by: what another station makes of them is told.

The bounds of a stop in the policy were recorded with the values below.  Nothing is read for this:
an autopilot tells every station what one of them sets, and who reads all parameters is heard too.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from gcs.gate.effects import Level
from gcs.protocol.autopilot import Autopilot
from gcs.protocol.parameter_names import ParameterName, names_of
from gcs.protocol.parameters import decode_value
from gcs.session.work import Log
from gcs.wire.ids import ParamType
from gcs.wire.messages import ParamValue

NODE: Final = "vehicle"

RECORDED: Final[Mapping[str, Mapping[str, float]]] = {
    "px4": {
        "MPC_ACC_HOR": 3.0,
        "MPC_ACC_HOR_MAX": 5.0,
        "MPC_JERK_AUTO": 4.0,
        "MPC_JERK_MAX": 8.0,
        "MPC_TILTMAX_AIR": 45.0,
        "MPC_XY_CRUISE": 5.0,
        "MPC_XY_P": 0.95,
        "MPC_XY_VEL_D_ACC": 0.2,
        "MPC_XY_VEL_I_ACC": 0.4,
        "MPC_XY_VEL_MAX": 12.0,
        "MPC_XY_VEL_P_ACC": 1.8,
    },
    "ardupilot": {
        "ATC_ANGLE_MAX": 30.0,
        "GUID_OPTIONS": 0.0,
        "GUID_TIMEOUT": 3.0,
        "PSC_ANGLE_MAX": 0.0,
        "PSC_JERK_NE": 5.0,
        "PSC_NE_POS_P": 1.0,
        "PSC_NE_VEL_D": 0.25,
        "PSC_NE_VEL_I": 1.0,
        "PSC_NE_VEL_P": 2.0,
        "WP_ACC": 2.5,
        "WP_JERK": 1.0,
        "WP_SPD": 10.0,
    },
}
"""By the newest names, of PX4 1.14.3 and ArduCopter 4.7 as the bounds were recorded."""

NO_WORSE_IF_LESS: Final = frozenset({"GUID_TIMEOUT"})
"""The sooner it stops by itself where setpoints are silent, the shorter the way."""

SHORTER_IS_SAFER: Final = frozenset({"GUID_TIMEOUT"})
"""Less than the recorded value makes no stop longer; `gcs fence put` makes it less."""

TYPES: Final = frozenset(int(kind) for kind in ParamType)


@dataclass(frozen=True, slots=True)
class Stops:
    """What is known of them: `others` than those that the bounds were recorded with, in words, and
    the commands that set them so again; `unread`, by every name that each of them may have, first
    the one of the firmware that the vehicle seems to have."""

    others: tuple[str, ...] = ()
    mends: tuple[str, ...] = ()
    unread: tuple[tuple[str, ...], ...] = ()


class StopParameters:
    """Of one vehicle."""

    def __init__(self) -> None:
        self._values: dict[str, float] = {}
        self._names: dict[str, ParameterName] = {}
        """By the newest name: the one that this vehicle has it under."""

    def known(self, autopilot: str) -> Stops:
        """Of those that an autopilot of that name has."""
        recorded = RECORDED.get(autopilot, {})
        others = {
            name: value
            for name, value in recorded.items()
            if name in self._values and _differ(self._values[name], value)
            if name not in SHORTER_IS_SAFER or self._values[name] > value
        }
        older = any(name.name != newest for newest, name in self._names.items())
        return Stops(
            tuple(f"{name} is {self._values[name]:g}, not {v:g}" for name, v in others.items()),
            tuple(self._command(name, value) for name, value in others.items()),
            tuple(
                tuple(each.name for each in names_of(name))[:: -1 if older else 1]
                for name in recorded
                if name not in self._values
            ),
        )

    def _command(self, newest: str, value: float) -> str:
        name = self._names[newest]
        return f"gcs param set {name.name} {value / name.scale:g}"

    def heard(self, message: ParamValue, autopilot: Autopilot) -> list[Log]:
        """PARAM_VALUE of its autopilot: a line where the value is news, and not the recorded."""
        if message.param_type not in TYPES:
            return []
        for newest, recorded in RECORDED.get(autopilot.name, {}).items():
            for name in names_of(newest):
                if name.name == message.param_id:
                    kind = ParamType(message.param_type)
                    read = decode_value(message.param_value, kind, autopilot.param_encoding)
                    self._names[newest] = name
                    return self._told(newest, float(read) * name.scale, recorded)
        return []

    def _told(self, name: str, value: float, recorded: float) -> list[Log]:
        was = self._values.get(name)
        self._values[name] = value
        if not _differ(value, recorded if was is None else was):
            return []
        if name in NO_WORSE_IF_LESS and 0.0 < value < recorded:
            return []
        change = f"{name} is {value:g}" if was is None else f"{name} was {was:g} and is {value:g}"
        if not _differ(value, recorded):
            return [Log(Level.INFO, NODE, f"{change}, as when the bounds of a stop were recorded")]
        text = f"{change}: the bounds of a stop were recorded with {recorded:g}, and may not hold"
        return [Log(Level.WARNING, NODE, text)]


def _differ(one: float, other: float) -> bool:
    """Parameters are float32."""
    return not math.isclose(one, other, rel_tol=1e-4, abs_tol=1e-6)
