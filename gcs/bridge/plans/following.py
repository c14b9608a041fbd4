"""A client that has sent its whole plan and waits for the answer is kept waiting.

Verifying the plan, bringing it on board and reading it back take from a second to a minute and a
half, and clients wait less: QGroundControl 1.5 s and MAVSDK 2 s after the last question
(PlanManager.h, mavlink_mission_transfer_client.cpp).  So the last items are asked for once more, in
order, over and over.

In order, and up to the last, because of MAVSDK: a question for the item that follows makes it
patient again, any other one uses up a try; and it takes an ACCEPTED for an error unless the last
item was the one that it sent last.  Clients that stop answering after the last item (MAVProxy,
DroneKit) do not mind, as they wait for ever or not at all.
"""

from __future__ import annotations

from typing import Final

from gcs.bridge.plans.collecting import Question, question
from gcs.protocol.effects import Address
from gcs.protocol.transfer import SPEC_TIMING, Timing
from gcs.wire.ids import MissionType

WINDOW: Final = 8
"""Items that are asked for again: so many questions are at most between the outcome and its ACK."""
PAUSE_NS: Final = 400_000_000
"""Between an answer and the next question."""
LONE_PAUSE_NS: Final = 1_200_000_000
"""The same where there is one item only: each question uses up a try of MAVSDK's four."""
LAST_TRIES: Final = 4
"""Questions in vain before the ACK is sent all the same."""


class Following:
    """Asks for the last items again until `finish`; then `ready` says when the ACK is due."""

    def __init__(
        self,
        count: int,
        client: Address,
        kind: MissionType,
        as_int: bool,
        timing: Timing,
        now_ns: int,
    ) -> None:
        self._count = count
        self._client = client
        self._kind = kind
        self._as_int = as_int
        self._again_ns = timing.item_wait_ns
        pause_ns = PAUSE_NS if count > 1 else LONE_PAUSE_NS
        self._pause_ns = pause_ns * timing.item_wait_ns // SPEC_TIMING.item_wait_ns
        self._next = max(0, count - WINDOW)
        self._asked: int | None = None
        self._tries = 0
        self._finishing = False
        self._at_end = True
        self.deadline_ns: int | None = now_ns + self._pause_ns

    @property
    def ready(self) -> bool:
        """An ACCEPTED is understood now, or the client does not answer anyhow."""
        return self._finishing and (self._at_end or self._tries >= LAST_TRIES)

    def item(self, seq: int, now_ns: int) -> list[Question]:
        """An item came (again)."""
        if seq != self._asked:
            return []
        self._asked, self._tries = None, 0
        self._at_end = seq + 1 == self._count
        self._next = max(0, self._count - WINDOW) if self._at_end else seq + 1
        if self.ready:
            self.deadline_ns = None
            return []
        if self._finishing:
            return self._ask(self._next, now_ns)
        self.deadline_ns = now_ns + self._pause_ns
        return []

    def finish(self, now_ns: int) -> list[Question]:
        """The outcome is known: what is left up to the last item is asked for without a pause."""
        self._finishing, self._tries = True, 0
        if self.ready:
            self.deadline_ns = None
            return []
        return self._ask(self._next if self._asked is None else self._asked, now_ns)

    def wake(self, now_ns: int) -> list[Question]:
        if self.deadline_ns is None or now_ns < self.deadline_ns:
            return []
        if self._asked is not None:
            self._tries += 1
            if self.ready:
                self.deadline_ns = None
                return []
        return self._ask(self._next if self._asked is None else self._asked, now_ns)

    def _ask(self, seq: int, now_ns: int) -> list[Question]:
        self._asked, self._at_end = seq, self._count == 1
        self.deadline_ns = now_ns + self._again_ns
        return [question(seq, self._client, self._kind, self._as_int)]
