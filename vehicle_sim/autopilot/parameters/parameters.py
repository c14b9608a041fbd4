"""Parameters: taken as the real autopilots take them, read live, in SI where asked by meaning.

A client sees what was set, by the name and in the unit of the firmware that is played.  The
vehicle reads by *canonical* name and unit, those of the oldest firmware, and reads the nearest
value with which it can fly: both real autopilots take almost any value.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum
from functools import cache
from math import inf, isfinite, isnan
from typing import TypeVar

from vehicle_sim.autopilot.firmware import Firmware, firmware_of
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.tables import RENAMED, TABLES, ParameterSpec, Renamed, listed
from vehicle_sim.autopilot.parameters.tables.spec import LIMITS, StoredAs
from vehicle_sim.autopilot.rules import RULES, AutopilotRules


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


@dataclass(frozen=True, slots=True)
class _Known:
    """What all vehicles of a personality and firmware share."""

    specs: dict[str, ParameterSpec]  # by listed name
    canonical: dict[str, ParameterSpec]  # by canonical name
    renamed: dict[str, Renamed]  # by canonical name
    canonical_names: dict[str, str]  # by listed name
    stored: dict[str, float]  # the defaults by listed name
    in_use: dict[str, float]  # the same by canonical name


@cache
def _known(personality: Personality, firmware: Firmware) -> _Known:
    specs = {spec.name: spec for spec in listed(personality, firmware)}
    canonical = {spec.name: spec for spec in TABLES[personality]}
    renamed = RENAMED.get(firmware, {})
    listed_names = {name: renamed[name].new if name in renamed else name for name in canonical}
    stored = {name: _fitted(personality, spec, spec.default) for name, spec in specs.items()}
    in_use = {
        name: _usable(spec, renamed.get(name), stored[listed_names[name]])
        for name, spec in canonical.items()
    }
    names = {new: old for old, new in listed_names.items()}
    return _Known(specs, canonical, renamed, names, stored, in_use)


def _with_others(known: _Known, names: Iterable[str]) -> _Known:
    """Those that no table has are kept as floats, in the order of names."""
    inert = {
        name: ParameterSpec(name, StoredAs.REAL32, 0.0, -inf, inf, "of a file", inert=True)
        for name in names
        if name not in known.specs
    }
    if not inert:
        return known
    zeros = dict.fromkeys(inert, 0.0)
    return _Known(
        dict(sorted({**known.specs, **inert}.items())),
        {**known.canonical, **inert},
        known.renamed,
        {**known.canonical_names, **{name: name for name in inert}},
        {**known.stored, **zeros},
        {**known.in_use, **zeros},
    )


class Parameters:
    """The values of one vehicle.  `version` grows with every change."""

    __slots__ = (
        "_caps",
        "_defaults",
        "_in_use",
        "_kept",
        "_known",
        "_si",
        "_stored",
        "firmware",
        "personality",
        "rules",
        "version",
    )

    def __init__(
        self,
        personality: Personality,
        firmware: Firmware | None = None,
        others: Iterable[str] = (),
    ) -> None:
        """Of the usual firmware unless one is given.  Raises FirmwareError for another's.

        `others` are floats that nothing here depends on, beside those of the tables.
        """
        self.personality = personality
        self.rules: AutopilotRules = RULES[personality]
        self.firmware = firmware_of(personality, firmware)
        self._known = _with_others(_known(personality, self.firmware), others)
        self._stored = self._known.stored.copy()
        self._in_use = self._known.in_use.copy()
        self._si = _SI[personality]
        self._caps = _CAPS[personality]
        self._defaults: dict[str, float] = {}  # this vehicle's own, by listed name
        self._kept: dict[str, float] | None = None  # what was set since all was erased
        self.version = 0

    @property
    def specs(self) -> tuple[ParameterSpec, ...]:
        """In the order of their indices, which is that of their names."""
        return tuple(self._known.specs.values())

    def __contains__(self, name: object) -> bool:
        return name in self._known.specs

    def __len__(self) -> int:
        return len(self._known.specs)

    def spec(self, name: str) -> ParameterSpec:
        """By its name in this firmware.  Raises ParameterError for an unknown name."""
        return _found(self._known.specs, name)

    def value(self, name: str) -> float:
        """As it was set, by its name in this firmware.  Raises ParameterError."""
        return _found(self._stored, name)

    def get(self, name: str) -> float:
        """What the vehicle acts on, by canonical name and in that one's unit.

        The nearest value within the bounds of the parameter's table.  Raises ParameterError.
        """
        try:  # here and not in a function: it is read a thousand times a second
            return self._in_use[name]
        except KeyError:
            raise ParameterError(f"{name}: no such parameter") from None

    def designed(self, name: str) -> float:
        """What it acts on where nothing was set, by canonical name.  Raises ParameterError."""
        return _found(self._known.in_use, name)

    def default(self, name: str) -> float:
        """What a reset of this vehicle gives, by its name in this firmware.

        Raises ParameterError.
        """
        stored = _found(self._known.stored, name)
        return self._defaults.get(name, stored)

    def start_with(self, name: str, value: float) -> None:
        """Sets a value that a reset of this vehicle gives again.  Raises ParameterError."""
        self._defaults[name] = self.set(name, value)

    def start_as(self, system: int) -> None:
        """With this MAVLink system id, also after a reset.  Raises ParameterError."""
        name, _ = self._si[Quantity.SYSTEM_ID]
        assert name is not None
        renamed = self._known.renamed.get(name)
        self.start_with(name if renamed is None else renamed.new, system)

    def reset(self) -> None:
        """Every parameter back to its default."""
        self._kept = None
        for name in self._known.specs:
            self._store(name, self.default(name))

    def erase(self) -> None:
        """The stored ones are gone; those in use go with the next power-up."""
        self._kept = {}

    def power_up(self) -> None:
        """What is stored is read."""
        kept = self._kept
        if kept is None:
            return
        self.reset()
        for name, value in kept.items():
            self._store(name, value)

    def set(self, name: str, value: float) -> float:
        """Take `value` and return what is stored now (float32, or whole).

        Raises ParameterError, and keeps the old value, for an unknown name and for what the
        autopilot does not take: NaN; px4 a fraction or more than 32 bits for an integer;
        ardupilot infinity.  ArduPilot cuts a fraction off an integer, and too large a one to
        what its type holds.
        """
        stored = _fitted(self.personality, self.spec(name), value)
        if self._kept is not None:
            self._kept[name] = stored
        self._store(name, stored)
        return stored

    def _store(self, name: str, stored: float) -> None:
        if stored == self._stored[name]:
            return
        self._stored[name] = stored
        known = self._known
        canonical = known.canonical_names[name]
        self._in_use[canonical] = _usable(
            known.canonical[canonical], known.renamed.get(canonical), stored
        )
        self.version += 1

    def si(self, quantity: Quantity) -> float:
        """A quantity in SI units, from whatever parameter of the personality holds it."""
        name, factor = self._si[quantity]
        if name is None:
            return factor
        value, cap = self._in_use[name] * factor, self._caps.get(quantity)
        return value if cap is None else min(value, self._in_use[cap])


_Thing = TypeVar("_Thing")


def _found(among: dict[str, _Thing], name: str) -> _Thing:
    try:
        return among[name]
    except KeyError:
        raise ParameterError(f"{name}: no such parameter") from None


def _fitted(personality: Personality, spec: ParameterSpec, value: float) -> float:
    """As the autopilot stores `value`.  Raises ParameterError for what it does not take."""
    rules = RULES[personality]
    if isnan(value) or not (rules.infinite_parameters or isfinite(value)):
        raise ParameterError(f"{spec.name}: {value} is not a number")
    if not spec.integer:
        return _float32(value)
    low, high = LIMITS[spec.stored_as]
    if rules.cuts_parameters_to_fit:
        return float(int(min(max(value, low), high)))
    if not low <= value <= high or value != int(value):
        raise ParameterError(f"{spec.name}: {value:g} is not a whole number of 32 bits")
    return float(value)


def _usable(spec: ParameterSpec, renamed: Renamed | None, stored: float) -> float:
    """What the vehicle acts on, in the canonical unit."""
    value = stored if renamed is None else renamed.to_old(stored)
    low, high = spec.low, spec.high
    if spec.stored_as is StoredAs.REAL32:
        value, low, high = _float32(value), _float32(low), _float32(high)
    return min(max(value, low), high)


def _float32(value: float) -> float:
    if not isfinite(value) or abs(value) > LIMITS[StoredAs.REAL32][1]:
        return inf if value > 0.0 else -inf
    return float(struct.unpack("<f", struct.pack("<f", value))[0])
