"""The parameter protocol, asking side (https://mavlink.io/en/services/parameter.html).

Names are asked for one by one, as a failsafe check needs ten of them, not a thousand.  How an
integer travels in the float differs: px4 puts its bytes there, ardupilot its value.
"""

from __future__ import annotations

import math
import struct
from collections import deque
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
from gcs.wire.messages import (
    Message,
    ParamRequestRead,
    ParamValue,
)
from gcs.wire.messages import ParamError as ParamErrorMessage

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


def _answer(heard: Heard, own: Address, target: Address, name: str) -> Message | None:
    """The PARAM_VALUE or PARAM_ERROR about `name`, if that is what was heard."""
    if not target.includes(heard.sysid, heard.compid):
        return None
    match heard.message:
        case ParamValue(param_id=about) if about == name:
            return heard.message
        case ParamErrorMessage(param_id=about, target_system=system, target_component=component):
            to_us = Address(system, component).includes(own.sysid, own.compid)
            return heard.message if about == name and to_us else None
        case _:
            return None


class ParamReader:
    """Read `names`, one at a time; each ends as ParamRead or ParamAbsent, then ParamsDone comes."""

    def __init__(
        self, own: Address, target: Address, encoding: ParamEncoding, names: tuple[str, ...]
    ) -> None:
        self._own = own
        self._target = target
        self._encoding = encoding
        self._names = deque(names)
        self._tries = 0
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
                if self._tries < READ_TRIES:
                    return self._ask(now_ns)
                return [ParamAbsent(self._names[0], None), *self._next(now_ns)]
            case _:
                assert_never(event)

    def _heard(self, heard: Heard, now_ns: int) -> list[ParamEffect]:
        name = self._names[0]
        match _answer(heard, self._own, self._target, name):
            case ParamValue() as answer:
                known = _read(answer, self._encoding)
                return [known, *self._next(now_ns)]
            case ParamErrorMessage(error=error):
                return [ParamAbsent(name, _param_error(error)), *self._next(now_ns)]
            case _:
                return []

    def _next(self, now_ns: int) -> list[ParamEffect]:
        self._names.popleft()
        self._tries = 0
        return self._ask(now_ns)

    def _ask(self, now_ns: int) -> list[ParamEffect]:
        if not self._names:
            self.ended = True
            self.deadline_ns = None
            return [ParamsDone()]
        self._tries += 1
        self.deadline_ns = now_ns + READ_WAIT_NS
        ask = ParamRequestRead(
            param_index=BY_NAME,
            target_system=self._target.sysid,
            target_component=self._target.compid,
            param_id=self._names[0],
        )
        return [Send(ask)]


def _read(answer: ParamValue, encoding: ParamEncoding) -> ParamRead:
    """A type that does not exist is taken for a float."""
    known = answer.param_type in ParamType.__members__.values()
    type_ = ParamType(answer.param_type) if known else ParamType.REAL32
    return ParamRead(answer.param_id, decode_value(answer.param_value, type_, encoding), type_)


def _param_error(error: int) -> ParamError | int:
    return ParamError(error) if error in ParamError.__members__.values() else error
