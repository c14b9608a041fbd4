"""What a client says about plans goes to its plan server (`plans/`)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from gcs import ipc
from gcs.bridge.catalog import Row
from gcs.bridge.client_plan import ClientPlan
from gcs.bridge.effects import (
    AsksPlan,
    BridgeEffect,
    ClientRefused,
    ForwardToVehicle,
    Reply,
    StopsPlan,
)
from gcs.bridge.judge.received import Judged, Received
from gcs.bridge.judge.set_up import SetUpJudge
from gcs.bridge.peers.client import Exchange
from gcs.bridge.plans import effects as plan_effects
from gcs.bridge.plans.collecting import acknowledgement
from gcs.bridge.plans.downloads import ASKS_ON_NS, Downloads, Reader
from gcs.bridge.plans.effects import PlanEffect
from gcs.bridge.translate.meaning import Seen
from gcs.gate.effects import Level
from gcs.wire.frame import Frame
from gcs.wire.ids import MissionResult, MissionType
from gcs.wire.messages import Message, MissionClearAll, MissionCount, MissionRequestList

KEPT_NS: Final = 30_000_000_000
"""DroneKit asks for a list once, and waits for it as long as this."""
_NOT_MISSION: Final = (MissionType.FENCE, MissionType.RALLY)


class PlanJudge:
    """Of what clients say about the plans of one vehicle."""

    def __init__(self, set_up: SetUpJudge) -> None:
        self._set_up = set_up
        self._downloads = Downloads()
        self._held: dict[Reader, tuple[Received, bool]] = {}
        """Lists that were held back, and whether their clients ask again by themselves."""

    def judge(self, given: Received, message: Message, row: Row) -> Judged:
        """What a client says about missions, fences and rally points."""
        seen, client = given.look(), given.client
        mission_alone = seen is not None and _means_mission_alone(given, message, seen)
        if seen is not None and isinstance(message, MissionCount | MissionClearAll):
            if _takes_off_nothing(given, message, seen) and not client.plans.busy:
                kind = message.mission_type
                done = acknowledgement(given.by.source, MissionResult.ACCEPTED, kind)
                return Judged(False, [Reply(given.by.link, given.by.addressed, done)])
            judged = None if mission_alone else self._set_up.refuses(given, message, row, seen)
            if judged is not None:
                return judged
        busy = seen is not None and seen.plan_transfer
        reader = given.by.link, given.by.source
        held = self._downloads.holds(
            message, reader, busy, given.now_ns, in_control=given.in_control
        )
        before, _ = self._held.get(reader, (None, False))
        again = before is not None and before.frame is given.frame
        if not held:
            self._held.pop(reader, None)
        elif isinstance(message, MissionRequestList) and not again:
            asks_on = before is not None and given.now_ns - before.now_ns <= ASKS_ON_NS
            self._held[reader] = (given, asks_on)
        if held:
            text = f"{row.name}: not now: {held}"
            told = client.dialogue.text(given.by, Level.INFO, text, given.now_ns)
            if not again and self._downloads.answers(reader, given.now_ns):
                kind = getattr(message, "mission_type", MissionType.MISSION)
                no = acknowledgement(given.by.source, MissionResult.ERROR, kind)
                told.append(Reply(given.by.link, given.by.addressed, no))
            return Judged(True, told)
        effects = client.plans.handle(message, given.by, given.now_ns, mission_alone=mission_alone)
        refused = any(
            isinstance(effect, plan_effects.Refused) and not effect.earlier for effect in effects
        )
        return Judged(refused, of_plan(client, effects, given.frame))

    def asked_once(self, now_ns: int) -> list[Received]:
        """Lists that are to be judged once more: nobody else asks for them again."""
        lists = (asked for asked, asks_on in self._held.values() if not asks_on)
        return [asked for asked in lists if now_ns - asked.now_ns <= KEPT_NS]

    def gone(self, link: int) -> None:
        """Nobody who was heard on that link is there any more: its turn to read is over."""
        self._downloads.gone(link)
        self._held = {who: held for who, held in self._held.items() if who[0] != link}


def _takes_off_nothing(
    given: Received, message: MissionCount | MissionClearAll, seen: Seen
) -> bool:
    """An empty fence, or empty rally points, where there are none: QGroundControl sends both with
    every plan (from memory), and whatever the policy says of them, nothing is changed."""
    if isinstance(message, MissionCount) and message.count:
        return False
    return _is_for_autopilot(given) and message.mission_type in seen.not_on_board


def _means_mission_alone(given: Received, message: Message, seen: Seen) -> bool:
    """A clear of all plans where there is no fence and no rally point, and none is on its way."""
    if not isinstance(message, MissionClearAll) or message.mission_type != MissionType.ALL:
        return False
    nothing = all(each in seen.not_on_board for each in _NOT_MISSION)
    under_way = given.client.plans.under_way(_NOT_MISSION)
    return _is_for_autopilot(given) and nothing and not under_way


def _is_for_autopilot(given: Received) -> bool:
    return given.by.addressed.compid == given.autopilot.compid


def of_plan(
    client: Exchange, effects: Sequence[PlanEffect], frame: Frame | None = None
) -> list[BridgeEffect]:
    """What a client's plan server wants; `frame` is what it was given, if it was one."""
    done: list[BridgeEffect] = []
    for effect in effects:
        match effect:
            case Reply():
                done.append(effect)
            case plan_effects.Upload(plan):
                done.append(_ask_plan(client, "mission_upload", plan.source, plan.kind, plan))
            case plan_effects.Clear(kind):
                done.append(_ask_plan(client, "mission_clear", "", kind, None))
            case plan_effects.Withdraw(reason):
                done.append(StopsPlan(client.number, client.plan_ask, reason))
            case plan_effects.Pass() if frame is not None:
                done.append(ForwardToVehicle(frame.raw))
            case plan_effects.Refused(name, refusal):
                ask = ipc.Ask(client.dialogue.number(), name.lower())  # answered already
                done.append(ClientRefused(client.number, ask, refusal))
    return done


def _ask_plan(
    client: Exchange, word: str, source: str, kind: MissionType, plan: ClientPlan | None
) -> AsksPlan:
    client.plan_ask = client.dialogue.number()
    ask = ipc.Ask(client.plan_ask, word, path=source, vehicle=client.vehicle)
    return AsksPlan(client.number, ask, kind, plan)
