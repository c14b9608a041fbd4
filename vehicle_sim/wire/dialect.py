"""The dialect as tables: layouts derived from pymavlink's `all` plus the supplement.

For `generate.py` and the tests: the program itself reads `layouts.py`, since loading pymavlink
takes longer than all else that a vehicle loads.

pymavlink's class attributes pair crosswise: `array_lengths` belongs to `ordered_fieldnames`,
`fieldtypes` to `fieldnames`; extensions are the parameters of `__init__` that have a default.
"""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Final, Protocol

from pymavlink.dialects.v20 import all as upstream

from vehicle_sim.wire.selection import MESSAGES
from vehicle_sim.wire.supplement import GROWN, NEW, Layout, MessageField


class _Upstream(Protocol):
    """What is read of a message class of pymavlink's."""

    id: int
    msgname: str
    fieldnames: list[str]
    ordered_fieldnames: list[str]
    fieldtypes: list[str]
    array_lengths: list[int]
    crc_extra: int


_MAP: Final[Mapping[int, type[_Upstream]]] = upstream.mavlink_map


def _layout(kind: type[_Upstream]) -> Layout:
    kinds = dict(zip(kind.fieldnames, kind.fieldtypes, strict=True))
    signature = inspect.signature(kind.__init__).parameters
    fields = tuple(
        # The dialect's pseudo type for the protocol's own version is a plain byte on the wire.
        MessageField(
            name,
            kinds[name].removesuffix("_mavlink_version"),
            length,
            name in signature and signature[name].default is not inspect.Parameter.empty,
        )
        for name, length in zip(kind.ordered_fieldnames, kind.array_lengths, strict=True)
    )
    return Layout(kind.id, kind.msgname, kind.crc_extra, fields + GROWN.get(kind.msgname, ()))


CRC_EXTRAS: Final[dict[int, int]] = {
    **{number: kind.crc_extra for number, kind in _MAP.items()},
    **{layout.number: layout.crc_extra for layout in NEW},
}
"""For every message that is known at all; without it a frame cannot be checked."""

NAMES: Final[dict[int, str]] = {
    **{number: kind.msgname for number, kind in _MAP.items()},
    **{layout.number: layout.name for layout in NEW},
}

_NUMBERS: Final = {name: number for number, name in NAMES.items()}
_NEW: Final = {layout.number: layout for layout in NEW}

LAYOUTS: Final[dict[int, Layout]] = {
    number: _NEW.get(number) or _layout(_MAP[number])
    for number in sorted(_NUMBERS[name] for name in MESSAGES)
}
"""For the messages that this vehicle reads or writes."""
