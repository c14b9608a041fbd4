"""Parameters: checked when set, read live by the autopilot, in SI where it asks by meaning."""

from __future__ import annotations

import struct
from enum import Enum
from math import isfinite

from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.tables import ARDUPILOT, PX4, ParameterSpec

TABLES: dict[Personality, tuple[ParameterSpec, ...]] = {"px4": PX4, "ardupilot": ARDUPILOT}


class ParameterError(ValueError):
    """An unknown name, or a value that the parameter does not take."""


class Quantity(Enum):
    """What the autopilot wants to know, whatever the personality calls it."""

    SYSTEM_ID = "system id"
    CRUISE_M_S = "cruise"
    FASTEST_M_S = "fastest"
    CLIMB_M_S = "climb"
    DESCEND_M_S = "descend"
    TAKEOFF_CLIMB_M_S = "take-off climb"
    LAND_M_S = "land"
    LAND_SLOW_BELOW_M = "land slow below"
    ACCEL_M_S2 = "acceleration"
    ACCEL_VERTICAL_M_S2 = "downward acceleration"
    ACCEL_UP_M_S2 = "upward acceleration"
    TURN_RAD_S = "turn"
    ACCEPT_M = "waypoint radius"
    SPOOL_UP_S = "spool up"
    TAKEOFF_UP_M = "take-off height"
    RETURN_UP_M = "return height"
    RETURN_WAIT_UP_M = "return waiting height"
    RETURN_WAIT_S = "return wait"
    SETPOINT_LOSS_S = "setpoint loss"
    STATION_LOSS_S = "station loss"
    EXPOSURE_S = "exposure"
    DISARM_LANDED_S = "disarm after landing"
    DISARM_IDLE_S = "disarm if not taken off"


_DEG = 0.017453292519943295

_Q = Quantity
# A name and its factor to SI; None where the autopilot has no such parameter: then the factor
# is the value itself.
_SI: dict[Personality, dict[Quantity, tuple[str | None, float]]] = {
    "px4": {
        _Q.SYSTEM_ID: ("MAV_SYS_ID", 1.0),
        _Q.CRUISE_M_S: ("MPC_XY_CRUISE", 1.0),
        _Q.FASTEST_M_S: ("MPC_XY_VEL_MAX", 1.0),
        _Q.CLIMB_M_S: ("MPC_Z_V_AUTO_UP", 1.0),
        _Q.DESCEND_M_S: ("MPC_Z_V_AUTO_DN", 1.0),
        _Q.TAKEOFF_CLIMB_M_S: ("MPC_TKO_SPEED", 1.0),
        _Q.LAND_M_S: ("MPC_LAND_SPEED", 1.0),
        _Q.LAND_SLOW_BELOW_M: ("MPC_LAND_ALT1", 1.0),
        _Q.ACCEL_M_S2: ("MPC_ACC_HOR", 1.0),
        _Q.ACCEL_VERTICAL_M_S2: ("MPC_ACC_DOWN_MAX", 1.0),
        _Q.ACCEL_UP_M_S2: ("MPC_ACC_UP_MAX", 1.0),
        _Q.TURN_RAD_S: ("MPC_YAWRAUTO_MAX", _DEG),
        _Q.ACCEPT_M: ("NAV_ACC_RAD", 1.0),
        _Q.SPOOL_UP_S: ("COM_SPOOLUP_TIME", 1.0),
        _Q.TAKEOFF_UP_M: ("MIS_TAKEOFF_ALT", 1.0),
        _Q.RETURN_UP_M: ("RTL_RETURN_ALT", 1.0),
        _Q.RETURN_WAIT_UP_M: ("RTL_DESCEND_ALT", 1.0),
        _Q.RETURN_WAIT_S: ("RTL_LAND_DELAY", 1.0),
        _Q.SETPOINT_LOSS_S: ("COM_OF_LOSS_T", 1.0),
        _Q.STATION_LOSS_S: ("COM_DL_LOSS_T", 1.0),
        _Q.EXPOSURE_S: ("CAM_EXPOSURE_S", 1.0),
        _Q.DISARM_LANDED_S: ("COM_DISARM_LAND", 1.0),
        _Q.DISARM_IDLE_S: ("COM_DISARM_PRFLT", 1.0),
    },
    "ardupilot": {
        _Q.SYSTEM_ID: ("SYSID_THISMAV", 1.0),
        _Q.CRUISE_M_S: ("WPNAV_SPEED", 0.01),
        _Q.FASTEST_M_S: (None, 20.0),
        _Q.CLIMB_M_S: ("WPNAV_SPEED_UP", 0.01),
        _Q.DESCEND_M_S: ("WPNAV_SPEED_DN", 0.01),
        _Q.TAKEOFF_CLIMB_M_S: ("WPNAV_SPEED_UP", 0.01),
        _Q.LAND_M_S: ("LAND_SPEED", 0.01),
        _Q.LAND_SLOW_BELOW_M: ("LAND_ALT_LOW", 0.01),
        _Q.ACCEL_M_S2: ("WPNAV_ACCEL", 0.01),
        _Q.ACCEL_VERTICAL_M_S2: ("WPNAV_ACCEL_Z", 0.01),
        _Q.ACCEL_UP_M_S2: ("WPNAV_ACCEL_Z", 0.01),
        _Q.TURN_RAD_S: ("ATC_SLEW_YAW", 0.01 * _DEG),
        _Q.ACCEPT_M: ("WPNAV_RADIUS", 0.01),
        _Q.SPOOL_UP_S: ("MOT_SPOOL_TIME", 1.0),
        _Q.TAKEOFF_UP_M: ("PILOT_TKOFF_ALT", 0.01),
        _Q.RETURN_UP_M: ("RTL_ALT", 0.01),
        # ArduCopter waits at the return height, then lands from there.
        _Q.RETURN_WAIT_UP_M: ("RTL_ALT", 0.01),
        _Q.RETURN_WAIT_S: ("RTL_LOIT_TIME", 0.001),
        _Q.SETPOINT_LOSS_S: ("GUID_TIMEOUT", 1.0),
        _Q.STATION_LOSS_S: ("FS_GCS_TIMEOUT", 1.0),
        _Q.EXPOSURE_S: ("CAM_EXPOSURE_S", 1.0),
        # After its own landings ArduCopter disarms at once, elsewhere by DISARM_DELAY.
        _Q.DISARM_LANDED_S: (None, 0.5),
        _Q.DISARM_IDLE_S: ("DISARM_DELAY", 1.0),
    },
}


