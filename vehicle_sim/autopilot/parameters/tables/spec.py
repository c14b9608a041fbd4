"""What is written down about a parameter."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum


class StoredAs(IntEnum):
    """What an autopilot keeps the value as; numbered as in MAV_PARAM_TYPE."""

    INT8 = 2
    INT16 = 4
    INT32 = 6
    REAL32 = 9


LIMITS: dict[StoredAs, tuple[float, float]] = {
    StoredAs.INT8: (-128.0, 127.0),
    StoredAs.INT16: (-32768.0, 32767.0),
    StoredAs.INT32: (-2147483648.0, 2147483647.0),
    StoredAs.REAL32: (-3.4028234663852886e38, 3.4028234663852886e38),
}
"""What a type can hold."""


@dataclass(frozen=True, slots=True)
class ParameterSpec:
    """One parameter.  `low` and `high` bound what the vehicle acts on, not what it takes.

    `reboot`: it acts with the next one.  `inert`: clients look for it, and nothing depends on it
    here.
    """

    name: str
    stored_as: StoredAs
    default: float
    low: float
    high: float
    what: str
    reboot: bool = False
    inert: bool = False

    @property
    def integer(self) -> bool:
        return self.stored_as is not StoredAs.REAL32


def real(name: str, default: float, low: float, high: float, what: str) -> ParameterSpec:
    """A float32 parameter."""
    return ParameterSpec(name, StoredAs.REAL32, default, low, high, what)


def int8(
    name: str, default: int, low: int, high: int, what: str, reboot: bool = False
) -> ParameterSpec:
    return ParameterSpec(name, StoredAs.INT8, default, low, high, what, reboot)


def int16(
    name: str, default: int, low: int, high: int, what: str, reboot: bool = False
) -> ParameterSpec:
    return ParameterSpec(name, StoredAs.INT16, default, low, high, what, reboot)


def int32(
    name: str, default: int, low: int, high: int, what: str, reboot: bool = False
) -> ParameterSpec:
    return ParameterSpec(name, StoredAs.INT32, default, low, high, what, reboot)


def inert(subject: str, stored_as: StoredAs, values: dict[str, float]) -> list[ParameterSpec]:
    """Parameters of one subject and type on which nothing depends, by name and default."""
    low, high = LIMITS[stored_as]
    what = f"{subject}; does nothing in this vehicle"
    return [
        ParameterSpec(name, stored_as, value, low, high, what, inert=True)
        for name, value in values.items()
    ]
