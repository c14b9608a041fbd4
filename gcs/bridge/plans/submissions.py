"""What the station was asked for on behalf of a client, until the client has its MISSION_ACK.

submitted: Upload, Clear ──▶ decided: refused ──▶ MISSION_ACK, texts
               │                └──▶ accepted, on its way to the vehicle;
               │                     `following` keeps the client waiting
               │                     └──▶ ended ──▶ MISSION_ACK, once
               └ cancelled, replaced ──▶ Withdraw ──▶ ended ──▶ the next one

The station works on one at a time.  One of another type waits for that; one of the same type takes
its place, and a clear of all that of every upload.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from gcs import ipc
from gcs.bridge.client_plan import ClientPlan
from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.plans.collecting import ItemMessage, acknowledgement
from gcs.bridge.plans.effects import Clear, PlanEffect, Upload, Withdraw
from gcs.bridge.plans.following import Following
from gcs.bridge.plans.last_ack import LastAck
from gcs.bridge.plans.replies import NAMES, Replies, replies, reply
from gcs.bridge.plans.results import result_of
from gcs.gate.effects import Level
from gcs.gate.refusal import Code
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
    mission_alone: bool = False
    """A clear of all plans: there is no other plan than a mission."""


class Submissions:
    """The one that the station works on, and those that wait until that is over."""

    def __init__(self, replies_to_client: Replies, last_ack: LastAck) -> None:
        self._replies = replies_to_client
        self._last_ack = last_ack
        self._current: Submission | None = None
        self._waiting: list[Submission] = []
        """Of other types, or of the one that is still being stopped; one of each at the most."""

    @property
    def current(self) -> Submission | None:
        """What the station was asked for and has not answered yet."""
        return self._current

    @property
    def kinds(self) -> list[MissionType]:
        """Of all that is not over, also where the client does not want it any more."""
        first = [] if self._current is None else [self._current]
        return [each.kind for each in (*first, *self._waiting)]

    @property
    def _wanted(self) -> list[Submission]:
        """What the client still waits for."""
        first = [] if self._current is None or self._current.withdrawn else [self._current]
        return [*first, *self._waiting]

    @property
    def deadline_ns(self) -> int | None:
        """When `wake` is due; None: nothing is waited for."""
        times = [each.following.deadline_ns for each in self._wanted if each.following is not None]
        return min((time for time in times if time is not None), default=None)

    # ----------------------------------------------------------------------- the client

    def submit(self, new: Submission, now_ns: int) -> list[PlanEffect]:
        """The client asks for this, now or when what is before it is over."""
        before = self._current
        if before is None:
            self._current = new
            return [_to_station(new)]
        same = self.of(new.kind)
        if same is not None and new.plan is not None and same.plan == new.plan:
            # The same plan once more: it is on its way already.
            same.following = new.following
            return []
        self._waiting = [each for each in self._waiting if not _replaces(new, each)]
        self._waiting.append(new)
        if before.withdrawn or not _replaces(new, before):
            return []
        wanted = "wants it cleared" if new.plan is None else "has sent another plan"
        return self._stop(before, f"the client {wanted}")

    def of(self, kind: int) -> Submission | None:
        """The one of this type that the client waits for."""
        return next((each for each in self._wanted if each.kind == kind), None)

    def began_with(self, opened: MissionCount) -> bool:
        """One of those that the client waits for began with this message."""
        return any(each.opened == opened for each in self._wanted)

    def clears(self, kind: MissionType) -> bool:
        """A clear of this kind is being done, or waits."""
        same = self.of(kind)
        return same is not None and same.plan is None

    def give_up(self, kind: MissionType, now_ns: int) -> list[PlanEffect]:
        """The plans of this type are to be cleared: who waits for one of them is told.  Of what the
        station is asked to stop, it says so itself for the log."""
        effects: list[PlanEffect] = []
        for each in self._wanted:
            if each.opened is None or kind not in (each.kind, MissionType.ALL):
                continue
            text = f"{NAMES[each.kind]}: given up, as it is to be cleared"
            to, opened, cancelled = each.asked_by, each.opened, MissionResult.OPERATION_CANCELLED
            if each is not self._current:
                effects += self._replies.refuse(
                    to, opened, cancelled, Code.SUPERSEDED, text, now_ns, earlier=True
                )
            elif each.result is None:
                effects += self._replies.text(to, Level.WARNING, text, now_ns)
                effects.append(reply(to, acknowledgement(to.source, cancelled, each.kind)))
            else:
                effects.append(reply(to, acknowledgement(to.source, each.result, each.kind)))
        return effects

    def cancel(self, kind: int) -> list[PlanEffect]:
        """The client does not want the one of this type any more, or, without one, the current."""
        over = self.of(kind) or self._current
        if over is None or over.withdrawn:
            return []
        if over is self._current:
            return self._stop(over, "the client has cancelled it")
        self._waiting.remove(over)
        return []

    def _stop(self, current: Submission, reason: str) -> list[PlanEffect]:
        """Its client is asked for nothing any more; the station says when it has stopped it, unless
        it has done it already."""
        if current.result is not None:
            return self._go_on()
        current.withdrawn, current.following = True, None
        return [Withdraw(reason)]

    def item(self, message: ItemMessage, asked_by: From, now_ns: int) -> list[PlanEffect]:
        """An item of a plan that is here already: it was asked for once more, or its
        acknowledgement has got lost."""
        found = self.of(message.mission_type)
        if found is None or found.following is None:
            return self._last_ack.item(message, asked_by, now_ns)
        if asked_by.source != found.asked_by.source:
            return []
        questions = found.following.item(message.seq, now_ns)
        return replies(found.asked_by, questions) + self._acknowledge_if_ready(now_ns)

    def wake(self, now_ns: int) -> list[PlanEffect]:
        """`deadline_ns` has passed."""
        effects: list[PlanEffect] = []
        for each in self._wanted:
            if each.following is not None:
                effects += replies(each.asked_by, each.following.wake(now_ns))
        return effects + self._acknowledge_if_ready(now_ns)

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
        over, self._current = self._current, None
        if not self._waiting:
            return []
        following = self._current = self._waiting.pop(0)
        if over is None or over.plan is None or over.kind == following.kind:
            self._last_ack.forget()
        return [_to_station(following)]


def _to_station(submission: Submission) -> PlanEffect:
    if submission.plan is not None:
        return Upload(submission.plan)
    return Clear(MissionType.MISSION if submission.mission_alone else submission.kind)


def _replaces(new: Submission, before: Submission) -> bool:
    """Whether `before` is not wanted any more."""
    return new.kind == before.kind or (new.kind == MissionType.ALL and before.plan is not None)
