"""What the station was asked for on behalf of a client, until the client has its MISSION_ACK.

submitted: Upload, Clear ──▶ decided: refused ──▶ MISSION_ACK, texts
               │                └──▶ accepted, on its way to the vehicle;
               │                     `following` keeps the client waiting
               │                     └──▶ ended ──▶ MISSION_ACK, once
               └ cancelled, replaced ──▶ Withdraw ──▶ ended ──▶ the next one
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from gcs import ipc
from gcs.bridge.client_plan import ClientPlan
from gcs.bridge.pending import From
from gcs.bridge.plans.collecting import ItemMessage, acknowledgement
from gcs.bridge.plans.effects import Clear, PlanEffect, Upload, Withdraw
from gcs.bridge.plans.following import Following
from gcs.bridge.plans.last_ack import LastAck
from gcs.bridge.plans.replies import Replies, replies, reply
from gcs.bridge.plans.results import result_of
from gcs.gate.effects import Level
from gcs.wire.ids import MissionResult, MissionType
from gcs.wire.messages import MissionCount

MOST_FINDINGS: Final = 10
"""Findings of one plan that a client is sent as texts; the log has all."""


@dataclass(slots=True)
class Submission:
    """An upload, or (no plan) a clear."""

    asked_by: From
    kind: MissionType
    plan: ClientPlan | None = None
    opened: MissionCount | None = None
    following: Following | None = None
    as_int: bool = True
    """The form of question that the client answers."""
    lossy: bool = False
    """Questions for its items had to be put again."""
    result: MissionResult | None = None
    """Known, but the client is not ready for it yet."""
    withdrawn: bool = False
    findings: int = 0
    """That the client was told."""


class Submissions:
    """The one that the station works on, and the one that waits until that is over."""

    def __init__(self, replies_to_client: Replies, last_ack: LastAck) -> None:
        self._replies = replies_to_client
        self._last_ack = last_ack
        self._current: Submission | None = None
        self._next: Submission | None = None
        """Collected while the one before is still being stopped."""

    @property
    def current(self) -> Submission | None:
        """What the station was asked for and has not answered yet."""
        return self._current

    @property
    def _following(self) -> Following | None:
        """What keeps the client waiting, if anything does."""
        return self._current.following if self._current is not None else None

    @property
    def deadline_ns(self) -> int | None:
        """When `wake` is due; None: nothing is waited for."""
        return self._following.deadline_ns if self._following is not None else None

    # ----------------------------------------------------------------------- the client

    def submit(self, new: Submission) -> list[PlanEffect]:
        """The client asks for this, now or when the one before it has been stopped."""
        before = self._current
        if before is None:
            self._current = new
            return [_to_station(new)]
        if new.plan is not None and before.plan == new.plan and not before.withdrawn:
            # The same plan once more: it is on its way already.
            before.following = new.following
            return []
        self._next = new
        if before.withdrawn:
            return []
        wanted = "wants it cleared" if new.plan is None else "has sent another plan"
        return _withdraw(before, f"the client {wanted}")

    def clears(self, kind: MissionType) -> bool:
        """A clear of this kind is being done."""
        current = self._current
        return current is not None and current.plan is None and current.kind == kind

    def cancel(self) -> list[PlanEffect]:
        """The client does not want the current one any more."""
        if self._current is None or self._current.withdrawn:
            return []
        return _withdraw(self._current, "the client has cancelled it")

    def item(self, message: ItemMessage, asked_by: From, now_ns: int) -> list[PlanEffect]:
        """An item of a plan that is here already: it was asked for once more, or its
        acknowledgement has got lost."""
        current, following = self._current, self._following
        if current is None or following is None:
            return self._last_ack.item(message, asked_by, now_ns)
        if asked_by.source != current.asked_by.source or message.mission_type != current.kind:
            return []
        questions = following.item(message.seq, now_ns)
        return replies(current.asked_by, questions) + self._acknowledge_if_ready(now_ns)

    def wake(self, now_ns: int) -> list[PlanEffect]:
        """`deadline_ns` has passed."""
        current, following = self._current, self._following
        if current is None or following is None:
            return []
        questions = following.wake(now_ns)
        return replies(current.asked_by, questions) + self._acknowledge_if_ready(now_ns)

    # ----------------------------------------------------------------------- the station

    def finding(self, text: str, now_ns: int) -> list[PlanEffect]:
        """Something that is wrong with the plan, for the client to read."""
        current = self._current
        if current is None or current.withdrawn or current.findings >= MOST_FINDINGS:
            return []
        current.findings += 1
        return self._replies.text(current.asked_by, Level.WARNING, text, now_ns)

    def decided(self, event: ipc.VerdictEvent, now_ns: int) -> list[PlanEffect]:
        """The verdict on the `Upload` or `Clear` that was asked for last."""
        if event.outcome == "accepted":
            return []
        return self._failed(event.code, event.sentence, now_ns)

    def ended(self, event: ipc.EndingEvent, now_ns: int) -> list[PlanEffect]:
        """How it ended after it was accepted."""
        if event.ended == "complete":
            return self._complete(now_ns)
        return self._failed(event.code, event.sentence, now_ns)

    def _complete(self, now_ns: int) -> list[PlanEffect]:
        current = self._current
        if current is None:
            return []
        if current.withdrawn:
            return self._go_on()
        current.result = MissionResult.ACCEPTED
        if current.following is None:
            return self._acknowledge_if_ready(now_ns)
        questions = current.following.finish(now_ns)
        return replies(current.asked_by, questions) + self._acknowledge_if_ready(now_ns)

    def _failed(self, code: str, sentence: str, now_ns: int) -> list[PlanEffect]:
        """Refused, or begun and failed."""
        current = self._current
        if current is None:
            return []
        if current.withdrawn:
            return self._go_on()
        result = result_of(code, sentence)
        text = f"{code}: {sentence}"
        said = self._replies.text(current.asked_by, Level.WARNING, text, now_ns)
        return [*said, *self._acknowledge(current, result, now_ns)]

    def _acknowledge_if_ready(self, now_ns: int) -> list[PlanEffect]:
        current = self._current
        if current is None or current.result is None:
            return []
        if current.following is not None and not current.following.ready:
            return []
        return self._acknowledge(current, current.result, now_ns)

    def _acknowledge(
        self, over: Submission, result: MissionResult, now_ns: int
    ) -> list[PlanEffect]:
        """The MISSION_ACK; it may be told once more, if it gets lost."""
        opened = over.opened
        opaque_id = opened.opaque_id if opened and result is MissionResult.ACCEPTED else 0
        ack = acknowledgement(over.asked_by.source, result, over.kind, opaque_id)
        count = opened.count if opened else 0
        self._last_ack.sent(
            over.asked_by, ack, over.kind, count, now_ns, as_int=over.as_int, lossy=over.lossy
        )
        return [reply(over.asked_by, ack), *self._go_on()]

    def _go_on(self) -> list[PlanEffect]:
        """With what the client has asked for since."""
        self._current, self._next = self._next, None
        if self._current is None:
            return []
        self._last_ack.forget()
        return [_to_station(self._current)]


def _to_station(submission: Submission) -> PlanEffect:
    plan = submission.plan
    return Clear(submission.kind) if plan is None else Upload(plan)


def _withdraw(submission: Submission, reason: str) -> list[PlanEffect]:
    """Its client is asked for nothing any more; the station says when it has stopped it."""
    submission.withdrawn, submission.following = True, None
    return [Withdraw(reason)]
