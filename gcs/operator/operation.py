"""An accepted request of a Python program, which may still be under way."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from gcs import ipc
from gcs.operator import arguments
from gcs.operator.conversation import Found, TrackedRequest
from gcs.operator.failures import NotCompleted


class Asking(Protocol):
    """What an operation needs of the station."""

    def request(
        self, ask: ipc.Ask, wait: bool = True, timeout_s: float | None = None
    ) -> object: ...
    def wait_until(self, done: Callable[[], bool], timeout_s: float | None) -> None: ...


@arguments.all_called_right
class Operation:
    """An accepted request, which may still be under way."""

    def __init__(self, station: Asking, tracked: TrackedRequest) -> None:
        self._station = station
        self._tracked = tracked

    @property
    def asked(self) -> ipc.Ask:
        """What was asked for."""
        return self._tracked.sent

    @property
    def id(self) -> int:
        """The station's number of it, as `gcs operations` shows it."""
        return 0 if self._tracked.verdict is None else self._tracked.verdict.operation

    @property
    def state(self) -> str:
        """running, complete, aborted, superseded, timed out or taken over."""
        return "running" if self._tracked.outcome is None else self._tracked.outcome.ended

    @property
    def ending(self) -> ipc.EndingEvent | None:
        """How it ended; None while it is under way."""
        return self._tracked.outcome

    @property
    def found(self) -> list[Found]:
        """What was read for it."""
        return self._tracked.found

    @property
    def goal_enu(self) -> ipc.Maybe3 | None:
        """Where it leads, as it was verified: metres east, north, up; None: to no place."""
        return None if self._tracked.verdict is None else self._tracked.verdict.goal_enu

    @property
    def numbers(self) -> dict[str, float | None]:
        """What it was accepted on, and what it ended with; the unit is at the end of each name."""
        told = (self._tracked.verdict, self._tracked.outcome)
        return {name: number for each in told if each for name, number in each.numbers.items()}

    @property
    def picture(self) -> int | None:
        """Of a photo that is complete, the vehicle's own number of the picture."""
        number = self.numbers.get("picture")
        return None if number is None else int(number)

    def wait(self, timeout_s: float | None = None) -> Operation:
        """Until it is complete.  Raises NotCompleted, Disconnected."""
        wait_s = arguments.seconds("wait", timeout_s=timeout_s)
        self._station.wait_until(lambda: self._tracked.settled, wait_s)
        ending = self._tracked.outcome
        if ending is None:
            text = f"{self._tracked.label} is still under way after {wait_s:g} s"
            raise NotCompleted("running", "", text, {"timeout_s": wait_s})
        if ending.ended != "complete":
            raise NotCompleted(ending.ended, ending.code, ending.sentence, ending.numbers)
        return self

    def stop(self) -> None:
        """Abort it, if it is still under way; if it is not, nothing else is stopped instead.

        Raises Refused with NOT_RUNNING, NotCompleted, Disconnected.
        """
        self._station.request(ipc.Ask(0, "abort", operation=self.id))

    def __repr__(self) -> str:
        return f"<Operation {self.id} {self._tracked.label}: {self.state}>"
