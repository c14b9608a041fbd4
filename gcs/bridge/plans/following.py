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
from gcs.protocol.transfers.transfer import SPEC_TIMING, Timing
from gcs.wire.ids import MissionType

WINDOW: Final = 16
"""Items that are asked for again: so many questions are at most between the outcome and its ACK."""
PAUSE_NS: Final = 200_000_000
"""Between an answer and the next question: where one is lost, another comes before MAVSDK's 0.5 s
are over.  Going back uses up a try, so the question after that follows at once."""
LONE_PAUSE_NS: Final = 1_200_000_000
"""The same where there is one item only: each question uses up a try of MAVSDK's four."""
LAST_TRIES: Final = 6
"""Questions in vain before the ACK is sent all the same."""
QUICK_TRIES: Final = 2
"""After so many the pauses grow, as those of `collecting.py` do."""


class Following:
    """Asks for the last items again until `finish`; then `ready` says when the ACK is due."""

    def __init__(
        self,
        count: int,
        client: Address,
        kind: MissionType,
        as_int: bool,
        again_ns: int,
        timing: Timing,
        now_ns: int,
    ) -> None:
        """`again_ns`: how long this client's link takes to bring an answer."""
        self._count = count
        self._client = client
        self._kind = kind
        self._as_int = as_int
        self._again_ns = again_ns
        self._longest_ns = 2 * timing.item_wait_ns
        pause_ns = PAUSE_NS if count > 1 else LONE_PAUSE_NS
        self._pause_ns = pause_ns * timing.item_wait_ns // SPEC_TIMING.item_wait_ns
        self._next = max(0, count - WINDOW)
        self._asked: int | None = None
        self._tries = 0
        self._finishing = False
        self._at_end = True
        """The last item is the one that was asked for last."""
        self._went_back = False
        self.deadline_ns: int | None = now_ns + self._pause_ns

    @property
    def ready(self) -> bool:
        """An ACCEPTED is understood now, or the client does not answer anyhow."""
        return self._finishing and (self._at_end or self._tries >= LAST_TRIES)

    def item(self, seq: int, now_ns: int) -> list[Question]:
        """An item came (again)."""
        if seq != self._asked:
            return []
        went_back, self._went_back = self._went_back, False
        self._asked, self._tries = None, 0
        self._at_end = seq + 1 == self._count
        self._next = max(0, self._count - WINDOW) if self._at_end else seq + 1
        if self.ready:
            self.deadline_ns = None
            return []
        if self._finishing or (went_back and not self._at_end):
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
        self._went_back |= self._at_end
        self._asked, self._at_end = seq, self._count == 1
        wait_ns = self._again_ns << max(0, self._tries - QUICK_TRIES)
        self.deadline_ns = now_ns + min(wait_ns, self._longest_ns)
        return [question(seq, self._client, self._kind, self._as_int)]
