"""Which of a station's warnings a console does not print, because they say nothing new there."""

from __future__ import annotations

from gcs import ipc
from gcs.gate.condition import Condition
from gcs.operator.conversation import TrackedRequest

WARNING = 3
"""The level of `ipc.LogEvent`."""
STANDING_CAUTION = Condition.VEHICLE_FAILSAFE_WEAK.value


class WarningFilter:
    """Is given every event, in order.

    A request of one's own that is refused or fails is in the log as well: the answer has said it
    already.  And that the vehicle's own failsafes are weak is as true before each of a hundred
    commands: `cautions` says whether it is shown.
    """

    def __init__(self, *, cautions: bool) -> None:
        self._cautions = cautions
        self._answered: set[str] = set()

    def hides(self, event: ipc.Event, request: TrackedRequest | None) -> bool:
        if isinstance(event, ipc.VerdictEvent | ipc.EndingEvent):
            if request is not None and event.sentence:
                self._answered.add(event.sentence)
            return False
        if not isinstance(event, ipc.LogEvent) or event.level != WARNING:
            return False
        if not self._cautions and STANDING_CAUTION in event.text:
            return True
        return any(event.text.endswith(sentence) for sentence in self._answered)
