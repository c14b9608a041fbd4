"""The parameter protocol, asking side (https://mavlink.io/en/services/parameter.html).

Names are asked for one by one, as a failsafe check needs ten of them, not a thousand.  How an
integer travels in the float differs: px4 puts its bytes there, ardupilot its value.
"""

from __future__ import annotations

import math
import struct
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeAlias, assert_never

from gcs.protocol.autopilot import ParamEncoding
from gcs.protocol.effects import (
    Address,
    Heard,
    ParamAbsent,
    ParamEffect,
    ParamRead,
    ParamsDone,
    Send,
    Wake,
)
from gcs.wire.ids import ParamError, ParamType
from gcs.wire.messages import ParamError as ParamErrorMessage
from gcs.wire.messages import ParamRequestRead, ParamValue

READ_WAIT_NS = 500_000_000
READ_TRIES = 3
BY_NAME = -1
"""param_index that says: look at the name."""

Input: TypeAlias = Heard | Wake

_INTEGER = {
    ParamType.UINT8: "B",
    ParamType.INT8: "b",
    ParamType.UINT16: "H",
    ParamType.INT16: "h",
    ParamType.UINT32: "I",
    ParamType.INT32: "i",
}


def decode_value(wire: float, type_: ParamType, encoding: ParamEncoding) -> int | float:
    """A PARAM_VALUE's float as what it means.  64-bit types do not fit and stay as they are.

    Bytewise integers whose bits are a signalling NaN (such as -8388607) come out with bit 22 set:
    `struct` goes through a double, which quietens them.  No parameter of PX4's is one.
    """
    code = _INTEGER.get(type_)
    if code is None:
        return wire
    if encoding is ParamEncoding.BYTEWISE:
        value: int = struct.unpack_from("<" + code, struct.pack("<f", wire))[0]
        return value
    return round(wire) if math.isfinite(wire) else wire


@dataclass(slots=True)
class _Wanted:
    """A parameter that is to be read: the names that it may have, the next to ask for first."""

    about: str
    names: deque[str]
    tries_left: int


class ParamReader:
    """Read each of `wanted`, one at a time; each ends as ParamRead or ParamAbsent, then ParamsDone
    comes.

    Each is a tuple of names, as versions of an autopilot differ: one that is answered is enough.  A
    name that the vehicle says it does not have, or is silent about, is followed by the next one.
    ParamAbsent tells the first name.  An answer counts whenever it comes before the end.
    """

    def __init__(
        self,
        own: Address,
        target: Address,
        encoding: ParamEncoding,
        wanted: Iterable[tuple[str, ...]],
        wait_ns: int = READ_WAIT_NS,
    ) -> None:
        self._own = own
        self._target = target
        self._encoding = encoding
        self._wait_ns = wait_ns
        self._open = deque(
            _Wanted(names[0], deque(names), READ_TRIES * len(names)) for names in wanted
        )
        self.deadline_ns: int | None = None
        self.ended = False

    def start(self, now_ns: int) -> list[ParamEffect]:
        return self._ask(now_ns)

    def handle(self, event: Input, now_ns: int) -> list[ParamEffect]:
        if self.ended:
            return []
        match event:
            case Heard():
                return self._heard(event, now_ns)
            case Wake():
                if self.deadline_ns is None or now_ns < self.deadline_ns:
                    return []
                return self._silence(now_ns)
            case _:
                assert_never(event)

    def _heard(self, heard: Heard, now_ns: int) -> list[ParamEffect]:
        if not self._target.includes(heard.sysid, heard.compid):
            return []
        match heard.message:
            case ParamValue(param_id=name) as answer:
                wanted = self._find(name)
                return [] if wanted is None else self._end(wanted, self._read(answer), now_ns)
            case ParamErrorMessage(param_id=name) as refused:
                to = Address(refused.target_system, refused.target_component)
                wanted = self._find(name)
                if wanted is None or not to.includes(self._own.sysid, self._own.compid):
                    return []
                return self._no_such(wanted, name, _param_error(refused.error), now_ns)
            case _:
                return []

    def _find(self, name: str) -> _Wanted | None:
        return next((wanted for wanted in self._open if name in wanted.names), None)

    def _no_such(
        self, wanted: _Wanted, name: str, error: ParamError | int, now_ns: int
    ) -> list[ParamEffect]:
        wanted.names.remove(name)
        if not wanted.names:
            return self._end(wanted, ParamAbsent(wanted.about, error), now_ns)
        return self._ask(now_ns) if wanted is self._open[0] else []

    def _silence(self, now_ns: int) -> list[ParamEffect]:
        wanted = self._open[0]
        if not wanted.tries_left:
            return self._end(wanted, ParamAbsent(wanted.about, None), now_ns)
        wanted.names.rotate(-1)
        return self._ask(now_ns)

    def _end(self, wanted: _Wanted, how: ParamRead | ParamAbsent, now_ns: int) -> list[ParamEffect]:
        asked = wanted is self._open[0]
        self._open.remove(wanted)
        return [how, *self._ask(now_ns)] if asked else [how]

    def _ask(self, now_ns: int) -> list[ParamEffect]:
        if not self._open:
            self.ended = True
            self.deadline_ns = None
            return [ParamsDone()]
        wanted = self._open[0]
        wanted.tries_left -= 1
        self.deadline_ns = now_ns + self._wait_ns
        ask = ParamRequestRead(
            param_index=BY_NAME,
            target_system=self._target.sysid,
            target_component=self._target.compid,
            param_id=wanted.names[0],
        )
        return [Send(ask)]

    def _read(self, answer: ParamValue) -> ParamRead:
        """A type that does not exist is taken for a float."""
        known = answer.param_type in ParamType.__members__.values()
        type_ = ParamType(answer.param_type) if known else ParamType.REAL32
        value = decode_value(answer.param_value, type_, self._encoding)
        return ParamRead(answer.param_id, value, type_)


def _param_error(error: int) -> ParamError | int:
    return ParamError(error) if error in ParamError.__members__.values() else error
