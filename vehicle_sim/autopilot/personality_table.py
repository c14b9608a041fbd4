"""Tables of what differs between the personalities: a dataclass with one line for each field.

    land_speed_high: str | None = each(None, "LAND_SPEED_HIGH")  # why

PX4's value comes first, ArduCopter's second.
"""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeVar, cast

from vehicle_sim.autopilot.modes import Personality

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Px4 = TypeVar("Px4")
Copter = TypeVar("Copter")
Table = TypeVar("Table", bound="DataclassInstance")


class _Each(NamedTuple):
    px4: object
    ardupilot: object


def each(px4: Px4, ardupilot: Copter) -> Px4 | Copter:
    """The default of a field, to be read by `tables`: mypy takes it for one of the values."""
    return cast("Px4 | Copter", _Each(px4, ardupilot))


PX4_ONLY: Final[bool] = each(True, False)
COPTER_ONLY: Final[bool] = each(False, True)


def tables(kind: type[Table]) -> dict[Personality, Table]:
    """Each personality's own; a field without `each` has the same value for both."""
    return {"px4": _table(kind, "px4"), "ardupilot": _table(kind, "ardupilot")}


def _table(kind: type[Table], personality: Personality) -> Table:
    both: dict[str, Any] = {field.name: field.default for field in fields(kind)}
    return kind(
        **{
            name: getattr(value, personality) if isinstance(value, _Each) else value
            for name, value in both.items()
        }
    )
