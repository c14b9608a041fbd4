"""All parameters of a vehicle by messages: PARAM_REQUEST_LIST, then what is missing by its index.

https://mavlink.io/en/services/parameter.html.  PX4 sends a `_HASH_CHECK` first, which is no
parameter, and may count one more while its list is on the way (recorded: 872, then 873).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, TypeAlias

from gcs.protocol.autopilot import ParamEncoding
from gcs.protocol.effects import Address, Heard, Send, Wake
from gcs.protocol.parameters import Parameter, decode_value
from gcs.wire.ids import ParamType
from gcs.wire.messages import ParamRequestList, ParamRequestRead, ParamValue

HASH_CHECK: Final = "_HASH_CHECK"
QUIET_NS: Final = 500_000_000
"""Nothing of the list for so long: it is over."""
ANSWER_NS: Final = 300_000_000
"""Without an answer for so long, an index is asked for again."""
WAITS: Final = 20
"""For so many quiet times nothing at all may come."""
FIRST_WAITS: Final = 6
"""The same before the first parameter."""
AT_ONCE: Final = 16
"""Indices that are asked for together; ArduPilot queues 20."""
_TYPES: Final = frozenset(int(kind) for kind in ParamType)


@dataclass(frozen=True, slots=True)
class ListProgress:
    done: int
    total: int


@dataclass(frozen=True, slots=True)
class ListDone:
    parameters: tuple[Parameter, ...]


@dataclass(frozen=True, slots=True)
class ListFailed:
    text: str


ListEffect: TypeAlias = Send | ListProgress | ListDone | ListFailed


def parameter_of(message: ParamValue, encoding: ParamEncoding) -> Parameter | None:
    """None for what is none: a hash, or a type that is not known."""
    if message.param_id == HASH_CHECK or message.param_type not in _TYPES:
        return None
    kind = ParamType(message.param_type)
    return Parameter(message.param_id, decode_value(message.param_value, kind, encoding), kind)


class ParameterList:
    """Reads them all; `done` after ListDone or ListFailed."""

    def __init__(
        self,
        target: Address,
        encoding: ParamEncoding,
        quiet_ns: int = QUIET_NS,
        answer_ns: int = ANSWER_NS,
    ) -> None:
        self._target = target
        self._encoding = encoding
        self._quiet_ns = quiet_ns
        self._answer_ns = answer_ns
        self._found: dict[int, Parameter] = {}
        self._asked: dict[int, int] = {}
        """When each index that is waited for was asked for."""
        self._count = 0
        self._heard_ns: int | None = None
        """When the latest of the list came, at first when it was asked for."""
        self.deadline_ns: int | None = None
        self.done = False

    def start(self, now_ns: int) -> list[ListEffect]:
        self.deadline_ns = now_ns + self._quiet_ns
        if self._heard_ns is None:
            self._heard_ns = now_ns
        return [Send(ParamRequestList(self._target.sysid, self._target.compid))]

    def handle(self, event: Heard | Wake, now_ns: int) -> list[ListEffect]:
        if self.done:
            return []
        if isinstance(event, Wake):
            due = self.deadline_ns is not None and now_ns >= self.deadline_ns
            return self._silent(now_ns) if due else []
        message = event.message
        if not isinstance(message, ParamValue):
            return []
        if not self._target.includes(event.sysid, event.compid):
            return []
        return self._heard(message, now_ns)

    def _heard(self, message: ParamValue, now_ns: int) -> list[ListEffect]:
        parameter = parameter_of(message, self._encoding)
        if parameter is None:
            return []
        index = message.param_index
        if index >= message.param_count:
            # An answer to a PARAM_SET of whomever: ArduPilot leaves the index out there.
            for known, old in self._found.items():
                if old.name == parameter.name:
                    self._found[known] = parameter
            return []
        self._count = max(self._count, message.param_count)
        self._heard_ns = now_ns
        self._found[index] = parameter
        asked = self._asked.pop(index, None) is not None
        if len(self._found) >= self._count:
            self.done, self.deadline_ns = True, None
            return [ListDone(tuple(self._found[each] for each in sorted(self._found)))]
        progress: list[ListEffect] = []
        if len(self._found) % 50 == 0:
            progress.append(ListProgress(len(self._found), self._count))
        if asked or self._asked:
            return [*progress, *self._ask(now_ns)]
        self.deadline_ns = now_ns + self._quiet_ns
        return progress

    def _silent(self, now_ns: int) -> list[ListEffect]:
        waits = WAITS if self._count else FIRST_WAITS
        if now_ns - (self._heard_ns or 0) >= waits * self._quiet_ns:
            self.done, self.deadline_ns = True, None
            missing = f"{self._count - len(self._found)} of {self._count} parameters are missing"
            return [ListFailed(missing if self._count else "the vehicle tells no parameters")]
        return self._ask(now_ns) if self._count else self.start(now_ns)

    def _ask(self, now_ns: int) -> list[ListEffect]:
        """For the first indices that are missing, each again once its wait is over."""
        overdue_ns = now_ns - self._answer_ns
        for index, asked_ns in list(self._asked.items()):
            if asked_ns <= overdue_ns:
                del self._asked[index]
        sends: list[ListEffect] = []
        for index in range(self._count):
            if len(self._asked) >= AT_ONCE:
                break
            if index not in self._found and index not in self._asked:
                self._asked[index] = now_ns
                sends.append(
                    Send(ParamRequestRead(index, self._target.sysid, self._target.compid, ""))
                )
        self.deadline_ns = min(self._asked.values()) + self._answer_ns
        return sends
