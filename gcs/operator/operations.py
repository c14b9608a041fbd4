"""The operations of a running station, as one that has joined it sees them."""

from __future__ import annotations

from types import TracebackType

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.operator.client import Polling
from gcs.operator.conversation import Conversation
from gcs.operator.errors import ExitError

POLL_S = 0.5


class OperationsView:
    """A block that looks at the operations and leaves the station as it was."""

    def __init__(self, connection: Polling) -> None:
        self._connection = connection
        self._talk = Conversation()

    def __enter__(self) -> OperationsView:
        self._connection.send(ipc.ListOperations(1))
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._connection.send(ipc.Leave("done"))
        self._connection.close()

    def listed(self, timeout_s: float) -> list[ipc.Operation]:
        """All that the station still knows, the oldest first.  Raises ExitError."""
        deadline_s = self._connection.now_s() + timeout_s
        while self._talk.operations is None:
            if self._connection.now_s() >= deadline_s:
                raise ExitError(ExitCode.NOT_COMPLETED, "the station does not answer")
            self._poll()
        return list(self._talk.operations.values())

    def ended(self, number: int, timeout_s: float) -> ipc.Operation:
        """That operation, once it has ended.  Raises ExitError, also when it takes too long."""
        deadline_s = self._connection.now_s() + timeout_s
        self.listed(timeout_s)
        while True:
            assert self._talk.operations is not None
            operation = self._talk.operations.get(number)
            if operation is None:
                hint = "gcs operations lists those that the station still knows"
                raise ExitError(ExitCode.USAGE, f"no operation {number}", hint)
            if operation.ended_ns is not None:
                return operation
            if self._connection.now_s() >= deadline_s:
                text = f"operation {number} is still under way after {timeout_s:g} s"
                raise ExitError(ExitCode.NOT_COMPLETED, text)
            self._poll()

    def _poll(self) -> None:
        for event in self._connection.poll(POLL_S).events:
            self._talk.told(event)
        if self._talk.ended is not None:
            raise self._talk.unexpected_end()
