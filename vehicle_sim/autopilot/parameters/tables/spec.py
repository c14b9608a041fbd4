"""What is written down about a parameter."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ParameterSpec:
    """One parameter: `integer` = int32, else float32; bounds inclusive; `reboot` = acts then."""

    name: str
    integer: bool
    default: float
    low: float
    high: float
    what: str
    reboot: bool = False


def real(name: str, default: float, low: float, high: float, what: str) -> ParameterSpec:
    """A float32 parameter."""
    return ParameterSpec(name, False, default, low, high, what)


def whole(
    name: str, default: int, low: int, high: int, what: str, reboot: bool = False
) -> ParameterSpec:
    """An int32 parameter."""
    return ParameterSpec(name, True, default, low, high, what, reboot)
