"""The last MISSION_ACK of a client, kept in case it gets lost, and sent again where it was.

It was lost where the client sends its last item or its MISSION_CLEAR_ALL once more.  On a link that
loses frames the client is also asked for its last item again, to see whether it still waits.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.plans.collecting import ItemMessage, question
from gcs.bridge.plans.effects import PlanEffect
from gcs.bridge.plans.replies import reply
from gcs.protocol.transfers.transfer import SPEC_TIMING, Timing
from gcs.wire.ids import MissionResult, MissionType
from gcs.wire.messages import MissionAck

ACK_REPEATED_NS: Final = 15_000_000_000
"""How long a client that sends its last item again is told the result again."""
CLEAR_REPEATED_NS: Final = 2_000_000_000
"""The same of a clear that was accepted, which clients repeat after 0.5 to 1.5 s.  Short, because
somebody else may have put another plan on board since."""
PROBE_NS: Final = 400_000_000
PROBES: Final = 4
"""On a link that loses frames the last item is asked for once more after the ACK: a client that
answers has not heard it."""


@dataclass(slots=True)
class _Sent:
    """An acknowledgement as it was sent; `count` is of the plan's items, 0 after a clear."""

    asked_by: From
    ack: MissionAck
    kind: MissionType
    count: int
    as_int: bool
    until_ns: int
    probes: int
    probe_ns: int | None


class LastAck:
    """`sent` keeps one, `forget` drops it; in between `item`, `of_clear` and `wake` repeat it."""

    def __init__(self, timing: Timing) -> None:
        self._scale = timing.item_wait_ns / SPEC_TIMING.item_wait_ns
        self._sent: _Sent | None = None

    @property
    def deadline_ns(self) -> int | None:
        """When `wake` is due; None: nothing is waited for."""
        return self._sent.probe_ns if self._sent is not None else None

    def forget(self) -> None:
        """The client has gone on to something else."""
        self._sent = None

    def sent(
        self,
        asked_by: From,
        ack: MissionAck,
        kind: MissionType,
        count: int,
        now_ns: int,
        *,
        as_int: bool,
        lossy: bool,
    ) -> None:
        """This one was sent; `lossy` where the link was seen to lose frames."""
        repeated_ns = ACK_REPEATED_NS if count else CLEAR_REPEATED_NS
        self._sent = _Sent(
            asked_by,
            ack,
            kind,
            count,
            as_int,
            now_ns + self._scaled(repeated_ns),
            PROBES,
            self._scaled(PROBE_NS) + now_ns if lossy and count else None,
        )

    def of_clear(self, kind: int, now_ns: int) -> MissionAck | None:
        """Of the same MISSION_CLEAR_ALL, if that was accepted last, and not long ago.  A refusal is
        decided anew: what was in the way may be over."""
        sent = self._sent
        if sent is None or sent.count != 0 or sent.kind != kind or now_ns >= sent.until_ns:
            return None
        return sent.ack if sent.ack.type == MissionResult.ACCEPTED else None

    def item(self, message: ItemMessage, asked_by: From, now_ns: int) -> list[PlanEffect]:
        """The last item once more, after the answer: the answer has got lost."""
        sent = self._sent
        if sent is None or sent.count == 0 or now_ns >= sent.until_ns:
            return []
        same = (asked_by.source, message.mission_type) == (sent.asked_by.source, sent.kind)
        if not same or message.seq + 1 != sent.count:
            return []
        if sent.probe_ns is not None:
            sent.probes, sent.probe_ns = PROBES, now_ns + self._scaled(PROBE_NS)
        return [reply(sent.asked_by, sent.ack)]

    def wake(self, now_ns: int) -> list[PlanEffect]:
        """The last item is asked for again, a few times."""
        sent = self._sent
        if sent is None or sent.probe_ns is None or now_ns < sent.probe_ns:
            return []
        if sent.probes == 0:
            sent.probe_ns = None
            return []
        sent.probes -= 1
        sent.probe_ns = now_ns + self._scaled(PROBE_NS)
        client = sent.asked_by.source
        return [reply(sent.asked_by, question(sent.count - 1, client, sent.kind, sent.as_int))]

    def _scaled(self, span_ns: int) -> int:
        return round(span_ns * self._scale)
