"""The mission protocol towards one MAVLink client, as if the station were the vehicle.

    COUNT ──▶ collecting ──all items──▶ Upload ──▶ decided: refused ──▶ MISSION_ACK, texts
                 │                         └──▶ accepted, on its way to the vehicle;
                 │ silence, a bad item          `following` keeps the client waiting
                 ▼                              └──▶ ended ──▶ MISSION_ACK, once
              MISSION_ACK

https://mavlink.io/en/services/mission.html.  Nothing of a plan reaches the vehicle before all of
it is here.  Downloads go to the vehicle as they are.  Answers are in the name of the autopilot, as
PX4's are to a client that addresses it as 0 or as MAV_COMP_ID_MISSIONPLANNER.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from gcs import ipc
from gcs.bridge.answers import texts
from gcs.bridge.client_plan import ClientPlan
from gcs.bridge.dialogue import From
from gcs.bridge.effects import Answers
from gcs.bridge.plans.collecting import Collecting, ItemMessage, acknowledgement, question
from gcs.bridge.plans.effects import (
    Clear,
    Pass,
    PlanEffect,
    Refused,
    SetCurrent,
    Upload,
    Withdraw,
)
from gcs.bridge.plans.following import Following
from gcs.bridge.plans.results import result_of
from gcs.bridge.recent_texts import RecentTexts
from gcs.gate.effects import Level
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.effects import Address
from gcs.protocol.transfer import SPEC_TIMING, Timing
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

MISSION_PLANNER: Final = 190
"""MAV_COMP_ID_MISSIONPLANNER: PX4 takes plans that are addressed to it (`mavlink_mission.cpp`)."""
MOST_ITEMS: Final[Mapping[MissionType, int]] = {
    MissionType.MISSION: 2_000,
    MissionType.FENCE: 500,
    MissionType.RALLY: 100,
}
"""A mission of more items keeps the 20 Hz tick waiting (`session/plans.py`); the vehicle may have
room for fewer, and says so itself."""
NAMES: Final = {
    MissionType.MISSION: "mission",
    MissionType.FENCE: "fence",
    MissionType.RALLY: "rally points",
}
ACK_REPEATED_NS: Final = 15_000_000_000
"""How long a client that sends its last item again is told the result again."""
PROBE_NS: Final = 400_000_000
PROBES: Final = 4
"""On a link that loses frames the last item is asked for once more after the ACK: a client that
answers has not heard it."""
MOST_FINDINGS: Final = 10
"""Findings of one plan that a client is sent as texts; the log has all."""

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


@dataclass(slots=True)
class _Asked:
    """What the station was asked for and has not answered yet: an upload, or (no plan) a clear."""

    asked_by: From
    kind: MissionType
    plan: ClientPlan | None
    opened: MissionCount | None
    following: Following | None
    as_int: bool
    lossy: bool
    result: MissionResult | None = None
    """Known, but the client is not ready for it yet."""
    withdrawn: bool = False
    told: int = 0


@dataclass(slots=True)
class _Told:
    """The last answer, in case it gets lost."""

    asked_by: From
    ack: MissionAck
    kind: MissionType
    count: int
    as_int: bool
    until_ns: int
    probes: int
    probe_ns: int | None


class PlanServer:
    """One client's plans.

    `handle` takes every message of `PLAN_MESSAGES` that this client has sent to the vehicle,
    `wake` is due at `deadline_ns`.  What became of an `Upload` or `Clear` is told with `decided`
    (its verdict) and `ended` (its ending, if it was accepted); what is wrong with the plan with
    `finding`, before the verdict.  All return effects; `Answers` go to the client.
    """

    def __init__(
        self,
        timing: Timing = SPEC_TIMING,
        most_items: Mapping[MissionType, int] = MOST_ITEMS,
    ) -> None:
        """`timing` is for this client's link; `most_items`: longer plans are answered NO_SPACE."""
        self._timing = timing
        self._scale = timing.item_wait_ns / SPEC_TIMING.item_wait_ns
        self._most_items = most_items
        self._collecting: Collecting | None = None
        self._collecting_by: From | None = None
        self._asked: _Asked | None = None
        self._next: _Asked | None = None
        """Collected while the one before is still being stopped."""
        self._told: _Told | None = None
        self._text_id = 0
        self._texts = RecentTexts()

    @property
    def deadline_ns(self) -> int | None:
        """When `wake` is due; None: nothing is waited for."""
        times = []
        if self._collecting is not None:
            times.append(self._collecting.deadline_ns)
        if self._asked is not None and self._asked.following is not None:
            times.append(self._asked.following.deadline_ns)
        if self._told is not None:
            times.append(self._told.probe_ns)
        return min((time for time in times if time is not None), default=None)

    @property
    def busy(self) -> bool:
        """An upload of this client is under way, from its first message to its answer."""
        return self._collecting is not None or self._asked is not None

    # ----------------------------------------------------------------------- the client

    def handle(self, message: Message, asked_by: From, now_ns: int) -> list[PlanEffect]:
        """One message of this client about plans."""
        match message:
            case MissionCount():
                return self._count(message, asked_by, now_ns)
            case MissionItem() | MissionItemInt():
                return self._item(message, asked_by, now_ns)
            case MissionAck():
                return self._acknowledged(message, asked_by, now_ns)
            case MissionClearAll():
                return self._clear(message, asked_by, now_ns)
            case MissionWritePartialList():
                text = "a part of a plan cannot be verified: send the whole plan"
                return self._refuse(
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
                self._told = None  # it has gone on to something else
                return [Pass()]
            case _:
                return []

    def _count(self, message: MissionCount, asked_by: From, now_ns: int) -> list[PlanEffect]:
        """An upload begins, or its first message comes again."""
        self._told = None
        refused = self._cannot_take(message, asked_by, now_ns)
        if refused is not None:
            return refused
        kind = MissionType(message.mission_type)
        if message.count > self._most_items[kind]:
            text = f"{NAMES[kind]} of {message.count} items: at most {self._most_items[kind]}"
            return self._refuse(
                asked_by, message, MissionResult.NO_SPACE, Code.BAD_MISSION, text, now_ns
            )
        if message.count == 0:
            return self._begin_clear(kind, asked_by)
        collecting = self._collecting
        if collecting is not None and collecting.opened == message and not collecting.items:
            return self._to(asked_by, collecting.again(now_ns))
        self._collecting_by = asked_by
        self._collecting = Collecting(message, asked_by.source, self._timing)
        return self._to(asked_by, self._collecting.start(now_ns))

    def _cannot_take(
        self, message: MissionCount | MissionClearAll, asked_by: From, now_ns: int
    ) -> list[PlanEffect] | None:
        """Why nothing like this can be taken now; None where it can."""
        if asked_by.addressed.compid not in (Component.AUTOPILOT1, MISSION_PLANNER):
            text = f"component {asked_by.addressed.compid} takes no plans through this station"
            return self._refuse(
                asked_by, message, MissionResult.UNSUPPORTED, Code.UNSUPPORTED, text, now_ns
            )
        known = message.mission_type in NAMES
        if not known and not (
            isinstance(message, MissionClearAll) and message.mission_type == MissionType.ALL
        ):
            text = f"mission type {message.mission_type} is not known here"
            return self._refuse(
                asked_by, message, MissionResult.UNSUPPORTED, Code.UNSUPPORTED, text, now_ns
            )
        other = self._collecting_by if self._collecting else None
        other = other or (self._asked.asked_by if self._asked else None)
        if other is not None and other.source != asked_by.source:
            who = f"{other.source.sysid}/{other.source.compid}"
            text = f"a plan of {who}, on the same link, is still under way"
            return self._refuse(asked_by, message, MissionResult.DENIED, Code.BUSY, text, now_ns)
        return None

    def _item(self, message: ItemMessage, asked_by: From, now_ns: int) -> list[PlanEffect]:
        collecting, asked = self._collecting, self._asked
        if collecting is not None and self._collecting_by is not None:
            opened_by = self._collecting_by
            ours = asked_by.source == opened_by.source
            if ours and message.mission_type == collecting.opened.mission_type:
                questions = collecting.item(message, now_ns)
                return self._to(opened_by, questions) + self._collected(now_ns)
            return []
        if asked is not None and asked.following is not None:
            if asked_by.source == asked.asked_by.source and message.mission_type == asked.kind:
                questions = asked.following.item(message.seq, now_ns)
                return self._to(asked.asked_by, questions) + self._answer_if_ready(now_ns)
            return []
        return self._late_item(message, asked_by, now_ns)

    def _collected(self, now_ns: int) -> list[PlanEffect]:
        """Where the last item is here, ask the station; where one is bad, refuse."""
        collecting, opened_by = self._collecting, self._collecting_by
        assert collecting is not None
        assert opened_by is not None
        kind = MissionType(collecting.opened.mission_type)
        if collecting.bad_item is not None:
            self._collecting = None
            text = f"item {collecting.bad_item}: its place is no latitude and longitude"
            return self._refuse(
                opened_by, collecting.opened, MissionResult.INVALID, Code.BAD_MISSION, text, now_ns
            )
        if not collecting.whole:
            return []
        self._collecting = None
        source = f"the {NAMES[kind]} of {opened_by.source.sysid}/{opened_by.source.compid}"
        plan = ClientPlan(kind, tuple(collecting.items), source)
        client, as_int = opened_by.source, collecting.asks_int
        count = collecting.opened.count
        asked = _Asked(
            opened_by,
            kind,
            plan,
            collecting.opened,
            Following(count, client, kind, as_int, collecting.answer_ns, self._timing, now_ns),
            as_int,
            collecting.repeated > 0,
        )
        before = self._asked
        if before is None:
            self._asked = asked
            return [Upload(plan)]
        if before.plan == plan and not before.withdrawn:
            # The same plan once more: it is on its way already.
            before.following = asked.following
            return []
        self._next = asked
        if before.withdrawn:
            return []
        before.withdrawn, before.following = True, None
        return [Withdraw("the client has sent another plan")]

    def _acknowledged(self, message: MissionAck, asked_by: From, now_ns: int) -> list[PlanEffect]:
        """The client ends a download (that is the vehicle's to hear), or its own upload."""
        if message.type == MissionResult.ACCEPTED:
            return [Pass()]
        collecting, asked = self._collecting, self._asked
        if collecting is not None and self._collecting_by is not None:
            opened_by = self._collecting_by
            if opened_by.source != asked_by.source:
                return [Pass()]
            if message.type == MissionResult.UNSUPPORTED:
                if collecting.items:
                    return []
                return self._to(opened_by, collecting.unsupported(now_ns))
            self._collecting = None
            return []
        if asked is not None and asked.asked_by.source == asked_by.source:
            if message.type == MissionResult.UNSUPPORTED or asked.withdrawn:
                return []
            asked.withdrawn, asked.following = True, None
            return [Withdraw("the client has cancelled it")]
        return [Pass()]

    # ---------------------------------------------------------------------------- clear

    def _clear(self, message: MissionClearAll, asked_by: From, now_ns: int) -> list[PlanEffect]:
        refused = self._cannot_take(message, asked_by, now_ns)
        if refused is not None:
            return refused
        told = self._told
        repeated = told is not None and told.count == 0 and told.kind == message.mission_type
        if told is not None and repeated and now_ns < told.until_ns:
            return [self._answer(asked_by, told.ack)]
        self._told = None
        return self._begin_clear(MissionType(message.mission_type), asked_by)

    def _begin_clear(self, kind: MissionType, asked_by: From) -> list[PlanEffect]:
        """A plan of no items, too, is none."""
        asked = self._asked
        if asked is not None and asked.plan is None and asked.kind == kind:
            return []  # it is being done
        self._collecting = None
        clear = _Asked(asked_by, kind, None, None, None, True, False)
        if asked is None:
            self._asked = clear
            return [Clear(kind)]
        self._next = clear
        if asked.withdrawn:
            return []
        asked.withdrawn, asked.following = True, None
        return [Withdraw("the client wants it cleared")]

    # ----------------------------------------------------------------------- the station

    def finding(self, text: str, now_ns: int) -> list[PlanEffect]:
        """Something that is wrong with the plan, for the client to read."""
        asked = self._asked
        if asked is None or asked.withdrawn or asked.told >= MOST_FINDINGS:
            return []
        asked.told += 1
        return self._text(asked.asked_by, Level.WARNING, text, now_ns)

    def decided(self, event: ipc.VerdictEvent, now_ns: int) -> list[PlanEffect]:
        """The verdict on the `Upload` or `Clear` that was asked for last."""
        if event.outcome == "accepted":
            return []
        return self._over(event.code, event.sentence, now_ns)

    def ended(self, event: ipc.EndingEvent, now_ns: int) -> list[PlanEffect]:
        """How it ended after it was accepted."""
        if event.ended == "complete":
            return self._complete(now_ns)
        return self._over(event.code, event.sentence, now_ns)

    def _complete(self, now_ns: int) -> list[PlanEffect]:
        asked = self._asked
        if asked is None:
            return []
        if asked.withdrawn:
            return self._go_on(now_ns)
        asked.result = MissionResult.ACCEPTED
        if asked.following is None:
            return self._answer_if_ready(now_ns)
        questions = asked.following.finish(now_ns)
        return self._to(asked.asked_by, questions) + self._answer_if_ready(now_ns)

    def _over(self, code: str, sentence: str, now_ns: int) -> list[PlanEffect]:
        """Refused, or begun and failed."""
        asked = self._asked
        if asked is None:
            return []
        if asked.withdrawn:
            return self._go_on(now_ns)
        asked.result = result_of(code, sentence)
        said = self._text(asked.asked_by, Level.WARNING, f"{code}: {sentence}", now_ns)
        return [*said, *self._tell(asked, now_ns)]

    def _answer_if_ready(self, now_ns: int) -> list[PlanEffect]:
        asked = self._asked
        if asked is None or asked.result is None:
            return []
        if asked.following is not None and not asked.following.ready:
            return []
        return self._tell(asked, now_ns)

    def _tell(self, asked: _Asked, now_ns: int) -> list[PlanEffect]:
        """The MISSION_ACK; it may be told once more, if it gets lost."""
        assert asked.result is not None
        opaque_id = asked.opened.opaque_id if asked.opened else 0
        if asked.result is not MissionResult.ACCEPTED:
            opaque_id = 0
        ack = acknowledgement(asked.asked_by.source, asked.result, asked.kind, opaque_id)
        count = asked.opened.count if asked.opened else 0
        probe_ns = self._scaled(PROBE_NS) + now_ns if asked.lossy and count else None
        self._told = _Told(
            asked.asked_by,
            ack,
            asked.kind,
            count,
            asked.as_int,
            now_ns + self._scaled(ACK_REPEATED_NS),
            PROBES,
            probe_ns,
        )
        return [self._answer(asked.asked_by, ack), *self._go_on(now_ns)]

    def _go_on(self, now_ns: int) -> list[PlanEffect]:
        """With what the client has asked for since."""
        self._asked, self._next = self._next, None
        if self._asked is None:
            return []
        self._told = None
        plan = self._asked.plan
        return [Clear(self._asked.kind)] if plan is None else [Upload(plan)]

    # ----------------------------------------------------------------------------- time

    def wake(self, now_ns: int) -> list[PlanEffect]:
        """`deadline_ns` has passed."""
        effects: list[PlanEffect] = []
        collecting, opened_by = self._collecting, self._collecting_by
        if collecting is not None and opened_by is not None:
            effects += self._to(opened_by, collecting.wake(now_ns))
            if collecting.given_up:
                effects += self._silent(collecting, opened_by, now_ns)
        asked = self._asked
        if asked is not None and asked.following is not None:
            effects += self._to(asked.asked_by, asked.following.wake(now_ns))
            effects += self._answer_if_ready(now_ns)
        return effects + self._probe(now_ns)

    def _silent(self, collecting: Collecting, opened_by: From, now_ns: int) -> list[PlanEffect]:
        self._collecting = None
        if self._asked is not None:
            return []  # it was the first message of the plan that is on its way, once more
        kind = MissionType(collecting.opened.mission_type)
        had, count = len(collecting.items), collecting.opened.count
        text = f"{NAMES[kind]}: item {had} of {count} did not come"
        return self._refuse(
            opened_by,
            collecting.opened,
            MissionResult.OPERATION_CANCELLED,
            Code.NO_ANSWER,
            text,
            now_ns,
        )

    def _late_item(self, message: ItemMessage, asked_by: From, now_ns: int) -> list[PlanEffect]:
        """The last item once more, after the answer: the answer has got lost."""
        told = self._told
        if told is None or told.count == 0 or now_ns >= told.until_ns:
            return []
        same = (asked_by.source, message.mission_type) == (told.asked_by.source, told.kind)
        if not same or message.seq + 1 != told.count:
            return []
        if told.probe_ns is not None:
            told.probes, told.probe_ns = PROBES, now_ns + self._scaled(PROBE_NS)
        return [self._answer(told.asked_by, told.ack)]

    def _probe(self, now_ns: int) -> list[PlanEffect]:
        told = self._told
        if told is None or told.probe_ns is None or now_ns < told.probe_ns:
            return []
        if told.probes == 0:
            told.probe_ns = None
            return []
        told.probes -= 1
        told.probe_ns = now_ns + self._scaled(PROBE_NS)
        client = told.asked_by.source
        return self._to(told.asked_by, [question(told.count - 1, client, told.kind, told.as_int)])

    def _scaled(self, span_ns: int) -> int:
        return round(span_ns * self._scale)

    # -------------------------------------------------------------------------- answers

    def _refuse(
        self,
        asked_by: From,
        message: MissionCount | MissionClearAll | MissionWritePartialList,
        result: MissionResult,
        code: Code,
        text: str,
        now_ns: int,
    ) -> list[PlanEffect]:
        """What is refused without the station's verdict."""
        ack = acknowledgement(asked_by.source, result, message.mission_type)
        name = type(message).MSG_ID.name
        return [
            Refused(name, Refusal(code, text)),
            *self._text(asked_by, Level.WARNING, text, now_ns),
            self._answer(asked_by, ack),
        ]

    def _text(self, to: From, level: Level, text: str, now_ns: int) -> list[PlanEffect]:
        """The same words not more often than every few seconds."""
        if not self._texts.is_news(text, now_ns):
            return []
        self._text_id = self._text_id % 0xFFFF + 1
        return [self._answer(to, message) for message in texts(level, text, self._text_id)]

    def _to(self, to: From, messages: Sequence[Message]) -> list[PlanEffect]:
        return [self._answer(to, message) for message in messages]

    @staticmethod
    def _answer(to: From, message: Message) -> Answers:
        compid = to.addressed.compid
        name = Component.AUTOPILOT1 if compid == MISSION_PLANNER else compid
        return Answers(to.link, Address(to.addressed.sysid, name), message)
