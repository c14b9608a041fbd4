"""Accepted requests of all operators, as anyone may look at them: running, or how they ended."""

from __future__ import annotations

import msgspec

from gcs import ipc
from gcs.gate.effects import Outcome

KEPT = 50
"""How many that have ended are still listed."""


class Operations:
    """An operation is an accepted request; its number is the request's, the same for everybody."""

    def __init__(self) -> None:
        self._all: dict[int, ipc.Operation] = {}

    def begin(
        self, operation_id: int, asked: ipc.Ask, operator: int, name: str, now_ns: int
    ) -> ipc.Operation:
        """The request was accepted."""
        begun = ipc.Operation(operation_id, asked, operator, name, now_ns)
        self._all[operation_id] = begun
        self._forget_oldest()
        return begun

    def end(self, told: Outcome, now_ns: int) -> ipc.Operation:
        """It has its outcome."""
        ended = msgspec.structs.replace(
            self._all[told.request_id],
            state=told.kind.value,
            code=told.code.value if told.code else "",
            sentence=told.sentence,
            ended_ns=now_ns,
        )
        self._all[told.request_id] = ended
        return ended

    def get(self, operation_id: int) -> ipc.Operation | None:
        """None for one that never was, or that ended long ago."""
        return self._all.get(operation_id)

    def listed(self) -> list[ipc.Operation]:
        return sorted(self._all.values(), key=lambda operation: operation.id)

    def _forget_oldest(self) -> None:
        ended = [each.id for each in self._all.values() if each.ended_ns is not None]
        for operation_id in ended[:-KEPT]:
            del self._all[operation_id]
