"""Some parameters of a vehicle, asked for all at once and again until each is known.

A firmware has a parameter under one of several names (ArduCopter 4.7 renamed many): each
quantity is asked for by all of its names, and the first answer settles it.  A name that is unknown
is answered with PARAM_ERROR by new firmwares and not at all by old ones.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import assert_never

from gcs.protocol.autopilot import ParamEncoding
from gcs.protocol.effects import Address, Heard, Send, Wake
from gcs.protocol.parameter_names import ParameterName, names_of
from gcs.protocol.parameters import BY_NAME, decode_value
from gcs.wire.ids import ParamType
from gcs.wire.messages import ParamError, ParamRequestRead, ParamValue

_TYPES = frozenset(int(kind) for kind in ParamType)


@dataclass(frozen=True, slots=True)
class Waits:
    """When what did not come is asked for again, and when it is waited for no longer: what is
    needed for `give_up_ns`, all else for `patience_ns`."""

    again_ns: int = 500_000_000
    give_up_ns: int = 30_000_000_000
    patience_ns: int = 5_000_000_000


USUAL_WAITS = Waits()


@dataclass(frozen=True, slots=True)
class Quantity:
    """Something that a parameter says, SI units; `parameter` is its newest name."""

    name: str
    parameter: str
    needed: bool = True
    """Whether to wait for it: else what is usual is taken where no answer has come in time."""

    @property
    def names(self) -> tuple[ParameterName, ...]:
        """All that a firmware may have it under, the newest first."""
        return names_of(self.parameter)


class SettingsReader:
    """Reads `quantities`; `done` once each is known, denied, or given up."""

    def __init__(
        self,
        own: Address,
        target: Address,
        encoding: ParamEncoding,
        quantities: tuple[Quantity, ...],
        waits: Waits = USUAL_WAITS,
    ) -> None:
        self._own = own
        self._target = target
        self._encoding = encoding
        self._quantities = quantities
        self._waits = waits
        self._denied: set[str] = set()
        self._began_ns = 0
        self.values: dict[str, float] = {}
        """By the quantity's own name, SI units."""
        self.deadline_ns: int | None = None
        self.done = False

    @property
    def missing(self) -> tuple[Quantity, ...]:
        """What is needed and not known."""
        return tuple(q for q in self._quantities if q.needed and q.name not in self.values)

    @property
    def silent(self) -> tuple[Quantity, ...]:
        """What is neither known nor denied under every name."""
        open_names = frozenset(self._open)
        return tuple(
            q for q in self._quantities if any(each.name in open_names for each in q.names)
        )

    @property
    def absent(self) -> tuple[Quantity, ...]:
        """What the vehicle has said that it does not have, under any name."""
        return tuple(
            q
            for q in self._quantities
            if q.name not in self.values and all(each.name in self._denied for each in q.names)
        )

    def start(self, now_ns: int) -> list[Send]:
        self._began_ns = now_ns
        return self._ask(now_ns)

    def handle(self, event: Heard | Wake, now_ns: int) -> list[Send]:
        if self.done:
            return []
        match event:
            case Heard():
                self._heard(event)
                return self._end() if not self._open else []
            case Wake():
                if self.deadline_ns is None or now_ns < self.deadline_ns:
                    return []
                longest_ns = self._waits.give_up_ns if self.missing else self._waits.patience_ns
                over = now_ns - self._began_ns >= longest_ns
                return self._end() if over else self._ask(now_ns)
            case _:
                assert_never(event)

    @property
    def _open(self) -> list[str]:
        """Names that may still be answered."""
        return [
            each.name
            for quantity in self._quantities
            if quantity.name not in self.values
            for each in quantity.names
            if each.name not in self._denied
        ]

    def _ask(self, now_ns: int) -> list[Send]:
        names = self._open
        if not names:
            return self._end()
        self.deadline_ns = now_ns + self._waits.again_ns
        return [
            Send(
                ParamRequestRead(
                    param_index=BY_NAME,
                    target_system=self._target.sysid,
                    target_component=self._target.compid,
                    param_id=name,
                )
            )
            for name in names
        ]

    def _end(self) -> list[Send]:
        self.done, self.deadline_ns = True, None
        return []

    def _heard(self, heard: Heard) -> None:
        if not self._target.includes(heard.sysid, heard.compid):
            return
        match heard.message:
            case ParamValue(param_id=name) as answer if answer.param_type in _TYPES:
                value = decode_value(
                    answer.param_value, ParamType(answer.param_type), self._encoding
                )
                for quantity in self._quantities:
                    for known in quantity.names:
                        if known.name == name:
                            self.values[quantity.name] = known.scale * float(value)
            case ParamError(param_id=name, target_system=system, target_component=component):
                if Address(system, component).includes(self._own.sysid, self._own.compid):
                    self._denied.add(name)
            case _:
                pass
