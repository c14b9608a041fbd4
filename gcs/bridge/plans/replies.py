"""Messages for a client about its plans: built, addressed, and refusals with their reason.

Answers are in the name of the autopilot, as PX4's are to a client that addresses it as 0 or as
MAV_COMP_ID_MISSIONPLANNER.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from gcs.bridge.conversation.answers import texts
from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.conversation.recent_texts import RecentTexts
from gcs.bridge.effects import Reply
from gcs.bridge.plans.collecting import acknowledgement
from gcs.bridge.plans.effects import PlanEffect, Refused
from gcs.gate.effects import Level
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.effects import Address
from gcs.wire.codec import encode
from gcs.wire.ids import Component, MissionResult, MissionType
from gcs.wire.messages import Message, MissionClearAll, MissionCount, MissionWritePartialList

MISSION_PLANNER: Final = 190
"""MAV_COMP_ID_MISSIONPLANNER: PX4 takes plans that are addressed to it (`mavlink_mission.cpp`)."""

NAMES: Final = {
    MissionType.MISSION: "mission",
    MissionType.FENCE: "fence",
    MissionType.RALLY: "rally points",
}
"""What plans are called in texts."""


def reply(to: From, message: Message) -> Reply:
    """One message for whoever sent `to`."""
    compid = to.addressed.compid
    name = Component.AUTOPILOT1 if compid == MISSION_PLANNER else compid
    return Reply(to.link, Address(to.addressed.sysid, name), message)


def replies(to: From, messages: Sequence[Message]) -> list[PlanEffect]:
    """Each of them for whoever sent `to`."""
    return [reply(to, message) for message in messages]


class Replies:
    """Texts and refusals for one client, whose texts are numbered and not repeated too soon."""

    def __init__(self) -> None:
        self._text_id = 0
        self._texts = RecentTexts()
        self._plans = 0

    def another_plan(self) -> None:
        """From now on it is about another plan: what was said of the one before is news again."""
        self._plans += 1

    def text(
        self, to: From, level: Level, text: str, now_ns: int, request: bytes = b""
    ) -> list[PlanEffect]:
        """The same words of the same plan, and request, not more often than every few seconds."""
        if not self._texts.is_news(text, now_ns, (self._plans, request)):
            return []
        self._text_id = self._text_id % 0xFFFF + 1
        return replies(to, texts(level, text, self._text_id))

    def refuse(
        self,
        asked_by: From,
        message: MissionCount | MissionClearAll | MissionWritePartialList,
        result: MissionResult,
        code: Code,
        text: str,
        now_ns: int,
        *,
        earlier: bool = False,
    ) -> list[PlanEffect]:
        """What is refused without the station's verdict; `earlier` as `Refused` has it."""
        ack = acknowledgement(asked_by.source, result, message.mission_type)
        name = type(message).MSG_ID.name
        return [
            Refused(name, Refusal(code, text), earlier),
            *self.text(asked_by, Level.WARNING, text, now_ns, encode(message)),
            reply(asked_by, ack),
        ]
