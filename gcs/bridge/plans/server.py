"""The mission protocol towards one MAVLink client, as if the station were the vehicle.

    COUNT ──▶ collecting ──all items──▶ Submission ──▶ Upload, to the station (`submissions`)
                 │
                 │ silence, a bad item, another plan or a clear
                 ▼
              MISSION_ACK, repeated where it gets lost (`last_ack`)

https://mavlink.io/en/services/mission.html.  Nothing of a plan reaches the vehicle before all of
it is here.  Downloads go to the vehicle as they are.
"""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import Final

from gcs import ipc
from gcs.bridge.client_plan import ClientPlan
from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.plans.collecting import Collecting, ItemMessage
from gcs.bridge.plans.effects import Pass, PlanEffect, SetCurrent
from gcs.bridge.plans.following import Following
from gcs.bridge.plans.last_ack import LastAck
from gcs.bridge.plans.replies import MISSION_PLANNER, NAMES, Replies, replies, reply
from gcs.bridge.plans.submissions import Submission, Submissions
from gcs.gate.refusal import Code
from gcs.protocol.transfers.transfer import SPEC_TIMING, Timing
from gcs.wire.ids import Component, MissionResult, MissionType
from gcs.wire.messages import (
    Message,
    MissionAck,
    MissionClearAll,
    MissionCount,
    MissionItem,
    MissionItemInt,
    MissionRequest,
    MissionRequestInt,
    MissionRequestList,
    MissionRequestPartialList,
    MissionSetCurrent,
    MissionWritePartialList,
)

MOST_ITEMS: Final[Mapping[MissionType, int]] = {
    MissionType.MISSION: 2_000,
    MissionType.FENCE: 500,
    MissionType.RALLY: 100,
}
"""A mission of more items keeps the 20 Hz tick waiting (`vehicle/missions/plans.py`); the vehicle
may have room for fewer, and says so itself."""
PLAN_MESSAGES: Final[tuple[type[Message], ...]] = (
    MissionCount,
    MissionItem,
    MissionItemInt,
    MissionAck,
    MissionClearAll,
    MissionWritePartialList,
    MissionSetCurrent,
    MissionRequestList,
    MissionRequestPartialList,
    MissionRequest,
    MissionRequestInt,
)
"""What `PlanServer.handle` takes: all that a client says about plans."""


