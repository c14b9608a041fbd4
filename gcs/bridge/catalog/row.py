"""What a row of the classification is, and how rows are written down in groups."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from enum import StrEnum
from types import MappingProxyType
from typing import NamedTuple


class Kind(StrEnum):
    """What the gate does with a message or a command of a client."""

    HARMLESS = "harmless"
    """It is forwarded unchanged."""
    POINTING = "pointing"
    """It points a camera, for which a vehicle may turn its nose: it is forwarded for the client in
    control, or for any while nobody is."""
    MOTION = "motion"
    """It moves the vehicle or decides how it moves: the gate decides, as for any operator."""
    CONFIGURATION = "configuration"
    """It changes how the vehicle is set up: a rule of the policy decides."""
    DENIED = "denied"
    """It is refused, and the client is told."""
    CARRIER = "carrier"
    """It carries a command, and the command's row decides."""
    LOCAL = "local"
    """It is between a client and the gate, and is never forwarded."""


class Row(NamedTuple):
    """One message or command: its name in the dialect, without MAV_CMD_, and its kind."""

    name: str
    kind: Kind
    why: str
    """One sentence."""


class Group(NamedTuple):
    """Messages or commands with the same kind for the same reason."""

    kind: Kind
    why: str
    names: Mapping[int, str]
    """By id."""


def table_of(groups: Iterable[Group]) -> Mapping[int, Row]:
    """The rows by id, in order of id.

    Raises ValueError if an id is in two groups: nothing may have two kinds.
    """
    rows: dict[int, Row] = {}
    for kind, why, names in groups:
        for number, name in names.items():
            if number in rows:
                raise ValueError(f"{name} has a row already: {rows[number]}")
            rows[number] = Row(name, kind, why)
    return MappingProxyType(dict(sorted(rows.items())))
