"""Which parameters make a vehicle obey its bridge, and what each must be: tables by autopilot.

PX4 asks its arm authorizer (COM_ARM_AUTH_*).  ArduPilot has no such question; its station number
says whose silence is a failsafe and whose sticks count, and it can be told to hear no other number
(SYSID_ENFORCE; from 4.7 on a bit of MAV_OPTIONS, from memory: of the recorded 4.7 the name alone is
known).  Where the fence is set, too, it is a cylinder about home with an action.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

ENFORCE: Final = 0b1
"""The bit of MAV_OPTIONS, and the value of SYSID_ENFORCE."""
HEIGHT_AND_CIRCLE: Final = 0b11
"""Of FENCE_TYPE."""
PX4_BREACH: Final = range(2, 6)
"""GF_ACTION: hold, return, terminate, land; 0 and 1 do nothing, and PX4 1.14 knows no other."""
COPTER_BREACH: Final = range(1, 6)
"""FENCE_ACTION: return, land, smart return, brake and smart return, or land; 0 reports only.  That
ArduCopter knows no other is from memory."""
COPTER_FENCE_ON: Final = 1
"""FENCE_ENABLE."""
PORTS: Final[Mapping[str, tuple[tuple[str, ...], ...]]] = {
    "px4": (("MAV_SIGN_CFG",),),
    "ardupilot": (
        tuple(f"SERIAL{port}_PROTOCOL" for port in range(10)),
        tuple(f"MAV{channel}_OPTIONS" for channel in range(1, 7)),
    ),
}
"""Parameters that tell which ports take unsigned frames although there is a key; of each row, those
behind the first one that a vehicle has not are not asked for."""
_SPEAKS_MAVLINK: Final = frozenset({1, 2, 43})
"""SERIALn_PROTOCOL: MAVLink 1, MAVLink 2, MAVLink High Latency."""
_SIGNING_OFF: Final = 0b1
"""Of MAVn_OPTIONS, ArduPilot 4.7."""
_MOST_BITS: Final = 1 << 24
"""A float has every whole number below."""
_STEP_M: Final = 0.5


@dataclass(frozen=True, slots=True)
class FenceSize:
    """The policy's, as a cylinder about home: how far, and how high above it, in metres."""

    reach_m: float
    ceiling_up_m: float


@dataclass(frozen=True, slots=True)
class Locking:
    """What the user wants.  `own_sysid`: the bridge's number; `fence`: None leaves it as it is."""

    own_sysid: int
    fence: FenceSize | None = None
    enforce_sysid: bool = False


@dataclass(frozen=True, slots=True)
class Wanted:
    """One parameter by its newest name.  `becomes` is given what it is, and answers what it is to
    be: the same where it is right already."""

    name: str
    becomes: Callable[[float], float]


def wanted_of(autopilot: str, lock: Locking) -> tuple[Wanted, ...]:
    """In the order in which they are set: what switches something on comes last."""
    own = float(lock.own_sysid)
    if autopilot == "px4":
        return (
            *(() if lock.fence is None else _px4_fence(lock.fence)),
            Wanted("COM_ARM_AUTH_ID", _always(own)),
            Wanted("COM_ARM_AUTH_MET", _always(0.0)),
            Wanted("COM_ARM_AUTH_REQ", _always(1.0)),
        )
    enforce = (Wanted("MAV_OPTIONS", _with_bits(ENFORCE)),) if lock.enforce_sysid else ()
    return (
        *(() if lock.fence is None else _copter_fence(lock.fence)),
        Wanted("MAV_GCS_SYSID", _always(own)),
        *enforce,
    )


def _px4_fence(fence: FenceSize) -> tuple[Wanted, ...]:
    return (
        Wanted("GF_MAX_HOR_DIST", _no_wider(fence.reach_m)),
        Wanted("GF_MAX_VER_DIST", _no_wider(fence.ceiling_up_m)),
        Wanted("GF_ACTION", _one_of(PX4_BREACH)),
    )


def _copter_fence(fence: FenceSize) -> tuple[Wanted, ...]:
    return (
        Wanted("FENCE_RADIUS", _no_wider(fence.reach_m)),
        Wanted("FENCE_ALT_MAX", _no_wider(fence.ceiling_up_m)),
        Wanted("FENCE_TYPE", _with_bits(HEIGHT_AND_CIRCLE)),
        Wanted("FENCE_ACTION", _one_of(COPTER_BREACH)),
        Wanted("FENCE_ENABLE", _always(COPTER_FENCE_ON)),
    )


def _always(value: float) -> Callable[[float], float]:
    return lambda _: value


def _no_wider(most_m: float) -> Callable[[float], float]:
    """A limit that is there and no wider stays; else half metres, which every float holds."""
    limit_m = max(_STEP_M, math.floor(most_m / _STEP_M) * _STEP_M)
    return lambda is_m: is_m if 0.0 < is_m <= limit_m else limit_m


def _one_of(known: range) -> Callable[[float], float]:
    """A value that the autopilot knows stays; else the first of them."""
    return lambda value: value if value in known else float(known[0])


def _with_bits(bits: int) -> Callable[[float], float]:
    return lambda value: float(bits_of(value) | bits)


def bits_of(value: float) -> int:
    """The bits of a parameter that is a set of them: none, where it is not a number, below 0, or
    greater than a float has every whole number of."""
    return int(value) if 0.0 <= value < _MOST_BITS else 0


def open_ports(autopilot: str, values: Mapping[str, float]) -> list[str]:
    """Where a vehicle that has a key takes unsigned frames, a sentence each; `values` are those of
    `PORTS`, as far as it has them.

    ArduPilot does so on its first MAVLink port, MAVLINK_COMM_0, whatever its parameters are: an
    ArduCopter 4.7 took a forced disarm there.  PX4's values are from its documentation.
    """
    if autopilot == "px4":
        return {
            0.0: ["it takes unsigned frames on every port (MAV_SIGN_CFG = 0)"],
            1.0: ["it takes unsigned frames on USB, always (MAV_SIGN_CFG = 1)"],
        }.get(values.get("MAV_SIGN_CFG", math.nan), [])
    protocols, options = PORTS["ardupilot"]
    ports = [n for n, name in enumerate(protocols) if values.get(name) in _SPEAKS_MAVLINK]
    first = f"SERIAL{ports[0]}" if ports else "its first MAVLink port"
    usb = " (USB, as a rule)" if not ports or ports[0] == 0 else ""
    lines = [f"{first}{usb} takes unsigned frames, always: keep strangers from it"]
    for channel, name in enumerate(options):
        if channel and bits_of(values.get(name, 0.0)) & _SIGNING_OFF:
            where = f"SERIAL{ports[channel]}" if channel < len(ports) else f"MAVLink port {channel}"
            lines.append(f"{where} takes unsigned frames, too: signing is off there ({name})")
    return lines
