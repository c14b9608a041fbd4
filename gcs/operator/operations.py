"""The operations of a running station, as one that has joined it sees them."""

from __future__ import annotations

from types import TracebackType

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.operator.client import StationEnded
from gcs.operator.dialogue import Connection, unexpected_end
from gcs.operator.errors import ExitError

POLL_S = 0.5


class OperationsView:
    """A block that looks at the operations and leaves the station as it was."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._operations: dict[int, ipc.Operation] | None = None
        self._trouble: ipc.Trouble | None = None

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
        while self._operations is None:
            if self._connection.now_s() >= deadline_s:
                raise ExitError(ExitCode.NOT_COMPLETED, "the station does not answer")
            self._poll()
        return list(self._operations.values())

    def ended(self, number: int, timeout_s: float) -> ipc.Operation:
        """That operation, once it has ended.  Raises ExitError, also when it takes too long."""
        deadline_s = self._connection.now_s() + timeout_s
        self.listed(timeout_s)
        while True:
            assert self._operations is not None
            operation = self._operations.get(number)
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
            match event:
                case ipc.OperationList(_, operations):
                    self._operations = {each.id: each for each in operations}
                case ipc.Operation() if self._operations is not None:
                    self._operations[event.id] = event
                case ipc.Trouble():
                    self._trouble = event
                case StationEnded():
                    raise unexpected_end(event, self._trouble)
                case _:
                    pass