class PlanServer:
    """One client's plans.

    `handle` takes every message of `PLAN_MESSAGES` that this client has sent to the vehicle,
    `wake` is due at `deadline_ns`.  What became of an `Upload` or `Clear` is told with `decided`
    (its verdict) and `ended` (its ending, if it was accepted); what is wrong with the plan with
    `finding`, before the verdict.  All return effects; `Reply` goes to the client.
    """

    def __init__(
        self,
        timing: Timing = SPEC_TIMING,
        most_items: Mapping[MissionType, int] = MOST_ITEMS,
    ) -> None:
        """`timing` is for this client's link; `most_items`: longer plans are answered NO_SPACE."""
        self._timing = timing
        self._most_items = most_items
        self._collecting: Collecting | None = None
        self._replies = Replies()
        self._last_ack = LastAck(timing)
        self._submissions = Submissions(self._replies, self._last_ack)

    @property
    def deadline_ns(self) -> int | None:
        """When `wake` is due; None: nothing is waited for."""
        collecting_ns = self._collecting.deadline_ns if self._collecting is not None else None
        times = (collecting_ns, self._submissions.deadline_ns, self._last_ack.deadline_ns)
        return min((time for time in times if time is not None), default=None)

    @property
    def busy(self) -> bool:
        """An upload of this client is under way, from its first message to its answer."""
        return self._collecting is not None or self._submissions.current is not None

    def under_way(self, kinds: Container[MissionType]) -> bool:
        """A plan of one of these types is being collected, or is on its way to the vehicle."""
        collected = self._collecting is not None and self._collecting.kind in kinds
        return collected or any(each in kinds for each in self._submissions.kinds)

    # ----------------------------------------------------------------------- the station

    def finding(self, text: str, now_ns: int) -> list[PlanEffect]:
        """Something that is wrong with the plan, for the client to read."""
        return self._submissions.finding(text, now_ns)

    def decided(self, event: ipc.VerdictEvent, now_ns: int) -> list[PlanEffect]:
        """The verdict on the `Upload` or `Clear` that was asked for last."""
        return self._submissions.decided(event, now_ns)

    def ended(self, event: ipc.EndingEvent, now_ns: int) -> list[PlanEffect]:
        """How it ended after it was accepted."""
        return self._submissions.ended(event, now_ns)

    # ----------------------------------------------------------------------- the client

    def handle(
        self, message: Message, asked_by: From, now_ns: int, *, mission_alone: bool = False
    ) -> list[PlanEffect]:
        """One message of this client about plans.  `mission_alone`: of all plans that it clears
        there is a mission at the most."""
        match message:
            case MissionCount():
                return self._count(message, asked_by, now_ns)
            case MissionItem() | MissionItemInt():
                return self._item(message, asked_by, now_ns)
            case MissionAck():
                return self._acknowledged(message, asked_by, now_ns)
            case MissionClearAll():
                return self._clear(message, asked_by, now_ns, mission_alone=mission_alone)
            case MissionWritePartialList():
                text = "a part of a plan cannot be verified: send the whole plan"
                return self._replies.refuse(
                    asked_by, message, MissionResult.UNSUPPORTED, Code.UNSUPPORTED, text, now_ns
                )
            case MissionSetCurrent(seq=seq):
                return [SetCurrent(seq)]
            case (
                MissionRequestList()
                | MissionRequestPartialList()
                | MissionRequest()
                | MissionRequestInt()
            ):
                self._last_ack.forget()  # it has gone on to something else
                return [Pass()]
            case _:
                return []

    def _count(self, message: MissionCount, asked_by: From, now_ns: int) -> list[PlanEffect]:
        """An upload begins, or its first message comes again."""
        self._last_ack.forget()
        refused = self._cannot_take(message, asked_by, now_ns)
        if refused is not None:
            return refused
        kind = MissionType(message.mission_type)
        if message.count > self._most_items[kind]:
            text = f"{NAMES[kind]} of {message.count} items: at most {self._most_items[kind]}"
            return self._replies.refuse(
                asked_by, message, MissionResult.NO_SPACE, Code.BAD_MISSION, text, now_ns
            )
        if message.count == 0:
            return self._begin_clear(Submission(asked_by, kind), now_ns, begins_anew=True)
        collecting = self._collecting
        if collecting is not None and collecting.opened == message and not collecting.items:
            return replies(asked_by, collecting.again(now_ns))
        given_up: list[PlanEffect] = []
        if collecting is not None and collecting.kind != kind:
            given_up = self._replaced(collecting, f"by another upload, of {NAMES[kind]}", now_ns)
        self._collecting = Collecting(message, asked_by, self._timing)
        self._replies.another_plan()
        return given_up + replies(asked_by, self._collecting.start(now_ns))

    def _cannot_take(
        self, message: MissionCount | MissionClearAll, asked_by: From, now_ns: int
    ) -> list[PlanEffect] | None:
        """Why nothing like this can be taken now; None where it can."""
        if asked_by.addressed.compid not in (Component.AUTOPILOT1, MISSION_PLANNER):
            text = f"component {asked_by.addressed.compid} takes no plans through this station"
            return self._replies.refuse(
                asked_by, message, MissionResult.UNSUPPORTED, Code.UNSUPPORTED, text, now_ns
            )
        known = message.mission_type in NAMES
        if not known and not (
            isinstance(message, MissionClearAll) and message.mission_type == MissionType.ALL
        ):
            text = f"mission type {message.mission_type} is not known here"
            return self._replies.refuse(
                asked_by, message, MissionResult.UNSUPPORTED, Code.UNSUPPORTED, text, now_ns
            )
        current = self._submissions.current
        other = current.asked_by if current is not None else None
        other = self._collecting.opened_by if self._collecting is not None else other
        if other is not None and other.source != asked_by.source:
            who = f"{other.source.sysid}/{other.source.compid}"
            text = f"a plan of {who}, on the same link, is still under way"
            return self._replies.refuse(
                asked_by, message, MissionResult.DENIED, Code.BUSY, text, now_ns
            )
        return None

    def _item(self, message: ItemMessage, asked_by: From, now_ns: int) -> list[PlanEffect]:
        collecting = self._collecting
        if collecting is None or message.mission_type != collecting.kind:
            return self._submissions.item(message, asked_by, now_ns)
        opened_by = collecting.opened_by
        if asked_by.source != opened_by.source:
            return []
        questions = collecting.item(message, now_ns)
        return replies(opened_by, questions) + self._collected(collecting, now_ns)

    def _collected(self, collecting: Collecting, now_ns: int) -> list[PlanEffect]:
        """Where the last item is here, ask the station; where one is bad, refuse."""
        opened, opened_by = collecting.opened, collecting.opened_by
        if collecting.bad_item is not None:
            self._collecting = None
            text = f"item {collecting.bad_item}: its place is no latitude and longitude"
            return self._replies.refuse(
                opened_by, opened, MissionResult.INVALID, Code.BAD_MISSION, text, now_ns
            )
        if not collecting.whole:
            return []
        self._collecting = None
        kind, client, as_int = collecting.kind, opened_by.source, collecting.asks_int
        source = f"the {NAMES[kind]} of {client.sysid}/{client.compid}"
        following = Following(
            opened.count, client, kind, as_int, collecting.answer_ns, self._timing, now_ns
        )
        submission = Submission(
            opened_by,
            kind,
            ClientPlan(kind, tuple(collecting.items), source),
            opened,
            following,
            as_int,
            lossy=collecting.repeated > 0,
        )
        return self._submissions.submit(submission, now_ns)

    def _acknowledged(self, message: MissionAck, asked_by: From, now_ns: int) -> list[PlanEffect]:
        """The client ends a download (that is the vehicle's to hear), or its own upload."""
        if message.type == MissionResult.ACCEPTED:
            return [Pass()]
        collecting, current = self._collecting, self._submissions.current
        of_another = self._submissions.of(message.mission_type) is not None
        if collecting is not None and (collecting.kind == message.mission_type or not of_another):
            opened_by = collecting.opened_by
            if opened_by.source != asked_by.source:
                return [Pass()]
            if message.type == MissionResult.UNSUPPORTED:
                if collecting.items:
                    return []
                return replies(opened_by, collecting.unsupported(now_ns))
            self._collecting = None
            return []
        if current is None or current.asked_by.source != asked_by.source:
            return [Pass()]
        if message.type == MissionResult.UNSUPPORTED:
            return []
        return self._submissions.cancel(message.mission_type)

    def _clear(
        self, message: MissionClearAll, asked_by: From, now_ns: int, *, mission_alone: bool
    ) -> list[PlanEffect]:
        refused = self._cannot_take(message, asked_by, now_ns)
        if refused is not None:
            return refused
        again = self._last_ack.of_clear(message.mission_type, now_ns)
        if again is not None:
            return [reply(asked_by, again)]
        self._last_ack.forget()
        kind = MissionType(message.mission_type)
        new = Submission(asked_by, kind, mission_alone=mission_alone)
        return self._begin_clear(new, now_ns, begins_anew=False)

    def _begin_clear(self, new: Submission, now_ns: int, *, begins_anew: bool) -> list[PlanEffect]:
        """A plan of no items is none.  It `begins_anew`, as each first message of an upload does:
        it alone is acknowledged, and not what it replaces."""
        kind = new.kind
        if self._submissions.clears(kind):
            return []
        given_up: list[PlanEffect] = []
        collecting = self._collecting
        if collecting is not None and kind in (collecting.kind, MissionType.ALL):
            self._collecting = None
            if not begins_anew:
                given_up = self._replaced(collecting, "as it is to be cleared", now_ns)
        if not begins_anew:
            given_up += self._submissions.give_up(kind, now_ns)
        self._replies.another_plan()
        return given_up + self._submissions.submit(new, now_ns)

    # ----------------------------------------------------------------------------- time

    def wake(self, now_ns: int) -> list[PlanEffect]:
        """`deadline_ns` has passed."""
        effects: list[PlanEffect] = []
        collecting = self._collecting
        if collecting is not None:
            effects += replies(collecting.opened_by, collecting.wake(now_ns))
            if collecting.given_up:
                effects += self._silent(collecting, now_ns)
        return effects + self._submissions.wake(now_ns) + self._last_ack.wake(now_ns)

    def _silent(self, collecting: Collecting, now_ns: int) -> list[PlanEffect]:
        had, count = len(collecting.items), collecting.opened.count
        text = f"{NAMES[collecting.kind]}: item {had} of {count} did not come"
        return self._give_up(collecting, Code.NO_ANSWER, text, now_ns)

    def _replaced(self, collecting: Collecting, why: str, now_ns: int) -> list[PlanEffect]:
        had, count = len(collecting.items), collecting.opened.count
        text = f"{NAMES[collecting.kind]}: given up after {had} of {count} items, {why}"
        return self._give_up(collecting, Code.SUPERSEDED, text, now_ns)

    def _give_up(
        self, collecting: Collecting, code: Code, text: str, now_ns: int
    ) -> list[PlanEffect]:
        """An upload ends before all of it is here, and its client is told."""
        self._collecting = None
        opened = collecting.opened
        if self._submissions.began_with(opened):
            return []  # it was the first message of a plan that is on its way, once more
        cancelled = MissionResult.OPERATION_CANCELLED
        return self._replies.refuse(
            collecting.opened_by, opened, cancelled, code, text, now_ns, earlier=True
        )