# What a quantity never exceeds, whatever is set for it.
_CAPS: dict[Personality, dict[Quantity, str]] = {
    "px4": {
        _Q.CRUISE_M_S: "MPC_XY_VEL_MAX",
        _Q.CLIMB_M_S: "MPC_Z_VEL_MAX_UP",
        _Q.DESCEND_M_S: "MPC_Z_VEL_MAX_DN",
    },
    "ardupilot": {},
}


class Parameters:
    """The values of one vehicle.  `version` grows with every change."""

    __slots__ = ("_caps", "_erased", "_si", "_specs", "_values", "personality", "version")

    def __init__(self, personality: Personality) -> None:
        self.personality = personality
        self._specs = {spec.name: spec for spec in TABLES[personality]}
        self._values = {spec.name: _stored(spec, spec.default) for spec in TABLES[personality]}
        self._si = _SI[personality]
        self._caps = _CAPS[personality]
        self._erased = False
        self.version = 0

    @property
    def specs(self) -> tuple[ParameterSpec, ...]:
        """In the order of their indices, which is that of their names."""
        return tuple(self._specs.values())

    def __contains__(self, name: object) -> bool:
        return name in self._specs

    def __len__(self) -> int:
        return len(self._specs)

    def spec(self, name: str) -> ParameterSpec:
        """Raises ParameterError for an unknown name."""
        try:
            return self._specs[name]
        except KeyError:
            raise ParameterError(f"{name}: no such parameter") from None

    def get(self, name: str) -> float:
        """The value in the parameter's own unit (integers are whole).  Raises ParameterError."""
        try:
            return self._values[name]
        except KeyError:
            raise ParameterError(f"{name}: no such parameter") from None

    def default(self, name: str) -> float:
        """As it is stored.  Raises ParameterError."""
        spec = self.spec(name)
        return _stored(spec, spec.default)

    def reset(self) -> None:
        """Every parameter back to its default."""
        self._erased = False
        for name in self._specs:
            self.set(name, self.default(name))

    def erase(self) -> None:
        """The stored ones are gone; those in use go with the next power-up."""
        self._erased = True

    def power_up(self) -> None:
        """What is stored is read."""
        if self._erased:
            self.reset()

    def set(self, name: str, value: float) -> float:
        """Take `value` and return what is stored now (float32, or whole).

        Raises ParameterError, and keeps the old value, for an unknown name and for a value that
        is not finite, out of range, or not whole where the parameter is an integer.
        """
        spec = self.spec(name)
        if not isfinite(value):
            raise ParameterError(f"{name}: {value} is not a number")
        if spec.integer and value != int(value):
            raise ParameterError(f"{name}: {value} is not a whole number")
        stored = _stored(spec, value)
        if not _stored(spec, spec.low) <= stored <= _stored(spec, spec.high):
            raise ParameterError(f"{name}: {value:g} is not in {spec.low:g} .. {spec.high:g}")
        if stored != self._values[name]:
            self._values[name] = stored
            self.version += 1
        return stored

    def si(self, quantity: Quantity) -> float:
        """A quantity in SI units, from whatever parameter of the personality holds it."""
        name, factor = self._si[quantity]
        if name is None:
            return factor
        value, cap = self._values[name] * factor, self._caps.get(quantity)
        return value if cap is None else min(value, self._values[cap])


def _stored(spec: ParameterSpec, value: float) -> float:
    """As the wire can carry it: int32 or float32."""
    if spec.integer:
        return float(int(value))
    if abs(value) > 3.4e38:
        return value
    return float(struct.unpack("<f", struct.pack("<f", value))[0])
