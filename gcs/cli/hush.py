"""Which of the link's warnings a console need not print, because they say nothing new there."""

from __future__ import annotations

from gcs import ipc
from gcs.cli.dialogue import Asked
from gcs.gate.condition import Condition

WARNING = 3
STANDING_CAUTION = Condition.VEHICLE_FAILSAFE_WEAK.value


class Hush:
    """Fed with every event, in order.

    A request of one's own that is refused or fails is logged too: the answer has said it.  And
    that the vehicle's own failsafes are weak is as true before each of a hundred commands:
    `cautions` says whether it is told here.
    """

    def __init__(self, *, cautions: bool) -> None:
        self._cautions = cautions
        self._answered: set[str] = set()

    def hides(self, event: ipc.Event, asked: Asked | None) -> bool:
        if isinstance(event, ipc.VerdictEvent | ipc.EndingEvent):
            if asked is not None and event.sentence:
                self._answered.add(event.sentence)
            return False
        if not isinstance(event, ipc.LogEvent) or event.level != WARNING:
            return False
        if not self._cautions and STANDING_CAUTION in event.text:
            return True
        return any(event.text.endswith(sentence) for sentence in self._answered)
