"""Parameters set on a vehicle one after the other: each is read, set where it differs, read back.

`Wanted` says by its newest name what a parameter is to become; the vehicle is asked for by all of
its names.  A value counts once the vehicle tells it to a question that follows its echo.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from gcs.float32 import float32
from gcs.protocol.autopilot import ParamEncoding
from gcs.protocol.effects import Address, Heard, Send, Wake
from gcs.protocol.lock_parameters import Wanted
from gcs.protocol.parameter_names import names_of
from gcs.protocol.parameters import BY_NAME, decode_value, encode_value
from gcs.wire.ids import ParamType
from gcs.wire.messages import ParamError, ParamRequestRead, ParamSet, ParamValue

TRIES: Final = 12
"""Of each question and of each setting."""
EVERY_NS: Final = 700_000_000

_TYPES: Final = frozenset(int(kind) for kind in ParamType)


@dataclass(frozen=True, slots=True)
class Change:
    """One parameter, in the vehicle's own name and unit; the same where it was right already."""

    name: str
    before: float
    after: float


class ParameterSetup:
    """Sets `wanted` in order; `over` once each is right, or `failure` says why one is not."""

    def __init__(
        self,
        own: Address,
        target: Address,
        encoding: ParamEncoding,
        wanted: tuple[Wanted, ...],
        every_ns: int = EVERY_NS,
    ) -> None:
        self._own, self._target = own, target
        self._encoding = encoding
        self._open = list(wanted)
        self._every_ns = every_ns
        self._set: ParamSet | None = None
        """What is asked to be set, until it is read back; None: it is read."""
        self._before = math.nan
        self._is = math.nan
        """What the parameter was told to be last; NaN before it is told."""
        self._echoed = False
        """What was set was told; what the vehicle then holds is asked for."""
        self._tries = 0
        self._denied: set[str] = set()
        self.changes: list[Change] = []
        self.failure = ""
        self.deadline_ns: int | None = None

    @property
    def over(self) -> bool:
        """Nothing more is sent."""
        return bool(self.failure) or not self._open

    @property
    def name(self) -> str:
        """The parameter that is at hand, by its newest name; empty at the end."""
        return self._open[0].name if self._open else ""

    def start(self, now_ns: int) -> list[Send]:
        return self._ask(now_ns)

    def handle(self, event: Heard | Wake, now_ns: int) -> list[Send]:
        if self.over:
            return []
        if isinstance(event, Heard):
            return self._heard(event, now_ns)
        if self.deadline_ns is None or now_ns < self.deadline_ns:
            return []
        return self._ask(now_ns)

    def _ask(self, now_ns: int) -> list[Send]:
        """Read the next parameter, or set it once more."""
        if self.over:
            self.deadline_ns = None
            return []
        if self._tries >= TRIES:
            return self._fail(self._why())
        self._tries += 1
        self.deadline_ns = now_ns + self._every_ns
        if self._set is not None and not self._echoed:
            return [Send(self._set)]
        to = self._target
        return [
            Send(ParamRequestRead(BY_NAME, to.sysid, to.compid, each.name))
            for each in names_of(self.name)
            if each.name not in self._denied
        ]

    def _why(self) -> str:
        if self._set is None:
            return f"{self.name}: the vehicle did not answer"
        return f"{self._set.param_id}: stays {self._is:g}"

    def _fail(self, why: str) -> list[Send]:
        self.failure, self.deadline_ns = why, None
        return []

    def _heard(self, heard: Heard, now_ns: int) -> list[Send]:
        if not self._target.includes(heard.sysid, heard.compid):
            return []
        match heard.message:
            case ParamValue(param_id=name) as told if told.param_type in _TYPES:
                return self._told(told, now_ns) if name in self._names else []
            case ParamError(param_id=name, target_system=system, target_component=component):
                ours = Address(system, component).includes(self._own.sysid, self._own.compid)
                if not ours or name not in self._names:
                    return []
                if self._set is not None:
                    return self._fail(f"{name}: the vehicle refuses it (PARAM_ERROR)")
                self._denied.add(name)
                if self._names <= self._denied:
                    return self._fail(f"{self.name}: the vehicle has no such parameter")
                return []
            case _:
                return []

    @property
    def _names(self) -> set[str]:
        return {each.name for each in names_of(self.name)}

    def _told(self, told: ParamValue, now_ns: int) -> list[Send]:
        kind = ParamType(told.param_type)
        scale = next(n.scale for n in names_of(self.name) if n.name == told.param_id)
        self._is = float(decode_value(told.param_value, kind, self._encoding))
        if self._set is None:
            self._before = self._is
        becomes = self._open[0].becomes(self._is * scale) / scale
        if float32(self._is) == float32(becomes):
            if self._set is not None and not self._echoed:
                self._echoed, self._tries = True, 0
                return self._ask(now_ns)
            self.changes.append(Change(told.param_id, self._before, self._is))
            self._open.pop(0)
            self._set, self._echoed, self._tries, self._is = None, False, 0, math.nan
            return self._ask(now_ns)
        if self._set is not None:
            self._echoed = False
            return []  # it is set again
        wire = encode_value(becomes, kind, self._encoding)
        self._set = ParamSet(wire, self._target.sysid, self._target.compid, told.param_id, kind)
        self._tries = 0
        return self._ask(now_ns)
